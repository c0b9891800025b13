"""Rays: where straight lines from a place first meet the surfaces, and where mirrors send them on."""

from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from frontend.scan import Floats
from frontend.sensors.surfaces import Surfaces

GRAZE = 1e-9  # metres a ray must travel before it can meet a wall: keeps a mirrored ray off the wall it left


@njit(cache=True)  # type: ignore[untyped-decorator]
def _first_hit(origin: Floats, direction: Floats, segments: Floats, left: int) -> tuple[float, int]:
    """Distance to the first segment on the ray and its index; infinite and −1 where the ray leaves the world."""
    nearest, index = np.inf, -1
    x, y = origin
    dx, dy = direction
    for m in range(segments.shape[0]):
        ax, ay = segments[m, 0, 0] - x, segments[m, 0, 1] - y
        bx, by = segments[m, 1, 0] - x, segments[m, 1, 1] - y
        side_a, side_b = dx * ay - dy * ax, dx * by - dy * bx
        # Only fronts answer: seen from the free side a segment starts right of the ray and ends left of it.
        if side_a > 0.0 or side_b < 0.0 or side_a == side_b or m == left:
            continue
        share = side_a / (side_a - side_b)
        distance = (ax + share * (bx - ax)) * dx + (ay + share * (by - ay)) * dy
        if GRAZE < distance < nearest:
            nearest, index = distance, m
    return nearest, index


@njit(cache=True)  # type: ignore[untyped-decorator]
def _cast(origin: Floats, angles: Floats, segments: Floats) -> tuple[Floats, NDArray[np.int64]]:
    distances, indices = np.empty(angles.size), np.empty(angles.size, np.int64)
    direction = np.empty(2)
    for k in range(angles.size):
        direction[0], direction[1] = np.cos(angles[k]), np.sin(angles[k])
        distances[k], indices[k] = _first_hit(origin, direction, segments, -1)
    return distances, indices


def cast(surfaces: Surfaces, origin: Floats, angles: Floats) -> tuple[Floats, NDArray[np.int64]]:
    """Distances (n,) to the first surface along each angle (n,) and its index; inf and −1 where there is none."""
    found: tuple[Floats, NDArray[np.int64]] = _cast(origin, angles, surfaces.segments)
    return found


def incidence_cosines(surfaces: Surfaces, angles: Floats, hits: NDArray[np.int64]) -> Floats:
    """Cosines (n,) between the rays (n,) and the normals of the surfaces (n,) they met."""
    tangents = surfaces.tangents[hits]
    return np.asarray(np.abs(np.cos(angles) * tangents[:, 1] - np.sin(angles) * tangents[:, 0]))


class Paths(NamedTuple):
    """Rays (n,) followed over mirrors, each array (n, b): one column per surface met.

    lengths: metres travelled to it, inf if none. hits: its index, −1 if none. sines: of the incidence, signed along the
    segment. offsets: metres from the segment's start to where it was met.
    """

    lengths: Floats
    hits: NDArray[np.int64]
    sines: Floats
    offsets: Floats


def trace(surfaces: Surfaces, origin: Floats, angles: Floats, mirrors: NDArray[np.bool_], bounces: int) -> Paths:
    """Follow rays (n,) over up to `bounces` mirrors, the surfaces (m,) that send a ray on."""
    shape = (angles.size, bounces + 1)
    paths = Paths(np.full(shape, np.inf), np.full(shape, -1, np.int64), np.zeros(shape), np.zeros(shape))
    _trace(origin, angles, surfaces.segments, mirrors, paths)
    return paths


@njit(cache=True)  # type: ignore[untyped-decorator]
def _trace(origin: Floats, angles: Floats, segments: Floats, mirrors: NDArray[np.bool_], paths: Paths) -> None:
    here, direction, tangent = np.empty(2), np.empty(2), np.empty(2)
    for k in range(angles.size):
        here[:] = origin
        direction[0], direction[1] = np.cos(angles[k]), np.sin(angles[k])
        travelled, left = 0.0, -1
        for b in range(paths.lengths.shape[1]):
            distance, m = _first_hit(here, direction, segments, left)
            if m < 0:
                break
            travelled += distance
            here[:] = here + distance * direction
            tangent[:] = segments[m, 1] - segments[m, 0]
            tangent /= np.hypot(tangent[0], tangent[1])
            sine = direction[0] * tangent[0] + direction[1] * tangent[1]
            paths.lengths[k, b], paths.hits[k, b], paths.sines[k, b] = travelled, m, sine
            paths.offsets[k, b] = np.dot(here - segments[m, 0], tangent)
            if not mirrors[m]:
                break
            direction[:] = 2.0 * sine * tangent - direction
            left = m
