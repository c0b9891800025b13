"""A recording made in a floor plan: a folder with the readings, the sensor's facts, the truth and the true poses."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from shapely import Point

from frontend.rigid_motion import compose
from frontend.scan import Floats, Scan, Sensor
from frontend.sensors.infrared import InfraredDetector, infrared_codes
from frontend.sensors.lidar import LIDAR, lidar_ranges
from frontend.sensors.sonar import SONAR, sonar_ranges
from frontend.sensors.surfaces import Surfaces
from frontend.sensors.time_of_flight import TIME_OF_FLIGHT, time_of_flight_ranges
from frontend.sensors.transducer import Transducer
from slam.readers.recording import OdometryNoise
from slam.recording_files import FACTS, readings_csv, readings_name, recording_toml, write_recording
from slam.simulation.trajectory import WheelNoise, in_first_frame, true_poses, wheel_odometry
from slam.simulation.truth import truth_geojson
from slam.simulation.world import Drive, World, read_plan
from slam.trajectory_file import read_trajectory, tum_text

Reading = tuple[Floats, NDArray[np.int16] | None]


class SimulationError(Exception):
    """A simulation that cannot be run; the message carries the numbers."""


@dataclass(frozen=True)
class SimulatedSensor:
    """A sensor that can be simulated: facts, bearings (n,), seconds a scan, and how it reads a world from a pose."""

    sensor: Sensor
    bearings: tuple[float, ...]
    seconds: float
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
    "sonar_infrared": SimulatedSensor(SONAR, _full_turn(256), 30.0, _sonar_infrared),
    "lidar": SimulatedSensor(LIDAR, _full_turn(360), 0.5, _lidar),
    "time_of_flight": SimulatedSensor(TIME_OF_FLIGHT, _full_turn(64), 2.0, _time_of_flight),
}


@dataclass(frozen=True)
class Recipe:
    """What makes a recording besides its world: the sensor's name, the seed of all noise, and how the wheels err.

    wheels: None takes what the plan's drive says.
    """

    sensor: str = "sonar_infrared"
    seed: int = 0
    wheels: WheelNoise | None = None

    @property
    def simulated(self) -> SimulatedSensor:
        """The sensor of that name."""
        if self.sensor not in SENSORS:
            raise SimulationError(f"no sensor is called {self.sensor!r}, known are {', '.join(SENSORS)}")
        return SENSORS[self.sensor]

    def wheel_noise(self, drive: Drive | None) -> WheelNoise:
        """The recipe's own wheels, or those of the drive."""
        if self.wheels is not None or drive is None:
            return self.wheels or WheelNoise()
        unknown = sorted(set(drive.wheels) - set(WheelNoise.__dataclass_fields__))
        if unknown:
            raise SimulationError(f"the drive's wheels have no {unknown[0]!r}")
        return WheelNoise(**drive.wheels)


def simulate(plan: Path, recipe: Recipe, out: Path, poses: Path | None = None) -> None:
    """Drive through a plan file and write what the sensor read to the folder `out`.

    poses: a file of `time x y z qx qy qz qw` lines, true poses in the plan's frame; without it the plan's own drive.
    Raises SimulationError, PlanError, TrajectoryFileError or OutputError.
    """
    world = read_plan(plan)
    if poses is not None:
        stood = read_trajectory(poses).poses
    elif world.drive is not None:
        stood = true_poses(world.drive)
    else:
        raise SimulationError(f"{plan} has no drive, so a file of poses must be given")
    scans = drive_through(world, stood, recipe)
    command = (
        f"roomsketch simulate {plan.as_posix()} --sensor {recipe.sensor} --out {out.as_posix()} --seed {recipe.seed}"
    )
    if poses is not None:
        command += f" --poses {poses.as_posix()}"
    wheels = recipe.wheel_noise(world.drive)
    noise = OdometryNoise(wheels.distance, wheels.turn, wheels.turn_per_metre)
    about = {"name": world.name, "description": world.description, "command": command}
    files = {
        FACTS: recording_toml(about, noise, scans),
        readings_name(len(scans)): readings_csv(scans),
        "truth.geojson": truth_geojson(world, stood[0]),
        "true.tum": tum_text(np.array([scan.time for scan in scans]), in_first_frame(stood)).encode(),
    }
    write_recording(out, files)


def drive_through(world: World, poses: Floats, recipe: Recipe) -> list[Scan]:
    """The scans read from true poses (p, 3), with the odometry of the wheels; the same for the same seed."""
    for number, pose in enumerate(poses):
        if not world.free.contains(Point(pose[:2])):
            raise SimulationError(f"pose {number} at {pose[0]:.2f}, {pose[1]:.2f} does not stand in free space")
    simulated = recipe.simulated
    mount, bearings = np.array(simulated.sensor.mount), np.array(simulated.bearings)
    rng = np.random.default_rng(recipe.seed)
    odometry = wheel_odometry(poses, recipe.wheel_noise(world.drive), rng)
    scans = []
    for number, (pose, believed) in enumerate(zip(poses, odometry, strict=True)):
        ranges, infrared = simulated.read(world.surfaces, compose(pose, mount), bearings, rng)
        scans.append(Scan(bearings, ranges, simulated.sensor, believed, number * simulated.seconds, infrared))
    return scans


def lidar_scan(world: World, pose: Floats, sensor: Sensor, rng: np.random.Generator) -> Floats:
    """Ranges (360,) of a full turn from a pose (3,) of the sensor."""
    return lidar_ranges(world.surfaces, pose, np.array(SENSORS["lidar"].bearings), sensor, rng)
