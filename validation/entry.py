"""Reads and checks the answers of a tool: a folder with one answer for each trial.

RESULTS/Txxx/diagnosis.json needs `effects`, a list of tables with `name` and optionally
`parameters` (by name with unit, each with `value` and `sd`), and `unknown` with `flag`.
RESULTS/Txxx/replay.csv holds free runs over run_3; it is optional.
"""

import csv
import json
import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any

VESSEL = "trial_boat"  # default if recording.toml names no vessel
HORIZON = 6.0  # [s] duration of a free run of a boat of LENGTH
LENGTH = 1.2  # [m]
OPTIONAL: Mapping[str, Any] = {"verdict": "", "described": [], "candidates": [], "fit": {}}
SPAN = 0.05  # tolerance of a free run's duration, share of the horizon
COVERED = 0.95  # share of the rows that the free runs must cover


class BadEntry(Exception):
    """The folder of answers is invalid; the message is one line."""


def vessel_of(trial: Path) -> str:
    """Return the vessel that the trial's recording.toml names."""
    from boatsim.recordings.notes import notes_for

    return notes_for(trial / "run_1.csv").notes.vessel or VESSEL


def horizon_of(trial: Path) -> float:
    """Return the duration [s] of a free run: 6 s at 1.2 m, Froude-scaled for others."""
    from boatsim.physics import vessel as vessels

    return HORIZON * math.sqrt(vessels.load_vessel(vessel_of(trial), []).length / LENGTH)


def read_answers(results: Path, trials: list[str]) -> dict[str, dict[str, Any]]:
    """Return the answers of a tool by trial.

    Raises:
        BadEntry: if the folder or an answer is missing or invalid.
    """
    if not results.is_dir():
        raise BadEntry(
            f"{results}: there is no such folder; a folder of answers holds "
            "T001.../diagnosis.json and so on"
        )
    return {name: read_answer(results / name / "diagnosis.json") for name in trials}


def read_answer(file: Path) -> dict[str, Any]:
    """Return one answer with defaults for the optional keys.

    Raises:
        BadEntry: if the file is missing or invalid.
    """
    if not file.is_file():
        raise BadEntry(
            f"{file}: there is no such file; every trial needs an answer, be it that "
            "nothing is missing"
        )
    try:
        found = json.loads(file.read_text(encoding="utf-8"))
    except ValueError as error:
        raise BadEntry(f"{file}: not JSON: {error}") from None
    if not isinstance(found, dict):
        raise BadEntry(f"{file}: a table is needed, with effects and unknown")
    effects = _required_value(found, "effects", list, file, "")
    unknown = _required_value(found, "unknown", dict, file, "")
    _required_value(unknown, "flag", bool, file, "unknown.")
    for i, effect in enumerate(effects):
        where = f"effects[{i}]."
        if not isinstance(effect, dict):
            raise BadEntry(
                f"{file}: effects[{i}] = {effect!r}; allowed is a table with name and parameters"
            )
        _required_value(effect, "name", str, file, where)
        effect.setdefault("tied_with", [])
        _required_value(effect, "tied_with", list, file, where)
        effect.setdefault("parameters", {})
        for key, value in _required_value(effect, "parameters", dict, file, where).items():
            _check_number(value, f"{where}parameters.{key}", file)
    for key, empty in OPTIONAL.items():
        found.setdefault(key, empty)
    laws = _required_value(found, "described", list, file, "")
    found["described"] = [
        d for d in laws if isinstance(d, dict) and {"axis", "terms", "carries_over"} <= set(d)
    ]
    return found


def _required_value(table: dict[str, Any], key: str, kind: type, file: Path, where: str) -> Any:
    """Return the value of a required key; raise BadEntry if it is missing or of another type."""
    words = {list: "a list", dict: "a table", bool: "true or false", str: "a text"}[kind]
    if key not in table:
        raise BadEntry(f"{file}: {where}{key} is missing; it is {words}")
    if not isinstance(table[key], kind):
        raise BadEntry(f"{file}: {where}{key} = {table[key]!r}; allowed is {words}")
    return table[key]


def _check_number(found: object, where: str, file: Path) -> None:
    """Raise BadEntry unless a parameter has a finite value and a positive sd."""
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
    """Return the position rms error [m] of free runs over run_3.

    Args:
        trial: folder of the trial.
        file: replay.csv of the tool.
        horizon: duration of a free run [s].

    Returns:
        The rms error, or None unless the runs last `horizon` each and together cover run_3.

    Raises:
        BadEntry: if the file lacks a column or has a time that run_3 has not.
    """
    if not file.is_file():
        return None
    with (trial / "run_3.csv").open() as opened:
        recorded = {round(float(row["t_s"]), 3): row for row in csv.DictReader(opened)}
    runs: dict[str, list[tuple[float, dict[str, str]]]] = {}
    try:
        with file.open() as opened:
            for row in csv.DictReader(opened):
                runs.setdefault(row["segment"], []).append((round(float(row["t_s"]), 3), row))
        whole = {}
        for k, rows in runs.items():
            if abs(rows[-1][0] - rows[0][0] - horizon) <= SPAN * horizon:
                whole[k] = rows
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
    if whole_way:
        return math.sqrt(sum(squares) / len(squares))
    return None
