from collections.abc import Iterable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from rosbags.rosbag1 import Writer as Writer1
from rosbags.rosbag2 import StoragePlugin
from rosbags.rosbag2 import Writer as Writer2
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

from slam.readers.recording import RecordingError
from slam.recordings import open_recording

ROS1, ROS2 = get_typestore(Stores.ROS1_NOETIC), get_typestore(Stores.ROS2_HUMBLE)
ROS1.register(get_types_from_msg("geometry_msgs/TransformStamped[] transforms", "tf2_msgs/msg/TFMessage"))
BEAMS = np.array([0.05, 1.0, np.inf, np.nan, 9.5], np.float32)
Said = tuple[str, str, float, Any]  # topic, type, seconds, message


class Robot:
    """Messages of one robot, in the types of one ROS."""

    def __init__(self, store: Any) -> None:
        self.store = store

    def header(self, frame: str, time: float) -> Any:
        stamp = self.store.types["builtin_interfaces/msg/Time"](sec=int(time), nanosec=round(time % 1 * 1e9))
        sequence = {"seq": 0} if self.store is ROS1 else {}
        return self.store.types["std_msgs/msg/Header"](stamp=stamp, frame_id=frame, **sequence)

    def pose(self, x: float, y: float, heading: float, roll: float = 0.0) -> tuple[Any, Any]:
        half, tilt = heading / 2, roll / 2
        turned = self.store.types["geometry_msgs/msg/Quaternion"](
            x=float(np.sin(tilt) * np.cos(half)), y=float(np.sin(tilt) * np.sin(half)),
            z=float(np.cos(tilt) * np.sin(half)), w=float(np.cos(tilt) * np.cos(half)),
        )  # fmt: skip
        return self.store.types["geometry_msgs/msg/Point"](x=x, y=y, z=0.0), turned

    def scan(self, time: float, ranges: Any = BEAMS, topic: str = "/scan") -> Said:
        kind = "sensor_msgs/msg/LaserScan"
        message = self.store.types[kind](
            header=self.header("laser", time), angle_min=-1.0, angle_max=1.0, angle_increment=0.5, time_increment=0.0,
            scan_time=0.1, range_min=0.1, range_max=9.0, ranges=ranges, intensities=np.empty(0, np.float32),
        )  # fmt: skip
        return topic, kind, time, message

    def odometry(self, time: float, x: float, heading: float) -> Said:
        kind, types = "nav_msgs/msg/Odometry", self.store.types
        place, turned = self.pose(x, 0.0, heading)
        still = types["geometry_msgs/msg/Vector3"](x=0.0, y=0.0, z=0.0)
        twist = types["geometry_msgs/msg/Twist"](linear=still, angular=still)
        message = types[kind](
            header=self.header("odom", time),
            child_frame_id="base_link",
            pose=types["geometry_msgs/msg/PoseWithCovariance"](
                pose=types["geometry_msgs/msg/Pose"](position=place, orientation=turned), covariance=np.zeros(36)
            ),
            twist=types["geometry_msgs/msg/TwistWithCovariance"](twist=twist, covariance=np.zeros(36)),
        )
        return "/odom", kind, time, message

    def mount(self, child: str, x: float, heading: float, roll: float = 0.0) -> Said:
        types = self.store.types
        _, turned = self.pose(0.0, 0.0, heading, roll)
        link = types["geometry_msgs/msg/TransformStamped"](
            header=self.header("base_link", 0.0),
            child_frame_id=child,
            transform=types["geometry_msgs/msg/Transform"](
                translation=types["geometry_msgs/msg/Vector3"](x=x, y=0.0, z=0.2), rotation=turned
            ),
        )
        return "/tf_static", "tf2_msgs/msg/TFMessage", 0.0, types["tf2_msgs/msg/TFMessage"](transforms=[link])

    def range(self, time: float, frame: str, metres: float) -> Said:
        kind = "sensor_msgs/msg/Range"
        newer = {"variance": 0.0} if "variance" in self.store.types[kind].__dataclass_fields__ else {}
        message = self.store.types[kind](
            header=self.header(frame, time), radiation_type=1, field_of_view=0.4, min_range=0.02, max_range=4.0,
            range=metres, **newer,
        )  # fmt: skip
        return f"/{frame}", kind, time, message

    def drive(self) -> list[Said]:
        """Three scans while the wheels go 1 m and turn half a radian in 2 s; the laser 0.2 m ahead."""
        wheels = [self.odometry(time, time / 2, time / 4) for time in (0.0, 1.0, 2.0)]
        return [self.mount("laser", 0.2, 0.1), *wheels, *(self.scan(time) for time in (0.5, 1.0, 1.5))]


def _write_ros2(path: Path, said: Iterable[Said], storage: StoragePlugin) -> Path:
    with Writer2(path, version=9, storage_plugin=storage) as writer:
        topics: dict[str, Any] = {}
        for topic, kind, time, message in said:
            if topic not in topics:
                topics[topic] = writer.add_connection(topic, kind, typestore=ROS2)
            writer.write(topics[topic], int(time * 1e9), ROS2.serialize_cdr(message, kind))
    return path


def _write_ros1(path: Path, said: Iterable[Said]) -> Path:
    with Writer1(path) as writer:
        topics: dict[str, Any] = {}
        for topic, kind, time, message in said:
            if topic not in topics:
                topics[topic] = writer.add_connection(topic, kind, typestore=ROS1)
            writer.write(topics[topic], int(time * 1e9), ROS1.serialize_ros1(message, kind))
    return path


@pytest.fixture(params=["ros1", "sqlite", "mcap", "bare mcap"])
def bag(request: pytest.FixtureRequest, tmp_path: Path) -> Path:
    """The same drive, as each kind of bag."""
    if request.param == "ros1":
        return _write_ros1(tmp_path / "drive.bag", Robot(ROS1).drive())
    storage = StoragePlugin.SQLITE3 if request.param == "sqlite" else StoragePlugin.MCAP
    folder = _write_ros2(tmp_path / "drive", Robot(ROS2).drive(), storage)
    return next(folder.glob("*.mcap")) if request.param == "bare mcap" else folder


def test_scans_come_with_the_odometry_of_their_moment_from_every_kind_of_bag(bag: Path) -> None:
    recording = open_recording(bag)
    assert [scan.time for scan in recording.scans] == [0.5, 1.0, 1.5]
    np.testing.assert_allclose(recording.scans[0].odometry, [0.25, 0.0, 0.125])
    np.testing.assert_allclose(recording.scans[1].odometry, [0.5, 0.0, 0.25])
    sensor = recording.scans[0].sensor
    assert (sensor.kind, sensor.max_range) == ("lidar", 9.0)
    np.testing.assert_allclose(sensor.mount, (0.2, 0.0, 0.1))
    assert recording.odometry is not None
    assert recording.odometry.times.tolist() == [0.0, 1.0, 2.0]


def test_too_near_is_unusable_and_too_far_is_no_return(bag: Path) -> None:
    scan = open_recording(bag).scans[0]
    np.testing.assert_array_equal(scan.ranges, [np.nan, 1.0, np.inf, np.nan, np.inf])
    np.testing.assert_allclose(scan.bearings, [-1.0, -0.5, 0.0, 0.5, 1.0])


def test_a_scanner_upside_down_is_read_in_a_mirror(tmp_path: Path) -> None:
    robot = Robot(ROS2)
    said = [robot.mount("laser", 0.2, 0.0, roll=np.pi), robot.odometry(0.0, 0.0, 0.0), robot.scan(1.0)]
    scan = open_recording(_write_ros2(tmp_path / "drive", said, StoragePlugin.MCAP)).scans[0]
    np.testing.assert_allclose(scan.bearings, [-1.0, -0.5, 0.0, 0.5, 1.0])
    np.testing.assert_array_equal(scan.ranges, [np.inf, np.nan, np.inf, 1.0, np.nan])


def test_single_beams_mounted_around_the_robot_make_one_scan_a_round(tmp_path: Path) -> None:
    robot = Robot(ROS2)
    mounts = [robot.mount("front", 0.02, 0.0), robot.mount("left", 0.0, np.pi / 2)]
    rounds = [robot.range(time + delay, frame, metres) for time in (0.0, 0.1, 0.2)
              for delay, frame, metres in ((0.0, "front", 1.0), (0.01, "left", 4.0))]  # fmt: skip
    recording = open_recording(_write_ros2(tmp_path / "drive", [*mounts, *rounds], StoragePlugin.MCAP))
    assert len(recording.scans) == 3
    np.testing.assert_allclose(recording.scans[0].bearings, [0.0, np.pi / 2])
    np.testing.assert_allclose(recording.scans[0].ranges, [1.02, np.inf], atol=1e-6)
    assert recording.scans[0].sensor.half_beam == pytest.approx(0.2)
    assert [str(note) for note in recording.damaged] == ["drive: no Odometry: the wheels are taken to stand still"]


def test_what_is_left_out_and_what_is_missing_is_said(tmp_path: Path) -> None:
    robot = Robot(ROS2)
    blind = np.full(5, np.nan, np.float32)
    said = [*robot.drive(), robot.scan(1.7, blind), robot.scan(1.8, topic="/rear")]
    path = _write_ros2(tmp_path / "drive", said, StoragePlugin.MCAP)
    notes = [str(note) for note in open_recording(path).damaged]
    assert notes == [
        "drive: 1 messages of /rear are left out, for /scan has more",
        "drive line 3: none of 5 ranges is usable",
    ]
    with pytest.raises(RecordingError, match="none of 5 ranges is usable"):
        open_recording(path, strict=True)
    only = _write_ros2(tmp_path / "wheels", [robot.odometry(0.0, 0.0, 0.0)], StoragePlugin.MCAP)
    with pytest.raises(RecordingError, match="no LaserScan or Range message that could be used; seen: /odom"):
        open_recording(only)
    beams = _write_ros2(
        tmp_path / "beams", [robot.range(0.0, "a", 1.0), robot.range(0.0, "b", 1.0)], StoragePlugin.MCAP
    )
    with pytest.raises(RecordingError, match="2 Range topics look the same way; /tf_static must say"):
        open_recording(beams)
    (tmp_path / "broken.bag").write_text("no bag")
    with pytest.raises(RecordingError, match=r"broken\.bag cannot be read as a bag"):
        open_recording(tmp_path / "broken.bag")


@pytest.mark.parametrize("suffix", [".bag", ".db3", ".mcap"])
def test_whatever_befalls_a_bag_is_one_error_with_its_name(tmp_path: Path, suffix: str) -> None:
    if suffix == ".bag":
        whole = _write_ros1(tmp_path / "drive.bag", Robot(ROS1).drive()).read_bytes()
    else:
        storage = StoragePlugin.SQLITE3 if suffix == ".db3" else StoragePlugin.MCAP
        whole = next(_write_ros2(tmp_path / "drive", Robot(ROS2).drive(), storage).glob(f"*{suffix}")).read_bytes()
    generator, reasons = np.random.default_rng(0), list[str]()
    for _ in range(30):
        damaged = np.frombuffer(whole, np.uint8).copy()
        damaged[generator.integers(damaged.size, size=10)] = generator.integers(256, size=10)
        (tmp_path / f"hurt{suffix}").write_bytes(damaged[: generator.integers(1, damaged.size)].tobytes())
        try:
            open_recording(tmp_path / f"hurt{suffix}")
        except RecordingError as reason:
            reasons.append(str(reason))
    assert len(reasons) > 10
    assert all(f"hurt{suffix}" in reason for reason in reasons)


def test_a_folder_that_names_parts_elsewhere_reads_nothing_outside_itself(tmp_path: Path) -> None:
    secret = _write_ros2(tmp_path / "secret", Robot(ROS2).drive(), StoragePlugin.SQLITE3)
    folder = _write_ros2(tmp_path / "drive", [], StoragePlugin.SQLITE3)
    facts, part = folder / "metadata.yaml", next(secret.glob("*.db3"))
    for outside in (f"../secret/{part.name}", str(part)):
        facts.write_text(facts.read_text().replace("drive.db3", outside))
        assert outside in facts.read_text()
        with pytest.raises(RecordingError, match=r"secret\.db3"):
            open_recording(folder)
        facts.write_text(facts.read_text().replace(outside, "drive.db3"))
