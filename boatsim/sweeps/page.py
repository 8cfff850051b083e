"""The report of a sweep: one page with its tables, and every norm against what varied."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from boatsim.diagnosis.report.blocks import Figures, Heading, Items, Section, Table
from boatsim.diagnosis.report.html_page import rendered
from boatsim.files import replacing
from boatsim.sweeps.plots import groups, legend_of, pictures
from boatsim.sweeps.results import Results
from boatsim.sweeps.text_tables import once, tables

NAME = "report.html"
TEMPLATE = Path(__file__).parent / "templates" / "sweep.html.j2"


def write(results: Results, folder: Path) -> None:
    """report.html (one page, nothing fetched). Raises OSError."""
    made = [section for section in _sections(results) if section.blocks]
    with replacing(folder / NAME) as temporary:
        temporary.write_text(
            rendered(TEMPLATE, title=_title(results), facts=_facts(results), sections=made),
            encoding="utf-8",
        )


def _title(results: Results) -> str:
    names = results.plan.scenarios
    what = names[0] if len(names) == 1 else f"{len(names)} scenarios"
    return f"{what}: {len(results.numbers)} runs"


def _facts(results: Results) -> list[tuple[str, str]]:
    plan = results.plan
    axes = [f"{axis.target.name}: {', '.join(_short(axis.values))}" for axis in plan.axes]
    draws = [f"{draw.target.name}: {draw}" for draw in plan.draws]
    found = [
        ("Varied", "; ".join(axes)),
        ("Drawn", "; ".join(draws)),
        ("Draws", f"{plan.runs}, {plan.kind}"),
    ]
    done = "" if len(results.numbers) == plan.count else f" (of {plan.count}: interrupted)"
    failed = f"{int(results.failed.sum())} of {len(results.numbers)} runs{done}"
    return [
        (name, words)
        for name, words in (*found, ("Seed", str(plan.seed)), ("Failed", failed))
        if words
    ]


def _short(values: Sequence[object]) -> list[str]:
    said = [f"{v:.6g}" if isinstance(v, float) else str(v) for v in values]
    return said if len(said) <= 6 else [said[0], said[1], "...", said[-1]]


def _sections(results: Results) -> list[Section]:
    made = [
        Section(t.key, t.title, [Table("", t.head, once(t), tuple(range(t.left)))])
        for t in tables(results)
    ]
    failed = [(f"{count} runs", why) for why, count in results.reasons.items()]
    made.append(Section("failed", "Why runs failed", [Items(tuple(failed))] if failed else []))
    several = len(results.plan.scenarios) > 1
    names = np.array([results.plan.points[number].scenario for number in results.point])
    for number, scenario in enumerate(results.plan.scenarios):
        section = Section(
            f"norms-{number + 1}", scenario if several else "Norms against what varied"
        )
        among = names == scenario
        for norm in results.told:
            if drawn := pictures(results, norm, among):
                section.blocks.extend(
                    [Heading(norm), Figures(legend_of(groups(results, among)), drawn)]
                )
        made.append(section)
    return made
