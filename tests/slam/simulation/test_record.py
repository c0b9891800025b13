import hashlib
import shutil
import tomllib
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from shapely import box

from frontend.sensors.lidar import LIDAR
from slam.recordings import open_recording
from slam.simulation.floors import drive_along, feature, write_plan
from slam.simulation.plans import PLANS
from slam.simulation.record import SENSORS, Recipe, SimulationError, drive_through, lidar_scan, simulate
from slam.simulation.trajectory import WheelNoise, true_poses
from slam.simulation.world import build_world
from slam.trajectory_file import read_trajectory

DATASETS = Path(__file__).parents[3] / "datasets"
RECORDINGS = sorted(path.parent.name for path in DATASETS.glob("*/recording.toml"))
PLAN_ROOM = box(0, 0, 3, 2)


def command_of(recording: Path) -> list[str]:
    command: str = tomllib.loads((recording / "recording.toml").read_text())["command"]
    return command.split()


@pytest.mark.parametrize("recording", RECORDINGS)
def test_the_command_in_a_recording_makes_the_same_bytes_again(
    recording: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    shipped = DATASETS / recording
    program, verb, plan, _, sensor, _, out, _, seed = command_of(shipped)
    assert (program, verb) == ("roomsketch", "simulate")
    shutil.copytree(DATASETS / "plans", tmp_path / "datasets" / "plans")
    monkeypatch.chdir(tmp_path)
    simulate(Path(plan), Recipe(sensor, int(seed)), Path(out))
    hashes = [
        {file.name: hashlib.sha256(file.read_bytes()).hexdigest() for file in folder.iterdir()}
        for folder in (shipped, tmp_path / out)
    ]
    assert hashes[0] == hashes[1]


@pytest.mark.parametrize("recording", RECORDINGS)
def test_every_shipped_recording_can_be_read_and_has_a_true_pose_per_scan(recording: str) -> None:
    scans = list(open_recording(DATASETS / recording, strict=True).scans)
    poses = read_trajectory(DATASETS / recording / "true.tum").poses
    assert len(scans) == len(poses)
    assert poses[0] == pytest.approx(np.zeros(3))
    assert command_of(DATASETS / recording)[2].removeprefix("datasets/plans/").removesuffix(".geojson") in PLANS


def test_the_basement_is_seen_from_three_places_two_feet_apart() -> None:
    feet = read_trajectory(DATASETS / "flynn_basement" / "true.tum").poses / 0.3048
    assert feet[:, :2] == pytest.approx(np.array([(0, 0), (0, -2), (2, -2)]), abs=1e-4)


@pytest.mark.parametrize("sensor", sorted(SENSORS))
def test_what_was_simulated_is_what_is_read_back(sensor: str, tmp_path: Path) -> None:
    plan = tmp_path / "plan.geojson"
    write_plan(PLANS["flynn_two_doors"](), plan)
    recipe = Recipe(sensor, seed=3)
    simulate(plan, recipe, tmp_path / "recording")
    world = build_world(PLANS["flynn_two_doors"]())
    assert world.drive is not None
    read = list(open_recording(tmp_path / "recording", strict=True).scans)
    for ours, theirs in zip(drive_through(world, true_poses(world.drive), recipe), read, strict=True):
        assert theirs.ranges == pytest.approx(ours.ranges, abs=1e-4)
        assert theirs.bearings == pytest.approx(ours.bearings, abs=1e-6)
        assert theirs.odometry == pytest.approx(ours.odometry, abs=1e-6)
        assert (theirs.infrared is None) == (ours.infrared is None)
        if ours.infrared is not None and theirs.infrared is not None:
            assert np.array_equal(theirs.infrared, ours.infrared)
        assert theirs.sensor.half_beam == pytest.approx(ours.sensor.half_beam, abs=1e-3)


def test_another_seed_makes_another_recording_and_the_same_seed_the_same() -> None:
    world = build_world(PLANS["flynn_basement"]())
    assert world.drive is not None
    poses = true_poses(world.drive)
    first, again, other = (drive_through(world, poses, Recipe("lidar", seed)) for seed in (1, 1, 2))
    assert all(np.array_equal(a.ranges, b.ranges) for a, b in zip(first, again, strict=True))
    assert not np.array_equal(first[1].odometry, other[1].odometry)


def test_poses_from_a_file_take_the_place_of_the_plans_drive(tmp_path: Path) -> None:
    plan, poses = tmp_path / "plan.geojson", tmp_path / "poses.tum"
    write_plan(PLANS["flynn_basement"](), plan)
    poses.write_text("0 2.0 1.0 0 0 0 0 1\n1 2.5 1.0 0 0 0 0 1\n")
    simulate(plan, Recipe("lidar"), tmp_path / "out", poses)
    assert read_trajectory(tmp_path / "out" / "true.tum").poses == pytest.approx(np.array([(0, 0, 0), (0.5, 0, 0)]))
    assert command_of(tmp_path / "out")[-2:] == ["--poses", poses.as_posix()]


def test_the_drive_says_how_its_wheels_err_unless_the_recipe_does() -> None:
    drive = build_world(PLANS["office"]()).drive
    assert drive is not None
    assert Recipe().wheel_noise(drive) == WheelNoise(slip=0.02)
    assert Recipe(wheels=WheelNoise(0.1)).wheel_noise(drive) == WheelNoise(0.1)
    with pytest.raises(SimulationError, match="the drive's wheels have no 'skid'"):
        Recipe().wheel_noise(replace(drive, wheels={"skid": 1.0}))


def test_what_cannot_be_simulated_is_refused_in_one_sentence(tmp_path: Path) -> None:
    plan = tmp_path / "plan.geojson"
    write_plan({"features": [feature(PLAN_ROOM, "boundary")]}, plan)
    with pytest.raises(SimulationError, match="has no drive, so a file of poses must be given"):
        simulate(plan, Recipe("lidar"), tmp_path / "out")
    with pytest.raises(SimulationError, match="no sensor is called 'radar', known are sonar_infrared, lidar"):
        Recipe("radar").simulated  # noqa: B018
    world = build_world({"features": [feature(PLAN_ROOM, "boundary"), drive_along([(1, 1), (2, 1)])]})
    with pytest.raises(SimulationError, match=r"pose 1 at 1.00, 5.00 does not stand in free space"):
        drive_through(world, np.array([(1, 1, 0), (1, 5, 0)], float), Recipe("lidar"))
    assert not (tmp_path / "out").exists()


def test_a_lidar_in_the_middle_of_a_room_reads_its_walls() -> None:
    world = build_world({"features": [feature(PLAN_ROOM, "boundary")]})
    exact = replace(LIDAR, range_noise=0.0)
    ranges = lidar_scan(world, np.array([1.0, 1.0, 0.0]), exact, np.random.default_rng(0))
    assert ranges[[180, 270, 0, 90]] == pytest.approx([2, 1, 1, 1])
