"""TOML files as dataclasses: written ones read back the same, and whatever is wrong is named."""

from dataclasses import dataclass, field
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from slam.toml_file import TomlFileError, dumps, load


@dataclass(frozen=True)
class Wheel:
    """A table inside."""

    radius: float = 0.1
    spokes: int = 3
    marks: tuple[float, ...] = (1.0, 2.0)


@dataclass(frozen=True)
class Cart:
    """A table with one inside."""

    name: str
    loaded: bool = False
    weight: float | None = None
    wheel: Wheel = field(default_factory=Wheel)


carts = st.builds(
    Cart,
    name=st.text(st.characters(min_codepoint=32, exclude_categories=["Cs", "Cc"])),
    loaded=st.booleans(),
    weight=st.none() | st.floats(allow_nan=False),
    wheel=st.builds(Wheel, st.floats(0, 1), st.integers(0, 9), st.lists(st.floats(0, 1), max_size=3).map(tuple)),
)


@given(carts)
def test_what_was_written_reads_back_the_same(tmp_path_factory: pytest.TempPathFactory, cart: Cart) -> None:
    path = tmp_path_factory.mktemp("cart") / "cart.toml"
    path.write_text(dumps(cart), encoding="utf-8")
    assert load(path, Cart) == cart


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("", "cart.toml: name is missing"),
        ("name = 'a'\nwheels = 4", "cart.toml: unknown key wheels; known are loaded, name, weight, wheel"),
        ("name = 'a'\n[wheel]\nspoke = 4", "cart.toml: unknown key wheel.spoke; known are marks, radius, spokes"),
        ("name = 3", "cart.toml: name = 3 should be a text in quotes"),
        ("name = 'a'\nloaded = 1", "loaded = 1 should be true or false"),
        ("name = 'a'\n[wheel]\nspokes = 1.5", "wheel.spokes = 1.5 should be a whole number"),
        ("name = 'a'\n[wheel]\nmarks = 1.5", "wheel.marks = 1.5 should be a list"),
        ("name = ", "is not TOML"),
    ],
)
def test_what_is_wrong_is_named(tmp_path: Path, text: str, says: str) -> None:
    path = tmp_path / "cart.toml"
    path.write_text(text)
    with pytest.raises(TomlFileError) as raised:
        load(path, Cart)
    assert says in str(raised.value)
