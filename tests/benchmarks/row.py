"""One row of the front end's table."""

from typing import Any

Row = dict[str, Any]


def row(name: str, values: dict[str, Any], unit: str, better: str, target: float | None, note: str) -> Row:
    """One row of the table: ours, and the others as peers."""
    peers = {peer: float(value) for peer, value in values.items() if peer != "ours"}
    return {
        "part": "frontend", "name": name, "value": float(values["ours"]), "unit": unit, "better": better,
        "target": target, "peers": peers, "runs": 1, "note": note,
    }  # fmt: skip
