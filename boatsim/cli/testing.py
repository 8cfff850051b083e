"""What `boatsim test` does: every scenario of a folder is run, and its norms are held against their pins and guards."""

import json
import xml.etree.ElementTree as xml
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from time import monotonic

from boatsim.cli import progress, show
from boatsim.cli.exits import FAULTS, Exit, complain, words
from boatsim.errors import BadInput, printable
from boatsim.files import replacing
from boatsim.simulate import baselines
from boatsim.simulate.baselines import Baseline, BaselinesFile
from boatsim.simulate.cases import files_of, meant
from boatsim.simulate.evaluation import Metric, all_metrics
from boatsim.simulate.run import run
from boatsim.simulate.scenario import Scenario, load


@dataclass(frozen=True)
class Case:
    """What became of one scenario; of a file that is no scenario, why."""

    name: str  # file, or file:case
    runs: Sequence[Mapping[str, Metric]] = ()  # norms with its own seed, then with further ones
    pins: Mapping[str, Baseline] | None = None  # None: it has none
    error: str = ""
    seconds: float = 0.0

    @property
    def norms(self) -> Mapping[str, Metric]:
        """Those with its own seed."""
        return self.runs[0] if self.runs else {}

    @property
    def faults(self) -> list[str]:
        """A line for all that is not as it was, and for guards that are not met."""
        if self.error:
            return []
        bars = {n: show.value(x.to_json()) for n, x in self.norms.items() if x.ok is False}
        missed = [f"{name} is {value}, outside its guard" for name, value in bars.items()]
        return [
            *missed,
            *(
                ["has no baseline"]
                if self.pins is None
                else baselines.differences(self.pins, self.norms)
            ),
        ]

    @property
    def code(self) -> Exit:
        """How it ended."""
        return Exit.BAD_INPUT if self.error else Exit.MISSED if self.faults else Exit.MET


def regress(folder: Path, pin: bool, seeds: int, junit: Path | None, as_json: bool) -> int:
    """Run all scenarios of a folder, compare or pin their norms, print a summary. Raises BadInput."""
    if not folder.is_dir():
        raise BadInput(f"{folder}: is no folder; give one with scenarios (*.toml) in it")
    kept = baselines.read(folder)
    cases = _run_all(folder, kept, seeds if pin else 1)
    if pin:
        cases = _pin(folder, kept, cases, seeds)
    elif kept:
        there = {case.name for case in cases} | _unread(cases, kept)
        cases += [Case(name, pins=own) for name, own in kept.scenario.items() if name not in there]
    if junit:
        _write_junit(folder, cases, junit)
    if as_json:
        print(json.dumps(_as_json(folder, cases), indent=1, allow_nan=False))
    else:
        _print(folder, cases)
    for case in cases:
        if case.error:
            complain(case.error if case.name in case.error else f"{case.name}: {case.error}")
    return max(case.code for case in cases)


def _run_all(folder: Path, kept: BaselinesFile | None, seeds: int) -> list[Case]:
    """All cases of all files, those that can not be read too."""
    found: list[Case] = []
    ready: list[tuple[str, Scenario]] = []
    for path in files_of(folder):
        try:
            ready += [(one.removeprefix(f"{path.parent}/"), load(one)) for one in meant(str(path))]
        except FAULTS as error:
            found.append(Case(path.name, error=words(error)))
    with progress.running(
        [(name, seeds * scenario.file.duration) for name, scenario in ready]
    ) as report:
        for number, (name, scenario) in enumerate(ready):
            own = kept.scenario.get(name) if kept else None
            found.append(_run(name, scenario, own, seeds, partial(report, number)))
    return sorted(found, key=lambda case: case.name)


def _run(
    name: str,
    scenario: Scenario,
    own: Mapping[str, Baseline] | None,
    seeds: int,
    report: Callable[[float], None],
) -> Case:
    """One scenario with its own seed and those after it."""
    begun, runs = monotonic(), []
    try:
        for k in range(seeds):
            before = k * scenario.file.duration
            done = run(
                scenario, scenario.file.seed + k, progress=partial(_report_later, report, before)
            )
            if not done.complete:
                raise KeyboardInterrupt
            runs.append(all_metrics(done))
    except FAULTS as error:
        return Case(name, pins=own, error=words(error), seconds=monotonic() - begun)
    return Case(name, runs, own, seconds=monotonic() - begun)


def _unread(cases: Sequence[Case], kept: BaselinesFile | None) -> set[str]:
    """Scenarios with pins whose file can not be read: they are not gone."""
    bad = [case.name for case in cases if case.error]
    return {
        name
        for name in (kept.scenario if kept else ())
        if any(name.startswith(f"{b}:") for b in bad)
    }


def _pin(folder: Path, kept: BaselinesFile | None, cases: Sequence[Case], seeds: int) -> list[Case]:
    """Write what was found; of a scenario that can not be run the old pins stay. Returns the cases as pinned."""
    was = kept.scenario if kept else {}
    stay = {case.name for case in cases if case.error} | _unread(cases, kept)
    new = {name: dict(norms) for name, norms in was.items() if name in stay}
    new |= {case.name: baselines.baselines_of(case.runs) for case in cases if not case.error}
    with replacing(folder / baselines.FILE) as temporary:
        temporary.write_text(
            baselines.to_toml(BaselinesFile(seeds=seeds, scenario=new)), encoding="utf-8"
        )
    return [Case(c.name, c.runs, new.get(c.name), c.error, c.seconds) for c in cases]


def _print(folder: Path, cases: Sequence[Case]) -> None:
    """One row a scenario, and below it a line for each fault."""
    from rich.console import Console
    from rich.table import Table
    from rich.text import Text

    table = Table(title=Text(printable(str(folder))), pad_edge=False)
    for heading, justify in (
        ("scenario", "left"),
        ("norms", "right"),
        ("faults", "right"),
        ("", "left"),
    ):
        table.add_column(heading, justify="right" if justify == "right" else "left", no_wrap=True)
    states = {
        Exit.MET: "as pinned",
        Exit.MISSED: "[bold red]DIFFERS[/]",
        Exit.BAD_INPUT: "[bold red]CAN NOT RUN[/]",
    }
    for case in cases:
        table.add_row(
            Text(printable(case.name)),
            f"{len(case.norms)}",
            f"{len(case.faults)}",
            states[case.code],
        )
    console = Console()
    console.print(table)
    for case in cases:
        for line in case.faults:
            console.print(Text(printable(f"{case.name}: {line}")), soft_wrap=True)


def _as_json(folder: Path, cases: Sequence[Case]) -> dict[str, object]:
    """What --json prints; the same for the same files."""
    return {
        "folder": str(folder),
        "exit": max(case.code for case in cases),
        "scenarios": [
            {
                "scenario": case.name,
                "exit": case.code,
                "error": case.error or None,
                "faults": case.faults,
                "norms": {
                    name: _entry(norm, (case.pins or {}).get(name))
                    for name, norm in case.norms.items()
                },
            }
            for case in cases
        ],
    }


def _entry(norm: Metric, pin: Baseline | None) -> dict[str, object]:
    """A norm as norms.json has it, beside its pin."""
    return {**norm.to_json(), "pin": pin.model_dump() if pin else None}


def _write_junit(folder: Path, cases: Sequence[Case], path: Path) -> None:
    """The same as JUnit XML, a test case a scenario."""
    counts = {
        "tests": len(cases),
        "failures": sum(case.code == Exit.MISSED for case in cases),
        "errors": sum(case.code == Exit.BAD_INPUT for case in cases),
    }
    total = {
        **{key: str(count) for key, count in counts.items()},
        "time": f"{sum(c.seconds for c in cases):.3f}",
    }
    top = xml.Element("testsuites", {"name": "boatsim", **total})
    suite = xml.SubElement(top, "testsuite", {"name": printable(folder.resolve().name), **total})
    for case in cases:
        about = {
            "classname": printable(folder.resolve().name),
            "name": printable(case.name),
            "time": f"{case.seconds:.3f}",
        }
        entry = xml.SubElement(suite, "testcase", about)
        if case.error:
            xml.SubElement(
                entry, "error", message=printable(case.error), type="BadInput"
            ).text = printable(case.error)
        elif case.faults:
            lines = [printable(line) for line in case.faults]
            xml.SubElement(entry, "failure", message=lines[0], type="Norm").text = "\n".join(lines)
    xml.indent(top)
    with replacing(path) as temporary:
        xml.ElementTree(top).write(temporary, encoding="utf-8", xml_declaration=True)


def _report_later(report: Callable[[float], None], offset: float, t: float) -> None:
    """Report the simulated time `t` [s] of one of several runs, with that of earlier runs added."""
    report(offset + t)
