"""`roomsketch doctor`: what is installed, and the remedy for what is missing."""

from typing import Annotated

import typer
from rich.table import Table

from slam import doctor as check_up
from slam.commands.console import out


def doctor(
    install: Annotated[bool, typer.Option(help="Fetch open3d's system libraries by apt, where this user may.")] = False,
) -> None:
    """Check the installation and name the remedy for whatever is missing."""
    if install:
        check_up.install_system_libraries(check_up.run_quietly)
    findings = check_up.examine()
    table = Table("", "part", "finding", box=None)
    for finding in findings:
        mark = "ok" if finding.in_order else "missing" if finding.needed else "without"
        table.add_row(mark, finding.subject, finding.says)
    out.print(table)
    if any(finding.needed and not finding.in_order for finding in findings):
        raise typer.Exit(1)
