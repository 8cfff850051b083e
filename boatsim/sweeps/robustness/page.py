"""report.html of a robustness benchmark: limits, errors and a figure of each disturbance."""

from math import isinf, isnan
from pathlib import Path

import numpy as np

from boatsim.files import replace_file
from boatsim.sweeps.plots import STYLES
from boatsim.sweeps.robustness.benchmark import Robustness
from boatsim.sweeps.robustness.drawn_boats import describe_draws
from boatsim.sweeps.robustness.survival import REQUIRED, Ladder
from boatsim.sweeps.robustness.tables import (
    disturbance_in_words,
    error_in_print,
    notes,
    result_tables,
    signal_in_words,
    surface_table,
)
from boatsim.view.formatting import capitalize, join_words, name_in_words
from boatsim.view.html_page import render_template
from boatsim.view.page_blocks import Figures, Items, Section, Table, Text
from boatsim.view.svg_plots import Line, Panel, figure, legend

NAME = "report.html"
TEMPLATE = Path(__file__).parents[1] / "templates" / "robustness.html.j2"
# Largest error of a figure in bars: above it the boats are lost, and a larger axis would hide the
# values below the bar
HIGHEST = 3.0


def write_page(found: Robustness, folder: Path) -> None:
    """Write report.html of a robustness benchmark, one page that loads nothing from elsewhere.

    Args:
        found: Result of a benchmark.
        folder: Output folder.

    Raises:
        OSError: The file cannot be written.
    """
    page = render_template(
        TEMPLATE,
        title=f"Robustness of {join_words(found.controllers)}",
        lead=lead_sentence(found),
        facts=_facts(found),
        sections=_sections(found),
    )
    with replace_file(folder / NAME) as temporary:
        temporary.write_text(page, encoding="utf-8", errors="replace")


def lead_sentence(found: Robustness) -> str:
    """Return in one sentence what the first disturbance shows, with the share of survivors.

    Args:
        found: Result of a benchmark.
    """
    parts = []
    for ladder in found.ladders:
        if ladder.disturbance == found.disturbances[0]:
            limit = "no value"
            if not isnan(ladder.largest_survived):
                limit = f"{ladder.largest_survived:g} {ladder.unit}".rstrip()
            parts.append(f"{ladder.controller} {limit}")
    words = name_in_words(found.disturbances[0])
    return f"Largest {words} that 95 % of {len(found.boats)} boats survive: {join_words(parts)}."


def _facts(found: Robustness) -> list[tuple[str, str]]:
    load = join_words(found.vessel.load)
    facts = [("Vessel", found.vessel.name), ("Load", load), ("Boats", str(len(found.boats)))]
    facts.append(("Seed", str(found.boats.seed)))
    return [(label, text) for label, text in facts if text]


def _sections(found: Robustness) -> list[Section]:
    sections = []
    for table in result_tables(found):
        words = tuple(range(1, table.left))
        sections.append(Section(table.key, table.title, [Table("", table.head, table.rows, words)]))
    criterion = Items(tuple(("", line) for line in notes(found)))
    sections.append(Section("criterion", "Criterion of survival", [criterion]))
    for name in found.disturbances:
        table = surface_table(found, name)
        block = Table("All values", table.head, table.rows, folded=True)
        looks = dict(zip(STYLES, found.controllers, strict=False))
        figures = Figures(legend(looks), _figures(found, name))
        title = capitalize(name_in_words(name))
        meaning = Text(f"{capitalize(disturbance_in_words(name))}. Dashed: 95 % of the boats.")
        sections.append(Section(name, title, [meaning, figures, block]))
    sections.append(
        Section(
            "draws",
            "Drawn boats: 5 to 95 % of each coefficient",
            [Items(tuple(describe_draws(found.boats)))],
        )
    )
    return sections


def _figures(found: Robustness, disturbance: str) -> list[str]:
    """Share of survivors, and median and 95 % quantile of each judged error, over the value."""
    ladders = []
    for name in found.controllers[: len(STYLES)]:
        ladders.append(found.ladder(name, disturbance))
    values = [point.value for ladder in ladders for point in ladder.points]
    ends = (min(values), max(values))
    if ends[0] == ends[1]:
        return []
    label = f"{name_in_words(disturbance)} [{ladders[0].unit}]".replace(" []", "")
    panels = [_survivor_panel(ladders, ends, label)]
    for number, bar in enumerate(found.bars):
        if not isinf(bar):
            panels.append(_error_panel(found, ladders, number, ends, label))
    return [figure([panel], panel.title) for panel in panels]


def _survivor_panel(ladders: list[Ladder], ends: tuple[float, float], label: str) -> Panel:
    lines = []
    for look, ladder in zip(STYLES, ladders, strict=False):
        x, shares = [], []
        for point in ladder.points:
            x.append(point.value)
            shares.append(100.0 * point.share)
        lines.append(Line(look, np.array(x), np.array(shares), ladder.controller))
    required = np.full(2, 100.0 * REQUIRED)
    lines.append(Line("zero goal", np.array(ends), required, "required"))
    return Panel("survivors [%]", tuple(lines), ends, (0.0, 105.0), label, shape=2.0)


def _error_panel(
    found: Robustness, ladders: list[Ladder], number: int, ends: tuple[float, float], label: str
) -> Panel:
    signal = found.signals[number]
    bar = error_in_print(signal.bar, signal)
    lines = []
    for look, ladder in zip(STYLES, ladders, strict=False):
        x, medians, highs = [], [], []
        for point in ladder.points:
            median, high, _ = point.error_quantiles(number)
            x.append(point.value)
            medians.append(error_in_print(median, signal))
            highs.append(error_in_print(high, signal))
        at = np.array(x)
        lines.append(Line(look, at, np.array(medians), f"{ladder.controller} median"))
        lines.append(Line(f"{look} end", at, np.array(highs), f"{ladder.controller} 95 %"))
    lines.append(Line("zero goal", np.array(ends), np.full(2, bar), "largest of a survivor"))
    title = f"rms error of {signal_in_words(signal)}"
    return Panel(title, tuple(lines), ends, (0.0, HIGHEST * bar), label, shape=2.0)
