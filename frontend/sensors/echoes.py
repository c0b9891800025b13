"""Echoes: everything the surfaces around a place would answer to a chirp, before any head listens in a direction.

Rough walls scatter from every ray; mirrors answer from the foot of the normal, from square corners and from edges
only, and send the ray on to what it meets next, which is why a reading can be much too long (Flynn 1988, §3.1).
Slats throw the ray down on the floor. Energies are shares of what arrives one metre away on the axis.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.special import fresnel

from frontend.scan import Floats
from frontend.sensors.rays import trace
from frontend.sensors.surfaces import Surfaces, coherent_share
from frontend.sensors.transducer import Transducer

RAYS = 2048  # a fan of 0.18°: at 3 m a ray stands for about one wavelength of wall, one independent scatterer
BOUNCES = 2
FLOOR_ALBEDO = 0.05  # chosen: bare concrete
SQUARE = np.radians(3.0)  # a corner this near to 90° sends the beam back where it came from


@dataclass(frozen=True, eq=False)
class Echoes:
    """Answers from around a place: directions (n,) in the room, path lengths (n,) one way, energies (n,) on the axis.

    tall: (n,) whether a whole height of wall answers (energy per steradian) or a single point of it does.
    """

    directions: Floats
    lengths: Floats
    energies: Floats
    tall: NDArray[np.bool_]


@dataclass(frozen=True, eq=False)
class _Fan:
    """Rays (n,) around a place, followed over b surfaces: all arrays but `angles` are (n, b), see Paths.

    mirrored: share of the power left on arrival, after the mirrors before, there and back.
    coherent: share that this surface would keep coherent.
    """

    angles: Floats
    lengths: Floats
    hits: NDArray[np.int64]
    sines: Floats
    offsets: Floats
    mirrored: Floats
    coherent: Floats


def echoes_around(surfaces: Surfaces, place: Floats, transducer: Transducer, rng: np.random.Generator) -> Echoes:
    """Every echo the sensor at `place` (2,) could hear, with the speckle of the rough walls drawn from `rng`."""
    fan = _fan(surfaces, place, transducer)
    parts = [
        _scattered(surfaces, fan, rng),
        _thrown_down(surfaces, fan, transducer),
        _feet(surfaces, fan, transducer),
        _corners(surfaces, fan),
        _edges(surfaces, place, fan, transducer),
    ]
    directions, lengths, energies = (np.concatenate(column) for column in zip(*parts, strict=True))
    tall = np.zeros(directions.size, bool)
    tall[: parts[0][0].size + parts[1][0].size] = True
    sent_back = energies > 0
    heard = energies * np.exp(-2 * transducer.decay * lengths)
    return Echoes(directions[sent_back], lengths[sent_back], heard[sent_back], tall[sent_back])


_Part = tuple[Floats, Floats, Floats]


def _fan(surfaces: Surfaces, place: Floats, transducer: Transducer) -> _Fan:
    angles = np.linspace(-np.pi, np.pi, RAYS, endpoint=False)
    # Slats throw the ray out of the plane and a convex face spreads it out: neither sends on what can be followed.
    mirrors = (surfaces.tilt == 0) & np.isinf(surfaces.radius)
    paths = trace(surfaces, place, angles, mirrors, BOUNCES)
    cosines = np.sqrt(1 - paths.sines**2)
    coherent = np.where(
        paths.hits >= 0, coherent_share(surfaces.roughness[paths.hits], cosines, transducer.wavelength), 0.0
    )
    before = np.concatenate([np.ones((RAYS, 1)), np.cumprod(coherent[:, :-1], axis=1)], axis=1)
    return _Fan(angles, *paths, before**2, coherent)


def _scattered(surfaces: Surfaces, fan: _Fan, rng: np.random.Generator) -> _Part:
    """Lambert's law from every ray, with fully developed speckle: exponential energies."""
    where = np.nonzero((fan.hits >= 0) & (surfaces.tilt[fan.hits] == 0))
    cosine = np.sqrt(1 - fan.sines[where] ** 2)
    share = (1 - fan.coherent[where]) * surfaces.albedo[fan.hits[where]] / np.pi
    energies = fan.mirrored[where] * share * cosine / fan.lengths[where] ** 2 * (2 * np.pi / RAYS)
    return fan.angles[where[0]], fan.lengths[where], energies * rng.exponential(size=energies.size)


def _thrown_down(surfaces: Surfaces, fan: _Fan, transducer: Transducer) -> _Part:
    """A slat leaning by τ mirrors the ray to the floor, which scatters it back along the same path."""
    where = np.nonzero((fan.hits >= 0) & (surfaces.tilt[fan.hits] > 0))
    cosine, tilt = np.sqrt(1 - fan.sines[where] ** 2), surfaces.tilt[fan.hits[where]]
    sinking = 2 * cosine * np.cos(tilt) * np.sin(tilt)  # downward part of the mirrored direction
    lengths = fan.lengths[where] + transducer.height / np.maximum(sinking, 1e-6)
    share = fan.mirrored[where] * fan.coherent[where] ** 2 * FLOOR_ALBEDO / np.pi
    return fan.angles[where[0]], lengths, share * sinking / lengths**2 * (2 * np.pi / RAYS)


def _feet(surfaces: Surfaces, fan: _Fan, transducer: Transducer) -> _Part:
    """Mirrors answer where a ray meets them square: the incidence changes its sign between two rays of one path."""
    followers = np.roll(fan.hits, -1, axis=0)
    # A round pole is a ring of facets finer than the fan: two rays that meet it have met the same face.
    round_face = np.isfinite(surfaces.radius[fan.hits] + surfaces.radius[followers])
    met = (fan.hits >= 0) & (followers >= 0)
    same_path = np.logical_and.accumulate(met & ((fan.hits == followers) | round_face), axis=1)
    after = np.roll(fan.sines, -1, axis=0)
    where = np.nonzero(same_path & ((fan.sines < 0) != (after < 0)) & (surfaces.tilt[fan.hits] == 0))
    share = fan.sines[where] / (fan.sines[where] - after[where])
    lengths = (1 - share) * fan.lengths[where] + share * np.roll(fan.lengths, -1, axis=0)[where]
    offsets = (1 - share) * fan.offsets[where] + share * np.roll(fan.offsets, -1, axis=0)[where]
    faces = surfaces.segments[fan.hits[where]]
    widths = np.linalg.norm(faces[:, 1] - faces[:, 0], axis=1)
    whole = np.where(round_face[where], 1.0, fresnel_share(offsets, widths - offsets, transducer.wavelength * lengths))
    convex = 1 / (1 + lengths / surfaces.radius[fan.hits[where]])
    energies = fan.mirrored[where] * fan.coherent[where] * whole * convex / (2 * lengths) ** 2
    return fan.angles[where[0]] + share * 2 * np.pi / RAYS, lengths, energies


def fresnel_share(before: Floats, after: Floats, zone: Floats) -> Floats:
    """Power (n,) of a strip over that of an endless mirror: it reaches `before` and `after` metres from the foot.

    zone: wavelength times range; a strip much narrower than its root answers little, and its very edge a quarter.
    """
    ends = np.stack([-before, after]) * 2 / np.sqrt(zone)
    sines, cosines = fresnel(ends)
    return np.asarray(((sines[1] - sines[0]) ** 2 + (cosines[1] - cosines[0]) ** 2) / 2)


def _corners(surfaces: Surfaces, fan: _Fan) -> _Part:
    """A square corner of two mirrors sends sound back whence it came, over twice the distance to its vertex."""
    followers = np.roll(fan.hits, -1, axis=0)
    same_way = np.logical_and.accumulate((fan.hits == followers) & (fan.hits >= 0), axis=1)
    arrived = np.concatenate([np.ones((RAYS, 1), bool), same_way[:, :-1]], axis=1)
    square = np.abs(surfaces.corner_turns() - np.pi / 2) < SQUARE
    # An odd number of mirrors turns the order of the walls around.
    meet = square[fan.hits] & (surfaces.following[fan.hits] == followers)
    meet |= square[followers] & (surfaces.following[followers] == fan.hits)
    both = (fan.hits >= 0) & (followers >= 0)
    where = np.nonzero(arrived & both & meet & (surfaces.tilt[fan.hits] + surfaces.tilt[followers] == 0))
    lengths = (fan.lengths[where] + np.roll(fan.lengths, -1, axis=0)[where]) / 2
    share = fan.mirrored[where] * fan.coherent[where] * np.roll(fan.coherent, -1, axis=0)[where]
    return fan.angles[where[0]] + np.pi / RAYS, lengths, share / (2 * lengths) ** 2


def _edges(surfaces: Surfaces, place: Floats, fan: _Fan, transducer: Transducer) -> _Part:
    """Convex edges of mirrors diffract: Keller's hard wedge, met by the direct ray only."""
    turns = surfaces.corner_turns()
    sharp = np.nonzero((turns < -SQUARE) & np.isinf(surfaces.radius) & (surfaces.tilt == 0))[0]
    offsets = surfaces.segments[sharp, 1] - place
    directions, lengths = np.arctan2(offsets[:, 1], offsets[:, 0]), np.linalg.norm(offsets, axis=1)
    ray = np.floor((directions + np.pi) / (2 * np.pi / RAYS)).astype(int) % RAYS
    beside = np.stack([fan.hits[ray, 0], fan.hits[(ray + 1) % RAYS, 0]])
    seen = np.any((beside == sharp) | (beside == surfaces.following[sharp]), axis=0)
    sharp, directions, lengths = sharp[seen], directions[seen], lengths[seen]
    wedge = (np.pi - turns[sharp]) / np.pi  # exterior angle over π
    # Seen from the edge, the way back to the sensor turns clockwise from the first face through free space.
    (along, across), (x, y) = surfaces.tangents[sharp].T, (np.cos(directions), np.sin(directions))
    from_face = np.mod(np.arctan2(across * x - along * y, along * x + across * y), 2 * np.pi)
    width = diffraction_width(wedge, from_face, transducer.wavelength)
    coherent = coherent_share(surfaces.roughness[sharp], np.ones(sharp.size), transducer.wavelength)
    # At the rim of the mirrored zone half the amplitude of the mirror is left, never more.
    energies = coherent * np.minimum(width / (2 * lengths**3), 1 / (16 * lengths**2))
    return directions, lengths, energies


def diffraction_width(wedge: Floats, angle: Floats, wavelength: float) -> Floats:
    """|D|² in metres of a hard wedge of exterior angle wedge·π, back towards `angle` from its face (Keller 1962)."""
    scale = np.sin(np.pi / wedge) / wedge
    with np.errstate(divide="ignore"):
        bracket = 1 / (np.cos(np.pi / wedge) - 1) + 1 / (np.cos(np.pi / wedge) - np.cos(2 * angle / wedge))
    return np.asarray(scale**2 * wavelength / (4 * np.pi**2) * bracket**2)
