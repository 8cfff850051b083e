"""Several runs side by side: one table of their norms, and one log with all boats, beside the folders of the runs."""

import os
import re
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import chain, count
from pathlib import Path
from typing import TYPE_CHECKING

from boatsim.cli.show import reasons, value
from boatsim.errors import printable
from boatsim.files import replacing

if TYPE_CHECKING:
    from boatsim.simulate.evaluation import MetricEntry, RunEntry
    from boatsim.view.rerun_log import Boat

UNCUT = 10_000  # [columns] wider than any table
BEST, MISSED = "*", "!"  # behind a value


@dataclass(frozen=True)
class Done:
    """A run that is over."""

    given: str  # scenario, as the user wrote it
    controller: str | None  # in place of its own
    folder: Path
    content: "RunEntry"  # of norms.json


def compare(runs: Sequence[Done]) -> None:
    """Print the table and write compare.rrd into the innermost folder that holds those of the runs."""
    if not runs:
        return
    heads = _heads(runs)
    _print(heads, runs)
    folder = Path(os.path.commonpath([run.folder.absolute() for run in runs]))
    path = Path(os.path.relpath(folder if len(runs) > 1 else folder.parent)) / "compare.rrd"
    _write(path, heads, runs)
    print("\n".join(printable(f"written to {run.folder}") for run in runs))
    print(printable(f"all boats: {path}"))


def _heads(runs: Sequence[Done]) -> list[tuple[str, ...]]:
    """What tells the runs apart: scenario, controller, or both."""
    found = [
        (run.content["scenario"].rpartition("/")[2], Path(run.content["controller"]).stem)
        for run in runs
    ]
    if len({scenario for scenario, _ in found}) < len({run.content["scenario"] for run in runs}):
        found = [
            (run.content["scenario"], controller)
            for run, (_, controller) in zip(runs, found, strict=True)
        ]
    several = [len(set(part)) > 1 for part in zip(*found, strict=True)]
    if not any(several):
        return list(found)
    return [
        tuple(part for part, differs in zip(head, several, strict=True) if differs)
        for head in found
    ]


def _rows(runs: Sequence[Done]) -> list[list[str]]:
    """Norm with its unit, what it is, and a cell for each run that has it, the best marked where lower is better."""
    asked = dict.fromkeys(
        (name, e["unit"]) for run in runs for name, e in run.content["norms"].items()
    )
    scenarios = [run.content["scenario"] for run in runs]
    rows = []
    for name, unit in asked:
        entries = [
            e if (e := run.content["norms"].get(name)) and e["unit"] == unit else None
            for run in runs
        ]
        best = _best(scenarios, entries)
        cells = [_cell(entry, number in best) for number, entry in enumerate(entries)]
        kind = next(e["kind"] for e in entries if e)
        rows.append([f"{name} [{unit}]" if unit else name, kind, *cells])
    return rows


def _best(scenarios: Sequence[str], entries: Sequence["MetricEntry | None"]) -> set[int]:
    """Which runs have the lowest value, of each scenario that is there several times, else of all.

    Lower is better of what is an error's size; a mean, a time or a place may be wanted as it is.
    """
    kinds = {e["kind"] for e in entries if e}
    if kinds & {"", "mean"}:
        return set()
    apart = any(scenarios.count(s) > 1 for s in scenarios)
    found: set[int] = set()
    for scenario in dict.fromkeys(scenarios) if apart else [None]:
        there = {
            i: float(f"{e['value']:.4g}")  # as it is printed
            for i, e in enumerate(entries)
            if e and e["value"] is not None and scenario in (None, scenarios[i])
        }
        if len(set(there.values())) > 1:
            found |= {i for i, x in there.items() if x == min(there.values())}
    return found


def _cell(entry: "MetricEntry | None", best: bool) -> str:
    if entry is None:
        return ""
    plain = value({**entry, "unit": ""})
    return f"{plain} {BEST if best else ' '}{MISSED if entry['ok'] is False else ' '}"


def _print(heads: Sequence[tuple[str, ...]], runs: Sequence[Done]) -> None:
    from rich.console import Console
    from rich.table import Table
    from rich.text import Text

    rows = _rows(runs)
    table = Table(title=Text(printable(_title(runs))), pad_edge=False)
    for heading in ("norm", "is"):
        table.add_column(heading, no_wrap=True)
    for head in heads:
        table.add_column(Text("\n".join(map(printable, head))), justify="right", no_wrap=True)
    for row in rows:
        table.add_row(*(Text(printable(cell), "bold" if BEST in cell else "") for cell in row))
    console = Console()
    if not console.is_terminal:  # nothing is cut in a file
        wide = console.options.update(max_width=UNCUT)
        console = Console(width=max(console.width, console.measure(table, options=wide).maximum))
    console.print(table)
    used = " ".join(cell for row in rows for cell in row[2:])
    marks = {BEST: "the best, where lower is better", MISSED: "outside its guard"}
    said = [f"{mark} {words}" for mark, words in marks.items() if mark in used]
    every = {
        f"{'/'.join(head)}: {n}": e
        for head, run in zip(heads, runs, strict=True)
        for n, e in run.content["norms"].items()
    }
    for line in [*(["; ".join(said)] if said else []), *reasons(every)]:
        console.print(Text(printable(line)), soft_wrap=True)


def _title(runs: Sequence[Done]) -> str:
    """What all of them share."""
    parts = [{run.content[key] for run in runs} for key in ("scenario", "controller")]
    seeds = {run.content["seed"] for run in runs}
    same = [part.pop() for part in parts if len(part) == 1]
    return (
        ", ".join([*map(str, same), *(f"seed {s}" for s in seeds if len(seeds) == 1)])
        or "side by side"
    )


def _write(path: Path, heads: Sequence[tuple[str, ...]], runs: Sequence[Done]) -> None:
    """compare.rrd, read back from the folders of the runs."""
    from boatsim.view.rerun_log import log_side_by_side

    names = _apart([re.sub(r"\W", "_", "_".join(head)) for head in heads])
    markdown = ["| norm | is | " + " | ".join(names) + " |", "|:---|:---|" + "---:|" * len(names)]
    markdown += ["| " + " | ".join(cell.strip() for cell in row) + " |" for row in _rows(runs)]
    with replacing(path) as temporary:
        log_side_by_side(
            temporary, dict(zip(names, _boats(runs), strict=True)), "\n".join(markdown) + "\n"
        )


def _apart(names: Sequence[str]) -> list[str]:
    """Names with a number behind one that is there before it."""
    found: list[str] = []
    for name in names:
        numbered = chain([name], (f"{name}_{number}" for number in count(2)))
        found.append(next(n for n in numbered if n not in found))
    return found


def _boats(runs: Sequence[Done]) -> "list[Boat]":
    """Their logs with the water they lie in; goals once for each scenario."""
    from boatsim.recordings.table import read
    from boatsim.simulate import world
    from boatsim.simulate.controllers import steered
    from boatsim.view import water
    from boatsim.view.rerun_log import Boat
    from boatsim.view.scene import scene_from

    logs = [read(run.folder / "recording.csv") for run in runs]
    names = [run.content["scenario"] for run in runs]
    found: list[Boat] = []
    for number, (run, log) in enumerate(zip(runs, logs, strict=True)):
        scenario = steered(run.given, run.controller)
        boat, walls = scenario.vessel, scenario.file.tank
        tank = world.Tank(**walls.model_dump()) if walls else None
        scene = (
            scene_from(world.build(boat, tank), boat, tank)
            if tank
            else water.around(boat, {"all": logs})
        )
        goals = f"goal of {scenario.name}" if len(set(names)) > 1 else "goal"
        found.append(Boat(log, scene, goals if names.index(names[number]) == number else ""))
    return found
