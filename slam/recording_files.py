"""The files of a recording folder: readings and the facts of the sensor, written all or nothing."""

import csv
import gzip
import io
import json
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from frontend.scan import Scan
from slam.readers.recording import OdometryNoise, RecordingError
from slam.whole_output import whole_folder

FACTS = "recording.toml"
LONG = 10  # scans: a longer recording is compressed


def write_recording(folder: Path, files: dict[str, bytes]) -> None:
    """Write a recording's files, all or nothing; only an earlier recording gives way. Raises OutputError."""
    with whole_folder(folder, FACTS) as making:
        for name, content in files.items():
            (making / name).write_bytes(content)


def readings_name(scans: int) -> str:
    """Long recordings are compressed."""
    return "readings.csv" if scans <= LONG else "readings.csv.gz"


def readings_csv(scans: Sequence[Scan]) -> bytes:
    """One line per scan under a header that names every bearing in degrees; compressed where the name says so.

    Raises RecordingError where the scans do not share their bearings: one header would bend them.
    """
    for number, scan in enumerate(scans):
        if scan.bearings.shape != scans[0].bearings.shape or not np.allclose(scan.bearings, scans[0].bearings, 0, 1e-5):
            raise RecordingError(f"scan {number + 1} has other bearings than the first, but a table has one header")
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
    time = f"{scan.time:.6f}".removesuffix("000")
    pose = [time, *(f"{value:.6f}" for value in scan.odometry)]
    ranges = ["" if np.isinf(distance) else f"{distance:.4f}" for distance in scan.ranges]
    codes = [] if scan.infrared is None else [f"{code:d}" for code in scan.infrared]
    return pose + ranges + codes


def recording_toml(about: dict[str, str], noise: OdometryNoise | None, scans: Sequence[Scan]) -> bytes:
    """The facts of a recording: SI units, angles in degrees. about: its name, description and command."""
    sensor = scans[0].sensor
    mount = [sensor.mount[0], sensor.mount[1], float(np.degrees(sensor.mount[2]))]
    infrared = [] if sensor.infrared_range is None else [f"infrared_range = {sensor.infrared_range:.4f}"]
    rows = ", ".join(f"[{metres:g}, {np.degrees(angle):.2f}]" for metres, angle in sensor.half_beams)
    beams = [f"half_beams = [{rows}]  # metres, degrees"] if rows else []
    lines = [
        *(f"{key} = {json.dumps(text, ensure_ascii=False)}" for key, text in about.items()),
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
    ]
    if noise is not None:
        lines += [
            "",
            "[odometry]",
            f"distance_noise = {noise.distance_noise:g}",
            f"turn_noise = {noise.turn_noise:g}",
            f"turn_per_metre_noise = {noise.turn_per_metre_noise:g}",
        ]
    return "\n".join([*lines, ""]).encode()
