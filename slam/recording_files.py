"""The files of a recording: readings, facts of the sensor, truth and true poses; written all or nothing."""

import csv
import gzip
import io
import json
import shutil
from pathlib import Path
from tempfile import mkdtemp

import numpy as np
from shapely import LineString
from shapely.affinity import affine_transform
from shapely.geometry import mapping
from shapely.geometry.base import BaseGeometry

from frontend.rigid_motion import inverse
from frontend.scan import Floats, Scan
from slam.simulation.trajectory import WheelNoise
from slam.simulation.world import World

FACTS = "recording.toml"
LONG = 10  # scans: a longer recording is compressed


class RecordingPlaceError(Exception):
    """A folder that a recording must not overwrite."""


def write_recording(folder: Path, files: dict[str, bytes]) -> None:
    """Write a recording's files, all or nothing; only an earlier recording gives way, and only to a whole one."""
    if folder.exists() and (not folder.is_dir() or (any(folder.iterdir()) and not (folder / FACTS).exists())):
        raise RecordingPlaceError(f"{folder} exists and is no recording (it has no {FACTS}): choose another folder")
    folder.parent.mkdir(parents=True, exist_ok=True)
    making = Path(mkdtemp(prefix=f".{folder.name}.", dir=folder.parent))
    try:
        for name, content in files.items():
            (making / name).write_bytes(content)
        making.chmod(0o755)
        if folder.exists():
            shutil.rmtree(folder)
        making.rename(folder)
    finally:
        shutil.rmtree(making, ignore_errors=True)


def readings_name(scans: int) -> str:
    """Long recordings are compressed."""
    return "readings.csv" if scans <= LONG else "readings.csv.gz"


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


def recording_toml(world: World, command: str, wheels: WheelNoise, scans: list[Scan]) -> bytes:
    """The facts of a recording: SI units, angles in degrees."""
    sensor = scans[0].sensor
    mount = [sensor.mount[0], sensor.mount[1], float(np.degrees(sensor.mount[2]))]
    infrared = [] if sensor.infrared_range is None else [f"infrared_range = {sensor.infrared_range:.4f}"]
    rows = ", ".join(f"[{metres:g}, {np.degrees(angle):.2f}]" for metres, angle in sensor.half_beams)
    beams = [f"half_beams = [{rows}]  # metres, degrees"] if rows else []
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
        *beams,
        f"range_noise = {sensor.range_noise:.4f}",
        f"quantum = {sensor.quantum:.6f}",
        *infrared,
        f"mount = [{', '.join(f'{value:g}' for value in mount)}]",
        "",
        "[odometry]",
        f"distance_noise = {wheels.distance:g}",
        f"turn_noise = {wheels.turn:g}",
        f"turn_per_metre_noise = {wheels.turn_per_metre:g}",
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
