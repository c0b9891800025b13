import json
from pathlib import Path

import pytest

from slam.simulation.plans import PLANS

SHIPPED = Path(__file__).parents[3] / "datasets" / "plans"


@pytest.mark.parametrize("name", sorted(PLANS))
def test_the_shipped_plan_is_the_one_that_is_drawn_here(name: str) -> None:
    assert json.loads((SHIPPED / f"{name}.geojson").read_text()) == json.loads(json.dumps(PLANS[name]()))


def test_every_shipped_plan_is_drawn_here() -> None:
    assert {path.stem for path in SHIPPED.iterdir()} == set(PLANS)
