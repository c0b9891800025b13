"""Every format a map can be taken away in, by name, and the one way to write any of them."""

import shutil
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory

from slam.exports.drawing import write_dxf, write_svg
from slam.exports.geopackage import write_geopackage
from slam.exports.mesh import write_mesh
from slam.exports.occupancy_grid import write_grid
from slam.exports.product import ExportError, Product
from slam.exports.rectangles import write_rectangles
from slam.room_file import room_text
from slam.trajectory_file import tum_text
from slam.whole_output import OutputError


@dataclass(frozen=True)
class Export:
    """suffix: what a file of this format ends in. write: puts the product at a path of that suffix."""

    suffix: str
    says: str
    write: Callable[[Product, Path], None]


def export_named(to: Path) -> Export | None:
    """The format whose ending the name has, the longest where several do."""
    fitting = [one for one in EXPORTS.values() if to.name.lower().endswith(one.suffix)]
    return max(fitting, key=lambda one: len(one.suffix), default=None)


def export(product: Product, to: Path) -> list[Path]:
    """Write the product in the format that the name `to` ends in; the files made, whole or not at all.

    Raises ExportError for an unknown ending or what the product lacks, OutputError where nothing can be written.
    """
    known = export_named(to)
    if known is None:
        endings = ", ".join(one.suffix for one in EXPORTS.values())
        raise ExportError(
            f"{to.name}: no format to export ends in {repr(to.suffix) if to.suffix else 'nothing'}; known are {endings}"
        )
    try:
        to.parent.mkdir(parents=True, exist_ok=True)
        with TemporaryDirectory(prefix=f".{to.name}.", dir=to.parent) as making:
            known.write(product, Path(making) / to.name)
            made = sorted(Path(making).iterdir())
            return [Path(shutil.move(part, to.parent / part.name)) for part in made]
    except OSError as reason:
        raise OutputError(f"{to} cannot be written: {reason.strerror or reason}") from reason


def _write_geojson(product: Product, path: Path) -> None:
    path.write_text(room_text(product.room, product.landmarks), encoding="utf-8")


def _write_trajectory(product: Product, path: Path) -> None:
    if product.trajectory is None:
        raise ExportError(f"{product.source} holds no trajectory: export from the folder that merge wrote")
    path.write_text(tum_text(product.trajectory.times, product.trajectory.poses), encoding="utf-8")


def _write_graph(product: Product, path: Path) -> None:
    if product.graph is None:
        raise ExportError(f"{product.source} holds no pose graph: export from the folder that merge wrote")
    path.write_text(product.graph, encoding="utf-8")


EXPORTS = {
    "geojson": Export(".geojson", "the map with the provenance of every edge", _write_geojson),
    "rectangles": Export(".rectangles.geojson", "the boundary as the paper's thin rectangles", write_rectangles),
    "svg": Export(".svg", "a drawing for browsers and illustration programs", write_svg),
    "dxf": Export(".dxf", "a drawing in metres for CAD programs", write_dxf),
    "pgm": Export(".pgm", "an occupancy grid with its .yaml for map servers", write_grid),
    "gpkg": Export(".gpkg", "a GeoPackage for geographic information systems", write_geopackage),
    "glb": Export(".glb", "walls extruded to a mesh, binary glTF", write_mesh),
    "ply": Export(".ply", "walls extruded to a mesh, PLY", write_mesh),
    "tum": Export(".tum", "the trajectory, one pose a scan", _write_trajectory),
    "g2o": Export(".g2o", "the pose graph with its landmarks", _write_graph),
}
