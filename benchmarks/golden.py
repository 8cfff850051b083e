"""Stored metrics of every scenario that has any, so that no change is overlooked.

python -m benchmarks.golden                           list the changes; exit 1 if there are any
python -m benchmarks.golden --update --reason "..."   store the new values

The reason is written to tests/golden/HISTORY.md.
"""

import argparse
import json
import sys
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from boatsim.files import replace_file
from boatsim.physics.content import shipped_content_names
from boatsim.physics.signals import STATE
from boatsim.simulate import scenario
from boatsim.simulate.baselines import TOLERANCE, round_to_nine_digits, values_agree
from boatsim.simulate.evaluation import Metric, requested_metrics
from boatsim.simulate.run import run

HOME = Path(__file__).parents[1]
HISTORY_TITLE = "# History of the pinned metrics"
NEW = "is new"
# Unstable loops, which some published controllers have, amplify rounding differences of the start.
# The resulting change of their metrics is stored.
NUDGE, NUDGES = 1e-12, 6  # perturbation in SI units in every dof, number of directions
REACH = 3.0  # tolerance on other machines, relative to the change by the perturbations
FIELDS = {
    "today": "",
    "at_reported": " at the rate reported",
    "published": " as published",
    "verdict": " verdict",
}
Values = dict[
    str, dict[str, Any]
]  # norm -> today, at_reported, published, verdict, unit, and moves where it does


def scenarios_with_metrics() -> list[str]:
    """Return the scenarios that have metrics."""
    return [
        name
        for name in shipped_content_names("scenario")
        if (file := scenario.load(name).file).measure or file.check
    ]


def metrics_of_scenario(name: str) -> dict[str, Metric]:
    """Return the metrics of a scenario with seed 0."""
    return requested_metrics(run(scenario.load(name), 0))


def metrics_with_perturbed_start(name: str) -> list[dict[str, Metric]]:
    """Return the metrics with a perturbed start, once for each direction."""
    start = scenario.load(name)
    chance = np.random.default_rng(0)
    off = NUDGE * chance.choice([-1.0, 1.0], (NUDGES, len(start.vessel.dof)))
    rates = [s.symbol for s in STATE if s.rate and s.axis in start.vessel.dof]
    said = start.file.start.model_dump()
    return [
        requested_metrics(
            run(
                scenario.load(
                    name, {"start": said | {k: said[k] + x for k, x in zip(rates, xs, strict=True)}}
                ),
                0,
            )
        )
        for xs in off
    ]


def values_to_store(
    found: Mapping[str, Metric], perturbed: Sequence[Mapping[str, Metric]] = ()
) -> Values:
    """Return the stored values of each metric.

    They include the range under perturbed starts if it exceeds the tolerance.
    """
    kept = {}
    for name, n in found.items():
        kept[name] = {
            "today": round_to_nine_digits(n.value),
            "at_reported": round_to_nine_digits(n.at_reported),
            "published": n.published,
            "verdict": n.verdict,
            "unit": n.unit,
        }
        moves = max(
            (abs(x - n.value) for other in perturbed if (x := other[name].value) and n.value),
            default=0.0,
        )
        if n.value and moves > TOLERANCE * abs(n.value):
            kept[name]["moves"] = round_to_nine_digits(moves)
    return kept


def path_of(name: str, home: Path = HOME) -> Path:
    """Return the file of a scenario's values; each holds the scenarios of one vessel."""
    return home / "tests" / "golden" / f"{name.partition('/')[0]}.json"


def read_values(path: Path) -> dict[str, Values]:
    """Return the values in a file by scenario; empty if there is no such file."""
    found: dict[str, Values] = (
        json.loads(path.read_text(encoding="utf-8"))["scenarios"] if path.is_file() else {}
    )
    return found


def stored_values(name: str, home: Path = HOME) -> Values:
    """Return the stored values of a scenario; empty if it is new."""
    return read_values(path_of(name, home)).get(name, {})


def file_content(scenarios: Mapping[str, Values]) -> str:
    """Return the content of a vessel's file, with a line for each metric."""
    parts = []
    for name, values in sorted(scenarios.items()):
        rows = ",\n".join(
            f"   {json.dumps(norm)}: {json.dumps(value)}" for norm, value in values.items()
        )
        parts.append(f"  {json.dumps(name)}: {{\n{rows}\n  }}")
    return '{\n "seed": 0,\n "scenarios": {\n' + ",\n".join(parts) + "\n }\n}\n"


def changes_of_metrics(name: str, old: Values, new: Values) -> list[str]:
    """Return a line for every change: scenario, metric, old, new and the paper's value."""
    return [
        line
        for norm in {**old, **new}
        for line in _change_of_metric(name, norm, old.get(norm), new.get(norm))
    ]


def update(changed: Mapping[str, tuple[Values, list[str]]], reason: str, home: Path = HOME) -> None:
    """Write the new values of the changed scenarios, and add the reason to the history."""
    for path in {path_of(name, home) for name in changed}:
        new = {name: values for name, (values, _) in changed.items() if path_of(name, home) == path}
        path.parent.mkdir(parents=True, exist_ok=True)
        _write(path, file_content(read_values(path) | new))
    history = home / "tests" / "golden" / "HISTORY.md"
    text = history.read_text(encoding="utf-8") if history.is_file() else f"{HISTORY_TITLE}\n"
    lines = [line for _, changes in changed.values() for line in changes]
    _write(history, add_to_history(text, reason, lines))


def add_to_history(history: str, reason: str, lines: list[str]) -> str:
    """Return the history with a new entry above the older ones; new metrics are only counted."""
    changes = [line for line in lines if not line.endswith(NEW)]
    entry = [f"- {reason}"]
    for line in changes:
        entry.append(f"  - {line}")
    if added := len(lines) - len(changes):
        entry.append(f"  - {added} new metrics")
    introduction, separator, older = history.partition("\n- ")
    return (
        introduction.rstrip("\n")
        + "\n\n"
        + "\n".join(entry)
        + "\n"
        + (separator + older).lstrip("\n")
    )


def _change_of_metric(
    name: str, norm: str, old: Mapping[str, Any] | None, new: Mapping[str, Any] | None
) -> Iterable[str]:
    if old is None or new is None:
        yield f"{name} {norm} {NEW if old is None else 'is gone'}"
        return
    reach = REACH * max(old.get("moves", 0.0), new.get("moves", 0.0))
    for field in FIELDS:
        if not values_agree(old[field], new[field], reach):
            change = f"{old[field]} -> {new[field]} {new['unit']}"
            yield f"{name} {norm}{FIELDS[field]}: {change} (paper: {new['published']})"


def _write(path: Path, text: str) -> None:
    with replace_file(path) as temporary:
        temporary.write_text(text, encoding="utf-8")


def main(arguments: list[str] | None = None) -> int:
    """Return 0 if nothing changed or values were stored, 1 if values changed, 2 for wrong use."""
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks.golden",
        description="Check the stored metrics of every scenario.",
    )
    parser.add_argument("--update", action="store_true", help="store the present values")
    parser.add_argument(
        "--reason", default="", help="reason for the change; written to tests/golden/HISTORY.md"
    )
    given = parser.parse_args(arguments)
    reason = " ".join(given.reason.split())
    if given.update and not reason:
        print('--update needs --reason "why the metrics changed"', file=sys.stderr)
        return 2
    changed: dict[str, tuple[Values, list[str]]] = {}
    for name in scenarios_with_metrics():
        found = metrics_of_scenario(name)
        if lines := changes_of_metrics(name, stored_values(name), values_to_store(found)):
            changed[name] = (
                values_to_store(found, metrics_with_perturbed_start(name) if given.update else ()),
                lines,
            )
            print("\n".join(lines), flush=True)
    if changed and given.update:
        update(changed, reason)
        print(f"{len(changed)} scenarios written, reason in tests/golden/HISTORY.md")
        return 0
    print("no metric has changed" if not changed else f"{len(changed)} scenarios have changed")
    return int(bool(changed))


if __name__ == "__main__":
    sys.exit(main())
