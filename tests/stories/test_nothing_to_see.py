"""Recordings that show nothing still end in a map, or in a sentence: never in a traceback."""

from pathlib import Path

import pytest
from typer.testing import CliRunner

from slam.cli import command_line

HEADER = "time,x,y,heading,range@-10,range@0,range@10\n"


@pytest.mark.parametrize(
    "rows",
    [
        "1,0,0,0,inf,inf,inf\n2,0,0,0,1,1,1\n",
        "1,0,0,0,1,1,1\n",
        "1,0,0,0,1,1,1\n2,5,0,0,inf,inf,1\n3,9,0,0,inf,inf,2\n",
    ],
)
def test_scans_without_a_wall_still_make_a_map(tmp_path: Path, rows: str) -> None:
    table = tmp_path / "scans.csv"
    table.write_text(HEADER + rows)
    result = CliRunner().invoke(command_line("merge"), ["merge", str(table), "--out", str(tmp_path / "map")])
    assert result.exit_code == 0, result.output
    assert (tmp_path / "map" / "map.geojson").exists()
