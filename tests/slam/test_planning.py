"""Planning on a room: poses and answers as text, and the tour that follows every merge."""

import json

import numpy as np
from shapely import MultiPolygon, Point, Polygon

from planners.path import Answer, Path
from slam.planning import PLANNERS, PlanningSettings, answer_values, paths_text, tour, tour_or_reason

ROOM = MultiPolygon([Polygon([(0, 0), (2, 0), (2, 3), (3, 3), (3, 0), (6, 0), (6, 4), (0, 4)])])
START = np.array([1.0, 1.0, 0.0])


def test_the_tour_goes_to_the_far_end_of_the_map() -> None:
    answers = tour(ROOM, START, PlanningSettings())
    assert answers.keys() == PLANNERS.keys()
    for answer in answers.values():
        assert answer.path is not None
        assert np.allclose(answer.path.poses[0, :2], START[:2])
        assert np.allclose(answer.path.poses[-1, :2], [6, 4], atol=0.4)
        assert ROOM.boundary.distance(Point(answer.path.poses[-1, :2])) > 0.3, "twice the radius of the tour's robot"
        assert answer.path.length > 5.5


def test_a_map_nobody_can_drive_on_says_so() -> None:
    answers, reason = tour_or_reason(ROOM, np.array([0.1, 0.1, 0.0]), PlanningSettings())
    assert answers == {}
    assert reason == "a robot disc:0.15 cannot stand at the first pose (0.10, 0.10)"


def test_answers_are_plain_values() -> None:
    path = Path(np.array([[0.0, 0.0, 0.0], [3.0, 4.0, 0.5]]), 0.25, "proved")
    assert answer_values(Answer("path", "found", path)) == {
        "answer": "path", "length": 5.0, "clearance": 0.25, "poses": [[0, 0, 0], [3, 4, 0.5]], "reason": "found",
    }  # fmt: skip
    nothing = answer_values(Answer("no path", "walled in"))
    assert nothing == {"answer": "no path", "length": None, "clearance": None, "poses": [], "reason": "walled in"}
    feature = json.loads(paths_text({"cones": Answer("path", "found", path)}))["features"][0]
    assert feature["geometry"] == {"type": "LineString", "coordinates": [[0, 0], [3, 4]]}
    assert feature["properties"]["headings"] == [0.0, 0.5]
