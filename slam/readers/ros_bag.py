"""Robot logs of ROS 1, ROS 2 and bare MCAP: LaserScan or Range messages with the odometry of their moment, without ROS.

Needs the extra [ros]. Of several topics of a kind the one with the most messages is read, and the others are named.
"""

from collections import defaultdict
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from frontend.rigid_motion import compose, transform
from frontend.scan import Floats, Scan, ScanError, Sensor
from slam.readers.recording import DamagedLine, Recording, RecordingError
from slam.trajectory_file import Trajectory

LASER, RANGE, ODOMETRY = "sensor_msgs/msg/LaserScan", "sensor_msgs/msg/Range", "nav_msgs/msg/Odometry"
TREES = ("tf2_msgs/msg/TFMessage", "tf/msg/tfMessage")
TOGETHER = 0.5  # of the period of a ring of Range sensors: readings that close belong to one scan
ULTRASOUND = 0  # radiation_type of a Range message


@dataclass(frozen=True, eq=False)
class Mount:
    """Where a sensor sits in the robot's frame: pose (3,), and whether it hangs upside down."""

    pose: Floats
    flipped: bool


@dataclass(frozen=True, eq=False)
class Messages:
    """What a bag holds of interest: (seconds, message) by topic, and parent frame with transform by child frame."""

    topics: dict[str, dict[str, list[tuple[float, Any]]]] = field(default_factory=lambda: defaultdict(dict))
    parents: dict[str, tuple[str, Any]] = field(default_factory=dict)

    def richest(self, kind: str) -> tuple[str, list[tuple[float, Any]]]:
        """The topic of this kind with the most messages, by its header's times; empty where there is none."""
        found = self.topics.get(kind, {})
        if not found:
            return "", []
        name = max(found, key=lambda topic: len(found[topic]))
        return name, sorted(found[name], key=lambda stamped: stamped[0])


def read_ros_bag(path: Path, strict: bool) -> Recording:
    """The scans of a .bag, .mcap or .db3 file or of a ROS 2 bag's folder."""
    bag = _read(path)
    damaged = [
        DamagedLine(path.name, None, f"{len(messages)} messages of {topic} are left out, for {chosen} has more")
        for kind in (LASER, ODOMETRY)
        for chosen in [bag.richest(kind)[0]]
        for topic, messages in bag.topics.get(kind, {}).items()
        if topic != chosen
    ]
    name, odometry = bag.richest(ODOMETRY)
    trail = _trail(odometry)
    base = odometry[0][1].child_frame_id if odometry else ""
    if not odometry:
        damaged.append(DamagedLine(path.name, None, "no Odometry: the wheels are taken to stand still"))
    scans, refused = _laser_scans(bag, trail, base) if bag.topics.get(LASER) else _rings(bag, trail, base, path)
    damaged += [DamagedLine(path.name, number, reason) for number, reason in refused]
    if strict and refused:
        raise RecordingError(str(damaged[-1]))
    if not scans:
        seen = ", ".join(sorted(topic for topics in bag.topics.values() for topic in topics)) or "nothing of use"
        raise RecordingError(f"{path}: no LaserScan or Range message that could be used; seen: {seen}")
    return Recording(path.stem, tuple(scans), tuple(damaged), odometry=trail if name else None)


def _read(path: Path) -> Messages:
    bag = Messages()
    for line, logged, message in _messages(path):
        if line.msgtype in TREES:
            bag.parents.update({link.child_frame_id: (link.header.frame_id, link) for link in message.transforms})
        else:
            stamp = message.header.stamp
            # Some drivers leave the header's time at zero: then the log's own clock must do.
            seconds = stamp.sec + stamp.nanosec * 1e-9 or logged * 1e-9
            bag.topics[line.msgtype].setdefault(line.topic, []).append((seconds, message))
    return bag


def _messages(path: Path) -> Iterator[tuple[Any, int, Any]]:
    """Connection, nanoseconds and message of whatever is of interest, in the order of the log.

    A bag's folder names its parts; only their last names count, so none can lie outside it. Damaged bytes make rosbags
    fail in any way its decoders know.
    """
    try:
        from rosbags.highlevel import AnyReader  # noqa: PLC0415  # an extra: only robot logs need it
        from rosbags.typesys import Stores, get_typestore  # noqa: PLC0415
    except ImportError as reason:
        raise RecordingError(f"{path.name} needs rosbags ({reason}): pip install 'roomsketch[ros]'") from reason
    number = 0
    try:
        with AnyReader([path], default_typestore=get_typestore(Stores.ROS2_HUMBLE)) as reader:
            wanted = [line for line in reader.connections if line.msgtype in (LASER, RANGE, ODOMETRY, *TREES)]
            for line, logged, raw in reader.messages(wanted) if wanted else ():
                yield line, logged, reader.deserialize(raw, line.msgtype)
                number += 1
    except Exception as reason:
        said = f"{type(reason).__name__}: {reason}"
        raise RecordingError(f"{path} cannot be read as a bag after {number} messages of use: {said}") from reason


def _trail(odometry: list[tuple[float, Any]]) -> Trajectory:
    """The wheels' way, headings unwrapped; one standing pose where nothing was logged."""
    if not odometry:
        return Trajectory(np.zeros(1), np.zeros((1, 2)), np.zeros(1))
    times, first = np.unique([time for time, _ in odometry], return_index=True)
    poses = [odometry[k][1].pose.pose for k in first]
    places = np.array([[pose.position.x, pose.position.y] for pose in poses])
    return Trajectory(times, places, np.unwrap([_rotation(pose.orientation)[0] for pose in poses]))


def _at(trail: Trajectory, time: float) -> Floats:
    return np.array([np.interp(time, trail.times, axis) for axis in trail.poses.T])


def _rotation(quaternion: Any) -> tuple[float, bool]:
    """Heading of the x axis in the plane, and whether the z axis points down."""
    x, y, z, w = quaternion.x, quaternion.y, quaternion.z, quaternion.w
    return float(np.arctan2(2 * (x * y + z * w), 1 - 2 * (y * y + z * z))), 1 - 2 * (x * x + y * y) < 0


def _mount(bag: Messages, frame: str, base: str) -> Mount:
    """The chain of transforms from the robot's base to a sensor's frame; at the base where the bag holds none."""
    pose, flipped, frame = np.zeros(3), False, frame.removeprefix("/")
    parents = {child.removeprefix("/"): link for child, link in bag.parents.items()}
    passed = {frame}
    while frame in parents and frame != base.removeprefix("/"):
        parent, link = parents[frame]
        heading, down = _rotation(link.transform.rotation)
        place = link.transform.translation
        here = pose * (1, -1, -1) if down else pose
        pose, flipped = compose(np.array([place.x, place.y, heading]), here), flipped != down
        frame = parent.removeprefix("/")
        if frame in passed or frame in ("odom", "map"):
            break
        passed.add(frame)
    return Mount(pose, flipped)


def _laser_scans(bag: Messages, trail: Trajectory, base: str) -> tuple[list[Scan], list[tuple[int, str]]]:
    _, messages = bag.richest(LASER)
    first = messages[0][1]
    mount = _mount(bag, first.header.frame_id, base)
    facts = ("lidar", float(first.range_max), max(float(first.range_min), 0.0))
    sensor = Sensor(*facts, mount=(float(mount.pose[0]), float(mount.pose[1]), float(mount.pose[2])))
    scans: list[Scan] = []
    refused = []
    for number, (time, message) in enumerate(messages):
        try:
            scans.append(_laser_scan(message, time, sensor, mount, _at(trail, time)))
        except ScanError as reason:
            refused.append((number, str(reason)))
            continue
        if len(scans) > 1 and scans[-1].time <= scans[-2].time:
            refused.append((number, f"time {time:.6f} does not come after the one before"))
            del scans[-1]
    return scans, refused


def _laser_scan(message: Any, time: float, sensor: Sensor, mount: Mount, odometry: Floats) -> Scan:
    ranges = np.asarray(message.ranges, np.float64)
    bearings = message.angle_min + message.angle_increment * np.arange(ranges.size)
    # By the message's definition what lies outside its limits is to be discarded; too far means that nothing came back.
    ranges = np.where(ranges < message.range_min, np.nan, np.where(ranges >= message.range_max, np.inf, ranges))
    if np.isnan(ranges).all():
        raise ScanError(f"none of {ranges.size} ranges is usable")
    if mount.flipped:
        bearings = -bearings
    order = np.argsort(bearings)
    whole = bearings[order] - bearings[order[0]] < 2 * np.pi - 1e-6  # some drivers repeat the first beam at the end
    return Scan(bearings[order][whole], ranges[order][whole], sensor, odometry, time)


def _rings(bag: Messages, trail: Trajectory, base: str, path: Path) -> tuple[list[Scan], list[tuple[int, str]]]:
    """Scans of a few fixed beams, one Range topic each, taken together round by round."""
    topics = bag.topics.get(RANGE, {})
    if not topics:
        return [], []
    beams = [sorted(messages, key=lambda stamped: stamped[0]) for _, messages in sorted(topics.items())]
    mounts = [_mount(bag, messages[0][1].header.frame_id, base).pose for messages in beams]
    headings = np.array([mount[2] for mount in mounts])
    order = np.argsort(headings)
    if (np.diff(headings[order]) < 1e-3).any():
        raise RecordingError(
            f"{path}: {len(topics)} Range topics look the same way; /tf_static must say how each sensor is mounted"
        )
    sensor, refused = _range_sensor([messages[0][1] for messages in beams]), []
    clock = np.array([time for time, _ in beams[0]])
    period = float(np.median(np.diff(clock))) if clock.size > 1 else np.inf
    stamps = [np.array([time for time, _ in messages]) for messages in beams]
    rounds = list(zip(stamps, beams, mounts, strict=True))
    scans: list[Scan] = []
    for number, time in enumerate(clock.tolist()):
        ring = np.array([_echo(*beam, time, TOGETHER * period) for beam in rounds])[order]
        if np.isnan(ring[:, 1]).all():
            refused.append((number, "no beam has a usable reading"))
        elif not scans or time > scans[-1].time:
            scans.append(Scan(ring[:, 0], ring[:, 1], sensor, _at(trail, time), time))
    return scans, refused


def _range_sensor(messages: list[Any]) -> Sensor:
    kind = "sonar" if messages[0].radiation_type == ULTRASOUND else "time_of_flight"
    near, far = max(message.min_range for message in messages), min(message.max_range for message in messages)
    return Sensor(kind, float(far), float(near), half_beam=float(messages[0].field_of_view) / 2)


def _echo(
    stamps: Floats, messages: list[tuple[float, Any]], mount: Floats, time: float, reach: float
) -> tuple[float, float]:
    """Bearing and range from the robot's centre of the reading nearest in time; nan where none is near enough."""
    nearest, message = messages[int(np.argmin(np.abs(stamps - time)))]
    if abs(nearest - time) > reach or message.range < message.min_range or np.isnan(message.range):
        return float(mount[2]), np.nan
    if message.range >= message.max_range:
        return float(mount[2]), np.inf
    end = transform(np.array([[message.range, 0.0]]), mount)[0]
    return float(mount[2]), float(np.hypot(*end))
