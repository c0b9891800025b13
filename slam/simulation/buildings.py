"""Two buildings in metres: a flat of six rooms and an office floor of twenty, each with the drive through it."""

from shapely import LineString, Polygon, box
from shapely.geometry.base import BaseGeometry

from slam.simulation.floors import Plan, drive_along, ell, feature, pillar, plan_of, walls_around


def apartment() -> Plan:
    """Six rooms behind 10 cm walls, seven doors, nine things standing in them, and a bathroom of smooth tiles."""
    rooms = {
        "hall": box(4.1, 0.0, 5.7, 8.0),
        "living room": box(0.0, 3.6, 4.0, 8.0),
        "kitchen": box(0.0, 0.0, 4.0, 3.5),
        "bathroom": box(5.8, 0.0, 10.0, 2.1),
        "study": box(5.8, 2.2, 10.0, 4.9),
        "bedroom": box(5.8, 5.0, 10.0, 8.0),
    }
    doors = {
        "living room door": _opening((4.05, 5.6), 0.9, upright=True),
        "kitchen door": _opening((4.05, 1.6), 0.8, upright=True),
        "kitchen passage": _opening((1.4, 3.55), 1.0, upright=False),
        "bathroom door": _opening((5.75, 1.0), 0.75, upright=True),
        "study door": _opening((5.75, 3.4), 0.8, upright=True),
        "bedroom door": _opening((5.75, 6.4), 0.9, upright=True),
        "study passage": _opening((8.6, 4.95), 0.8, upright=False),
    }
    things = [
        *((box(*corners), "rough") for corners in _FURNITURE),
        (ell((0.0, 8.0), -90, 1.6, 0.75), "dark"),
    ]
    return plan_of(
        "apartment",
        "Six rooms with furniture: every room is visited, the study twice through two doors",
        [
            *walls_around(rooms, doors, 0.1, smooth=["bathroom"]),
            *(feature(shape, "obstacle", material=material) for shape, material in things),
            pillar((2.6, 6.6), 0.4),
            drive_along(_APARTMENT_WAY, step=0.9, wheels={"slip": 0.02}),
        ],
    )


_FURNITURE = [
    (3.0, 7.6, 4.0, 8.0),
    (0.0, 0.0, 2.2, 0.6),
    (2.4, 2.6, 3.4, 3.3),
    (9.2, 1.0, 10.0, 2.1),
    (6.6, 4.4, 7.6, 4.9),
    (9.3, 2.2, 10.0, 3.4),
    (8.4, 6.0, 10.0, 7.6),
]

_APARTMENT_WAY = [
    (4.9, 0.8), (4.9, 1.6), (3.4, 1.6), (1.4, 1.7), (1.4, 3.55), (1.4, 5.2), (3.0, 5.5), (4.05, 5.6), (4.9, 5.6),
    (4.9, 7.2), (4.9, 6.4), (5.75, 6.4), (7.6, 6.4), (7.6, 5.6), (8.6, 5.4), (8.6, 4.95), (8.4, 4.0), (7.2, 3.4),
    (5.75, 3.4), (4.9, 3.4), (4.9, 1.0), (5.75, 1.0), (8.2, 1.0), (7.0, 1.0), (5.75, 1.0), (4.9, 1.0), (4.9, 4.0),
    (4.9, 5.6), (4.05, 5.6), (3.2, 5.0),
]  # fmt: skip


def office() -> Plan:
    """Twenty rooms: a ring of corridor 2 m wide round six inner offices, and fourteen outer ones."""
    corridor = box(4.6, 4.6, 31.0, 17.4).difference(box(6.6, 6.6, 29.0, 15.4))
    rooms: dict[str, BaseGeometry] = {"corridor": corridor}
    doors: dict[str, LineString] = {}
    for column in range(6):
        left = 4.6 + column * 4.4
        width = 4.3 if column < 5 else 4.4
        rooms[f"south {column + 1}"] = box(left, 0.0, left + width, 4.5)
        rooms[f"north {column + 1}"] = box(left, 17.5, left + width, 22.0)
        doors[f"south door {column + 1}"] = _opening((left + 1.2 + 0.3 * column, 4.55), 0.9, upright=False)
        doors[f"north door {column + 1}"] = _opening((left + 3.2 - 0.3 * column, 17.45), 0.9, upright=False)
    rooms |= {"west": box(0.0, 7.0, 4.5, 15.0), "east": box(31.1, 7.0, 35.6, 15.0)}
    doors |= {
        "west door": _opening((4.55, 11.0), 1.0, upright=True),
        "east door": _opening((31.05, 10.0), 1.0, upright=True),
    }
    inner_rooms, inner_doors = _inner_offices()
    return plan_of(
        "office",
        "Twenty rooms on a ring of corridor, driven round one and a half times with visits to nine rooms",
        [
            *walls_around(rooms | inner_rooms, doors | inner_doors, 0.1),
            *(feature(box(*corners), "obstacle", material="rough") for corners in _DESKS),
            *(pillar(centre, 0.25) for centre in _BINS),
            drive_along(_OFFICE_WAY, step=1.2, wheels={"slip": 0.02}),
        ],
    )


def _inner_offices() -> tuple[dict[str, Polygon], dict[str, LineString]]:
    """Two rows of three, back to back, 10 cm walls; the middle ones are joined by a door."""
    rooms: dict[str, Polygon] = {}
    doors: dict[str, LineString] = {}
    for column in range(3):
        left, right = 6.7 + column * 7.45, 6.7 + column * 7.45 + (7.35 if column < 2 else 7.3)
        rooms[f"inner south {column + 1}"] = box(left, 6.7, right, 10.95)
        rooms[f"inner north {column + 1}"] = box(left, 11.05, right, 15.3)
        doors[f"inner south door {column + 1}"] = _opening((left + 2.0 + column, 6.65), 0.9, upright=False)
        doors[f"inner north door {column + 1}"] = _opening((right - 2.0 - column, 15.35), 0.9, upright=False)
    doors["inner passage"] = _opening((17.0, 11.0), 0.9, upright=False)
    return rooms, doors


_DESKS = [
    (4.9, 0.0, 6.5, 0.8), (9.0, 1.5, 9.8, 3.1), (13.4, 0.0, 15.4, 0.7), (20.6, 2.6, 22.1, 3.4), (26.6, 0.3, 28.4, 1.1),
    (4.6, 21.2, 6.6, 22.0), (11.4, 19.6, 13.2, 20.4), (16.4, 20.9, 17.2, 22.0), (24.6, 19.0, 25.4, 21.0),
    (29.4, 21.1, 31.0, 22.0), (0.0, 7.0, 0.9, 9.4), (1.6, 12.4, 3.4, 13.4), (34.2, 12.8, 35.6, 15.0),
    (32.6, 7.0, 34.4, 7.8), (10.8, 7.6, 12.4, 8.4), (6.7, 14.1, 8.3, 15.3), (19.4, 9.0, 21.2, 9.8),
    (15.0, 13.2, 16.0, 14.8), (25.4, 8.2, 26.2, 10.0), (23.4, 12.0, 25.0, 12.8), (8.6, 17.0, 10.0, 17.4),
    (20.4, 4.6, 21.4, 4.95), (30.6, 8.0, 31.0, 9.2),
]  # fmt: skip
_BINS = [(7.6, 9.8), (18.6, 1.2), (29.9, 2.4), (28.0, 20.4), (4.95, 16.0)]

_OFFICE_WAY = [
    (5.6, 5.6), (5.8, 4.55), (6.2, 2.4), (5.8, 4.55), (6.6, 5.6), (10.0, 5.6), (10.5, 4.55), (11.4, 2.4), (10.5, 4.55),
    (11.6, 5.6), (17.0, 5.6), (17.15, 6.65), (17.2, 8.6), (17.0, 11.0), (18.6, 13.0), (18.5, 15.35), (18.5, 16.4),
    (16.0, 16.4), (16.0, 17.45), (14.2, 19.0), (16.0, 17.45), (16.0, 16.4), (5.7, 16.6), (5.5, 11.0), (4.55, 11.0),
    (2.4, 11.0), (4.55, 11.0), (5.5, 11.0), (5.6, 5.6), (25.6, 5.6), (25.6, 6.65), (24.0, 8.0), (25.6, 6.65),
    (25.6, 5.6), (30.0, 5.6), (29.9, 10.0), (31.05, 10.0), (33.2, 10.2), (31.05, 10.0), (29.9, 10.0), (29.9, 16.4),
    (24.0, 16.4), (24.2, 17.45), (23.6, 19.0), (24.2, 17.45), (24.0, 16.4), (18.5, 16.4), (12.05, 16.4),
    (12.05, 15.35), (11.4, 13.0), (12.05, 15.35), (12.05, 16.4), (5.7, 16.6), (5.6, 5.6), (14.0, 5.6),
]  # fmt: skip


def _opening(centre: tuple[float, float], width: float, upright: bool) -> LineString:
    """A doorway of `width` around its centre, along y where upright."""
    (x, y), half = centre, width / 2
    return LineString([(x, y - half), (x, y + half)] if upright else [(x - half, y), (x + half, y)])
