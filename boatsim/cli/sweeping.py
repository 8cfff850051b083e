"""What `boatsim sweep` does: many runs into one folder, one table of them printed."""

from collections.abc import Sequence
from pathlib import Path

from boatsim.cli.exits import Exit, complain, say
from boatsim.cli.progress import counting
from boatsim.cli.show import printed
from boatsim.sweep.axes import axis
from boatsim.sweep.carry_out import swept
from boatsim.sweep.designs import Kind
from boatsim.sweep.draws import draw
from boatsim.sweep.plan import plan
from boatsim.sweep.results import Results
from boatsim.sweep.rows import once, tables

MOST = 60  # lines of a table on a terminal
REASONS = 5  # reasons of failed runs that are told


def sweep(
    scenarios: Sequence[str], vary: Sequence[str], drawn: Sequence[str], runs: int, kind: Kind, seed: int, out: Path,
    jobs: int | None, ray: str | None, norms: Sequence[str] = (),
) -> int:  # fmt: skip
    """Carry out a sweep, or go on with it, and print what its runs say together."""
    made = plan(scenarios, [axis(text) for text in vary], [draw(text) for text in drawn], runs, seed, kind)
    with counting() as report:
        found, whole = swept(made, out, jobs, ray, norms, report)
    _tell(found, out)
    if not whole:
        complain(f"interrupted after {len(found.numbers)} of {made.count} runs; the same command goes on")
        return Exit.INTERRUPTED
    return Exit.MET


def _tell(found: Results, out: Path) -> None:
    for table in tables(found):
        printed(table.title, table.head, once(table)[:MOST], table.left)
        if len(table.rows) > MOST:
            say([f"{len(table.rows) - MOST} lines more: report.html has them"])
    if failed := int(found.failed.sum()):
        say([f"{failed} of {len(found.numbers)} runs failed:"])
        say(f"  {count} times: {why}" for why, count in list(found.reasons.items())[:REASONS])
    say([f"written to {out}: sweep.parquet, report.html"])
