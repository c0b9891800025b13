"""Simulation: how fast a floor of twenty rooms answers, and how near the model comes to the paper's figures."""

from collections.abc import Callable
from time import process_time
from typing import Any

import numpy as np

from frontend.scan import Floats
from frontend.sensors.echoes import echoes_around
from frontend.sensors.infrared import InfraredDetector, infrared_codes
from frontend.sensors.lidar import LIDAR
from frontend.sensors.sonar import first_echoes, half_beam_at, sonar_ranges
from frontend.sensors.surfaces import Surfaces
from frontend.sensors.time_of_flight import TIME_OF_FLIGHT, time_of_flight_ranges
from frontend.sensors.transducer import FOOT, INCH, Transducer
from slam.simulation.plans import PLANS
from slam.simulation.record import SENSORS, lidar_scan
from slam.simulation.trajectory import true_poses
from slam.simulation.world import World, build_world
from tests.frontend.sensors.bodies import pole, surfaces_of, wall_at

RUNS = 30
Row = dict[str, Any]


def rows() -> list[Row]:
    """Timings in the office, then the claims of the paper that fix or check the model."""
    world = build_world(PLANS["office"]())
    return [*_timings(world), *_claims()]


def _timings(world: World) -> list[Row]:
    assert world.drive is not None
    places = true_poses(world.drive)[:: len(world.drive.waypoints) // RUNS or 1][:RUNS]
    rng, head, detector = np.random.default_rng(0), Transducer(), InfraredDetector()
    turn, cone = (np.array(SENSORS[name].bearings) for name in ("sonar_infrared", "time_of_flight"))
    walls = world.surfaces
    timed: list[tuple[str, Callable[[Floats], object], float | None]] = [
        ("256 sonar readings", lambda pose: sonar_ranges(walls, pose, turn, head, rng), 50.0),
        ("256 infrared readings", lambda pose: infrared_codes(walls, pose, turn, detector, rng), None),
        ("360 lidar readings", lambda pose: lidar_scan(world, pose, LIDAR, rng), None),
        ("64 cone readings", lambda pose: time_of_flight_ranges(walls, pose, cone, TIME_OF_FLIGHT, rng), None),
    ]
    note = f"median of {len(places)} places in a floor of 20 rooms, {len(walls.segments)} faces, one core"
    return [_row(name, _median_ms(read, places), "ms", target, note) for name, read, target in timed]


def _median_ms(read: Callable[[Floats], object], places: Floats) -> float:
    read(places[0])  # compiles
    took = []
    for pose in places:
        start = process_time()
        read(pose)
        took.append(1e3 * (process_time() - start))
    return float(np.median(took))


def _claims() -> list[Row]:
    head = Transducer()
    heard = _last_heard(surfaces_of(pole(2.5 * FOOT, INCH / 2)), head)
    lost = 90 - _last_heard(wall_at(3 * FOOT, "smooth"), head)
    read = f"the model hears the pole to {heard:.1f}° and loses the wall below {lost:.1f}° from it"
    door = "a door of 30 in 6 ft ahead is closed above 11.8°"
    return [
        _row("1 in pole at 2.5 ft: off the paper's 40°", abs(heard - 40), "deg", 5.0, read),
        _row("smooth wall at 3 ft: off the paper's 25°", abs(lost - 25), "deg", 3.0, read),
        _row("half-beam on a rough wall at 6 ft", _half_beam(6 * FOOT, head), "deg", None, door),
        _row("half-beam on a rough wall at 12 ft", _half_beam(12 * FOOT, head), "deg", None, door),
    ]


def _last_heard(surfaces: Surfaces, head: Transducer) -> float:
    turns = np.radians(np.arange(0.0, 90.0, 0.25))
    echoes = echoes_around(surfaces, np.zeros(2), head, np.random.default_rng(0))
    return float(np.degrees(turns[np.isfinite(first_echoes(echoes, turns, head))].max()))


def _half_beam(distance: float, head: Transducer) -> float:
    return float(np.degrees(half_beam_at(np.array([distance]), head)[0]))


def _row(name: str, value: float, unit: str, target: float | None, note: str) -> Row:
    row: Row = {"part": "simulation", "name": name, "value": round(value, 2), "unit": unit, "better": "lower"}
    return row | {"target": target, "peers": {}, "runs": RUNS if unit == "ms" else 1, "note": note}
