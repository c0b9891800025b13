"""The logbook: an answer that was written down comes back to the last bit, and nobody is asked twice."""

import json

import numpy as np
import pytest

from frontend.registration import Alignment
from slam.logbook import Logbook
from slam.loops import Tried
from slam.tracking import Placed

RNG = np.random.default_rng(0)
PLACED = Placed(RNG.normal(size=3), RNG.normal(size=(3, 3)) * 1e-9, 0.1 + 0.2, None)
ALIGNMENT = Alignment(
    RNG.normal(size=3), RNG.normal(size=(3, 3)), np.empty((0, 2), np.int64), float(np.nextafter(1, 2)), 0.5, 0.0
)


def nobody() -> Placed:
    raise AssertionError("asked, though the answer is known")


def test_an_answer_is_asked_for_once_and_then_read() -> None:
    first = Logbook()
    assert first.answer(lambda: PLACED) is PLACED
    again = Logbook(first.lines).answer(nobody)
    assert again.pose.tobytes() == PLACED.pose.tobytes()
    assert again.covariance.tobytes() == PLACED.covariance.tobytes()
    assert (again.matched, again.refused) == (PLACED.matched, None)


def test_after_the_known_answers_new_ones_are_asked_for_and_appended() -> None:
    logbook = Logbook([json.dumps("too few faces")])
    assert logbook.answer(lambda: "") == "too few faces"
    assert logbook.answer(lambda: "new") == "new"
    assert len(logbook.lines) == 2


@pytest.mark.parametrize("answer", [(), (Tried(4, ALIGNMENT), Tried(7, "only 3 old faces look this way"))])
def test_several_answers_to_one_question_keep_their_kinds(answer: tuple[Tried, ...]) -> None:
    first = Logbook()
    first.answer(lambda: answer)
    again: tuple[Tried, ...] = Logbook(first.lines).answer(tuple)
    assert [tried.fixed for tried in again] == [tried.fixed for tried in answer]
    for old, new in zip(answer, again, strict=True):
        assert type(new.found) is type(old.found)
        if isinstance(new.found, Alignment) and isinstance(old.found, Alignment):
            assert new.found.information.tobytes() == old.found.information.tobytes()
            assert new.found.residual == old.found.residual
            assert new.found.pairs.shape == (0, 2)
            assert new.found.pairs.dtype == np.int64
