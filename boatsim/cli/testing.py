"""Implementation of `boatsim test`: compare the metrics of scenarios with baselines and bands."""

import json
import xml.etree.ElementTree as xml
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from time import monotonic

from boatsim.cli import progress
from boatsim.cli.exits import FAULTS, Exit, one_line, print_error
from boatsim.cli.metric_table import format_value
from boatsim.errors import BadInput, escape_for_terminal
from boatsim.files import replace_file
from boatsim.simulate import baselines
from boatsim.simulate.baselines import Baseline, BaselinesFile
from boatsim.simulate.cases import find_scenarios, scenario_files
from boatsim.simulate.evaluation import Metric, all_metrics
from boatsim.simulate.run import run
from boatsim.simulate.scenario import Scenario, load


@dataclass(frozen=True)
class Case:
    """Result of the regression test of one scenario: its metrics and their stored baselines.

    Attributes:
        name: `file`, or `file:case`.
        runs: Metrics with the scenario's own seed, then with the following seeds.
        baseline: Baselines of its metrics; None if it has none.
        error: Why it cannot be run; "" if it can.
        seconds: Wall time [s].
    """

    name: str
    runs: Sequence[Mapping[str, Metric]] = ()
    baseline: Mapping[str, Baseline] | None = None
    error: str = ""
    seconds: float = 0.0

    @property
    def metrics(self) -> Mapping[str, Metric]:
        """Metrics of the tested scenario's run with its own random seed."""
        if not self.runs:
            return {}
        return self.runs[0]

    @property
    def failures(self) -> list[str]:
        """Messages for the metrics that miss their regression band or differ from the baseline."""
        if self.error:
            return []
        lines = []
        for name, metric in self.metrics.items():
            if metric.ok is False:
                value = format_value(metric.to_json())
                lines.append(f"{name} is {value}, outside its regression band")
        if self.baseline is None:
            return [*lines, "has no baseline"]
        return [*lines, *baselines.compare_with_baselines(self.baseline, self.metrics)]

    @property
    def exit_code(self) -> Exit:
        """Exit code of the regression test of this scenario."""
        if self.error:
            return Exit.BAD_INPUT
        if self.failures:
            return Exit.MISSED
        return Exit.MET


def run_regression(folder: Path, pin: bool, seeds: int, junit: Path | None, as_json: bool) -> int:
    """Run all scenarios of a folder and compare their metrics with stored baselines, or store them.

    Args:
        folder: Folder with scenarios.
        pin: Whether to write the metrics as new baselines.
        seeds: Number of seeds from which the tolerance of a baseline follows.
        junit: File for the results as JUnit XML; None for none.
        as_json: Whether to print JSON in place of the table.

    Returns:
        Exit code.

    Raises:
        BadInput: The folder or its baselines cannot be read.
    """
    if not folder.is_dir():
        raise BadInput(f"{folder} is not a folder; give a folder with scenarios (*.toml)")
    stored = baselines.read_baselines(folder)
    known = stored.scenario if stored else {}
    cases = _run_all(folder, known, seeds if pin else 1)
    if pin:
        cases = _write_baselines(folder, known, cases, seeds)
    else:
        present = {case.name for case in cases} | _unreadable_scenarios(cases, known)
        for name, own in known.items():
            if name not in present:
                cases.append(Case(name, baseline=own))
    if junit:
        _write_junit(folder, cases, junit)
    if as_json:
        print(json.dumps(_cases_to_json(folder, cases), indent=1, allow_nan=False))
    else:
        _print_cases(folder, cases)
    for case in cases:
        if case.error:
            message = case.error
            if case.name not in message:
                message = f"{case.name}: {message}"
            print_error(message)
    return max(case.exit_code for case in cases)


def _run_all(folder: Path, known: Mapping[str, Mapping[str, Baseline]], seeds: int) -> list[Case]:
    """Run all cases of all files; files that cannot be read are cases with an error."""
    cases: list[Case] = []
    ready: list[tuple[str, Scenario]] = []
    for path in scenario_files(folder):
        try:
            for address in find_scenarios(str(path)):
                ready.append((address.removeprefix(f"{path.parent}/"), load(address)))
        except FAULTS as error:
            cases.append(Case(path.name, error=one_line(error)))
    durations = [(name, seeds * scenario.file.duration) for name, scenario in ready]
    with progress.report_runs(durations) as report:
        for index, (name, scenario) in enumerate(ready):
            case = _run_case(name, scenario, seeds, partial(report, index))
            cases.append(replace(case, baseline=known.get(name)))
    return sorted(cases, key=lambda case: case.name)


def _run_case(name: str, scenario: Scenario, seeds: int, report: Callable[[float], None]) -> Case:
    """Run one scenario with its own seed and the following ones."""
    start = monotonic()
    runs = []
    try:
        for k in range(seeds):
            offset = partial(_report_with_offset, report, k * scenario.file.duration)
            done = run(scenario, scenario.file.seed + k, progress=offset)
            if not done.complete:
                raise KeyboardInterrupt
            runs.append(all_metrics(done))
    except FAULTS as error:
        return Case(name, error=one_line(error), seconds=monotonic() - start)
    return Case(name, runs, seconds=monotonic() - start)


def _unreadable_scenarios(
    cases: Sequence[Case], known: Mapping[str, Mapping[str, Baseline]]
) -> set[str]:
    """Scenarios with baselines whose file cannot be read; their baselines stay."""
    prefixes = tuple(f"{case.name}:" for case in cases if case.error)
    return {name for name in known if name.startswith(prefixes)}


def _write_baselines(
    folder: Path, known: Mapping[str, Mapping[str, Baseline]], cases: Sequence[Case], seeds: int
) -> list[Case]:
    """Write new baselines; those of scenarios that cannot be run stay. Return the new cases."""
    kept = {case.name for case in cases if case.error} | _unreadable_scenarios(cases, known)
    new = {name: dict(metrics) for name, metrics in known.items() if name in kept}
    for case in cases:
        if not case.error:
            new[case.name] = baselines.make_baselines(case.runs)
    text = baselines.to_toml(BaselinesFile(seeds=seeds, scenario=new))
    with replace_file(folder / baselines.FILE) as temporary:
        temporary.write_text(text, encoding="utf-8")
    return [replace(case, baseline=new.get(case.name)) for case in cases]


def _print_cases(folder: Path, cases: Sequence[Case]) -> None:
    """Print a row for each scenario, then a line for each fault."""
    from rich.console import Console
    from rich.table import Table
    from rich.text import Text

    table = Table(title=Text(escape_for_terminal(str(folder))), pad_edge=False)
    table.add_column("scenario", no_wrap=True)
    table.add_column("metrics", justify="right", no_wrap=True)
    table.add_column("faults", justify="right", no_wrap=True)
    table.add_column("", no_wrap=True)
    states = {
        Exit.MET: "as baseline",
        Exit.MISSED: "[bold red]DIFFERS[/]",
        Exit.BAD_INPUT: "[bold red]CANNOT RUN[/]",
    }
    for case in cases:
        counts = str(len(case.metrics)), str(len(case.failures))
        table.add_row(Text(escape_for_terminal(case.name)), *counts, states[case.exit_code])
    console = Console()
    console.print(table)
    for case in cases:
        for line in case.failures:
            console.print(Text(escape_for_terminal(f"{case.name}: {line}")), soft_wrap=True)


def _cases_to_json(folder: Path, cases: Sequence[Case]) -> dict[str, object]:
    """Content that --json prints; it is the same for the same scenarios."""
    scenarios = []
    for case in cases:
        metrics = {}
        for name, metric in case.metrics.items():
            pin = (case.baseline or {}).get(name)
            metrics[name] = {**metric.to_json(), "pin": pin.model_dump() if pin else None}
        scenarios.append(
            {
                "scenario": case.name,
                "exit": case.exit_code,
                "error": case.error or None,
                "faults": case.failures,
                "norms": metrics,
            }
        )
    worst = max(case.exit_code for case in cases)
    return {"folder": str(folder), "exit": worst, "scenarios": scenarios}


def _write_junit(folder: Path, cases: Sequence[Case], path: Path) -> None:
    """Write the results as JUnit XML, one test case for each scenario."""
    codes = [case.exit_code for case in cases]
    total = {
        "tests": str(len(cases)),
        "failures": str(codes.count(Exit.MISSED)),
        "errors": str(codes.count(Exit.BAD_INPUT)),
        "time": f"{sum(case.seconds for case in cases):.3f}",
    }
    suite_name = escape_for_terminal(folder.resolve().name)
    top = xml.Element("testsuites", {"name": "boatsim", **total})
    suite = xml.SubElement(top, "testsuite", {"name": suite_name, **total})
    for case in cases:
        about = {
            "classname": suite_name,
            "name": escape_for_terminal(case.name),
            "time": f"{case.seconds:.3f}",
        }
        entry = xml.SubElement(suite, "testcase", about)
        if case.error:
            message = escape_for_terminal(case.error)
            xml.SubElement(entry, "error", message=message, type="BadInput").text = message
        elif case.failures:
            lines = list(map(escape_for_terminal, case.failures))
            failure = xml.SubElement(entry, "failure", message=lines[0], type="Norm")
            failure.text = "\n".join(lines)
    xml.indent(top)
    with replace_file(path) as temporary:
        xml.ElementTree(top).write(temporary, encoding="utf-8", xml_declaration=True)


def _report_with_offset(report: Callable[[float], None], offset: float, t: float) -> None:
    """Report the simulated time `t` [s] of one of several runs, after those before it."""
    report(offset + t)
