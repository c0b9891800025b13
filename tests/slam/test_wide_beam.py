"""Claims about what a wide beam leaves open for the merge."""

import numpy as np
from shapely import box

from frontend.contour import ContourKind
from slam.perception import FrontendSettings, Percept, perceive
from slam.simulation.record import Recipe, drive_through
from slam.wide_beam import wide_beam
from tests.simulated_drives import world_of

POSE = np.array([[2.0, 1.5, 0.4]])


def percept(sensor: str) -> Percept:
    scan = drive_through(world_of(box(0, 0, 5, 4)), POSE, Recipe(sensor))[0]
    return perceive(scan, FrontendSettings())


def test_a_thin_beam_leaves_nothing_open() -> None:
    assert wide_beam(percept("lidar").outline, percept("lidar").fused) is None


def test_a_surface_lies_as_far_aside_as_the_beam_is_wide_there() -> None:
    seen = percept("sonar_infrared")
    beam = wide_beam(seen.outline, seen.fused)
    assert beam is not None
    reach = np.linalg.norm(seen.outline.points - seen.outline.origin, axis=1)
    half_beams = np.array([seen.scan.sensor.half_beam_at(float(metres)) for metres in reach])
    np.testing.assert_allclose(beam.aside, reach * half_beams)


def test_measured_surface_bounds_nothing_and_drawn_arcs_count_only_as_far_as_was_heard() -> None:
    seen = percept("sonar_infrared")
    beam = wide_beam(seen.outline, seen.fused)
    assert beam is not None
    assert np.all(np.isinf(beam.sure[seen.outline.kinds == ContourKind.MEASURED]))
    drawn = seen.outline.kinds == ContourKind.DOOR_ARC
    np.testing.assert_allclose(beam.sure[drawn], seen.fused.raw_ranges[seen.outline.reading[drawn]])
