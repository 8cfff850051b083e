"""report.html of a sweep: its tables, and plots of every metric against what varied."""

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

from boatsim.files import replace_file
from boatsim.sweeps.keys import Value
from boatsim.sweeps.plots import controller_legend, group_by_controller, metric_plots
from boatsim.sweeps.results import Results
from boatsim.sweeps.sentence import Picture, headline_figure, result_sentence, varied_keys_sentence
from boatsim.sweeps.text_tables import blank_repeats, format_values, result_tables
from boatsim.view.html_page import render_template
from boatsim.view.page_blocks import Block, Figures, Heading, Items, Section, Table

NAME = "report.html"
TEMPLATE = Path(__file__).parent / "templates" / "sweep.html.j2"
MOST_VALUES = 6  # of an axis that are listed; of more the first two and the last


def write_report(results: Results, folder: Path) -> None:
    """Write report.html of a sweep, one page that loads nothing from elsewhere.

    Args:
        results: Results of a sweep.
        folder: Output folder.

    Raises:
        OSError: The file cannot be written.
    """
    picture = headline_figure(results)
    plots = _plot_sections(results, picture)
    sections = [_failure_section(results), *plots, *_table_sections(results)]
    sections = [section for section in sections if section.blocks]
    facts = _page_facts(results)
    page = render_template(
        TEMPLATE,
        title=_page_title(results),
        varied=varied_keys_sentence(results),
        came_out=result_sentence(results),
        picture=picture,
        facts=facts,
        sections=sections,
    )
    with replace_file(folder / NAME) as temporary:
        temporary.write_text(page, encoding="utf-8", errors="replace")


def _page_title(results: Results) -> str:
    names = results.plan.scenarios
    what = f"{len(names)} scenarios"
    if len(names) == 1:
        what = results.labels[names[0]]
    return f"{what}: {len(results.run_numbers)} runs"


def _page_facts(results: Results) -> list[tuple[str, str]]:
    """Label and text of the facts at the head of the page."""
    plan = results.plan
    axes = [
        f"{axis.target.name}: {', '.join(_shorten(axis.values, results.labels))}"
        for axis in plan.axes
    ]
    sampled = [f"{one.target.name}: {one}" for one in plan.sampled]
    done = len(results.run_numbers)
    failed = f"{int(results.failed_mask.sum())} of {done} runs"
    if done < plan.run_count:
        failed += f" (of {plan.run_count}: interrupted)"
    facts = {
        "Varied": "; ".join(axes),
        "Sampled": "; ".join(sampled),
        "Samples": f"{plan.runs}, {plan.design}",
        "Seed": str(plan.seed),
        "Failed": failed,
    }
    return [(label, text) for label, text in facts.items() if text]


def _shorten(values: Sequence[Value], labels: Mapping[str, str]) -> list[str]:
    texts = format_values(values, labels)
    if len(texts) <= MOST_VALUES:
        return texts
    return [texts[0], texts[1], "...", texts[-1]]


def _table_sections(results: Results) -> list[Section]:
    sections = []
    for table in result_tables(results):
        rows = [_with_minus_signs(row, table.left) for row in blank_repeats(table)]
        block = Table("", table.head, rows, tuple(range(1, table.left)))
        sections.append(Section(table.key, table.title, [block]))
    return sections


def _with_minus_signs(row: Sequence[str], first: int) -> list[str]:
    """Return a row of a table whose numbers, from a column on, have minus signs, not hyphens."""
    return [*row[:first], *(cell.replace("-", "\N{MINUS SIGN}") for cell in row[first:])]


def _failure_section(results: Results) -> Section:
    """Reasons of failed runs; a section without blocks if no run failed."""
    section = Section("failed", "Why runs failed", [])
    reasons = [(f"{count} runs", reason) for reason, count in results.failure_counts.items()]
    if reasons:
        section.blocks.append(Items(tuple(reasons)))
    return section


def _plot_sections(results: Results, picture: Picture | None) -> list[Section]:
    """Plots of the metrics, a section for each scenario, without the picture at the top."""
    first = picture.figure if picture else ""
    scenarios = results.plan.scenarios
    names = np.array([results.plan.points[number].scenario for number in results.point_numbers])
    sections = []
    for number, scenario in enumerate(scenarios, 1):
        title = results.labels[scenario] if len(scenarios) > 1 else "Metrics against what varied"
        section = Section(f"norms-{number}", title)
        rows = names == scenario
        legend = controller_legend(group_by_controller(results, rows))
        plots = {}
        for metric in results.displayed_metrics:
            drawn = [plot for plot in metric_plots(results, metric, rows) if plot != first]
            if drawn:
                plots[metric] = drawn
        section.blocks.extend(_plot_blocks(legend, plots))
        sections.append(section)
    return sections


def _plot_blocks(legend: str, plots: Mapping[str, list[str]]) -> list[Block]:
    """Return the plots by metric under headings, or side by side if each metric has only one."""
    if all(len(drawn) == 1 for drawn in plots.values()):
        single = [plot for drawn in plots.values() for plot in drawn]
        return [Figures(legend, single)] if single else []
    blocks: list[Block] = []
    for metric, drawn in plots.items():
        blocks += [Heading(metric), Figures(legend, drawn)]
    return blocks
