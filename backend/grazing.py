"""Grazing sight: what a wide beam tells of the ground past a wall that it met aslant.

Smooth walls mirror a beam that meets them aslant and the reading is much too long (Flynn 1988, §2.1, Fig. 6): at less
than 25° to them all walls may. A wall that was measured squarely and seen through aslant, at the same places, is a
mirror, and answers no more aslant than it was measured. A beam that crosses the line of a wall more aslant than that
says nothing of what lies behind, as far as the wall may go on, unless another view looked squarely through the line
at the same place: then there is an opening.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from backend.leak_repair import BIN
from backend.samples import Samples
from backend.sight import Sight, sight_of
from backend.wall_faces import WallFaces

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Flags = NDArray[np.bool_]
PAST = 0.05  # metres behind a line that are but the noise of what was measured on it


@dataclass(frozen=True)
class GrazingSettings:
    """Opinions about mirrors."""

    steepest: float = 65.0  # degrees off a wall's normal to which even smooth walls answer; larger finds fewer mirrors
    answered: float = 0.9  # of what was measured of a mirror, that it answers; larger lets it answer more aslant
    seen_through: float = 0.05  # beams aslant through a wall by its samples; larger asks more of them for a mirror
    stray: int = 5  # such beams pass any wall's end; larger asks more of them beside a short wall
    least: float = 0.30  # metres of face; larger follows the lines of longer walls only
    behind: float = 0.10  # metres free before and behind a line; larger takes only deeper gaps for openings


@dataclass(frozen=True, eq=False)
class Walls:
    """Faces, the cosine (f,) of the angle off its normal to which each answers, and the sight of all views, which
    says where their lines are open; settings: by which they were told."""

    faces: WallFaces
    answers: Floats
    sight: Sight
    settings: GrazingSettings


@dataclass(frozen=True, eq=False)
class _Crossings:
    """Beams (n,) of a ring that cross lines of faces (n,): at which share (n,) of their length, and where (n, 2)."""

    beam: Ints
    face: Ints
    share: Floats
    points: Floats

    def where(self, chosen: Flags) -> "_Crossings":
        return _Crossings(self.beam[chosen], self.face[chosen], self.share[chosen], self.points[chosen])


def walls_of(
    faces: WallFaces, samples: Samples, rings: list[Floats], origins: Floats, settings: GrazingSettings
) -> Walls:
    """The walls that placed samples and rings, each (m, 2), of all views tell; origins: (v, 2) of the views."""
    mirror, measured = _answers(samples, origins, faces, settings), _places(samples.points, faces.label, faces)
    through = np.zeros(len(mirror))
    for ring, origin in zip(rings, origins, strict=True):
        aslant = _crossings(ring, origin, (faces, mirror), settings.least)
        passed = np.isin(_places(aslant.points, aslant.face, faces), measured)
        through += np.bincount(aslant.face[passed], minlength=len(mirror))
    number = np.bincount(faces.label[faces.label >= 0], minlength=len(mirror))
    mirrors = through > settings.stray + settings.seen_through * number
    cosines = np.where(mirrors, mirror, np.cos(np.radians(settings.steepest)))
    return Walls(faces, cosines, sight_of(rings, origins), settings)


def up_to_mirrors(near: Floats, far: Floats, origin: Floats, walls: Walls) -> tuple[Floats, Floats]:
    """The near and the far ring of a placed view (m, 2), its beams cut where a mirror makes void what lies farther."""
    crossed = _crossings(far, origin, (walls.faces, walls.answers), walls.settings.least)
    crossed = crossed.where(_goes_on_to(crossed.points, crossed.face, walls.faces))
    crossed = crossed.where(~_open_at(crossed.points, crossed.face, walls))
    sure = np.ones(len(far))
    np.minimum.at(sure, crossed.beam, crossed.share)
    cut = origin + sure[:, None] * (far - origin)
    short = np.linalg.norm(cut - origin, axis=1) < np.linalg.norm(near - origin, axis=1)
    return np.where(short[:, None], cut, near), cut


def _answers(samples: Samples, origins: Floats, faces: WallFaces, settings: GrazingSettings) -> Floats:
    """The cosine (f,) of the angle off its normal within which most of each face was measured."""
    known = faces.label >= 0
    face, beam = faces.label[known], origins[samples.view[known]] - samples.points[known]
    cosine = np.sum(beam * faces.normals[face], axis=1) / np.linalg.norm(beam, axis=1)
    order = np.lexsort((-cosine, face))
    first = np.searchsorted(face[order], np.arange(len(faces.centres) + 1))
    last = first[:-1] + np.floor(settings.answered * np.maximum(np.diff(first) - 1, 0)).astype(np.int64)
    most = np.cos(np.radians(settings.steepest))
    return np.asarray(np.maximum(cosine[order][np.minimum(last, len(order) - 1)], most))


def _along(points: Floats, face: Ints, faces: WallFaces) -> Floats:
    """How far along the lines of faces (n,) points (n, 2) lie, from the centres."""
    normals, arm = faces.normals[face], points - faces.centres[face]
    return np.asarray(arm[:, 0] * normals[:, 1] - arm[:, 1] * normals[:, 0])


def _places(points: Floats, face: Ints, faces: WallFaces) -> Ints:
    """A number for each piece of face that points (n, 2) lie on; negative for none."""
    pieces = np.floor(_along(points, face, faces) / BIN).astype(np.int64) + (1 << 20)
    return np.where(face >= 0, face * (1 << 21) + pieces, -1)


def _crossings(ring: Floats, origin: Floats, walls: tuple[WallFaces, Floats], least: float) -> _Crossings:
    """Where the beams from the origin (2,) to a ring (m, 2) pass lines of wall more aslant than these answer: faces and
    cosines (f,); those `least` metres long count."""
    faces, answers = walls
    chosen = np.flatnonzero((np.ptp(faces.spans, axis=1) >= least) & (faces.support >= 2))
    normals, height = faces.normals[chosen], np.sum((origin - faces.centres[chosen]) * faces.normals[chosen], axis=1)
    beams = ring - origin
    descent = -beams @ normals.T
    past = (height > PAST) & (descent > height + PAST)
    beam, line = np.nonzero(past & (descent < np.linalg.norm(beams, axis=1)[:, None] * answers[chosen]))
    share = height[line] / descent[beam, line]
    return _Crossings(beam, chosen[line], share, origin + share[:, None] * beams[beam])


def _goes_on_to(points: Floats, face: Ints, faces: WallFaces) -> Flags:
    """Whether points (n, 2) on the lines of faces (n,) lie on them or no farther off than they are long."""
    along, spans = _along(points, face, faces), faces.spans[face]
    length = spans[:, 1] - spans[:, 0]
    return np.asarray((along > spans[:, 0] - length) & (along < spans[:, 1] + length))


def _open_at(points: Floats, face: Ints, walls: Walls) -> Flags:
    """Whether some view looks squarely through the lines of faces (n,) at points (n, 2)."""
    normals, views = walls.faces.normals[face], len(walls.sight.origins)
    before, behind = (walls.sight.pairs(points + side * walls.settings.behind * normals) for side in (1, -1))
    point, view = np.divmod(np.intersect1d(before[0] * views + before[1], behind[0] * views + behind[1]), views)
    beam = walls.sight.origins[view] - points[point]
    square = np.sum(beam * normals[point], axis=1) > walls.answers[face[point]] * np.linalg.norm(beam, axis=1)
    return np.isin(np.arange(len(points)), point[square])
