"""`roomsketch convert`: a map for other programs, or a recording as the plain folder this one reads."""

from pathlib import Path
from typing import Annotated

import typer

from slam.commands.console import err, out
from slam.exports.formats import export, export_named
from slam.exports.product import ExportError, load_product
from slam.recording_files import FACTS, readings_csv, readings_name, recording_toml, write_recording
from slam.recordings import open_recording
from slam.whole_output import RESULT_MARK


def convert(
    source: Annotated[Path, typer.Argument(help="The folder that merge wrote, a map.geojson, or a recording.")],
    to: Annotated[
        Path,
        typer.Argument(
            help="FILE.geojson, .rectangles.geojson, .svg, .dxf, .pgm, .gpkg, .glb, .ply, .tum or .g2o; "
            "a folder for a recording."
        ),
    ],
    format_name: Annotated[str | None, typer.Option("--format", help="The recording's format, if not guessed.")] = None,
) -> None:
    """Turn a map into another format, or a recording into a recording folder."""
    if source.suffix == ".geojson" or (source / RESULT_MARK).exists():
        out.print(f"{', '.join(map(str, export(load_product(source), to)))}")
        return
    recording = open_recording(source, format_name)
    if export_named(to):
        remedy = f"first `roomsketch merge {source} --out run`, then `roomsketch convert run {to}`"
        raise ExportError(f"{to.name}: {source} is a recording, and has no map to export yet; {remedy}")
    about = {"name": recording.name, "description": f"converted from {source.name}"}
    files = {
        FACTS: recording_toml(about, recording.odometry_noise, recording.scans),
        readings_name(len(recording.scans)): readings_csv(recording.scans),
    }
    write_recording(to, files)
    for damaged in recording.damaged:
        err.print(f"left out or mended: {damaged}")
    out.print(f"{to}: {', '.join(files)}, {len(recording.scans)} scans")
