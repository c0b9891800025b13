"""Passages within two hundredths of the robot's width: no path through a wall, no proof against a way that is there."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from planners import configuration_space, generalized_cones
from planners.certify import certify
from planners.configuration_space import ConfigurationSpaceSettings
from planners.generalized_cones import ConesSettings
from planners.visibility import SMOOTHED
from tests.planners.tight_worlds import PASSAGES, Passage, Tight, tight

MOST = 0.02  # of the robot's width
QUICK = ConfigurationSpaceSettings(most_boxes=8_000, smaller_robots=0, shortcuts=20)
SEEDS = st.integers(0, 100_000)


def asked(seed: int, passage: Passage) -> Tight:
    return tight(np.random.default_rng(seed), passage, MOST)


@pytest.mark.parametrize("passage", PASSAGES)
@settings(deadline=None, max_examples=12)
@given(seed=SEEDS)
def test_what_configuration_space_says_of_a_tight_passage_is_true(passage: Passage, seed: int) -> None:
    question = asked(seed, passage)
    answer = configuration_space.plan(question.world, question.robot, question.start, question.goal, QUICK)
    if answer.kind == "path":
        assert question.spare > 0
        assert answer.path is not None
        assert certify(answer.path.poses, question.robot, question.world.free)
    if answer.kind == "no path":
        assert question.spare < 0
    if question.robot.is_disc:
        assert answer.kind != "undecided" or abs(question.spare) < 1.2 * SMOOTHED, (
            "arcs in chords give away a little more"
        )


@pytest.mark.parametrize("passage", PASSAGES)
@settings(deadline=None, max_examples=12)
@given(seed=SEEDS)
def test_cones_never_lead_through_a_passage_that_is_too_tight(passage: Passage, seed: int) -> None:
    question = asked(seed, passage)
    answer = generalized_cones.plan(question.world, question.robot, question.start, question.goal, ConesSettings())
    if answer.path is not None:
        assert question.spare > 0
        assert certify(answer.path.poses, question.robot, question.world.free)
