"""What `boatsim sweep` does: many runs into one folder, one table of them printed."""

from collections.abc import Sequence
from pathlib import Path

from boatsim.cli.exits import Exit, complain, say
from boatsim.cli.progress import counting
from boatsim.cli.show import printed
from boatsim.errors import shown
from boatsim.sweep import indices, summary
from boatsim.sweep.axes import axis
from boatsim.sweep.carry_out import swept
from boatsim.sweep.designs import Kind
from boatsim.sweep.draws import draw
from boatsim.sweep.keys import Value
from boatsim.sweep.plan import plan
from boatsim.sweep.results import Results

MOST = 60  # lines of a table on a terminal
REASONS = 5  # reasons of failed runs that are told


def sweep(
    scenarios: Sequence[str], vary: Sequence[str], drawn: Sequence[str], runs: int, kind: Kind, seed: int, out: Path,
    jobs: int | None, ray: str | None,
) -> int:  # fmt: skip
    """Carry out a sweep, or go on with it, and print what its runs say together."""
    made = plan(scenarios, [axis(text) for text in vary], [draw(text) for text in drawn], runs, seed, kind)
    with counting() as report:
        found, whole = swept(made, out, jobs, ray, report)
    _tell(found)
    if not whole:
        complain(f"interrupted after {len(found.numbers)} of {made.count} runs; the same command goes on")
        return Exit.INTERRUPTED
    return Exit.MET


def _tell(found: Results) -> None:
    names = summary.point_names(found)
    _print_spreads(names, summary.spreads(found), several=len(found.plan.drawn) > 1)
    _print_pairs([n for n in names if n != summary.CONTROLLER], summary.pairs(found))
    _print_indices(names, indices.indices(found))
    failed = int(found.failed.sum())
    if failed:
        say([f"{failed} of {len(found.numbers)} runs failed:"])
        say(f"  {count} times: {why}" for why, count in list(found.reasons.items())[:REASONS])


def _print_spreads(names: Sequence[str], found: Sequence[summary.Spread], several: bool) -> None:
    if not several:
        rows = [[*_cells(s.point), *_named(s.norm, s.unit), *_numbers(s.mean)] for s in found]
        _print("one run at each point", [*names, "norm", "value"], rows, len(names))
        return
    rows = [
        [*_cells(s.point), *_named(s.norm, s.unit), *_numbers(s.mean, s.p5, s.p50, s.p95), f"{s.reached} of {s.runs}"]
        for s in found
    ]
    _print("all runs", [*names, "norm", "mean", "p5", "p50", "p95", "reached"], rows, len(names))


def _print_pairs(names: Sequence[str], found: Sequence[summary.Pair]) -> None:
    for first, second in dict.fromkeys((p.first, p.second) for p in found):
        rows = [
            [*_cells(p.point), *_named(p.norm, p.unit), *_numbers(p.of_first, p.of_second), _with_spread(p),
             f"{100 * p.second_lower:.0f} %", f"{p.pairs}"]
            for p in found if (p.first, p.second) == (first, second)
        ]  # fmt: skip
        head = [*names, "norm", first, second, "difference", f"{second} lower", "pairs"]
        _print(f"{second} beside {first}, on the same draws", head, rows, len(names))


def _print_indices(names: Sequence[str], found: Sequence[indices.Index]) -> None:
    rows = [
        [*_cells(i.point), i.norm, i.quantity, f"{i.first:.2f} ({i.first_low:.2f} to {i.first_high:.2f})",
         f"{i.total:.2f} ({i.total_low:.2f} to {i.total_high:.2f})"]
        for i in found
    ]  # fmt: skip
    _print("Sobol indices", [*names, "norm", "quantity", "first order", "total"], rows, len(names) + 1)


def _print(title: str, head: Sequence[str], rows: Sequence[Sequence[str]], left: int) -> None:
    """A table, what repeats in its first columns told once; of a long one its first lines."""
    if rows:
        printed(title, head, _once(rows[:MOST], left), left + 1)
    if len(rows) > MOST:
        say([f"{len(rows) - MOST} lines more: report.html has them"])


def _once(rows: Sequence[Sequence[str]], left: int) -> list[list[str]]:
    found: list[list[str]] = []
    for number, row in enumerate(rows):
        same = number > 0 and rows[number - 1][:left] == row[:left]
        found.append([*([""] * left if same else row[:left]), *row[left:]])
    return found


def _cells(values: Sequence[Value]) -> list[str]:
    return [shown(f"{v:.6g}" if isinstance(v, float) else str(v)) for v in values]


def _named(norm: str, unit: str) -> list[str]:
    return [f"{norm} [{unit}]" if unit else norm]


def _numbers(*values: float) -> list[str]:
    return [f"{value:.4g}" for value in values]


def _with_spread(p: summary.Pair) -> str:
    return f"{p.difference:.3g} +- {p.sure:.2g}"
