"""Snapping: measured corners move along their beams onto fused faces, and traced boundaries become runs of faces."""

import numpy as np
from numpy.typing import NDArray

from backend.surfaces import Surfaces
from backend.wall_faces import WallFaces

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Run = tuple[int, int, int]  # first point, one past the last, face (−1 for none)
SQUARE = np.sqrt(2)  # how far off the ring faces within reach of it meet at a right angle, over the reach


def snap_view(ring: Floats, origin: Floats, surfaces: Surfaces, label: Ints, faces: WallFaces) -> Floats:
    """The placed ring (m, 2) with its measured corners on their faces (n,), each moved along its own beam."""
    snapped = ring.copy()
    snapped[surfaces.corner] = onto_faces(ring[surfaces.corner], origin, label, faces)
    return snapped


def onto_faces(points: Floats, origins: Floats, label: Ints, faces: WallFaces) -> Floats:
    """Points (n, 2) moved onto their faces (n,) along the beams from the origins (n, 2) or (2,), where these are not
    too slanting and there is a face."""
    if not len(faces.centres):
        return points
    normals, beam = faces.normals[label], points - origins
    slope = np.sum(beam * normals, axis=1)
    height = np.sum((faces.centres[label] - origins) * normals, axis=1)
    steep = (label >= 0) & (slope < -0.15 * np.linalg.norm(beam, axis=1))
    share = np.where(steep, height / np.where(steep, slope, 1.0), 1.0)
    return np.where(steep[:, None], origins + share[:, None] * beam, points)


def snap_ring(ring: Floats, faces: WallFaces, reach: float) -> Floats:
    """A traced ring (r, 2), free on its left, re-expressed on the faces within `reach` metres of it.

    A ring too short for directions to be read off its steps stays as traced.
    """
    if len(ring) * np.linalg.norm(ring[1] - ring[0]) < 8 * reach:
        return ring
    ahead, behind = np.roll(ring, -3, axis=0), np.roll(ring, 3, axis=0)
    along = (ahead - behind) / np.maximum(np.linalg.norm(ahead - behind, axis=1, keepdims=True), 1e-9)
    label = faces.nearest(ring, np.stack([-along[:, 1], along[:, 0]], axis=1), reach)
    if np.all(label < 0):
        return ring
    ring, runs = _runs(ring, label)
    return _rebuilt(ring, runs, faces, reach)


def _runs(ring: Floats, label: Ints) -> tuple[Floats, list[Run]]:
    """The ring turned so that a run starts it, and its runs of one face; specks of one or two points have no face."""
    changes = np.flatnonzero(label != np.roll(label, 1))
    turn = int(changes[0]) if len(changes) else 0
    ring, label = np.roll(ring, -turn, axis=0), np.roll(label, -turn)
    label = _without_specks(label)
    starts = np.concatenate([[0], np.flatnonzero(np.diff(label)) + 1])
    return ring, [(int(a), int(b), int(label[a])) for a, b in zip(starts, [*starts[1:], len(label)], strict=True)]


def _without_specks(label: Ints) -> Ints:
    """Runs of fewer than three points lose their face, unless the same face goes on within two points."""
    label = label.copy()
    for gap in (1, 2):
        between = (np.roll(label, gap) == np.roll(label, -1)) & (np.roll(label, gap) >= 0)
        label = np.where(between, np.roll(label, -1), label)
    starts = np.concatenate([[0], np.flatnonzero(np.diff(label)) + 1])
    lengths = np.diff(np.append(starts, len(label)))
    return np.where(np.repeat(lengths, lengths) < 3, -1, label)


def _rebuilt(ring: Floats, runs: list[Run], faces: WallFaces, reach: float) -> Floats:
    """Corners of the ring: ends of runs on their faces, the meeting points of neighbours, and free pieces as traced."""
    on_face = [run for run in runs if run[2] >= 0]
    if not on_face:
        return ring
    corners: list[Floats] = []
    for i, (start, end, face) in enumerate(on_face):
        before, after = on_face[i - 1], on_face[(i + 1) % len(on_face)]
        entry = _meeting(ring, before, on_face[i], faces, reach) if len(on_face) > 1 else None
        leave = _meeting(ring, on_face[i], after, faces, reach) if len(on_face) > 1 else None
        corners.append(_foot(ring[start], faces, face) if entry is None else entry)
        if leave is None:
            corners.append(_foot(ring[end - 1], faces, face))
            corners.append(_between(ring, end, after[0]))
    return np.vstack(corners)


def _foot(point: Floats, faces: WallFaces, face: int) -> Floats:
    """The point moved straight onto the face."""
    normal: Floats = faces.normals[face]
    return np.asarray(point - normal * float((point - faces.centres[face]) @ normal))[None]


def _between(ring: Floats, end: int, start: int) -> Floats:
    """The traced points from `end` on to before `start`, around the ring's seam if need be."""
    return ring[end:start] if start >= end else np.vstack([ring[end:], ring[:start]])


def _meeting(ring: Floats, first: Run, second: Run, faces: WallFaces, reach: float) -> Floats | None:
    """Where two runs' faces meet (1, 2), if the ring comes by: faces at an acute angle meet far off it."""
    gap = _between(ring, first[1], second[0])
    one, two = faces.normals[first[2]], faces.normals[second[2]]
    across = float(one[0] * two[1] - one[1] * two[0])
    if abs(across) < 0.25 or len(gap) * np.linalg.norm(ring[1] - ring[0]) > 5 * reach:
        return None
    levels = float(one @ faces.centres[first[2]]), float(two @ faces.centres[second[2]])
    corner = np.array([levels[0] * two[1] - levels[1] * one[1], levels[1] * one[0] - levels[0] * two[0]]) / across
    traced = np.vstack([ring[first[1] - 1], gap, ring[second[0]]])
    near = np.linalg.norm(traced - corner, axis=1).min() < SQUARE * reach
    return corner[None] if near else None
