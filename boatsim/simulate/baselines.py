"""Baselines of metrics, stored next to the scenarios, so that every change of behaviour is noticed.

`pins.toml` in a folder of scenarios holds the value of each metric with the scenario's own seed,
and a tolerance: the range of the metric over several seeds, because other noise is not a change,
and at least the difference between the arithmetic of two machines.
"""

import json
from collections.abc import Mapping, Sequence
from pathlib import Path

from pydantic import Field

from boatsim.files import Table, read_toml, validate_table
from boatsim.simulate.evaluation import Metric

FILE = "pins.toml"
# Relative. Machines differ in the 16th digit. Start conditions changed by 1e-12 move the metrics of
# nearly every scenario by less than 1e-7, even with relays in the controller; 1e-6 is therefore a
# change of the code.
TOLERANCE = 1e-6
NOTHING = 1e-9  # absolute tolerance, for metrics that are zero


class Baseline(Table):
    """Stored value of one metric in pins.toml, with unit and tolerance, for regression tests."""

    value: float | None = None  # None: the run did not reach the metric's condition
    unit: str = ""
    tolerance: float = Field(default=0.0, ge=0.0)  # to either side


class BaselinesFile(Table):
    """Content of a pins.toml: stored metrics of the scenarios of a folder, for regression tests."""

    seeds: int = Field(default=1, ge=1)  # number of seeds behind the tolerances
    scenario: dict[str, dict[str, Baseline]] = {}  # by file, or file:case


def values_agree(old: float | str | None, new: float | str | None, tolerance: float) -> bool:
    """Return whether the new value of a metric agrees with its stored value.

    Args:
        old: Stored value.
        new: New value.
        tolerance: Largest difference of two numbers, in addition to the arithmetic's.

    Returns:
        For two numbers whether they agree within the tolerance, otherwise whether they are equal.
    """
    if not isinstance(old, float | int) or not isinstance(new, float | int):
        return old == new
    return abs(new - old) <= max(TOLERANCE * abs(old), NOTHING, tolerance)


def round_to_nine_digits(value: float | None) -> float | None:
    """Round the value of a metric to nine digits; None, for a metric without a value, stays None.

    Nine digits are finer than the tolerance of the comparison with stored values.
    """
    return None if value is None else float(f"{value:.9g}")


def read_baselines(folder: Path) -> BaselinesFile | None:
    """Read the stored metrics of the scenarios of a folder from its pins.toml.

    Args:
        folder: Folder of scenarios.

    Returns:
        The baselines, or None if the folder has none.

    Raises:
        BadInput: If the file is not valid.
    """
    path = folder / FILE
    return validate_table(BaselinesFile, read_toml(path), str(path)) if path.exists() else None


def make_baselines(runs: Sequence[Mapping[str, Metric]]) -> dict[str, Baseline]:
    """Return the metrics of one scenario as baselines, to be stored for regression tests.

    Args:
        runs: Metrics of runs with different seeds; the first run has the scenario's own seed.

    Returns:
        Baseline by metric: the value of the first run, with a tolerance that spans all runs.
    """
    found: dict[str, Baseline] = {}
    for name, metric in runs[0].items():
        tolerance = max(TOLERANCE * abs(metric.value or 0.0), NOTHING)
        if metric.value is not None:
            values = [run[name].value for run in runs if name in run]
            numbers = [value for value in values if value is not None]
            tolerance = max(max(numbers) - min(numbers), tolerance)
        rounded = float(f"{tolerance:.3g}")
        found[name] = Baseline(
            value=round_to_nine_digits(metric.value), unit=metric.unit, tolerance=rounded
        )
    return found


def compare_with_baselines(
    baselines: Mapping[str, Baseline], metrics: Mapping[str, Metric]
) -> list[str]:
    """Compare the metrics of a run with their stored baselines.

    Args:
        baselines: Baseline by metric.
        metrics: The metrics of a run.

    Returns:
        A line for each metric that differs.
    """
    lines = []
    for name in {**baselines, **metrics}:
        if name not in baselines:
            lines.append(f"{name} has no baseline")
            continue
        if name not in metrics:
            lines.append(f"{name} has a baseline and is not computed any more")
            continue
        old = baselines[name]
        new = metrics[name]
        if not values_agree(old.value, new.value, old.tolerance):
            before = _format_value(old.value, new.lacking)
            after = _format_value(new.value, new.lacking)
            changed = f"{name}: {before} -> {after} {new.unit}".rstrip()
            lines.append(f"{changed} (+- {old.tolerance:.3g})")
        elif old.unit != new.unit:
            lines.append(f"{name}: its unit was {old.unit!r} and is {new.unit!r}")
    return lines


def _format_value(value: float | None, lacking: str | None) -> str:
    if value is None:
        return lacking or "not reached"
    return f"{value:.6g}"


def to_toml(baselines: BaselinesFile) -> str:
    """Return stored metrics as the text of a pins.toml, with one line per metric.

    One line per metric keeps differences between two versions of the file readable.
    """
    lines = [
        "# Baselines of the metrics of these scenarios, with each scenario's own seed.",
        "# `boatsim test FOLDER` compares with them, `boatsim test FOLDER --pin` writes this file.",
        "# tolerance: range over the seeds, at least a millionth of the value.",
        f"seeds = {baselines.seeds}",
    ]
    for scenario, entries in sorted(baselines.scenario.items()):
        lines += ["", f"[scenario.{json.dumps(scenario)}]"]
        for name, entry in entries.items():
            value = "" if entry.value is None else f"value = {entry.value!r}, "
            unit = json.dumps(entry.unit, ensure_ascii=False)
            rest = f"tolerance = {entry.tolerance!r}, unit = {unit}"
            lines.append(f"{json.dumps(name)} = {{ {value}{rest} }}")
    return "\n".join(lines) + "\n"
