from pathlib import Path

import numpy as np
import pytest
from matplotlib.figure import Figure

from frontend.scan import Scan, Sensor
from slam.figures.sensing import beam_pattern, infrared_codes, sensing_figures
from slam.perception import FrontendSettings, Percept, perceive
from slam.recordings import open_recording

DOORS = Path(__file__).parents[3] / "datasets" / "flynn_two_doors"


@pytest.fixture(scope="module")
def percept() -> Percept:
    return perceive(next(iter(open_recording(DOORS).scans)), FrontendSettings())


def words(figure: Figure) -> str:
    legends = [axes.get_legend() for axes in figure.axes]
    texts = [text.get_text() for legend in legends if legend is not None for text in legend.get_texts()]
    return " | ".join([axes.get_title() for axes in figure.axes] + texts)


def test_a_sonar_and_infrared_recording_allows_every_figure(percept: Percept) -> None:
    figures = sensing_figures([percept])
    assert list(figures) == ["8c_before_and_after", "8d_scale_space", "8a_beam", "8b_codes"]
    assert "openings redrawn" in words(figures["8c_before_and_after"])
    assert "tracks" in words(figures["8d_scale_space"])


def test_a_lidar_has_neither_beam_nor_codes() -> None:
    bearings = np.radians(np.arange(-180.0, 180.0, 2.0))
    square = 2 / np.maximum(np.abs(np.cos(bearings)), np.abs(np.sin(bearings)))
    seen = perceive(Scan(bearings, square, Sensor("lidar", 5.0), np.zeros(3), 0.0), FrontendSettings())
    assert list(sensing_figures([seen])) == ["8c_before_and_after", "8d_scale_space"]


def test_a_view_without_surface_says_so() -> None:
    bearings = np.radians(np.arange(-180.0, 180.0, 2.0))
    nothing = Scan(bearings, np.full(180, np.inf), Sensor("lidar", 5.0), np.zeros(3), 0.0)
    figures = sensing_figures([perceive(nothing, FrontendSettings())])
    assert "no surface" in words(figures["8d_scale_space"])
    assert sensing_figures([]) == {}


def test_the_codes_are_written_beside_their_readings(percept: Percept) -> None:
    written = {text.get_text() for text in infrared_codes(percept).axes[0].texts}
    assert {"11", "30"} <= written


def test_the_beam_has_its_side_lobes_and_the_chirp_fills_the_nulls(percept: Percept) -> None:
    lobes = beam_pattern(percept.scan.sensor).axes[0]
    tone, chirp, *_ = (np.asarray(line.get_ydata()) for line in lobes.lines)
    angles = np.asarray(lobes.lines[0].get_xdata())
    near_null = (np.abs(angles) > 10) & (np.abs(angles) < 14)
    assert np.min(chirp[near_null]) > np.min(tone[near_null]) + 10
    assert np.max(tone[(angles > 14) & (angles < 20)]) == pytest.approx(-17.6, abs=0.5)
