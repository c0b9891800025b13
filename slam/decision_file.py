"""The merge's decisions as GeoJSON: what was kept, thrown away and inferred, whose it was, and who decided."""

import json
from collections.abc import Iterable
from pathlib import Path

import numpy as np
import shapely
from shapely import LineString
from shapely.geometry import mapping

from backend.room_map import Decision, Verdict
from slam.room_file import RoomFileError, read_features

WORDS = {
    Verdict.KEPT: "kept",
    Verdict.CONTRADICTED: "contradicted",
    Verdict.SEEN_BEHIND: "seen behind",
    Verdict.OPEN: "open",
    Verdict.INFERRED: "inferred",
}
DECIMALS = 3  # millimetres


def decisions_text(decisions: Iterable[Decision]) -> str:
    """Decisions as a GeoJSON FeatureCollection: pieces of boundary in metres, views by number."""
    features = [
        {
            "type": "Feature",
            "properties": {
                "verdict": WORDS[made.verdict],
                "owners": made.owners.tolist(),
                "deciders": made.deciders.tolist(),
            },
            "geometry": mapping(LineString(np.round(made.piece, DECIMALS))),
        }
        for made in decisions
    ]
    return json.dumps({"type": "FeatureCollection", "features": features}) + "\n"


def read_decisions(path: Path) -> tuple[Decision, ...]:
    """The decisions that `decisions_text` wrote. Raises RoomFileError where the file holds anything else."""
    verdicts = {word: verdict for verdict, word in WORDS.items()}
    features = read_features(path)
    if odd := {piece.geom_type for piece, _ in features} - {"LineString"}:
        raise RoomFileError(f"{path}: a decision is about a line, not a {min(odd)}")
    try:
        return tuple(
            Decision(
                verdicts[says["verdict"]],
                shapely.get_coordinates(piece),
                np.array(says["owners"], dtype=np.int64),
                np.array(says["deciders"], dtype=np.int64),
            )
            for piece, says in features
        )
    except KeyError as missing:
        raise RoomFileError(f"{path}: a decision lacks or does not know {missing}") from missing
    except (TypeError, ValueError, AttributeError) as damage:
        raise RoomFileError(f"{path}: a decision's verdict or views cannot be read: {damage}") from damage
