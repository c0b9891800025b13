"""The paper's scenes: its basement room of 19 × 13 ft with what stood in it (Flynn 1988, Figs 4 to 12), in feet."""

import numpy as np
from shapely import LineString, Polygon, box

from frontend.sensors.transducer import FOOT, INCH
from slam.simulation.floors import Plan, drive_along, ell, feature, pillar, plan_of, walls_around

Jambs = dict[str, tuple[tuple[float, float], tuple[float, float]]]

# The basement's room, 19 × 13 ft, and the passage that its doors open on, both in feet.
ROOM, WALL = (0.0, 0.0, 19.0, 13.0), 0.5
THREE_DOORS: Jambs = {
    "left door": ((0.0, 2.9), (0.0, 5.567)),
    "front door": ((4.4, 13.0), (7.067, 13.0)),
    "right door": ((19.0, 5.2), (19.0, 8.2)),
}
AHEAD = 90.0


def basement() -> Plan:
    """The paper's room with three doors, two L-shapes and a round obstacle (Figs 9, 11, 12)."""
    return plan_of(
        "flynn_basement",
        "Three views of a basement room of 19 x 13 ft with rough walls; each pose is 2 ft from the one before",
        [
            *_basement_walls(THREE_DOORS, (-5, -0.5, 24, 18)),
            _closet_door((1.2, 9.8), -90, "rough"),
            _closet_door((16.0, 2.0), 90, "rough"),
            pillar((9.0 * FOOT, 9.0 * FOOT), 0.65 * FOOT),
            drive_along(np.array([(8, 4), (10, 4), (10, 6)]) * FOOT, headings=[AHEAD] * 3),
        ],
    )


def closet_door() -> Plan:
    """A folding closet door with slats a foot and a half in front of the robot throws the sound away (Fig. 6)."""
    return plan_of(
        "flynn_closet_door",
        "A robot 1.5 ft from a folding closet door whose slats mirror the sound down to the floor",
        [
            *_basement_walls({}, (-8, -0.5, 27, 21)),
            _closet_door((9.5, 7.5), 0, "slatted"),
            _closet_door((3.5, 3.0), 45, "slatted"),
            drive_along(np.array([(10.5, 6.0), (10.5, 5.0)]) * FOOT, headings=[AHEAD, AHEAD]),
        ],
    )


def doorway_ahead() -> Plan:
    """An open doorway of 30 in, 6 ft ahead: the sound closes it, the light does not (Figs 4, 5)."""
    doors: Jambs = {"front door": ((8.25, 13.0), (10.75, 13.0))}
    return plan_of(
        "flynn_doorway_ahead",
        "A robot 6 ft in front of an open doorway of 30 in between rough walls",
        [
            *_basement_walls(doors, (-4, -0.5, 23, 24)),
            drive_along(np.array([(9.5, 7.0), (9.5, 6.0)]) * FOOT, headings=[AHEAD, AHEAD]),
        ],
    )


def two_doors() -> Plan:
    """Doors ahead and to the left, seen from near and from far (Fig. 7)."""
    doors: Jambs = {"front door": ((3.0, 13.0), (6.0, 13.0)), "left door": ((0.0, 6.5), (0.0, 9.167))}
    return plan_of(
        "flynn_two_doors",
        "Doors of 36 and 32 in: near them the sound passes with smeared edges, from afar it is blind to them",
        [
            *_basement_walls(doors, (-11, -0.5, 19.5, 24)),
            drive_along(np.array([(4.5, 9.0), (8.0, 5.0)]) * FOOT, headings=[AHEAD, AHEAD]),
        ],
    )


def _basement_walls(jambs: Jambs, passage: tuple[float, float, float, float]) -> list[Plan]:
    """The room in the middle of a passage that is wide enough for the infrared to find nothing in it."""
    room, outer = _feet_box(*ROOM), _feet_box(*passage)
    around = outer.difference(room.buffer(WALL * FOOT, join_style="mitre"))
    doors = {name: LineString(np.array(ends) * FOOT) for name, ends in jambs.items()}
    return walls_around({"basement": room, "passage": around}, doors, WALL * FOOT)


def _closet_door(corner: tuple[float, float], turn: float, material: str) -> Plan:
    """An L of two leaves, 2 ft each and 2 in thick, its corner in feet."""
    shape = ell((corner[0] * FOOT, corner[1] * FOOT), turn, 2 * FOOT, 2 * INCH)
    return feature(shape, "obstacle", material=material, name="folding closet door")


def _feet_box(left: float, bottom: float, right: float, top: float) -> Polygon:
    return box(left * FOOT, bottom * FOOT, right * FOOT, top * FOOT)
