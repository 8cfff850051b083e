"""Response amplitude operators from a plain table, .csv, with its conventions in the first lines.

    # axes = sname            or z-up: x forward, y to port, z up, directions counter-clockwise
    # phase = lead            or lag: of the motion to the crest of the wave
    # direction = to          or from: where the waves of a direction run to, or come from
    # speed = 0.0             forward speed [m/s]
    # x = 0.0                 point to which the values refer, ahead of the vessel's origin [m]
    # z = 0.0                 and below it [m]
    direction_rad,frequency_radps,heave_m_per_m,heave_phase_rad,...

All of these lines may be left out: the values above are the defaults, and those of the table that
`boatsim manoeuvre response` writes. A direction is in _rad or _deg, period_s may replace
frequency_radps, and the unit of a column decides whether the table has motions or loads.
"""

import csv
from pathlib import Path

import numpy as np

from boatsim.errors import BadInput, unknown_name_message
from boatsim.hydrodynamics.axes import SIGNS
from boatsim.hydrodynamics.rao_table import Complex, RaoTable, complete_table
from boatsim.physics.signals import AXES, ROTATIONS, Array

WORDS = {"axes": ("sname", "z-up"), "phase": ("lead", "lag"), "direction": ("to", "from")}
NUMBERS = ("speed", "x", "z")
MOTION_UNITS = ({"m_per_m": 1.0}, {"rad_per_m": 1.0, "deg_per_m": np.pi / 180.0})
LOAD_UNITS = (
    {"N_per_m": 1.0, "kN_per_m": 1e3},
    {"Nm_per_m": 1.0, "kNm_per_m": 1e3},
)
ANGLES = {"rad": 1.0, "deg": np.pi / 180.0}
MOST_ROWS = 200_000


def read_rao_csv(path: Path, depth: float) -> RaoTable:
    """Read motions or loads over frequency and heading from a plain table.

    Args:
        path: The file.
        depth: Depth of the water [m]; 0 for deep water.

    Raises:
        BadInput: A line has another form.
    """
    if not path.is_file():
        raise BadInput(f"{path}: there is no such file")
    lines = path.read_text(encoding="utf-8-sig", errors="replace").splitlines()
    words, numbers, begin = _conventions(lines, path)
    columns, rows = _rows(lines[begin:], begin, path)
    waves = np.stack([_frequencies(columns, rows, path), _directions(columns, rows, path)], axis=1)
    kind, values = _values(columns, rows, path)
    if words["direction"] == "from":
        waves[:, 1] += np.pi
    if words["phase"] == "lag":
        values = np.conj(values)
    if words["axes"] == "z-up":
        values, waves = values * SIGNS, waves * np.array([1.0, -1.0])
    # directions that are the same after a whole turn
    waves[:, 1] = (waves[:, 1] + np.pi + 1e-9) % (2.0 * np.pi) - np.pi - 1e-9
    frequency, heading, complete = complete_table(waves, values, path)
    return RaoTable(
        source=path.name,
        kind="motion" if kind == "motion" else "load",
        frequency=frequency,
        heading=heading,
        values=complete,
        depth=depth,
        speed=numbers["speed"],
        point=(numbers["x"], numbers["z"]),
    )


def _conventions(lines: list[str], path: Path) -> tuple[dict[str, str], dict[str, float], int]:
    """Return the conventions of the first lines, and the number of these lines."""
    words = {key: allowed[0] for key, allowed in WORDS.items()}
    numbers = dict.fromkeys(NUMBERS, 0.0)
    for number, line in enumerate(lines):
        if not line.startswith("#"):
            return words, numbers, number
        key, equals, value = (part.strip() for part in line[1:].partition("="))
        if not equals:
            continue  # a remark
        if key in words:
            if value not in WORDS[key]:
                raise BadInput(
                    f"{path}:{number + 1}: {key} = {value!r}; allowed are {', '.join(WORDS[key])}"
                )
            words[key] = value
        elif key in numbers:
            numbers[key] = _number(value, f"{path}:{number + 1}: {key}")
        else:
            known = [*WORDS, *NUMBERS]
            raise BadInput(unknown_name_message(f"{path}:{number + 1}: convention", key, known))
    raise BadInput(f"{path}: there are no rows")


def _number(text: str, label: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = np.nan
    if not np.isfinite(value):
        raise BadInput(f"{label} = {text!r}; a number is required")
    return value


def _rows(lines: list[str], begin: int, path: Path) -> tuple[list[str], Array]:
    """Return the names of the columns and the numbers (R, C)."""
    table = [row for row in csv.reader(lines) if row]
    columns = [name.strip() for name in table[0]]
    if len(table) > MOST_ROWS:
        raise BadInput(f"{path}: more than {MOST_ROWS} rows")
    if len(table) < 2:
        raise BadInput(f"{path}: there are no rows")
    rows = []
    for number, row in enumerate(table[1:], begin + 2):
        if len(row) != len(columns):
            raise BadInput(f"{path}:{number}: {len(row)} columns; {len(columns)} are required")
        values = []
        for name, cell in zip(columns, row, strict=True):
            values.append(_number(cell, f"{path}:{number}: {name}"))
        rows.append(values)
    return columns, np.array(rows)


def _frequencies(columns: list[str], rows: Array, path: Path) -> Array:
    if "frequency_radps" in columns:
        return np.asarray(rows[:, columns.index("frequency_radps")])
    if "period_s" not in columns:
        raise BadInput(f"{path}: a column frequency_radps or period_s is required")
    period = rows[:, columns.index("period_s")]
    if not np.all(period > 0.0):
        raise BadInput(f"{path}: period_s must be above 0")
    return np.asarray(2.0 * np.pi / period)


def _directions(columns: list[str], rows: Array, path: Path) -> Array:
    for unit, factor in ANGLES.items():
        if f"direction_{unit}" in columns:
            return np.asarray(factor * rows[:, columns.index(f"direction_{unit}")])
    raise BadInput(f"{path}: a column direction_rad or direction_deg is required")


def _values(columns: list[str], rows: Array, path: Path) -> tuple[str, Complex]:
    """Return the kind of the table and its complex values (R, 6), as the file states them."""
    found = np.full((len(rows), 6), np.nan + 0j)
    kinds: dict[str, str] = {}
    for place, axis in enumerate(AXES):
        for kind, units in (("motion", MOTION_UNITS), ("load", LOAD_UNITS)):
            for unit, factor in units[axis in ROTATIONS].items():
                name = f"{axis}_{unit}"
                if name not in columns:
                    continue
                kinds.setdefault(kind, name)
                size = factor * rows[:, columns.index(name)]
                found[:, place] = size * np.exp(1j * _phase(columns, rows, axis, path))
    if not kinds:
        raise BadInput(
            f"{path}: a column such as heave_m_per_m, pitch_rad_per_m, heave_N_per_m or "
            "pitch_Nm_per_m is required"
        )
    if len(kinds) == 2:
        raise BadInput(
            f"{path}: {kinds['motion']} is a motion and {kinds['load']} a load; a table has one "
            "of both"
        )
    return next(iter(kinds)), found


def _phase(columns: list[str], rows: Array, axis: str, path: Path) -> Array:
    for unit, factor in ANGLES.items():
        if f"{axis}_phase_{unit}" in columns:
            return np.asarray(factor * rows[:, columns.index(f"{axis}_phase_{unit}")])
    raise BadInput(f"{path}: a column {axis}_phase_rad or {axis}_phase_deg is required")
