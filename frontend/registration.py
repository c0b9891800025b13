"""Registration: where a scan's surface lies on a local map, point to line, with the covariance of the answer.

One scan on a map is compiled code, whose Hessian gives the covariance. Whole submaps, which need no
covariance, go through open3d, which stays behind this door.
"""

import ctypes
from dataclasses import dataclass, replace
from functools import cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from frontend.local_map import CELL, Faces, LocalMap
from frontend.point_to_line import descend, paired
from frontend.rigid_motion import rotation
from frontend.scan import Floats
from frontend.surface import Surface


class RegistrationError(Exception):
    """open3d cannot be loaded; the message says what is missing and how to get it."""


@dataclass(frozen=True)
class RegistrationSettings:
    """How far and how strictly a scan is pulled onto a map."""

    distances: tuple[float, ...] = (0.5, 0.25, 0.15)  # metres, one per pass; larger survives a worse guess
    widths: tuple[float, ...] = (0.15, 0.06, 0.03)  # Cauchy widths, metres; larger trusts outliers more
    rounds: int = 10  # per pass; more follows a worse guess
    alike: float = 0.8  # least cosine between matched normals; larger demands more parallel faces
    alike_beams: int = 6  # steps between readings whose errors may be alike: line fits overlap; larger believes less
    finest: float = 0.01  # metres; no surface is believed to be smoother

    def passes(self, spread: float) -> Floats:
        """(p, 5) rows of cell, reach, least cosine, Cauchy width, rounds for surface of this spread in metres."""
        return np.array(
            [
                (CELL, max(reach, 3 * spread), self.alike, max(width, 2 * spread), self.rounds)
                for reach, width in zip(self.distances, self.widths, strict=True)
            ]
        )


@dataclass(frozen=True, eq=False)
class Alignment:
    """Where the moving frame lies in the fixed one, and how well that is known.

    pose_in_fixed: (3,). information: (3, 3) inverse covariance in the fixed frame's axes, of the surface alone.
    pairs: (p, 2) indices of matched points (moving, fixed). residual: rms across the faces, metres.
    matched: share of the moving points that found a face. firmness: smallest over largest eigenvalue of the
    information on position (near 0: a corridor, free to slide).
    """

    pose_in_fixed: Floats
    information: Floats
    pairs: NDArray[np.int64]
    residual: float
    matched: float
    firmness: float

    def freed(self, metres: float) -> "Alignment":
        """The same, with a doubt of so many metres more along the direction in which the place is known least.

        Noisy normals and the wrong jambs pull along a corridor, too, and seem to know where it is.
        """
        along = np.zeros(3)
        along[:2] = np.linalg.eigh(self.information[:2, :2])[1][:, 0]
        pulled = self.information @ along  # Sherman–Morrison on the inverse: the information may be singular
        lost = metres**2 / (1 + metres**2 * float(along @ pulled))
        return replace(self, information=np.asarray(self.information - lost * np.outer(pulled, pulled)))


@dataclass(frozen=True, eq=False)
class Guess:
    """Where to start, and how sure that is: pose (3,), information (3, 3) in the fixed frame's axes (0: unknown)."""

    pose: Floats
    information: Floats


def register(
    surface: Surface, local_map: LocalMap, guess: Guess, settings: RegistrationSettings, start: Floats | None = None
) -> Alignment:
    """Pull the surface onto the map, from `start` (3,) where it differs from the guess."""
    spread = surface.usual_spread
    passes = settings.passes(spread)
    faces = local_map.faces
    pose, information, square, partners = descend(
        surface.points, surface.normals, faces.points, faces.normals,
        local_map.first, local_map.corner, local_map.columns, local_map.rows,
        guess.pose if start is None else start, guess.pose, guess.information, passes,
    )  # fmt: skip
    pairs, shared = paired(
        surface.points, surface.reading, faces.points, faces.normals, partners, pose, settings.alike_beams
    )
    believed = information / (max(square, spread**2, settings.finest**2) * shared)
    middle = (information[0, 0] + information[1, 1]) / 2
    apart = float(np.hypot((information[0, 0] - information[1, 1]) / 2, information[0, 1]))
    return Alignment(
        pose,
        believed,
        pairs,
        float(np.sqrt(square)),
        len(pairs) / max(len(partners), 1),
        max(float(middle) - apart, 0.0) / max(float(middle) + apart, 1e-12),
    )


def register_submaps(moving: Faces, fixed: Faces, guess: Floats, reach: float) -> Floats:
    """The pose (3,) of the frame of `moving` that lays it on `fixed`, from a guess; partners within `reach` metres."""
    open3d = load_open3d()
    icp = open3d.pipelines.registration
    kernel = icp.CauchyLoss(reach / 4)
    start = np.eye(4)
    start[:2, :2], start[:2, 3] = rotation(guess[2]), guess[:2]
    found = icp.registration_icp(
        _cloud(open3d, moving), _cloud(open3d, fixed), reach, start, icp.TransformationEstimationPointToPlane(kernel),
        icp.ICPConvergenceCriteria(max_iteration=40),
    ).transformation  # fmt: skip
    # open3d sums in any order, so that its last digits differ from call to call; here ends what it can measure.
    return np.round(np.array([found[0, 3], found[1, 3], np.arctan2(found[1, 0], found[0, 0])]), 4)


@cache
def load_open3d() -> Any:
    """The open3d module, with libusb loaded from the package that carries it. Raises RegistrationError."""
    import libusb_package  # noqa: PLC0415  # only where used: open3d costs a second and 200 MB

    ctypes.CDLL(str(libusb_package.get_library_path()), mode=ctypes.RTLD_GLOBAL)
    try:
        import open3d  # noqa: PLC0415
    except (ImportError, OSError) as error:
        raise RegistrationError(
            f"open3d cannot be loaded ({error}); on Debian and Ubuntu: apt-get install libgl1 libegl1 libx11-6"
        ) from error
    return open3d


def _cloud(open3d: Any, faces: Faces) -> Any:
    """The faces in the plane z = 0, with a few ground points: without them the six unknowns are not all determined."""
    ground = faces.points[:: max(len(faces.points) // 8, 1)]
    points = np.zeros((len(faces.points) + len(ground), 3))
    points[: len(faces.points), :2], points[len(faces.points) :, :2] = faces.points, ground
    normals = np.zeros_like(points)
    normals[: len(faces.points), :2], normals[len(faces.points) :, 2] = faces.normals, 1.0
    cloud = open3d.geometry.PointCloud(open3d.utility.Vector3dVector(points))
    cloud.normals = open3d.utility.Vector3dVector(normals)
    return cloud
