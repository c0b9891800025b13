"""Cones to look at: spines with the free strip on both sides, slice by slice."""

from functools import partial

import numpy as np
from numpy.typing import NDArray

from planners.compiled import compiled, kernel
from planners.orientations import room_before
from planners.path import Cone
from planners.slices import Slices

Floats = NDArray[np.float64]


def cone_outlines(slices: Slices, ends: Floats, lines: Floats, pairs: Floats) -> tuple[Cone, ...]:
    """Every cone, to be outlined when it is looked at: as far as its own two walls reach, or another obstacle.

    ends (m, 4) of the walls; lines (f, 3), normals and offsets, of the faces, and pairs (k, 2) of them.
    """
    cones = []
    for cone, pair in enumerate(pairs.astype(int)):
        rows = slice(slices.first[cone], slices.first[cone + 1])
        pieces = slices.pieces[rows]
        spine = np.stack([pieces[0, :2], pieces[-1, 2:]])
        cones.append(Cone(spine, slices.legal[rows], partial(_outline, pieces, ends, lines[pair])))
    return tuple(cones)


def _outline(pieces: Floats, ends: Floats, lines: Floats) -> Floats:
    """Corners (4n, 2) around n slices between two walls' lines (2, 3)."""
    across = lines[0, :2] - lines[1, :2]
    across = across / np.linalg.norm(across)
    one, two = _side(pieces, across, ends, lines[0]), _side(pieces, -across, ends, lines[1])
    return np.concatenate([one, two[::-1]])


def _side(pieces: Floats, normal: Floats, ends: Floats, line: Floats) -> Floats:
    """Corners (2n, 2) of one side over n slices: on the wall's line (3,), or as near as an obstacle comes.

    normal: unit vector (2,) across the spine, away from the side.
    """
    points = pieces.reshape(-1, 2)
    radii = np.maximum((points @ line[:2] - line[2]) / (normal @ line[:2]), 0)
    narrow = radii.reshape(-1, 2).min(axis=1)
    rooms = np.repeat(_rooms(pieces, np.ascontiguousarray(normal), ends, float(narrow.max())), 2)
    narrow = np.repeat(narrow, 2)
    # A wall in line with the side is as near as the side's narrow end; only nearer ones cut the cone.
    radii = np.where(rooms < 0.999 * narrow, rooms, radii)
    return np.asarray(points - radii[:, None] * normal)


@kernel
def _beside(pieces: Floats, normal: Floats, ends: Floats, most: float) -> Floats:
    """The walls (k, 4) that come beside pieces (n, 4) of one line, against a unit normal, nearer than `most`."""
    last, kept, count = pieces.shape[0] - 1, np.empty_like(ends), 0
    one = normal[0] * pieces[0, 1] - normal[1] * pieces[0, 0]
    two = normal[0] * pieces[last, 3] - normal[1] * pieces[last, 2]
    here = normal[0] * pieces[0, 0] + normal[1] * pieces[0, 1]
    for k in range(ends.shape[0]):
        first = normal[0] * ends[k, 1] - normal[1] * ends[k, 0]
        second = normal[0] * ends[k, 3] - normal[1] * ends[k, 2]
        near = here - normal[0] * ends[k, 0] - normal[1] * ends[k, 1]
        far = here - normal[0] * ends[k, 2] - normal[1] * ends[k, 3]
        along = max(first, second) >= min(one, two) and min(first, second) <= max(one, two)
        if along and max(near, far) > 0 and min(near, far) <= most:
            for each in range(4):
                kept[count, each] = ends[k, each]
            count += 1
    return kept[:count].copy()


@compiled
def _rooms(pieces: Floats, normal: Floats, ends: Floats, most: float) -> Floats:
    """Distance (n,) against a unit normal from each of `pieces` (n, 4) of one line to the nearest wall beside it.

    It may be too great where it is greater than `most`.
    """
    rooms, beside = np.full(pieces.shape[0], np.inf), _beside(pieces, normal, ends, most)
    for k in range(pieces.shape[0]):
        for wall in range(beside.shape[0]):
            room = room_before(pieces[k], beside[wall], normal, 0.0)
            if room > 0:
                rooms[k] = min(rooms[k], room)
    return rooms
