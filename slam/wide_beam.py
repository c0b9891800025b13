"""What a wide sensor leaves open for the merge: how far a beam surely passed, and how far aside it answers."""

import numpy as np

from backend.view import WideBeam
from frontend.contour import Contour, ContourKind
from frontend.fusion import FusedScan


def wide_beam(outline: Contour, fused: FusedScan) -> WideBeam | None:
    """Lengths of beam at each point of the outline, metres; None for a sensor without a beam to speak of.

    In a door's arc the sonar vouches for what it read itself, in an inferred corner for what its readings leave; where
    it heard nothing for no more than its blind range, as smooth walls mirror the beam away (Flynn 1988, §2.1).
    """
    sensor = fused.scan.sensor
    if sensor.half_beam <= 0:
        return None
    raw = fused.raw_ranges[outline.reading]
    drawn = (outline.kinds == ContourKind.DOOR_ARC) & np.isfinite(raw)
    silent = (outline.kinds == ContourKind.NO_RETURN) & ~np.isfinite(raw)
    inferred = outline.kinds == ContourKind.INFERRED
    vouched = fused.vouched[outline.reading]
    reach = np.linalg.norm(outline.points - outline.origin, axis=1)
    aside = reach * np.array([sensor.half_beam_at(float(metres)) for metres in reach])
    return WideBeam(np.select([drawn, silent, inferred], [raw, sensor.min_range, vouched], np.inf), aside)
