"""What a tool hands in to the benchmark, read and checked: a folder of answers, one for each trial.

RESULTS/Txxx/diagnosis.json needs `effects`, a list of tables with `name` and, where they are told, `parameters` (by
name with unit, each with `value` and `sd`), and `unknown` with `flag`. RESULTS/Txxx/replay.csv has free runs over
run_3, if the tool makes any.
"""

import csv
import json
import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any

VESSEL, HORIZON, LENGTH = (
    "trial_boat",
    6.0,
    1.2,
)  # where none is named; [s] of free runs at this length [m]
OPTIONAL: Mapping[str, Any] = {"verdict": "", "described": [], "candidates": [], "fit": {}}
SPAN = 0.05  # of the horizon that a free run may be shorter or longer
COVERED = 0.95  # of the rows that free runs must reach


class BadEntry(Exception):
    """What is wrong with a folder of answers, in one line."""


def vessel_of(trial: Path) -> str:
    """The vessel its recording.toml names."""
    from boatsim.recordings.notes import notes_for

    return notes_for(trial / "run_1.csv").notes.vessel or VESSEL


def horizon_of(trial: Path) -> float:
    """Seconds of a free run: 6 for a boat of 1.2 m, for others by Froude's scale of time."""
    from boatsim.physics import vessel as vessels

    return HORIZON * math.sqrt(vessels.load(vessel_of(trial), []).length / LENGTH)


def answers_in(results: Path, trials: list[str]) -> dict[str, dict[str, Any]]:
    """The answers of a tool, by trial. Raises BadEntry."""
    if not results.is_dir():
        raise BadEntry(
            f"{results}: there is no such folder; a folder of answers holds T001.../diagnosis.json and so on"
        )
    return {name: read_answer(results / name / "diagnosis.json") for name in trials}


def read_answer(file: Path) -> dict[str, Any]:
    """One answer, what need not be there filled in. Raises BadEntry."""
    if not file.is_file():
        raise BadEntry(
            f"{file}: there is no such file; every trial needs an answer, be it that nothing is missing"
        )
    try:
        found = json.loads(file.read_text(encoding="utf-8"))
    except ValueError as error:
        raise BadEntry(f"{file}: not JSON: {error}") from None
    if not isinstance(found, dict):
        raise BadEntry(f"{file}: a table is needed, with effects and unknown")
    effects, unknown = (
        _needed(found, "effects", list, file, ""),
        _needed(found, "unknown", dict, file, ""),
    )
    _needed(unknown, "flag", bool, file, "unknown.")
    for i, effect in enumerate(effects):
        where = f"effects[{i}]."
        if not isinstance(effect, dict):
            raise BadEntry(
                f"{file}: effects[{i}] = {effect!r}; allowed is a table with name and parameters"
            )
        _needed(effect, "name", str, file, where)
        effect.setdefault("tied_with", [])
        _needed(effect, "tied_with", list, file, where)
        effect.setdefault("parameters", {})
        for key, value in _needed(effect, "parameters", dict, file, where).items():
            _check_number(value, f"{where}parameters.{key}", file)
    for key, empty in OPTIONAL.items():
        found.setdefault(key, empty)
    laws = _needed(found, "described", list, file, "")
    found["described"] = [
        d for d in laws if isinstance(d, dict) and {"axis", "terms", "carries_over"} <= set(d)
    ]
    return found


def _needed(table: dict[str, Any], key: str, kind: type, file: Path, where: str) -> Any:
    """A key's value. Raises BadEntry."""
    words = {list: "a list", dict: "a table", bool: "true or false", str: "a text"}[kind]
    if key not in table:
        raise BadEntry(f"{file}: {where}{key} is missing; it is {words}")
    if not isinstance(table[key], kind):
        raise BadEntry(f"{file}: {where}{key} = {table[key]!r}; allowed is {words}")
    return table[key]


def _check_number(found: object, where: str, file: Path) -> None:
    """A parameter has a finite value and an sd. Raises BadEntry."""
    for key in ("value", "sd"):
        x = found.get(key) if isinstance(found, dict) else None
        if (
            isinstance(x, bool)
            or not isinstance(x, int | float)
            or not math.isfinite(x)
            or (key == "sd" and x <= 0.0)
        ):
            raise BadEntry(
                f"{file}: {where}.{key} = {x!r}; allowed is a finite number"
                + " above 0" * (key == "sd")
            )


def replay_errors(trial: Path, file: Path, horizon: float) -> float | None:
    """Position rms [m] of free runs over run_3; None unless they last `horizon` s each and together cover it."""
    if not file.is_file():
        return None
    with (trial / "run_3.csv").open() as opened:
        recorded = {round(float(row["t_s"]), 3): row for row in csv.DictReader(opened)}
    runs: dict[str, list[tuple[float, dict[str, str]]]] = {}
    try:
        with file.open() as opened:
            for row in csv.DictReader(opened):
                runs.setdefault(row["segment"], []).append((round(float(row["t_s"]), 3), row))
        whole = {
            k: rows
            for k, rows in runs.items()
            if abs(rows[-1][0] - rows[0][0] - horizon) <= SPAN * horizon
        }
        pairs = [(row, recorded[t]) for rows in whole.values() for t, row in rows]
        squares = [(float(a[c]) - float(b[c])) ** 2 for a, b in pairs for c in ("x_m", "y_m")]
    except (KeyError, ValueError, TypeError) as error:
        raise BadEntry(
            f"{file}: {error!r}; needed are t_s of run_3.csv, segment, x_m, y_m"
        ) from None
    begin, end = min(recorded), max(recorded)
    last = begin + horizon * math.floor((end - begin) / horizon * (1.0 + 1e-6))
    needed = {t for t in recorded if t <= last}
    reached = needed & {t for rows in whole.values() for t, _ in rows}
    whole_way = (
        squares and all(map(math.isfinite, squares)) and len(reached) >= COVERED * len(needed)
    )
    return math.sqrt(sum(squares) / len(squares)) if whole_way else None
