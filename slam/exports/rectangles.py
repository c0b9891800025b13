"""The boundary of the free space as the paper's thin rectangles, which the planners take as walls."""

import json
from pathlib import Path

from shapely import Polygon
from shapely.geometry import mapping

from backend.thin_rectangles import ThinRectangles, thin_rectangles
from slam.exports.product import Product
from slam.world_file import RECTANGLE


def write_rectangles(product: Product, path: Path) -> None:
    """GeoJSON of the best estimate's boundary, one feature a rectangle (Flynn 1988, §4.1 and Fig. 10)."""
    path.write_text(rectangles_text(thin_rectangles(product.room.free)), encoding="utf-8")


def rectangles_text(rectangles: ThinRectangles) -> str:
    """Rectangles in metres, each with the number of its chain; `unit` and `origin` lead back to the 256 × 256 map."""
    features = [
        {
            "type": "Feature",
            "properties": {"kind": RECTANGLE, "chain": number},
            "geometry": mapping(Polygon(corners * rectangles.unit + rectangles.origin)),
        }
        for number, chain in enumerate(rectangles.chains)
        for corners in chain
    ]
    head = {"type": "FeatureCollection", "unit": rectangles.unit, "origin": rectangles.origin.tolist()}
    return json.dumps(head | {"features": features}) + "\n"
