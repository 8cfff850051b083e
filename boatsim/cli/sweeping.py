"""What `boatsim sweep` and `boatsim diagnose --each` do: many tasks into one folder, one table of them printed."""

from collections.abc import Sequence
from pathlib import Path

from boatsim.cli.exits import Exit, complain, say
from boatsim.cli.progress import counting
from boatsim.cli.show import printed
from boatsim.sweeps import diagnoses
from boatsim.sweeps.axes import axis
from boatsim.sweeps.designs import Kind
from boatsim.sweeps.execute import backend, swept
from boatsim.sweeps.journal import Entry
from boatsim.sweeps.plan import plan
from boatsim.sweeps.results import Results
from boatsim.sweeps.sampled_keys import draw
from boatsim.sweeps.text_tables import once, tables

MOST = 60  # lines of a table on a terminal
REASONS = 5  # reasons of failed runs that are told


def sweep(
    scenarios: Sequence[str],
    vary: Sequence[str],
    drawn: Sequence[str],
    runs: int,
    kind: Kind,
    seed: int,
    out: Path,
    jobs: int | None,
    ray: str | None,
    norms: Sequence[str] = (),
) -> int:
    """Carry out a sweep, or go on with it, and print what its runs say together."""
    made = plan(
        scenarios, [axis(text) for text in vary], [draw(text) for text in drawn], runs, seed, kind
    )
    with counting() as report:
        found, whole = swept(made, out, jobs, ray, norms, report)
    _tell(found, out)
    if not whole:
        complain(
            f"interrupted after {len(found.numbers)} of {made.count} runs; the same command goes on"
        )
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


def diagnose_each(
    given: Sequence[Path], asked: diagnoses.Asked, out: Path, jobs: int | None, ray: str | None
) -> int:
    """Diagnose recordings one by one, or go on with it, and print what was found in each."""
    paths = diagnoses.recordings(given)
    with counting() as report:
        done = diagnoses.diagnosed(paths, asked, out, backend(jobs, ray), report)
    names = [str(path) for path in paths]
    rows = [
        [names[n], e.get("verdict", "failed"), _causes(e) if e["failure"] is None else e["failure"]]
        for n, e in done.entries.items()
    ]
    printed("Each recording by itself", ["recording", "verdict", "causes"], rows[:MOST], 3)
    if len(rows) > MOST:
        say([f"{len(rows) - MOST} more: {diagnoses.NAME} has them"])
    verdicts = [row[1] for row in rows]
    say([", ".join(f"{verdict} {verdicts.count(verdict)}" for verdict in dict.fromkeys(verdicts))])
    say([f"written to {out}: {diagnoses.NAME}, and a folder for each recording"])
    if not done.whole:
        complain(
            f"interrupted after {len(rows)} of {len(paths)} recordings; the same command goes on"
        )
        return Exit.INTERRUPTED
    return Exit.MET


def _causes(entry: Entry) -> str:
    """What was named, with the values found."""
    said = []
    for cause in entry["causes"]:
        own = {
            k.removeprefix(f"{cause}."): v
            for k, v in entry["values"].items()
            if k.startswith(f"{cause}.")
        }
        numbers = [
            f"{k} {v[0]:.4g} ± {own[f'{k} sd'][0]:.2g}" for k, v in own.items() if f"{k} sd" in own
        ]
        said.append(f"{cause}: {', '.join(numbers)}")
    return "; ".join(said)
