"""All figures of a run, by name, written as pictures."""

from collections.abc import Callable
from pathlib import Path

from matplotlib.figure import Figure

from backend.room_map import RoomMap
from slam.figures.rooms import decisions, map_errors, merged_map, planned_paths
from slam.figures.sensing import sensing_figures
from slam.figures.views import overlaid_views, raw_boundaries, redrawn_boundaries, sketches
from slam.scores.maps import MapTruth
from slam.story import Story

DOTS_PER_INCH = 110
FIGURES: dict[str, Callable[[Story], Figure]] = {
    "1_raw_boundaries": raw_boundaries,
    "2_redrawn_boundaries": redrawn_boundaries,
    "3_sketches": sketches,
    "4_overlaid_views": overlaid_views,
    "4b_decisions": decisions,
    "5_map": merged_map,
    "6_paths": planned_paths,
}


def draw(story: Story, folder: Path) -> list[str]:
    """Write every figure that the recording allows into `folder` as PNG; their names."""
    folder.mkdir(parents=True, exist_ok=True)
    drawn = {name: figure(story) for name, figure in FIGURES.items()} | sensing_figures(story.percepts)
    for name, figure in drawn.items():
        figure.savefig(folder / f"{name}.png", dpi=DOTS_PER_INCH, bbox_inches="tight")
    return list(drawn)


def draw_errors(room: RoomMap, truth: MapTruth, folder: Path) -> Path:
    """Write the error picture into `folder` as PNG; where it is."""
    folder.mkdir(parents=True, exist_ok=True)
    picture = folder / "7_errors.png"
    map_errors(room, truth).savefig(picture, dpi=DOTS_PER_INCH, bbox_inches="tight")
    return picture
