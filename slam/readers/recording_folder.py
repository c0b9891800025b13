"""Recording folders: `recording.toml` with the robot's facts beside a range table. Truth lying there is never read."""

import math
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path

from frontend.half_beam import HalfBeamSettings, beam_arcs, with_estimated_beam
from frontend.scan import Scan, Sensor
from slam import toml_file
from slam.readers.range_table import parse_header, parse_row
from slam.readers.recording import DamagedLine, OdometryNoise, Recording, RecordingError
from slam.readers.sieve import LineError, Sieve, in_time


@dataclass(frozen=True)
class SensorTable:
    """[sensor] of recording.toml, as `frontend.scan.Sensor` but in degrees. mount: x, y in metres, heading.

    half_beam_degrees: None where nobody measured it. half_beams: pairs of metres and degrees from near to far.
    """

    kind: str
    max_range: float
    min_range: float = 0.0
    half_beam_degrees: float | None = None
    range_noise: float = 0.02
    quantum: float = 0.0
    infrared_range: float | None = None
    mount: tuple[float, float, float] = (0.0, 0.0, 0.0)
    half_beams: tuple[tuple[float, float], ...] = ()

    @property
    def sensor(self) -> Sensor:
        """The same facts in the units of the front end."""
        x, y, heading = self.mount
        half_beam, mount = math.radians(self.half_beam_degrees or 0.0), (x, y, math.radians(heading))
        facts = (self.kind, self.max_range, self.min_range, half_beam, self.range_noise, self.quantum)
        half_beams = tuple((metres, math.radians(degrees)) for metres, degrees in self.half_beams)
        return Sensor(*facts, self.infrared_range, mount, half_beams)


@dataclass(frozen=True)
class RecordingTable:
    """The whole of recording.toml. command: what made the recording, if it was simulated."""

    name: str
    sensor: SensorTable
    readings: str = "readings.csv"
    description: str = ""
    command: str = ""
    odometry: OdometryNoise | None = None


def read_recording_folder(folder: Path, strict: bool) -> Recording:
    """The folder's recording."""
    facts = toml_file.load(folder / "recording.toml", RecordingTable)
    if Path(facts.readings).name != facts.readings:
        named = f"readings = {facts.readings!r}"
        raise RecordingError(
            f"{folder / 'recording.toml'}: {named} may lie outside the folder, but must be a file in it"
        )
    table = read_range_table(folder / facts.readings, strict, facts.sensor.sensor)
    scans, damaged = table.scans, table.damaged
    if facts.sensor.kind == "sonar_infrared" and facts.sensor.half_beam_degrees is None:
        try:
            scans = beam_from_arcs(scans)
        except LineError as doubt:
            damaged = (*damaged, DamagedLine("recording.toml", 1, str(doubt)))
    return Recording(facts.name, scans, damaged, facts.odometry)


def beam_from_arcs(scans: tuple[Scan, ...]) -> tuple[Scan, ...]:
    """The scans of a sonar whose half-beam nobody measured, with what its own readings tell of it."""
    settings = HalfBeamSettings()
    arcs = beam_arcs(scans, settings)
    sensor = with_estimated_beam(scans[0].sensor, arcs, settings)
    if sensor is None:
        raise LineError(
            f"no half_beam_degrees, and {arcs.distances.size} clean arcs of walls in {len(scans)} scans are too few to "
            "tell it: the ranges are taken as they were read"
        )
    return tuple(replace(scan, sensor=sensor) for scan in scans)


def read_range_table(path: Path, strict: bool, sensor: Sensor) -> Recording:
    """The range table at `path`, seen by `sensor`."""
    sieve = Sieve(path, strict=strict)
    lines = ((number, text) for number, text in sieve.lines() if text.strip() and not text.startswith("#"))
    number, first = next(lines, (1, ""))
    try:
        header = parse_header(first)
    except LineError as damage:
        raise RecordingError(f"{path.name} line {number}: {damage}") from damage
    scans = tuple(sieve.through(lines, in_time(partial(parse_row, header=header, sensor=sensor))))
    sieve.check()
    return Recording(path.name.split(".")[0], scans, tuple(sieve.damaged))
