"""`roomsketch score`: how good a result is against truth."""

import json
from pathlib import Path
from typing import Annotated, Any

import typer

from slam.commands.console import err, print_values
from slam.figures.gallery import draw_errors
from slam.html_report import write_page
from slam.result_folder import MAP, read_report, write_report
from slam.room_file import read_room
from slam.scores.results import map_scores, map_truth, pose_scores, relation_scores


def score(
    result: Annotated[Path, typer.Argument(help="The folder that merge wrote.")],
    truth: Annotated[Path | None, typer.Option(help="GeoJSON plan in the frame of the first pose.")] = None,
    poses: Annotated[Path | None, typer.Option(help="True poses: TUM, or a camera's P lines.")] = None,
    relations: Annotated[
        Path | None, typer.Option(help="Relative poses checked by hand: t1 t2 x y z roll pitch yaw.")
    ] = None,
    as_json: Annotated[bool, typer.Option("--json", help="Print JSON instead of a table.")] = False,
) -> None:
    """Score a map and its trajectory; the scores are also kept in the report."""
    report = read_report(result)
    if truth is poses is relations is None:
        err.print("nothing to score against: name a --truth, --poses or --relations")
    scores: dict[str, Any] = {"counts": report["counts"]}
    if truth is not None:
        known = map_truth(result, truth, poses)
        scores |= map_scores(result, known)
        picture = draw_errors(read_room(result / MAP), known, result / "figures")
        err.print(f"drawn: {picture}")
    if poses is not None:
        scores["poses"] = pose_scores(result, poses)
    if relations is not None:
        scores["relations"] = relation_scores(result, relations)
    report["scores"] |= {name: value for name, value in scores.items() if name != "counts"}
    write_report(result, report)
    write_page(result)
    if as_json:
        print(json.dumps(read_report(result)["scores"] | {"counts": report["counts"]}))
    else:
        print_values(scores)
