"""Scoring the result of a run against what is known of the truth: a plan, poses, or relations checked by hand."""

from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np
import shapely
from shapely import MultiPolygon, Polygon
from shapely.geometry.base import BaseGeometry

from frontend.rigid_motion import transform
from frontend.scan import Floats, Scan
from frontend.sensors.rays import cast
from frontend.sensors.surfaces import MATERIALS, join_rings
from slam.result_folder import MAP, ODOMETRY, TRAJECTORY, read_report, recording_of
from slam.room_file import free_space, read_features, read_room
from slam.scores.maps import MapTruth, best_alignment, moved, score_map
from slam.scores.trajectories import (
    Spread,
    Track,
    absolute_errors,
    align,
    read_relations,
    relation_errors,
    relative_errors,
)
from slam.trajectory_file import Trajectory, TrajectoryFileError, read_trajectory

VISIBLE_RAYS = 3600  # a tenth of a degree
STRAIGHT = 1e-6  # metres off a line at which a point of it is no corner

Scores = dict[str, Any]


def pose_scores(folder: Path, reference: Path) -> Scores:
    """Errors in metres and radians after the best rigid alignment, ours and those of the odometry alone."""
    true, ours, wheels = read_trajectory(reference), _track(folder), _wheels(folder)
    within = (true.times >= ours.times[0] - 1e-6) & (true.times <= ours.times[-1] + 1e-6)
    if within.sum() < 2:
        raise TrajectoryFileError(f"{reference.name}: {within.sum()} poses lie in the time of the run, 2 are needed")
    times = true.times[within]
    estimated, dead_reckoned = (np.array([track.at(time) for time in times]) for track in (ours, wheels))
    positions = true.positions[within]
    scores: Scores = {
        "position": asdict(Spread.of(absolute_errors(estimated[:, :2], positions))),
        "position, scale undone": asdict(Spread.of(absolute_errors(scaled_to(estimated[:, :2], positions), positions))),
        "position by odometry alone": asdict(Spread.of(absolute_errors(dead_reckoned[:, :2], positions))),
    }
    if true.headings is not None:
        metres, radians = relative_errors(estimated, true.poses[within])
        scores |= {"step": asdict(Spread.of(metres)), "turn": asdict(Spread.of(radians))}
    return scores


def scaled_to(estimated: Floats, true: Floats) -> Floats:
    """Positions (n, 2) stretched about their mean to the scale that fits the true ones best (Umeyama 1991).

    A camera that looks down on a robot sees it nearer, and so larger, than the floor it was calibrated on.
    """
    turned = transform(estimated - estimated.mean(axis=0), np.array([0.0, 0.0, align(estimated, true)[2]]))
    scale = float(np.sum(turned * (true - true.mean(axis=0))) / max(float(np.sum(turned**2)), 1e-12))
    return np.asarray(estimated.mean(axis=0) + scale * (estimated - estimated.mean(axis=0)))


def relation_scores(folder: Path, relations: Path) -> Scores:
    """Errors over the relations in metres and radians, ours and those of the odometry alone."""
    known = read_relations(relations)
    (metres, radians), (by_wheels, _) = (relation_errors(track, known) for track in (_track(folder), _wheels(folder)))
    return {
        "translation": asdict(Spread.of(metres)),
        "rotation": asdict(Spread.of(radians)),
        "translation by odometry alone": asdict(Spread.of(by_wheels)),
    }


def map_scores(folder: Path, truth: MapTruth) -> Scores:
    """The map against the truth in the first pose's frame, and again after the best small alignment.

    The raw readings at our poses are scored beside the map.
    """
    room = read_room(folder / MAP)
    poses = read_trajectory(folder / TRAJECTORY).poses
    raw = raw_free_space(recording_of(read_report(folder)).scans, poses)
    return {
        "map": asdict(score_map(room, truth)),
        "map aligned": asdict(score_map(moved(room, best_alignment(room, truth)), truth)),
        "raw boundaries": {"iou": overlap(raw, truth.seen), "false_free": raw.difference(truth.free).area},
    }


def map_truth(folder: Path, plan: Path, reference: Path | None) -> MapTruth:
    """The plan, and what of it the sensor of the run could see from the true poses, or all of it without these."""
    reach = read_report(folder)["recording"]["max_range"]
    return _truth(plan, None if reference is None else read_trajectory(reference), reach)


def raw_free_space(scans: tuple[Scan, ...], poses: Floats) -> BaseGeometry:
    """The union of the readings' boundaries as the sensor gave them, at poses (n, 3)."""
    return shapely.union_all([_raw_boundary(scan, pose) for scan, pose in zip(scans, poses, strict=True)])


def visible(free: MultiPolygon, poses: Floats, reach: float) -> BaseGeometry:
    """The part of free space that a thin beam from poses (n, 3) could see within `reach` metres."""
    oriented = shapely.orient_polygons(free)
    rings = [np.asarray(ring.coords)[:-1] for part in oriented.geoms for ring in (part.exterior, *part.interiors)]
    materials = [[MATERIALS["rough"]] * len(ring) for ring in rings]
    surfaces = join_rings(rings, materials, [np.full(len(ring), np.inf) for ring in rings])
    angles = np.linspace(-np.pi, np.pi, VISIBLE_RAYS, endpoint=False)
    rays = np.column_stack([np.cos(angles), np.sin(angles)])
    views = [pose[:2] + np.minimum(cast(surfaces, pose[:2], angles)[0], reach)[:, None] * rays for pose in poses]
    straight = shapely.simplify([Polygon(view) for view in views], STRAIGHT)  # rays along one wall add no corner
    return shapely.union_all(shapely.make_valid(straight)).intersection(free)


def overlap(ours: BaseGeometry, theirs: BaseGeometry) -> float:
    """Intersection over union."""
    return float(ours.intersection(theirs).area / ours.union(theirs).area)


def _raw_boundary(scan: Scan, pose: Floats) -> BaseGeometry:
    usable = ~np.isnan(scan.ranges)
    ranges, bearings = np.minimum(scan.ranges[usable], scan.sensor.max_range), scan.bearings[usable]
    ends = ranges[:, None] * np.column_stack([np.cos(bearings), np.sin(bearings)])
    ring = ends if scan.full_turn else np.vstack([ends, np.zeros((1, 2))])
    return shapely.make_valid(Polygon(transform(transform(ring, np.array(scan.sensor.mount)), pose)))


def _truth(plan: Path, true: Trajectory | None, reach: float) -> MapTruth:
    features = read_features(plan)
    obstacles = tuple(
        shape for shape, says in features if says.get("kind") == "obstacle" and isinstance(shape, Polygon)
    )
    jambs = [shapely.get_coordinates(shape) for shape, says in features if says.get("kind") == "door"]
    free, _ = free_space(plan, "free")
    seen = free if true is None else visible(free, true.poses, reach)
    return MapTruth(free, seen, np.array(jambs).reshape(-1, 2, 2), obstacles)


def _track(folder: Path) -> Track:
    ours, wheels = read_trajectory(folder / TRAJECTORY), read_trajectory(folder / ODOMETRY)
    return Track(ours.times, ours.poses, wheels.times, wheels.poses)


def _wheels(folder: Path) -> Track:
    wheels = read_trajectory(folder / ODOMETRY)
    return Track(wheels.times, wheels.poses, wheels.times, wheels.poses)
