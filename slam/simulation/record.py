"""A recording made in a floor plan: a folder with the readings, the sensor's facts, the truth and the true poses."""

import csv
import gzip
import io
import json
import shutil
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from tempfile import mkdtemp

import numpy as np
from numpy.typing import NDArray
from shapely import LineString, Point
from shapely.affinity import affine_transform
from shapely.geometry import mapping
from shapely.geometry.base import BaseGeometry

from frontend.rigid_motion import compose, inverse
from frontend.scan import Floats, Scan, Sensor
from frontend.sensors.infrared import InfraredDetector, infrared_codes
from frontend.sensors.lidar import LIDAR, lidar_ranges
from frontend.sensors.sonar import SONAR, sonar_ranges
from frontend.sensors.surfaces import Surfaces
from frontend.sensors.time_of_flight import TIME_OF_FLIGHT, time_of_flight_ranges
from frontend.sensors.transducer import Transducer
from slam.simulation.trajectory import WheelNoise, in_first_frame, read_poses, true_poses, wheel_odometry
from slam.simulation.world import World, read_plan

SECONDS_PER_SCAN = 30.0  # a head that stops 256 times a turn takes its time

Reading = tuple[Floats, NDArray[np.int16] | None]


class SimulationError(Exception):
    """A simulation that cannot be run; the message carries the numbers."""


@dataclass(frozen=True)
class SimulatedSensor:
    """A sensor that can be simulated: its facts, its bearings (n,), and how it reads a world from a pose."""

    sensor: Sensor
    bearings: tuple[float, ...]
    read: Callable[[Surfaces, Floats, Floats, np.random.Generator], Reading]


def _sonar_infrared(surfaces: Surfaces, pose: Floats, bearings: Floats, rng: np.random.Generator) -> Reading:
    ranges = sonar_ranges(surfaces, pose, bearings, Transducer(), rng)
    return ranges, infrared_codes(surfaces, pose, bearings, InfraredDetector(), rng)


def _lidar(surfaces: Surfaces, pose: Floats, bearings: Floats, rng: np.random.Generator) -> Reading:
    return lidar_ranges(surfaces, pose, bearings, LIDAR, rng), None


def _time_of_flight(surfaces: Surfaces, pose: Floats, bearings: Floats, rng: np.random.Generator) -> Reading:
    return time_of_flight_ranges(surfaces, pose, bearings, TIME_OF_FLIGHT, rng), None


def _full_turn(count: int) -> tuple[float, ...]:
    """Bearings of a full turn, to the four decimals of a degree that a recording keeps."""
    return tuple(np.radians(np.round(np.linspace(-180.0, 180.0, count, endpoint=False), 4)))


SENSORS = {
    "sonar_infrared": SimulatedSensor(SONAR, _full_turn(256), _sonar_infrared),
    "lidar": SimulatedSensor(LIDAR, _full_turn(360), _lidar),
    "time_of_flight": SimulatedSensor(TIME_OF_FLIGHT, _full_turn(64), _time_of_flight),
}


@dataclass(frozen=True)
class Recipe:
    """What makes a recording besides its world: the sensor's name, the seed, and how the wheels err."""

    sensor: str = "sonar_infrared"
    seed: int = 0
    wheels: WheelNoise = field(default_factory=WheelNoise)

    @property
    def simulated(self) -> SimulatedSensor:
        """The sensor of that name."""
        if self.sensor not in SENSORS:
            raise SimulationError(f"no sensor is called {self.sensor!r}, known are {', '.join(SENSORS)}")
        return SENSORS[self.sensor]


def simulate(plan: Path, recipe: Recipe, out: Path, poses: Path | None = None) -> None:
    """Drive through a plan file and write what the sensor read to the folder `out`.

    poses: a file of `time x y z qx qy qz qw` lines, true poses in the plan's frame; without it the plan's own drive.
    Raises SimulationError, PlanError or TrajectoryError.
    """
    world = read_plan(plan)
    if poses is not None:
        stood = read_poses(poses)
    elif world.drive is not None:
        stood = true_poses(world.drive)
    else:
        raise SimulationError(f"{plan} has no drive, so a file of poses must be given")
    command = (
        f"roomsketch simulate {plan.as_posix()} --sensor {recipe.sensor} --out {out.as_posix()} --seed {recipe.seed}"
    )
    if poses is not None:
        command += f" --poses {poses.as_posix()}"
    scans = drive_through(world, stood, recipe)
    write_recording(
        out, {"recording.toml": recording_toml(recipe, world, command, scans)} | files_of(world, stood, scans)
    )


def drive_through(world: World, poses: Floats, recipe: Recipe) -> list[Scan]:
    """The scans read from true poses (p, 3), with the odometry of the wheels; the same for the same seed."""
    for number, pose in enumerate(poses):
        if not world.free.contains(Point(pose[:2])):
            raise SimulationError(f"pose {number} at {pose[0]:.2f}, {pose[1]:.2f} does not stand in free space")
    simulated = recipe.simulated
    mount, bearings = np.array(simulated.sensor.mount), np.array(simulated.bearings)
    rng = np.random.default_rng(recipe.seed)
    odometry = wheel_odometry(poses, recipe.wheels, rng)
    scans = []
    for number, (pose, believed) in enumerate(zip(poses, odometry, strict=True)):
        ranges, infrared = simulated.read(world.surfaces, compose(pose, mount), bearings, rng)
        scans.append(Scan(bearings, ranges, simulated.sensor, believed, number * SECONDS_PER_SCAN, infrared))
    return scans


def files_of(world: World, poses: Floats, scans: list[Scan]) -> dict[str, bytes]:
    """The readings, the truth and the true poses, by file name."""
    return {
        readings_name(len(scans)): readings_csv(scans),
        "truth.geojson": truth_geojson(world, poses[0]),
        "true.tum": tum_lines(in_first_frame(poses), scans),
    }


def write_recording(folder: Path, files: dict[str, bytes]) -> None:
    """Write a recording's files, all or nothing: an older recording of that name stays until the new one is whole."""
    folder.parent.mkdir(parents=True, exist_ok=True)
    making = Path(mkdtemp(prefix=f".{folder.name}-", dir=folder.parent))
    try:
        for name, content in files.items():
            (making / name).write_bytes(content)
        making.chmod(0o755)
        if folder.exists():
            shutil.rmtree(folder)
        making.rename(folder)
    except BaseException:
        shutil.rmtree(making, ignore_errors=True)
        raise


def readings_name(scans: int) -> str:
    """Long recordings are compressed."""
    return "readings.csv" if scans <= 10 else "readings.csv.gz"


def readings_csv(scans: list[Scan]) -> bytes:
    """One line per scan under a header that names every bearing in degrees; compressed where the name says so."""
    degrees = [f"{bearing:.4f}" for bearing in np.degrees(scans[0].bearings)]
    header = ["time", "x", "y", "heading", *(f"range@{bearing}" for bearing in degrees)]
    if scans[0].infrared is not None:
        header += [f"infrared@{bearing}" for bearing in degrees]
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(header)
    writer.writerows(_row(scan) for scan in scans)
    plain = text.getvalue().encode()
    return plain if readings_name(len(scans)).endswith("csv") else gzip.compress(plain, mtime=0)


def _row(scan: Scan) -> list[str]:
    pose = [f"{scan.time:.3f}", *(f"{value:.6f}" for value in scan.odometry)]
    ranges = ["" if np.isinf(distance) else f"{distance:.4f}" for distance in scan.ranges]
    codes = [] if scan.infrared is None else [f"{code:d}" for code in scan.infrared]
    return pose + ranges + codes


def recording_toml(recipe: Recipe, world: World, command: str, scans: list[Scan]) -> bytes:
    """The facts of a recording: SI units, angles in degrees."""
    sensor = scans[0].sensor
    mount = [sensor.mount[0], sensor.mount[1], float(np.degrees(sensor.mount[2]))]
    infrared = [] if sensor.infrared_range is None else [f"infrared_range = {sensor.infrared_range:.4f}"]
    lines = [
        f"name = {json.dumps(world.name)}",
        f"description = {json.dumps(world.description)}",
        f"command = {json.dumps(command)}",
        f'readings = "{readings_name(len(scans))}"',
        "",
        "[sensor]",
        f'kind = "{sensor.kind}"',
        f"min_range = {sensor.min_range:.4f}",
        f"max_range = {sensor.max_range:.4f}",
        f"half_beam_degrees = {np.degrees(sensor.half_beam):.2f}",
        f"range_noise = {sensor.range_noise:.4f}",
        f"quantum = {sensor.quantum:.6f}",
        *infrared,
        f"mount = [{', '.join(f'{value:g}' for value in mount)}]",
        "",
        "[odometry]",
        f"distance_noise = {recipe.wheels.distance:g}",
        f"turn_noise = {recipe.wheels.turn:g}",
        f"turn_per_metre_noise = {recipe.wheels.turn_per_metre:g}",
        "",
    ]
    return "\n".join(lines).encode()


def truth_geojson(world: World, first: Floats) -> bytes:
    """The plan in the frame of the first true pose (3,): free space, walls, obstacles and doors."""
    parts: list[tuple[BaseGeometry, dict[str, object]]] = [(world.free, {"kind": "free"})]
    for body in world.solids:
        kind = "obstacle" if body.kind == "obstacle" else "wall"
        parts.append((body.outline, {"kind": kind, "material": body.material}))
    parts += [
        (LineString(door.jambs), {"kind": "door", "name": door.name, "open": door.is_open}) for door in world.doors
    ]
    features = [
        {"type": "Feature", "properties": properties, "geometry": _placed(geometry, inverse(first))}
        for geometry, properties in parts
    ]
    return json.dumps({"type": "FeatureCollection", "features": features}).encode() + b"\n"


def _placed(geometry: BaseGeometry, motion: Floats) -> dict[str, object]:
    cosine, sine = float(np.cos(motion[2])), float(np.sin(motion[2]))
    moved = affine_transform(geometry, [cosine, -sine, sine, cosine, float(motion[0]), float(motion[1])])
    rounded: dict[str, object] = json.loads(
        json.dumps(mapping(moved)), parse_float=lambda digits: round(float(digits), 4)
    )
    return rounded


def tum_lines(poses: Floats, scans: list[Scan]) -> bytes:
    """Lines of time x y z qx qy qz qw for poses (p, 3)."""
    lines = [
        f"{scan.time:.3f} {x:.6f} {y:.6f} 0 0 0 {np.sin(heading / 2):.8f} {np.cos(heading / 2):.8f}\n"
        for scan, (x, y, heading) in zip(scans, poses, strict=True)
    ]
    return "".join(lines).encode()


def lidar_scan(world: World, pose: Floats, sensor: Sensor, rng: np.random.Generator) -> Floats:
    """Ranges (360,) of a full turn from a pose (3,) of the sensor."""
    return lidar_ranges(world.surfaces, pose, np.array(SENSORS["lidar"].bearings), sensor, rng)
