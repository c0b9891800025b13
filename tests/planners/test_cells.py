import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from planners.cells import EMPTY, FULL, Walls, label_box
from planners.certify import certify
from planners.outline import outline_of
from tests.planners.random_worlds import random_robot, random_world


@settings(deadline=None, max_examples=20)
@given(st.integers(0, 10_000))
def test_empty_boxes_are_free_and_full_boxes_collide_wherever_they_are_sampled(seed: int) -> None:
    rng = np.random.default_rng(seed)
    world, robot = random_world(rng), random_robot(rng)
    if robot.is_disc:
        return
    outline, walls = outline_of(robot), Walls(world.edges.reshape(-1, 4).copy(), world.grid)
    every = np.arange(len(walls.ends), dtype=np.int32)
    for _ in range(20):
        box = np.concatenate(
            [rng.uniform(0, 100, 2), rng.uniform(0, 6, 1), rng.uniform(0.01, 2, 2), rng.uniform(0.01, 0.6, 1)]
        )
        label, _, _ = label_box(outline, outline, walls, box, every, np.empty_like(every))
        poses = box[:3] + box[3:] * np.vstack([rng.uniform(-1, 1, (12, 3)), [[1, 1, 1], [-1, -1, -1], [1, -1, 0]]])
        free = [bool(certify(pose[None], robot, world.free)) for pose in poses]
        assert label != EMPTY or all(free)
        assert label != FULL or not any(free)
