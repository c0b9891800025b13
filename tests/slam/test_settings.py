"""Settings: one frozen tree, no branch shared by accident, and every leaf a plain value that TOML can hold."""

from collections.abc import Iterator
from dataclasses import FrozenInstanceError, fields, is_dataclass, replace
from typing import Any

import pytest

from slam.readers.recording import OdometryNoise
from slam.settings import Settings, knowing


def leaves(branch: Any, path: str = "") -> Iterator[tuple[str, Any]]:
    for field in fields(branch):
        value = getattr(branch, field.name)
        if is_dataclass(value):
            yield from leaves(value, f"{path}{field.name}.")
        else:
            yield path + field.name, value


def test_every_leaf_is_a_plain_value() -> None:
    found = dict(leaves(Settings()))
    assert len(found) > 30
    for name, value in found.items():
        parts = value if isinstance(value, tuple) else (value,)
        assert all(isinstance(part, int | float | bool | str) for part in parts), name


def test_settings_are_values() -> None:
    assert Settings() == Settings()
    assert hash(Settings()) == hash(Settings())
    poses = replace(Settings().poses, keyframe_metres=0.4)
    assert replace(Settings(), poses=poses) != Settings()


def test_settings_cannot_be_written_into() -> None:
    with pytest.raises(FrozenInstanceError):
        Settings().poses.tracking.recent = 3  # type: ignore[misc]


def test_what_a_recording_knows_of_its_wheels_outweighs_the_opinion() -> None:
    told = knowing(Settings(), OdometryNoise(0.01, 0.02, 0.03))
    assert (told.poses.odometry.distance_noise, told.poses.odometry.turn_noise) == (0.01, 0.02)
    assert told.poses.odometry.turn_per_metre == 0.03
    assert told.poses.loops == Settings().poses.loops
    assert knowing(Settings(), None) == Settings()
