"""Maps from sonar and infrared: the paper's basement, a furnished apartment, and random floors.

At the poses of our own back end and, to tell what is the merge's own, at the true ones. A map is judged in the frame
of its first pose and, where it says so, after the best rigid alignment. On floors of smooth walls every wall is a
mirror to the sonar.
"""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import shapely
from shapely import MultiPolygon, Polygon

from backend.polygon_merging import merge_views
from backend.room_map import RoomMap
from backend.thin_rectangles import free_space as from_rectangles
from backend.thin_rectangles import thin_rectangles
from frontend.rigid_motion import inverse, transform
from frontend.scan import Floats, Scan
from slam.door_tracking import sharpened_views
from slam.perception import perceive
from slam.pipeline import merge_scans
from slam.readers.recording import OdometryNoise
from slam.recordings import open_recording
from slam.room_file import free_space, read_features
from slam.scores.maps import MapScores, MapTruth, best_alignment, moved, score_map
from slam.scores.results import visible
from slam.settings import Settings, knowing
from slam.simulation.floors import Plan
from slam.simulation.random_plans import random_plan
from slam.simulation.record import Recipe, drive_through
from slam.simulation.trajectory import in_first_frame, true_poses
from slam.simulation.world import World, build_world
from slam.trajectory_file import read_trajectory

DATASETS = Path(__file__).parents[2] / "datasets"
FLOORS = (51, 52, 53, 54)  # seeds of random floors of six rooms, and of their drives
JAMB = 0.10  # metres, the target for both jambs of a door
Row = dict[str, Any]


@dataclass(frozen=True, eq=False)
class Drive:
    """Scans of one drive, their true poses (n, 3) in the frame of the first one, the truth there, and the wheels."""

    scans: list[Scan]
    poses: Floats
    truth: MapTruth
    wheels: OdometryNoise | None


def rows() -> list[Row]:
    """All rows of the part."""
    basement, apartment = recorded("flynn_basement"), recorded("apartment")
    rough = [driven(random_plan(seed, 6), seed) for seed in FLOORS]
    smooth = [driven(plastered(random_plan(seed, 6)), seed) for seed in FLOORS]
    rooms = [at_true_poses(drive) for drive in (basement, apartment)]
    own = (at_own_poses(apartment), apartment.truth)
    driven_own = [(at_own_poses(drive), drive.truth) for drive in rough]
    return [
        *rows_of("basement, true poses", [(rooms[0], basement.truth)], 0.80),
        *rows_of("apartment, true poses", [(rooms[1], apartment.truth)], None),
        *rows_of("apartment, own poses", [own], 0.93),
        *rows_of("apartment, own poses, aligned", [aligned(*own)], 0.93),
        *rows_of("random floors, true poses", [(at_true_poses(drive), drive.truth) for drive in rough], None),
        *rows_of("random floors, own poses", driven_own, None),
        *rows_of("random floors, own poses, aligned", [aligned(*pair) for pair in driven_own], None),
        *rows_of("smooth floors, true poses", [(at_true_poses(drive), drive.truth) for drive in smooth], None),
        *(rectangle_row(name, room) for name, room in zip(("basement", "apartment"), rooms, strict=True)),
    ]


def recorded(name: str) -> Drive:
    """A recording of the project with its truth."""
    folder = DATASETS / name
    recording, true = open_recording(folder), read_trajectory(folder / "true.tum").poses
    features, (free, _) = read_features(folder / "truth.geojson"), free_space(folder / "truth.geojson", "free")
    kinds = [(thing, str(says.get("kind"))) for thing, says in features]
    obstacles = tuple(thing for thing, kind in kinds if kind == "obstacle" and isinstance(thing, Polygon))
    jambs = np.array([shapely.get_coordinates(thing) for thing, kind in kinds if kind == "door"]).reshape(-1, 2, 2)
    seen = visible(free, true, recording.scans[0].sensor.max_range)
    return Drive(list(recording.scans), true, MapTruth(free, seen, jambs, obstacles), recording.odometry_noise)


def driven(plan: Plan, seed: int) -> Drive:
    """A drive through a plan, read by sonar and infrared."""
    world = build_world(plan)
    assert world.drive is not None
    stood, recipe = true_poses(world.drive), Recipe(seed=seed)
    noise = recipe.wheel_noise(world.drive)
    known = OdometryNoise(
        distance_noise=noise.distance, turn_noise=noise.turn, turn_per_metre_noise=noise.turn_per_metre
    )
    scans, true = drive_through(world, stood, recipe), in_first_frame(stood)
    return Drive(scans, true, truth_of(world, stood, scans[0].sensor.max_range), known)


def plastered(plan: Plan) -> Plan:
    """The plan with every wall smooth."""
    smooth = [
        part | {"properties": part["properties"] | {"material": "smooth"}} if _is_wall(part) else part
        for part in plan["features"]
    ]
    return plan | {"features": smooth}


def _is_wall(part: Plan) -> bool:
    return bool(part["properties"]["kind"] == "wall")


def truth_of(world: World, stood: Floats, reach: float) -> MapTruth:
    """The truth of a world in the frame of the first of the poses (n, 3) it was driven through by."""
    back = inverse(stood[0])
    free = MultiPolygon([shapely.transform(world.free, lambda points: transform(points, back))])
    things = [body.outline for body in world.solids if body.kind == "obstacle"]
    placed = [shapely.transform(thing, lambda points: transform(points, back)) for thing in things]
    jambs = np.array([transform(door.jambs, back) for door in world.doors]).reshape(-1, 2, 2)
    obstacles = tuple(thing for thing in placed if isinstance(thing, Polygon))
    return MapTruth(free, visible(free, in_first_frame(stood), reach), jambs, obstacles)


def at_true_poses(drive: Drive) -> RoomMap:
    """The map of a drive whose poses are known."""
    settings = Settings()
    percepts = [perceive(scan, settings.frontend) for scan in drive.scans]
    sure = np.tile(np.diag([1e-3, 1e-3, 1e-4]) ** 2, (len(percepts), 1, 1))
    views, _ = sharpened_views(percepts, drive.poses, sure, settings.door_edges)
    return merge_views(views, drive.poses, settings.merging)


def at_own_poses(drive: Drive) -> RoomMap:
    """The map of a drive as the whole system makes it."""
    return merge_scans(drive.scans, knowing(Settings(), drive.wheels)).room


def aligned(room: RoomMap, truth: MapTruth) -> tuple[RoomMap, MapTruth]:
    """The map laid rigidly on its truth as well as it will go, and the truth."""
    return moved(room, best_alignment(room, truth)), truth


def rows_of(name: str, maps: list[tuple[RoomMap, MapTruth]], overlap: float | None) -> list[Row]:
    """Medians over maps of one kind, and the worst of several; overlap: the target of the IoU, and who has one has
    the others."""
    scores = [score_map(room, truth) for room, truth in maps]
    aimed = overlap is not None
    measures = {
        "IoU": ([score.iou for score in scores], "higher", overlap),
        "wall breach": ([score.wall_breach for score in scores], "lower", 0.02 if aimed else None),
        "false free": ([score.false_free for score in scores], "lower", None),
        "doors within 15 cm": ([score.doors.recall for score in scores], "higher", 0.9 if aimed else None),
        "named doors right": ([score.doors.precision for score in scores], "higher", None),
        "jamb error": ([score.doors.jamb_error for score in scores], "lower", JAMB if aimed else None),
        "inferred objects right": (_inferred(scores, "precision"), "higher", 0.9 if aimed else None),
        "inferred objects found": (_inferred(scores, "recall"), "higher", 0.8 if aimed else None),
    }
    return [row for what, measure in measures.items() for row in _median_and_worst(f"{name}: {what}", *measure)]


def _inferred(scores: list[MapScores], kind: str) -> list[float]:
    return [float(getattr(score.obstacles, f"inferred_{kind}")) for score in scores]


def _median_and_worst(name: str, values: list[float], better: str, target: float | None) -> list[Row]:
    """The median, and where there are several the worst; maps where there is nothing to judge are left out."""
    known = np.array([value for value in values if np.isfinite(value)])
    if not known.size:
        return []
    said = ", ".join(f"{value:.3f}" for value in known) if len(known) > 1 else ""
    found = [_row(name, float(np.median(known)), better, target, said)]
    if len(known) > 1:
        worst = known.max() if better == "lower" else known.min()
        found.append(_row(f"{name}, worst", float(worst), better, target, ""))
    return found


def rectangle_row(name: str, room: RoomMap) -> Row:
    """What a map loses on its way to thin rectangles and back, beside what a grid of their units would."""
    rectangles = thin_rectangles(room.free)
    lost = from_rectangles(rectangles).symmetric_difference(room.free).area
    grid = 0.5 * rectangles.unit * room.free.length
    return _row(
        f"{name}: area lost as thin rectangles", float(lost), "lower", float(grid), "target: half a unit a side"
    )


def _row(name: str, value: float, better: str, target: float | None, note: str) -> Row:
    unit = "m" if "jamb error" in name else "m²" if "false free" in name or "area" in name else ""
    return {
        "part": "merging", "name": name, "value": value, "unit": unit, "better": better,
        "target": target, "peers": {}, "runs": 1, "note": note,
    }  # fmt: skip
