"""Comparison of published figures with boatsim's results, written to docs/papers.md.

python -m benchmarks.papers            check whether docs/papers.md is up to date; exit 1 if not
python -m benchmarks.papers --update   write it

Sources are docs/papers/*.toml and the metrics stored in tests/golden. A paper's file has `title`,
`source`, [[scenario]] tables (`name`, and keys that apply to all its published metrics) and [[row]]
tables. Boatsim's result is the stored `norm` of a `scenario`, a `figure` of a `module` here, or a
number `ours` that `command` prints.

The verdict is computed from the signed figures and the `tolerance` of the published one (or
`within`, as a share of it; otherwise that of the scenario's metric), or from the `span` that
represents published words. A tolerance is the scatter that the paper itself shows or allows: its
accuracy of measurement, repeated runs, or half of the last printed digit. Words alone are not
evaluated. `because` and `reason` explain a difference; they do not change the verdict. A row with
`comparison = true` prints what another law or program does; it does not attempt to reproduce the
published figure and gets no verdict.
"""

import argparse
import importlib
import sys
from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from math import isinf
from pathlib import Path
from typing import Any

from benchmarks import golden
from boatsim.errors import BadInput
from boatsim.files import read_toml
from boatsim.simulate import scenario
from boatsim.simulate.evaluation import MISSED, NO_TOLERANCE, REPRODUCED, within_tolerance

HOME = Path(__file__).parents[1]
OUT = HOME / "docs" / "papers.md"
WORDS = "in words"  # no numbers to compare
COMPARISON = "for comparison"  # of something else than was published
VERDICTS = (REPRODUCED, MISSED, NO_TOLERANCE, COMPARISON, WORDS)
BECAUSE = ("corrected", "can't be", "diagnosed")  # the last: a concealed case of the paper
KEYS = {
    "what",
    "unit",
    "published",
    "tolerance",
    "within",
    "span",
    "because",
    "reason",
    "comparison",
}
EXPLANATION = (
    "The deviation is that of boatsim's result in per cent of the published number. *Reproduced* and "
    "*not reproduced* say whether it lies within the margin, which is the scatter that the paper "
    "itself shows or allows: its accuracy of measurement, repeated runs, or half of the last "
    "printed digit. *For comparison* are results of another law or program than the published one."
)
OURS = ({"scenario", "norm"}, {"module", "figure"}, {"ours", "command"}, {"ours"}, set[str]())


@dataclass(frozen=True)
class PublishedFigure:
    """One published figure: a number, or a word if the paper gives no number."""

    what: str
    published: float | str
    ours: float | str | None
    unit: str
    verdict: str
    reason: str
    command: str
    tolerance: float | None = None  # of the published figure, in both directions
    # range of our result that the published words represent
    span: tuple[float, float] | None = None

    def line(self) -> str:
        """Return the row of the table."""
        cells = [_figure_text(self.published, self.unit), _figure_text(self.ours, self.unit)]
        return (
            f"| {self.what} | {' | '.join(cells)} | {self.deviation_text()} | {self.verdict} | "
            f"{self.reason} | {self.command} |"
        )

    def deviation_text(self) -> str:
        """Return the deviation of our result in per cent of the published number."""
        if isinstance(self.published, str) or isinstance(self.ours, str | None):
            return "-"
        if self.published == 0.0:
            return "-"
        return f"{100.0 * (self.ours - self.published) / abs(self.published):+.1f} %"


def read_figures(file: Path) -> Iterator[PublishedFigure]:
    """Return the figures of one paper.

    Raises:
        BadInput: for an unknown key or metric.
    """
    paper = read_toml(file)
    for table in paper.get("scenario", []):
        name = table["name"]
        for norm, value in _stored_metrics(name).items():
            if value["published"] is not None and norm not in table.get("but", []):
                given = {k: v for k, v in table.items() if k in KEYS} | table.get(norm, {})
                what = f"{table.get('what', name.rpartition('/')[2])}: {norm.replace('_', ' ')}"
                yield _read_figure({**given, "what": what, "scenario": name, "norm": norm}, file)
    for table in paper.get("row", []):
        yield _read_figure(table, file)


def _read_figure(table: Mapping[str, Any], file: Path) -> PublishedFigure:
    found = set(table) - KEYS
    if found not in OURS:
        raise BadInput(
            f"{file.name}: {table.get('what')}: has {sorted(found)}; allowed are "
            f"{[*map(sorted, OURS)]}"
        )
    ours = table.get("ours")
    published = table.get("published")
    unit = table.get("unit")
    command = ""
    if "norm" in table:
        values = _stored_metrics(table["scenario"])
        if table["norm"] not in values:
            raise BadInput(
                f"{file.name}: {table['scenario']} has no metric {table['norm']}; it has "
                f"{[*values]}"
            )
        pinned = values[table["norm"]]
        ours, command = pinned["today"], f"`boatsim run {table['scenario']}`"
        published = pinned["published"] if published is None else published
        unit = unit or pinned["unit"]
    elif "figure" in table:
        ours, command = _figures(table["module"])[table["figure"]], f"`python -m {table['module']}`"
    elif "command" in table:
        command = f"`{table['command']}`"
    if published is None:
        raise BadInput(f"{file.name}: {table['what']}: nothing published to compare with")
    tolerance = _tolerance(table, published)
    span = tuple(table["span"]) if "span" in table else None
    verdict = verdict_on(published, ours, tolerance, span)
    if table.get("comparison", False):
        verdict = COMPARISON
    because, reason = table.get("because", ""), table.get("reason", "")
    if because not in ("", *BECAUSE):
        raise BadInput(
            f"{file.name}: {table['what']}: because = {because!r}; allowed are {', '.join(BECAUSE)}"
        )
    if verdict == MISSED and not reason:
        raise BadInput(f"{file.name}: {table['what']}: {published} against {ours} needs a reason")
    told = "; ".join(
        part for part in (_margin(tolerance, span, unit or ""), because, reason) if part
    )
    return PublishedFigure(
        table["what"], published, ours, unit or "", verdict, told, command, tolerance, span
    )


def _tolerance(table: Mapping[str, Any], published: Any) -> float | None:
    """Return the tolerance of a published number: the row's own or the scenario metric's."""
    if isinstance(published, str):
        return None
    if "tolerance" in table:
        return float(table["tolerance"])
    if "within" in table:
        return float(table["within"] * abs(published))
    norm = _scenario_metrics(table["scenario"]).get(table["norm"]) if "norm" in table else None
    if norm is not None and norm.published == published:
        return norm.tolerance
    return None


def verdict_on(
    published: Any, ours: Any, tolerance: float | None, span: tuple[float, float] | None
) -> str:
    """Return the verdict that follows from the figures."""
    if isinstance(ours, str) or (isinstance(published, str) and span is None):
        return WORDS
    if span is not None:
        if ours is not None and span[0] <= ours <= span[1]:
            return REPRODUCED
        return MISSED
    if tolerance is None:
        return NO_TOLERANCE
    if ours is not None and within_tolerance(ours, published, tolerance):
        return REPRODUCED
    return MISSED


def _margin(tolerance: float | None, span: tuple[float, float] | None, unit: str) -> str:
    """Return the margin of a verdict in words."""
    if span is not None:
        if isinf(span[1]):
            return f"at least {_figure_text(span[0], unit)}"
        return f"{span[0]:.4g} to {_figure_text(span[1], unit)}"
    if tolerance is None:
        return ""
    return f"within {_figure_text(tolerance, unit)}"


@cache
def _scenario_metrics(name: str) -> Mapping[str, scenario.MetricTable]:
    return scenario.load(name).file.norms


@cache
def _stored_metrics(name: str) -> dict[str, Any]:
    if not (found := golden.stored_values(name)):
        raise BadInput(
            f"{name}: no stored metrics; python -m benchmarks.golden --update stores them"
        )
    return found


@cache
def _figures(module: str) -> dict[str, float]:
    found: dict[str, float] = importlib.import_module(module).figures()
    return found


def _figure_text(value: float | str | None, unit: str) -> str:
    if value is None:
        return "never reached"
    if isinstance(value, str):
        return value
    return f"{value:.4g} {unit}".strip()


def page_text() -> str:
    """Return the text of docs/papers.md."""
    parts = [
        "# Published figures and boatsim's results\n\nGenerated by `python -m "
        "benchmarks.papers --update`; do not edit."
    ]
    summary = [f"| paper | {' | '.join(VERDICTS)} |", f"| --- |{' --- |' * len(VERDICTS)}"]
    total: Counter[str] = Counter()
    for file in sorted((HOME / "docs" / "papers").glob("*.toml")):
        paper, found = read_toml(file), list(read_figures(file))
        counts = Counter(r.verdict for r in found)
        total.update(counts)
        summary.append(_summary_row(paper["title"], counts))
        head = (
            "| figure | published | boatsim | deviation | verdict | margin, reason | from |\n"
            "| --- | --- | --- | --- | --- | --- | --- |"
        )
        parts.append(
            f"## {paper['title']}\n\n{paper['source']}\n\n{head}\n"
            + "\n".join(r.line() for r in found)
        )
    summary.append(_summary_row("all", total))
    parts.insert(1, ", ".join(f"{total[v]} {v}" for v in VERDICTS) + ".")
    parts.insert(2, EXPLANATION)
    parts.insert(3, "\n".join(summary))
    return "\n\n".join(parts) + "\n"


def _summary_row(title: str, counts: Mapping[str, int]) -> str:
    """Return one paper's row of the summary."""
    return f"| {title} | {' | '.join(str(counts[v]) for v in VERDICTS)} |"


def main(arguments: list[str] | None = None) -> int:
    """Return 0 if the page is up to date or written, 1 if it is out of date."""
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks.papers",
        description="Compare published figures with boatsim's results.",
    )
    parser.add_argument("--update", action="store_true", help="write docs/papers.md")
    given = parser.parse_args(arguments)
    text = page_text()
    if given.update:
        OUT.write_text(text, encoding="utf-8")
    same = OUT.is_file() and OUT.read_text(encoding="utf-8") == text
    print(text.splitlines()[4])
    print(
        "docs/papers.md is up to date"
        if same
        else "docs/papers.md is out of date: --update writes it"
    )
    return int(not same)


if __name__ == "__main__":
    sys.exit(main())
