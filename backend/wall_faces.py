"""Wall faces: straight pieces of surface with a facing side, fused over all placed views that measured them.

Cell lines grow into faces from the best supported outward, while position and direction agree; each face
is refitted as it grows. Opposite sides of a wall face opposite ways and stay two faces.
"""

from dataclasses import dataclass

import numpy as np
from numba import njit
from numpy.typing import NDArray

from backend.cell_lines import SECTORS, CellGrid, cell_lines, distinct_views
from backend.samples import Samples

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]


@dataclass(frozen=True)
class FaceSettings:
    """Opinions of fusing faces."""

    cell: float = 0.25  # metres; larger bridges wider gaps and bends, and blurs short faces
    flat: float = 0.02  # metres; larger lets a face swallow more bent or stepped surface
    turn: float = 0.20  # radians; larger lets strokes of more different direction join a face
    doubt: float = 3.0  # in sigmas; larger keeps samples farther from their face


@dataclass(frozen=True, eq=False)
class WallFaces:
    """Fused faces, and where to find them.

    centres, normals: (f, 2), normals towards free space. spans: (f, 2) extent along the face, from the centre, to
    the right of the normal. support: (f,) distinct views. label: (n,) face of every sample, −1 for none.
    codes, face: (l,) cells and sectors in rising order, and the face of each; origin: (2,) cell the codes count from.
    """

    centres: Floats
    normals: Floats
    spans: Floats
    support: Ints
    label: Ints
    codes: Ints
    face: Ints
    origin: Ints
    settings: FaceSettings

    def nearest(self, points: Floats, normals: Floats, reach: float) -> Ints:
        """The face (n,) nearest to each point (n, 2) that faces like its normal (n, 2) within `reach`; −1 for none."""
        lines = np.hstack([self.centres, self.normals])
        cells = np.floor(points / self.settings.cell).astype(np.int64) - self.origin
        return np.asarray(_nearest(np.hstack([points, normals]), cells, (self.codes, self.face, lines), reach))


def fuse_faces(samples: Samples, settings: FaceSettings) -> WallFaces:
    """The faces of placed samples; those whose direction is not sure take no part and get no face."""
    everywhere = np.full(len(samples.view), -1, dtype=np.int64)
    if not samples.sure.any():
        none, nowhere = np.empty(0, np.int64), np.empty((0, 2))
        return WallFaces(nowhere, nowhere, nowhere, none, everywhere, none, none, np.zeros(2, np.int64), settings)
    sure = samples.where(samples.sure)
    scale = np.hypot(sure.sigma, settings.flat)
    weight = sure.weight / scale**2
    lines = cell_lines(sure.points, sure.normals, weight, scale, CellGrid(settings.cell, np.zeros(2), 0.0))
    origin = lines.keys[:, :2].min(axis=0) - 1
    codes = _codes(lines.keys[:, :2] - origin, lines.keys[:, 2])
    order = np.argsort(codes)
    moments = _moments(sure, weight * lines.trust, lines.group, len(codes))[order]
    tolerance = settings.flat + 1.5 * np.bincount(lines.group, sure.sigma)[order] / np.bincount(lines.group)[order]
    face, fitted = _grow(codes[order], moments, tolerance, np.cos(settings.turn))
    rank = np.empty(len(order), dtype=np.int64)
    rank[order] = np.arange(len(order))
    candidate = face[rank[lines.group]]
    offset = np.sum((sure.points - fitted[candidate, :2]) * fitted[candidate, 2:], axis=1)
    label = np.where(np.abs(offset) < settings.doubt * scale, candidate, -1)
    spans, support = _spans(sure, label, fitted)
    everywhere[samples.sure] = label
    return WallFaces(fitted[:, :2], fitted[:, 2:], spans, support, everywhere, codes[order], face, origin, settings)


def _codes(cell: Ints, sector: Ints) -> Ints:
    return (cell[:, 0] * (1 << 24) + cell[:, 1]) * SECTORS + sector


def _moments(samples: Samples, weight: Floats, group: Ints, count: int) -> Floats:
    """Per line (l, 8): Σw, Σwx, Σwy, Σwxx, Σwxy, Σwyy, Σw·normal x, Σw·normal y."""
    x, y = samples.points.T
    columns = (np.ones(len(x)), x, y, x * x, x * y, y * y, *samples.normals.T)
    return np.stack([np.bincount(group, weight * column, count) for column in columns], axis=1)


def _spans(samples: Samples, label: Ints, fitted: Floats) -> tuple[Floats, Ints]:
    """Extent along each face (f, 2) and its number of distinct views (f,)."""
    known = label >= 0
    face = label[known]
    normal = fitted[face, 2:]
    arm = samples.points[known] - fitted[face, :2]
    along = arm[:, 0] * normal[:, 1] - arm[:, 1] * normal[:, 0]
    spans = np.zeros((len(fitted), 2))
    np.minimum.at(spans[:, 0], face, along)
    np.maximum.at(spans[:, 1], face, along)
    return spans, distinct_views(face, samples.view[known], len(fitted))


@njit(cache=True)
def _line(moments):  # type: ignore[no-untyped-def]
    """Centre and normal of a line from its moments: its own direction once it is long, before that its normals'."""
    total = moments[0]
    x, y = moments[1] / total, moments[2] / total
    xx, xy, yy = moments[3] / total - x * x, moments[4] / total - x * y, moments[5] / total - y * y
    facing = np.sqrt(moments[6] ** 2 + moments[7] ** 2) + 1e-12
    nx, ny = moments[6] / facing, moments[7] / facing
    half = 0.5 * (xx + yy)
    root = np.sqrt(0.25 * (xx - yy) ** 2 + xy * xy)
    if half + root > 0.12**2:
        angle = 0.5 * np.arctan2(2 * xy, xx - yy)
        sx, sy = -np.sin(angle), np.cos(angle)
        sign = 1.0 if sx * nx + sy * ny >= 0 else -1.0
        nx, ny = sign * sx, sign * sy
    return np.array([x, y, nx, ny])


@njit(cache=True)
def _grow(codes, moments, tolerance, cosine):  # type: ignore[no-untyped-def]
    """Face of every cell line (l,), and the fitted faces (f, 4): centre and normal."""
    count = len(codes)
    face = np.full(count, -1, dtype=np.int64)
    fitted = np.empty((count, 4))
    queue = np.empty(count * 27, dtype=np.int64)
    faces = 0
    for seed in np.argsort(-moments[:, 0]):
        if face[seed] >= 0:
            continue
        face[seed] = faces
        grown = moments[seed].copy()
        line = _line(grown)
        queue[0], waiting, done = seed, 1, 0
        while done < waiting:
            here = codes[queue[done]]
            done += 1
            for around in range(27):
                other = _beside(codes, here, around)
                if other < 0 or face[other] >= 0:
                    continue
                own = _line(moments[other])
                away = abs((own[0] - line[0]) * line[2] + (own[1] - line[1]) * line[3])
                if away < tolerance[other] and own[2] * line[2] + own[3] * line[3] > cosine:
                    face[other] = faces
                    grown += moments[other]
                    line = _line(grown)
                    queue[waiting] = other
                    waiting += 1
        fitted[faces] = line
        faces += 1
    return face, fitted[:faces].copy()


@njit(cache=True)
def _beside(codes, code, around):  # type: ignore[no-untyped-def]
    """Index of one of the 27 cells and sectors around a code, −1 where nothing was measured."""
    sector = (code + around % 3 - 1 - code // 12 * 12) % 12
    wanted = (code // 12 + (around // 3 % 3 - 1) + (around // 9 - 1) * (1 << 24)) * 12 + sector
    place = np.searchsorted(codes, wanted)
    return place if place < len(codes) and codes[place] == wanted else -1


@njit(cache=True)
def _nearest(queries, cells, index, reach):  # type: ignore[no-untyped-def]
    codes, face, lines = index
    found = np.full(len(queries), -1, dtype=np.int64)
    for i in range(len(queries)):
        sector = int(np.floor(np.arctan2(queries[i, 3], queries[i, 2]) / (2 * np.pi) * 12)) % 12
        code = (cells[i, 0] * (1 << 24) + cells[i, 1]) * 12 + sector
        best = reach
        for around in range(27):
            other = _beside(codes, code, around)
            if other < 0:
                continue
            line = lines[face[other]]
            away = abs((queries[i, 0] - line[0]) * line[2] + (queries[i, 1] - line[1]) * line[3])
            if away < best and queries[i, 2] * line[2] + queries[i, 3] * line[3] > 0.8:
                best = away
                found[i] = face[other]
    return found
