"""The tables of a sweep in words, as the command line prints them and its page shows them."""

from collections.abc import Sequence
from dataclasses import dataclass

from boatsim.sweeps import indices, summary
from boatsim.sweeps.keys import Value
from boatsim.sweeps.results import Results


@dataclass(frozen=True)
class Rows:
    """A table: its first `left` columns are words."""

    key: str
    title: str
    head: list[str]
    rows: list[list[str]]
    left: int


def tables(found: Results) -> list[Rows]:
    """Spread of the norms, controllers in pairs, Sobol indices: those of them that there are."""
    names = found.plan.differ
    rest = [name for name in names if name != summary.CONTROLLER]
    made = [
        _spreads(names, found),
        *_pairs(rest, summary.pairs(found)),
        _indices(names, indices.indices(found)),
    ]
    return [table for table in made if table.rows]


def _spreads(names: Sequence[str], found: Results) -> Rows:
    spreads = summary.spreads(found)
    if len(found.plan.drawn) == 1:
        rows = [[*_cells(s.point), _named(s.norm, s.unit), number(s.mean)] for s in spreads]
        return Rows(
            "runs", "One run at each point", [*names, "norm", "value"], rows, len(names) + 1
        )
    rows = [
        [
            *_cells(s.point),
            _named(s.norm, s.unit),
            *map(number, (s.mean, s.p5, s.p50, s.p95)),
            f"{s.reached} of {s.runs}",
        ]
        for s in spreads
    ]
    return Rows(
        "runs",
        "All runs",
        [*names, "norm", "mean", "p5", "p50", "p95", "reached"],
        rows,
        len(names) + 1,
    )


def _pairs(names: Sequence[str], found: Sequence[summary.Pair]) -> list[Rows]:
    made: list[Rows] = []
    for first, second in dict.fromkeys((p.first, p.second) for p in found):
        rows = [
            [
                *_cells(p.point),
                _named(p.norm, p.unit),
                number(p.of_first),
                number(p.of_second),
                f"{p.difference:+.3g} ± {p.sure:.2g}",
                f"{100 * p.first_lower:.0f} %",
                f"{100 * p.second_lower:.0f} %",
                str(p.pairs),
            ]
            for p in found
            if (p.first, p.second) == (first, second)
        ]
        head = [
            *names,
            "norm",
            first,
            second,
            "difference",
            f"{first} lower",
            f"{second} lower",
            "pairs",
        ]
        title = f"{second} beside {first}, on the same draws"
        made.append(Rows(f"pairs-{len(made) + 1}", title, head, rows, len(names) + 1))
    return made


def _indices(names: Sequence[str], found: Sequence[indices.Index]) -> Rows:
    rows = [
        [
            *_cells(i.point),
            i.norm,
            i.quantity,
            f"{i.first:.2f} ({i.first_low:.2f} to {i.first_high:.2f})",
            f"{i.total:.2f} ({i.total_low:.2f} to {i.total_high:.2f})",
        ]
        for i in found
    ]
    head = [*names, "norm", "quantity", "first order", "total"]
    return Rows("sobol", "Sobol indices (95 % interval)", head, rows, len(names) + 2)


def once(table: Rows) -> list[list[str]]:
    """Its rows, what repeats in the columns of words told once."""
    left, found = table.left - 1, list[list[str]]()
    for number, row in enumerate(table.rows):
        same = number > 0 and table.rows[number - 1][:left] == row[:left]
        found.append([*([""] * left if same else row[:left]), *row[left:]])
    return found


def number(value: float) -> str:
    """As all tables print it."""
    return f"{value:.4g}"


def _cells(values: Sequence[Value]) -> list[str]:
    return [f"{v:.6g}" if isinstance(v, float) else str(v) for v in values]


def _named(norm: str, unit: str) -> str:
    return f"{norm} [{unit}]" if unit else norm
