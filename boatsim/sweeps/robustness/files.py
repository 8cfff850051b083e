"""Files of a robustness benchmark: robustness.csv and robustness.json."""

import csv
import json
from math import isfinite
from pathlib import Path

from boatsim.files import replace_file
from boatsim.recordings.notes import unit_of
from boatsim.sweeps.robustness.benchmark import Robustness
from boatsim.sweeps.robustness.drawn_boats import describe_draws
from boatsim.sweeps.robustness.survival import REQUIRED, LadderPoint

CSV, JSON = "robustness.csv", "robustness.json"
QUANTILES = ("median", "p95", "largest")


def write_csv(found: Robustness, folder: Path) -> None:
    """Write a row for each controller and value of a disturbance; errors are in SI units.

    Args:
        found: Result of a benchmark.
        folder: Output folder.

    Raises:
        OSError: The file cannot be written.
    """
    head = ["controller", "disturbance", "unit", "value", "boats", "survivors", "low", "high"]
    for signal in found.signals:
        head += [f"{signal.goal}_error_{name}" for name in QUANTILES]
    with replace_file(folder / CSV) as temporary:
        with temporary.open("w", encoding="utf-8", newline="") as file:
            writer = csv.writer(file)
            writer.writerow(head)
            for ladder in found.ladders:
                for point in ladder.points:
                    start = [ladder.controller, ladder.disturbance, ladder.unit, point.value]
                    writer.writerow([*start, *_numbers(found, point)])


def write_json(found: Robustness, folder: Path) -> None:
    """Write settings, bars and the largest values survived.

    Args:
        found: Result of a benchmark.
        folder: Output folder.

    Raises:
        OSError: The file cannot be written.
    """
    content = {
        "vessel": found.vessel.name,
        "load": list(found.vessel.load),
        "boats": len(found.boats),
        "seed": found.boats.seed,
        "required_share": REQUIRED,
        "draws": dict(describe_draws(found.boats)),
        "signals": _signals(found),
        "limits": _limits(found),
        "unavailable": dict(found.unavailable),
    }
    text = json.dumps(content, indent=2, allow_nan=False)
    with replace_file(folder / JSON) as temporary:
        temporary.write_text(f"{text}\n", encoding="utf-8")


def _numbers(found: Robustness, point: LadderPoint) -> list[float]:
    numbers: list[float] = [len(point.survived), int(point.survived.sum()), *point.interval]
    for number in range(len(found.signals)):
        numbers += point.error_quantiles(number)
    return numbers


def _signals(found: Robustness) -> list[dict[str, object]]:
    signals: list[dict[str, object]] = []
    for signal, bar in zip(found.signals, found.bars.tolist(), strict=True):
        signals.append(
            {
                "goal": signal.goal,
                "column": signal.column,
                "unit": unit_of(signal.column),
                "bar": signal.bar,
                "judged": isfinite(bar),
            }
        )
    return signals


def _limits(found: Robustness) -> list[dict[str, object]]:
    limits: list[dict[str, object]] = []
    for ladder in found.ladders:
        survived = ladder.survived_points
        failed = ladder.first_failed
        limits.append(
            {
                "controller": ladder.controller,
                "disturbance": ladder.disturbance,
                "unit": ladder.unit,
                "largest_survived": survived[-1].value if survived else None,
                "survivors": survived[-1].share if survived else None,
                "interval": survived[-1].interval if survived else None,
                "first_failed": failed.value if failed else None,
            }
        )
    return limits
