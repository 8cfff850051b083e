"""Comparison of several runs: one table of their metrics, and compare.rrd with all boats."""

import os
import re
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import chain, compress
from pathlib import Path
from typing import TYPE_CHECKING

from boatsim.cli.exits import print_lines
from boatsim.cli.metric_table import explain_missing_values, format_value, print_rich_table
from boatsim.errors import escape_for_terminal
from boatsim.files import replace_file

if TYPE_CHECKING:
    from boatsim.simulate.evaluation import MetricEntry, RunEntry
    from boatsim.view.rerun_log import Boat

BEST, MISSED = "*", "!"  # marks behind a value


@dataclass(frozen=True)
class FinishedRun:
    """A finished run of a scenario, for a comparison of several runs.

    Attributes:
        scenario: Scenario as the user wrote it.
        controller: Controller in place of the scenario's own; None for that one.
        folder: Output folder.
        content: Content of norms.json.
    """

    scenario: str
    controller: str | None
    folder: Path
    content: "RunEntry"


def compare_runs(runs: Sequence[FinishedRun]) -> None:
    """Print one table with the metrics of several runs, and write compare.rrd.

    The file is written into the innermost common folder of the runs.

    Args:
        runs: Finished runs.
    """
    if not runs:
        return
    heads = _run_headings(runs)
    rows = _metric_rows(runs)
    _print_comparison(heads, runs, rows)
    folder = Path(os.path.commonpath([run.folder.absolute() for run in runs]))
    if len(runs) == 1:
        folder = folder.parent
    path = Path(os.path.relpath(folder)) / "compare.rrd"
    _write_compare_rrd(path, heads, runs, rows)
    print_lines(escape_for_terminal(f"written to {run.folder}") for run in runs)
    print_lines([escape_for_terminal(f"all boats: {path}")])


def _run_headings(runs: Sequence[FinishedRun]) -> list[tuple[str, ...]]:
    """Heading of each run: scenario, controller or both, those that differ between runs."""
    scenarios = [run.content["scenario"] for run in runs]
    short = [name.rpartition("/")[2] for name in scenarios]
    if len(set(short)) == len(set(scenarios)):
        scenarios = short
    controllers = [Path(run.content["controller"]).stem for run in runs]
    heads = list(zip(scenarios, controllers, strict=True))
    differs = [len(set(scenarios)) > 1, len(set(controllers)) > 1]
    if not any(differs):
        return list(heads)
    columns = compress([scenarios, controllers], differs)
    return list(zip(*columns, strict=True))


def _metric_rows(runs: Sequence[FinishedRun]) -> list[list[str]]:
    """Metric with unit, its kind, and a cell for each run; the lowest value is marked."""
    metrics: dict[tuple[str, str], None] = {}
    for run in runs:
        metrics |= dict.fromkeys((name, e["unit"]) for name, e in run.content["norms"].items())
    scenarios = [run.content["scenario"] for run in runs]
    rows = []
    for name, unit in metrics:
        entries: list[MetricEntry | None] = []
        kind = ""
        for run in runs:
            entry = run.content["norms"].get(name)
            if entry is not None and entry["unit"] == unit:
                entries.append(entry)
                kind = kind or entry["kind"]
            else:
                entries.append(None)
        best = _lowest_value_indices(scenarios, entries)
        cells = [_format_cell(entry, index in best) for index, entry in enumerate(entries)]
        if unit:
            name = f"{name} [{unit}]"
        rows.append([name, kind, *cells])
    return rows


def _lowest_value_indices(
    scenarios: Sequence[str], entries: Sequence["MetricEntry | None"]
) -> set[int]:
    """Indices of the runs with the lowest value, per scenario if one scenario was run repeatedly.

    Lower is better only for the size of an error, not for a mean, a time or a position.
    """
    kinds = {entry["kind"] for entry in entries if entry}
    if kinds & {"", "mean"}:
        return set()
    per_scenario = len(set(scenarios)) < len(scenarios)
    groups: dict[str, dict[int, float]] = {}
    for index, entry in enumerate(entries):
        if entry and entry["value"] is not None:
            key = scenarios[index] if per_scenario else ""
            group = groups.setdefault(key, {})
            group[index] = float(f"{entry['value']:.4g}")  # rounded like the printed value
    best: set[int] = set()
    for values in groups.values():
        lowest = min(values.values())
        if max(values.values()) > lowest:
            best.update(index for index, value in values.items() if value == lowest)
    return best


def _format_cell(entry: "MetricEntry | None", best: bool) -> str:
    if entry is None:
        return ""
    plain = format_value({**entry, "unit": ""})
    best_mark = BEST if best else " "
    missed_mark = MISSED if entry["ok"] is False else " "
    return f"{plain} {best_mark}{missed_mark}"


def _print_comparison(
    heads: Sequence[tuple[str, ...]], runs: Sequence[FinishedRun], rows: Sequence[Sequence[str]]
) -> None:
    from rich.console import Console
    from rich.table import Table
    from rich.text import Text

    table = Table(title=Text(escape_for_terminal(_table_title(runs))), pad_edge=False)
    for heading in ("metric", "kind"):
        table.add_column(heading, no_wrap=True)
    for head in heads:
        table.add_column(
            Text("\n".join(map(escape_for_terminal, head))), justify="right", no_wrap=True
        )
    for row in rows:
        texts = []
        for cell in row:
            style = "bold" if BEST in cell else ""
            texts.append(Text(escape_for_terminal(cell), style))
        table.add_row(*texts)
    print_rich_table(table)
    used = " ".join(chain.from_iterable(row[2:] for row in rows))
    marks = {BEST: "the best, where lower is better", MISSED: "outside its regression band"}
    legend = "; ".join(f"{mark} {words}" for mark, words in marks.items() if mark in used)
    entries = {}
    for head, run in zip(heads, runs, strict=True):
        for name, entry in run.content["norms"].items():
            entries[f"{'/'.join(head)}: {name}"] = entry
    console = Console()
    for line in filter(None, [legend, *explain_missing_values(entries)]):
        console.print(Text(escape_for_terminal(line)), soft_wrap=True)


def _table_title(runs: Sequence[FinishedRun]) -> str:
    """Scenario, controller and seed that all runs share."""
    shared = []
    for key, prefix in (("scenario", ""), ("controller", ""), ("seed", "seed ")):
        values = {str(run.content[key]) for run in runs}  # type: ignore[literal-required]
        if len(values) == 1:
            shared.append(f"{prefix}{values.pop()}")
    return ", ".join(shared) or "side by side"


def _write_compare_rrd(
    path: Path,
    heads: Sequence[tuple[str, ...]],
    runs: Sequence[FinishedRun],
    rows: Sequence[Sequence[str]],
) -> None:
    """Write compare.rrd from the recordings in the folders of the runs."""
    from boatsim.view.rerun_log import write_comparison_log

    joined = map("_".join, heads)
    names = _make_unique([re.sub(r"\W", "_", name) for name in joined])
    markdown = f"| metric | kind | {' | '.join(names)} |\n|:---|:---|" + "---:|" * len(names) + "\n"
    for row in rows:
        markdown += f"| {' | '.join(map(str.strip, row))} |\n"
    with replace_file(path) as temporary:
        write_comparison_log(
            temporary, dict(zip(names, _load_recorded_boats(runs), strict=True)), markdown
        )


def _make_unique(names: Sequence[str]) -> list[str]:
    """Names with a number appended to those that occur earlier in the list."""
    unique: list[str] = []
    for name in names:
        candidate = name
        number = 1
        while candidate in unique:
            number += 1
            candidate = f"{name}_{number}"
        unique.append(candidate)
    return unique


def _load_recorded_boats(runs: Sequence[FinishedRun]) -> "list[Boat]":
    """Recording and scene of each run; the goals of a scenario belong to its first run."""
    from boatsim.recordings.table import read
    from boatsim.simulate import world
    from boatsim.simulate.controllers import load_with_controller
    from boatsim.simulate.tank import Tank
    from boatsim.view import water
    from boatsim.view.rerun_log import Boat
    from boatsim.view.scene import scene_from_model

    logs = [read(run.folder / "recording.csv") for run in runs]
    names = [run.content["scenario"] for run in runs]
    boats: list[Boat] = []
    for index, (run, log) in enumerate(zip(runs, logs, strict=True)):
        scenario = load_with_controller(run.scenario, run.controller)
        vessel = scenario.vessel
        if scenario.file.tank:
            tank = Tank(**scenario.file.tank.model_dump())
            scene = scene_from_model(world.build_model(vessel, tank), vessel, tank)
        else:
            scene = water.comparison_scene(vessel, {"all": logs})
        goals = ""
        if names.index(names[index]) == index:
            goals = "goal"
            if len(set(names)) > 1:
                goals = f"goal of {scenario.name}"
        boats.append(Boat(log, scene, goals))
    return boats
