import json
from pathlib import Path
from typing import Any

import ezdxf
import gtsam
import numpy as np
import pyogrio
import pytest
import shapely
import yaml
from evo.tools import file_interface
from matplotlib.image import imread
from shapely import MultiPolygon, Polygon, box

from backend.estimate import Estimate, LandmarkTie, Tie
from backend.room_map import Door, MapEdge, MapEdgeKind, Obstacle, RoomMap
from frontend.registration import load_open3d
from slam.exports.formats import EXPORTS, export
from slam.exports.product import ExportError, Product, load_product
from slam.pose_graph_file import g2o_text
from slam.room_file import read_room
from slam.trajectory_file import Trajectory
from slam.whole_output import OutputError
from slam.world_file import read_world

VIEWS = np.array([0, 1])
PILLAR = box(1.5, 1.0, 2.0, 1.4)


def _estimate() -> Estimate:
    poses = np.array([[0.5, 0.5, 0.0], [1.5, 0.5, 0.1], [2.0, 2.0, 1.2]])
    tie = Tie(0, 1, np.array([1.0, 0.0, 0.1]), np.diag([100.0, 200.0, 300.0]))
    seen = LandmarkTie(1, 0, np.array([2.0, 0.5]), np.diag([10.0, 20.0]))
    counts = np.array([2])
    keyframes = np.array([0, 1])
    return Estimate(
        poses,
        np.zeros((3, 3, 3)),
        np.array([[3.5, 1.2]]),
        counts,
        keyframes,
        (),
        {},
        np.ones(3, bool),
        ties=(tie,),
        landmark_ties=(seen,),
    )


@pytest.fixture
def product() -> Product:
    """A room of 4 m × 3 m whose right wall was never seen, with a pillar and a door."""
    corners = [(0.0, 0.0), (4.0, 0.0), (4.0, 3.0), (0.0, 3.0)]
    kinds = [MapEdgeKind.REAL, MapEdgeKind.FRONTIER, MapEdgeKind.REAL, MapEdgeKind.REAL]
    edges = [
        MapEdge(start, end, kind, 2, 1, 0.01 if kind is MapEdgeKind.REAL else np.inf, VIEWS)
        for start, end, kind in zip(corners, corners[1:] + corners[:1], kinds, strict=True)
    ]
    free = MultiPolygon([Polygon(corners, [PILLAR.exterior.coords[:]])])
    room = RoomMap(
        free=free,
        safety=MultiPolygon([box(0.1, 0.1, 1.4, 2.9)]),
        edges=tuple(edges),
        doors=(Door("door 1", np.array([[0.0, 1.0], [0.0, 1.8]]), 0.9, VIEWS),),
        obstacles=(Obstacle(PILLAR, False, 2, VIEWS),),
        leaks=np.empty((0, 2)),
    )
    estimate = _estimate()
    times = np.arange(3.0)
    trajectory = Trajectory(times, estimate.poses[:, :2], estimate.poses[:, 2])
    return Product(Path("run"), room, estimate.landmarks, trajectory, g2o_text(estimate))


def test_every_format_is_written_whole_and_leaves_nothing_else(product: Product, tmp_path: Path) -> None:
    for name in EXPORTS:
        made = export(product, tmp_path / name / f"map{EXPORTS[name].suffix}")
        assert sorted((tmp_path / name).iterdir()) == made


def test_geojson_is_the_map_again(product: Product, tmp_path: Path) -> None:
    (path,) = export(product, tmp_path / "map.geojson")
    assert read_room(path).free.equals(product.room.free)
    assert load_product(path).graph is None


def test_a_browser_would_find_every_layer_and_provenance_in_the_svg(product: Product, tmp_path: Path) -> None:
    (path,) = export(product, tmp_path / "map.svg")
    text = path.read_text()
    assert text.count("<path") == 1 + 4 + 1 + 1 + 1  # ground, edges, pillar, door, way
    assert "wall, seen by 2 views, contradicted by 1" in text
    assert 'viewBox="-0.500 -3.500 5.000 4.000"' in text


def test_cad_reads_the_drawing_in_metres_on_layers(product: Product, tmp_path: Path) -> None:
    (path,) = export(product, tmp_path / "map.dxf")
    drawing = ezdxf.filemanagement.readfile(path)
    assert drawing.units == ezdxf.units.M
    walls = drawing.modelspace().query('LWPOLYLINE[layer=="wall"]')
    assert len(walls) == 3
    assert len(drawing.modelspace().query('LWPOLYLINE[layer=="free"]')) == 2
    assert len(drawing.modelspace().query("POINT")) == 1


def test_a_map_server_finds_free_occupied_and_unknown_where_they_are(product: Product, tmp_path: Path) -> None:
    picture_path, facts_path = export(product, tmp_path / "map.pgm")
    facts = yaml.safe_load(facts_path.read_text())
    picture = imread(tmp_path / facts["image"])[::-1]
    cell, (x, y, heading) = facts["resolution"], facts["origin"]
    assert picture_path.name == "map.pgm"
    assert heading == 0

    def occupancy(at: tuple[float, float]) -> float:
        return float((255 - picture[int((at[1] - y) / cell), int((at[0] - x) / cell)]) / 255)

    assert occupancy((0.5, 0.5)) < facts["free_thresh"]
    assert occupancy((2.0, 0.01)) > facts["occupied_thresh"]
    assert occupancy((1.5, 1.2)) > facts["occupied_thresh"]
    for unknown in [(1.75, 1.2), (4.3, 1.5), (-0.3, 1.0)]:
        assert facts["free_thresh"] < occupancy(unknown) < facts["occupied_thresh"]


def test_a_gis_reads_every_layer_with_its_columns(product: Product, tmp_path: Path) -> None:
    (path,) = export(product, tmp_path / "map.gpkg")
    names = pyogrio.list_layers(path)[:, 0].tolist()
    assert names == ["free", "safety", "walls", "frontiers", "doors", "obstacles", "landmarks"]
    facts, _, outlines, columns = pyogrio.raw.read(path, layer="walls")
    assert [line.length for line in shapely.from_wkb(outlines)] == [4.0, 4.0, 3.0]
    assert dict(zip(facts["fields"], columns, strict=True))["views"].tolist() == ["0 1"] * 3
    _, _, (free,), _ = pyogrio.raw.read(path, layer="free")
    assert shapely.from_wkb(free).area == pytest.approx(12 - 0.2)


@pytest.mark.parametrize("suffix", [".glb", ".ply"])
def test_the_walls_stand_on_the_floor(product: Product, tmp_path: Path, suffix: str) -> None:
    (path,) = export(product, tmp_path / f"map{suffix}")
    mesh = load_open3d().io.read_triangle_mesh(str(path))
    low, high = mesh.get_min_bound(), mesh.get_max_bound()
    assert low == pytest.approx([0, 0, 0], abs=1e-6)
    assert high == pytest.approx([4, 3, 2.5], abs=1e-6)
    floor = 12 - 0.2
    walls, pillar = 2.5 * 11, 0.2 + 1.0 * 1.8
    assert mesh.get_surface_area() == pytest.approx(floor + walls + pillar)


def test_evo_reads_the_trajectory(product: Product, tmp_path: Path) -> None:
    (path,) = export(product, tmp_path / "way.tum")
    read = file_interface.read_tum_trajectory_file(str(path))
    assert product.trajectory is not None
    np.testing.assert_allclose(read.positions_xyz[:, :2], product.trajectory.positions, atol=1e-6)


def test_gtsam_reads_the_pose_graph(product: Product, tmp_path: Path) -> None:
    (path,) = export(product, tmp_path / "graph.g2o")
    graph, values = gtsam.readG2o(str(path), False)
    assert values.atPose2(1).theta() == pytest.approx(0.1)
    factor: Any = graph.at(0)
    assert factor.measured().x() == pytest.approx(1.0)
    np.testing.assert_allclose(factor.noiseModel().information(), np.diag([100.0, 200.0, 300.0]))
    assert "VERTEX_XY 2 3.5 1.2" in path.read_text()
    assert "EDGE_SE2_XY 1 2 2 0.5 10 0 20" in path.read_text()


def test_what_cannot_be_exported_is_said(product: Product, tmp_path: Path) -> None:
    with pytest.raises(ExportError, match=r"map.step: no format to export ends in '.step'; known are .geojson"):
        export(product, tmp_path / "map.step")
    alone = load_product(export(product, tmp_path / "map.geojson")[0])
    for name, lacking in [("way.tum", "trajectory"), ("graph.g2o", "pose graph")]:
        with pytest.raises(ExportError, match=f"holds no {lacking}: export from the folder that merge wrote"):
            export(alone, tmp_path / name)
    (tmp_path / "file").write_text("")
    with pytest.raises(OutputError, match="cannot be written"):
        export(product, tmp_path / "file" / "map.svg")


def test_thin_rectangles_enclose_the_free_space_but_for_half_their_width(product: Product, tmp_path: Path) -> None:
    (path,) = export(product, tmp_path / "room.rectangles.geojson")
    unit = json.loads(path.read_text())["unit"]
    world = read_world(path, "safety").world
    assert shapely.hausdorff_distance(world.free.boundary, product.room.free.boundary) < unit
