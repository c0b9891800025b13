"""TOML files as frozen dataclasses: every key is known and of its type, or a sentence says which is not."""

import tomllib
from dataclasses import MISSING, fields, is_dataclass
from pathlib import Path
from types import NoneType, UnionType
from typing import Any, TypeVar, get_args, get_origin, get_type_hints

Table = TypeVar("Table")


class TomlFileError(Exception):
    """A TOML file that cannot be read as what it should say; the message names file, key and known keys."""


def load(path: Path, shape: type[Table]) -> Table:
    """The file as an instance of the dataclass `shape`; keys that are absent take its defaults."""
    try:
        content = tomllib.loads(path.read_text(encoding="utf-8-sig"))
    except OSError as reason:
        raise TomlFileError(f"{path} cannot be read: {reason.strerror or reason}") from reason
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as damage:
        raise TomlFileError(f"{path} is not TOML: {damage}") from damage
    try:
        return _table(content, shape, "")
    except TomlFileError as damage:
        raise TomlFileError(f"{path.name}: {damage}") from damage


def dumps(table: object) -> str:
    """The dataclass instance as TOML that `load` reads back; fields that are None are left out."""
    lines: list[str] = []
    _write(table, "", lines)
    return "\n".join(lines).lstrip("\n") + "\n"


def _table(content: dict[str, Any], shape: type[Table], prefix: str) -> Table:
    hints = get_type_hints(shape)
    for key in content:
        if key not in hints:
            raise TomlFileError(f"unknown key {prefix}{key}; known are {', '.join(sorted(hints))}")
    for field in fields(shape):  # type: ignore[arg-type]
        if field.name not in content and field.default is MISSING and field.default_factory is MISSING:
            raise TomlFileError(f"{prefix}{field.name} is missing")
    return shape(**{key: _value(value, hints[key], prefix + key) for key, value in content.items()})


def _value(value: Any, hint: Any, key: str) -> Any:
    if get_origin(hint) is UnionType:
        hint = next(choice for choice in get_args(hint) if choice is not NoneType)
    if is_dataclass(hint) and isinstance(value, dict):
        return _table(value, hint, f"{key}.")  # type: ignore[arg-type]
    if get_origin(hint) is tuple and isinstance(value, list):
        return _row(value, get_args(hint), key)
    if hint is float and isinstance(value, int) and not isinstance(value, bool):
        return float(value)
    if type(value) is not hint:
        raise TomlFileError(f"{key} = {value!r} should be {_in_words(hint)}")
    return value


def _row(values: list[Any], hints: tuple[Any, ...], key: str) -> tuple[Any, ...]:
    if hints[-1] is Ellipsis:
        hints = hints[:1] * len(values)
    if len(values) != len(hints):
        raise TomlFileError(f"{key} has {len(values)} values, but needs {len(hints)}")
    return tuple(_value(value, hint, f"{key}[{i}]") for i, (value, hint) in enumerate(zip(values, hints, strict=True)))


def _in_words(hint: Any) -> str:
    words = {float: "a number", int: "a whole number", bool: "true or false", str: "a text in quotes"}
    return words.get(hint, "a list" if get_origin(hint) is tuple else "a table")


def _write(table: Any, name: str, lines: list[str]) -> None:
    hints = get_type_hints(type(table))
    values = {field.name: getattr(table, field.name) for field in fields(table)}
    values = {key: float(value) if hints[key] is float else value for key, value in values.items()}
    plain = {key: value for key, value in values.items() if value is not None and not is_dataclass(value)}
    if name and plain:
        lines += ["", f"[{name}]"]
    lines += [f"{key} = {_literal(value)}" for key, value in plain.items()]
    for key, value in values.items():
        if is_dataclass(value):
            _write(value, f"{name}.{key}" if name else key, lines)


def _literal(value: Any) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, tuple):
        return f"[{', '.join(map(_literal, value))}]"
    if isinstance(value, str):
        escaped = value.replace("\\", "\\\\").replace('"', '\\"').replace("\n", "\\n")
        return f'"{escaped}"'
    return repr(value)
