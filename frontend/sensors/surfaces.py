"""Surfaces: the walls a sensor can hear and see, as oriented segments with what each is made of.

A wall answers sound with a mirrored (coherent) part and a scattered part. How they share the energy is Rayleigh's
criterion: a height spread σ leaves exp(−(4πσ cos i/λ)²) of it coherent, so plasterboard is a mirror and cinder block
is not, and both turn into mirrors at grazing incidence.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from frontend.scan import Floats


class SurfaceError(Exception):
    """Surfaces that cannot be: the message carries the numbers or the names."""


@dataclass(frozen=True)
class Material:
    """What a wall is made of.

    roughness: spread of the heights, metres. albedo: share of the incoherent sound that comes back into the room.
    tilt: how far the faces lean out of the vertical towards the floor, radians (slats). reflectance: in the near
    infrared. facets: spread of the slopes of its micro-facets, radians (Oren & Nayar 1994).
    """

    roughness: float
    albedo: float
    tilt: float = 0.0
    reflectance: float = 0.8
    facets: float = 0.1


# The heights are those of the trade; the albedos and reflectances are chosen: no source gives them.
MATERIALS = {
    "rough": Material(roughness=3e-3, albedo=0.05, reflectance=0.8, facets=0.5),  # cinder block, exposed studs
    "smooth": Material(roughness=5e-5, albedo=0.05, reflectance=0.8, facets=0.2),  # painted plasterboard
    "slatted": Material(roughness=5e-5, albedo=0.05, tilt=np.radians(25.0), reflectance=0.05, facets=0.3),
    "dark": Material(roughness=3e-3, albedo=0.05, reflectance=0.05, facets=0.3),  # black cloth, unlit steel mesh
}


@dataclass(frozen=True, eq=False)
class Surfaces:
    """Every face of a world, free space on the left of each segment.

    segments: (m, 2, 2) start and end, metres. following: (m,) the segment that starts where this one ends.
    roughness, albedo, tilt, reflectance, facets: (m,) as in Material. radius: (m,) of convex curvature,
    infinite if flat.
    """

    segments: Floats
    following: NDArray[np.int64]
    roughness: Floats
    albedo: Floats
    tilt: Floats
    reflectance: Floats
    facets: Floats
    radius: Floats

    def __post_init__(self) -> None:
        """Check the shapes once, at the door."""
        count = len(self.segments)
        if self.segments.shape != (count, 2, 2) or count == 0:
            raise SurfaceError(f"surfaces need (m, 2, 2) segments, but got {self.segments.shape}")
        for name in ("following", "roughness", "albedo", "tilt", "reflectance", "facets", "radius"):
            if getattr(self, name).shape != (count,):
                raise SurfaceError(f"{count} segments, but {name} has shape {getattr(self, name).shape}")

    @property
    def tangents(self) -> Floats:
        """(m, 2) unit vectors along the segments."""
        along = self.segments[:, 1] - self.segments[:, 0]
        return np.asarray(along / np.linalg.norm(along, axis=1, keepdims=True))

    def corner_turns(self) -> Floats:
        """(m,) turn at the end of each segment into the one that follows: positive where the room is concave there."""
        ours, theirs = self.tangents, self.tangents[self.following]
        return np.asarray(
            np.arctan2(ours[:, 0] * theirs[:, 1] - ours[:, 1] * theirs[:, 0], np.einsum("mi,mi->m", ours, theirs))
        )


def coherent_share(roughness: Floats, cosine: Floats, wavelength: float) -> Floats:
    """Share of the sound power that stays a mirror image at incidence acos(cosine) (Rayleigh's criterion)."""
    return np.asarray(np.exp(-((4 * np.pi * roughness * cosine / wavelength) ** 2)))


def join_rings(rings: list[Floats], materials: list[list[Material]], radii: list[Floats]) -> Surfaces:
    """Surfaces from closed rings (k, 2) of corners, free space on the left, a material and a radius per side."""
    starts = np.concatenate(rings)
    ends = np.concatenate([np.roll(ring, -1, axis=0) for ring in rings])
    firsts = np.cumsum([0] + [len(ring) for ring in rings[:-1]])
    following = np.concatenate([f + np.roll(np.arange(len(r)), -1) for f, r in zip(firsts, rings, strict=True)])
    made_of = [material for ring in materials for material in ring]
    columns = {
        name: np.array([getattr(material, name) for material in made_of])
        for name in ("roughness", "albedo", "tilt", "reflectance", "facets")
    }
    return Surfaces(np.stack([starts, ends], axis=1), following, radius=np.concatenate(radii), **columns)
