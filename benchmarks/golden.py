"""Today's norms of every measured scenario, kept so that no change goes unseen.

python -m benchmarks.golden                           what has drifted; exit 1 if anything has
python -m benchmarks.golden --update --reason "..."   store the new values; the reason goes into tests/golden/HISTORY.md
"""

import argparse
import json
import sys
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from boatsim.files import replacing
from boatsim.physics.content import names
from boatsim.physics.signals import STATE
from boatsim.simulate import scenario
from boatsim.simulate.baselines import TOLERANCE, digits, same
from boatsim.simulate.evaluation import Metric, requested_metrics
from boatsim.simulate.run import run

HOME = Path(__file__).parents[1]
HISTORY_TITLE = "# History of the pinned metrics"
NEW = "is new"
# Loops that run away, as published controllers may, forget how they began: what such a start moves
# there is kept.
NUDGE, NUDGES = 1e-12, 6  # SI units off in every freedom; so many ways of it
REACH = 3.0  # of what the nudges moved, within which another machine's arithmetic may end
FIELDS = {
    "today": "",
    "at_reported": " at the rate reported",
    "published": " as published",
    "verdict": " verdict",
}
Values = dict[
    str, dict[str, Any]
]  # norm -> today, at_reported, published, verdict, unit, and moves where it does


def tracked() -> list[str]:
    """Scenarios that measure something."""
    return [
        name
        for name in names("scenario")
        if (file := scenario.load(name).file).measure or file.check
    ]


def measured(name: str) -> dict[str, Metric]:
    """Norms of a scenario with seed 0."""
    return requested_metrics(run(scenario.load(name), 0))


def nudged(name: str) -> list[dict[str, Metric]]:
    """The same, started a little beside, each time in another direction."""
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


def values(found: Mapping[str, Metric], beside: Sequence[Mapping[str, Metric]] = ()) -> Values:
    """What is kept of each norm, and how far those of starts beside it lie where that is more than the tolerance."""
    kept = {}
    for name, n in found.items():
        kept[name] = {
            "today": digits(n.value),
            "at_reported": digits(n.at_reported),
            "published": n.published,
            "verdict": n.verdict,
            "unit": n.unit,
        }
        moves = max(
            (abs(x - n.value) for other in beside if (x := other[name].value) and n.value),
            default=0.0,
        )
        if n.value and moves > TOLERANCE * abs(n.value):
            kept[name]["moves"] = digits(moves)
    return kept


def path_of(name: str, home: Path = HOME) -> Path:
    """File of a scenario's values: that of its folder, which holds one vessel's."""
    return home / "tests" / "golden" / f"{name.partition('/')[0]}.json"


def table(path: Path) -> dict[str, Values]:
    """The values kept in a file, by scenario; none if there is no such file."""
    found: dict[str, Values] = (
        json.loads(path.read_text(encoding="utf-8"))["scenarios"] if path.is_file() else {}
    )
    return found


def kept(name: str, home: Path = HOME) -> Values:
    """The values kept of a scenario; none if it is new."""
    return table(path_of(name, home)).get(name, {})


def text_of(scenarios: Mapping[str, Values]) -> str:
    """Content of a vessel's file: a line for each norm, so that a change of one is a change of one line."""
    parts = []
    for name, values in sorted(scenarios.items()):
        rows = ",\n".join(
            f"   {json.dumps(norm)}: {json.dumps(value)}" for norm, value in values.items()
        )
        parts.append(f"  {json.dumps(name)}: {{\n{rows}\n  }}")
    return '{\n "seed": 0,\n "scenarios": {\n' + ",\n".join(parts) + "\n }\n}\n"


def drifts(name: str, old: Values, new: Values) -> list[str]:
    """A line for everything that is not as it was: scenario, norm, old, new and the paper's value."""
    return [
        line for norm in {**old, **new} for line in _drift(name, norm, old.get(norm), new.get(norm))
    ]


def update(changed: Mapping[str, tuple[Values, list[str]]], reason: str, home: Path = HOME) -> None:
    """Write the new values of the scenarios that drifted, and add the reason with every drift to the history."""
    for path in {path_of(name, home) for name in changed}:
        new = {name: values for name, (values, _) in changed.items() if path_of(name, home) == path}
        path.parent.mkdir(parents=True, exist_ok=True)
        _write(path, text_of(table(path) | new))
    history = home / "tests" / "golden" / "HISTORY.md"
    text = history.read_text(encoding="utf-8") if history.is_file() else f"{HISTORY_TITLE}\n"
    lines = [line for _, changes in changed.values() for line in changes]
    _write(history, with_reason(text, reason, lines))


def with_reason(history: str, reason: str, lines: list[str]) -> str:
    """Return the history with a new entry above the older ones; new metrics are counted, not listed."""
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


def _drift(
    name: str, norm: str, old: Mapping[str, Any] | None, new: Mapping[str, Any] | None
) -> Iterable[str]:
    if old is None or new is None:
        yield f"{name} {norm} {NEW if old is None else 'is gone'}"
        return
    reach = REACH * max(old.get("moves", 0.0), new.get("moves", 0.0))
    for field in FIELDS:
        if not same(old[field], new[field], reach):
            change = f"{old[field]} -> {new[field]} {new['unit']}"
            yield f"{name} {norm}{FIELDS[field]}: {change} (paper: {new['published']})"


def _write(path: Path, text: str) -> None:
    with replacing(path) as temporary:
        temporary.write_text(text, encoding="utf-8")


def main(arguments: list[str] | None = None) -> int:
    """0 nothing drifted or taken over, 1 drifted, 2 wrong use."""
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks.golden", description="Norms kept of every scenario."
    )
    parser.add_argument("--update", action="store_true", help="take today's values")
    parser.add_argument(
        "--reason", default="", help="why they changed; goes into tests/golden/HISTORY.md"
    )
    given = parser.parse_args(arguments)
    reason = " ".join(given.reason.split())
    if given.update and not reason:
        print('--update needs --reason "why the norms changed"', file=sys.stderr)
        return 2
    changed: dict[str, tuple[Values, list[str]]] = {}
    for name in tracked():
        found = measured(name)
        if lines := drifts(name, kept(name), values(found)):
            changed[name] = (values(found, nudged(name) if given.update else ()), lines)
            print("\n".join(lines), flush=True)
    if changed and given.update:
        update(changed, reason)
        print(f"{len(changed)} scenarios written, reason in tests/golden/HISTORY.md")
        return 0
    print("no norm has drifted" if not changed else f"{len(changed)} scenarios have drifted")
    return int(bool(changed))


if __name__ == "__main__":
    sys.exit(main())
