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

from pathlib import Path
from typing import cast

import numpy as np

from boatsim.errors import BadInput
from boatsim.hydrodynamics.axes import SIGNS
from boatsim.hydrodynamics.rao_table import Complex, Kind, RaoTable, complete_table
from boatsim.physics.signals import AXES, ROTATIONS, Array
from boatsim.physics.stated_table import ANGLES, StatedTable, read_stated_table

WORDS = {"axes": ("sname", "z-up"), "phase": ("lead", "lag"), "direction": ("to", "from")}
NUMBERS = ("speed", "x", "z")
# Units of a translation and of a rotation, or of a force and of a moment
UNITS = {
    "motion": ({"m_per_m": 1.0}, {"rad_per_m": 1.0, "deg_per_m": ANGLES["deg"]}),
    "load": ({"N_per_m": 1.0, "kN_per_m": 1e3}, {"Nm_per_m": 1.0, "kNm_per_m": 1e3}),
}


def read_rao_csv(path: Path, depth: float) -> RaoTable:
    """Read motions or loads over frequency and heading from a plain table.

    Args:
        path: The file.
        depth: Depth of the water [m]; 0 for deep water.

    Raises:
        BadInput: A line has another form.
    """
    table = read_stated_table(path, WORDS, NUMBERS)
    waves = np.stack([_frequencies(table), _directions(table)], axis=1)
    kind, values = _values(table)
    if table.words["direction"] == "from":
        waves[:, 1] += np.pi
    if table.words["phase"] == "lag":
        values = np.conj(values)
    if table.words["axes"] == "z-up":
        values, waves = values * SIGNS, waves * np.array([1.0, -1.0])
    # directions that are the same after a whole turn
    waves[:, 1] = (waves[:, 1] + np.pi + 1e-9) % (2.0 * np.pi) - np.pi - 1e-9
    frequency, heading, complete = complete_table(waves, values, path)
    return RaoTable(
        source=path.name,
        kind=kind,
        frequency=frequency,
        heading=heading,
        values=complete,
        depth=depth,
        speed=table.numbers["speed"],
        point=(table.numbers["x"], table.numbers["z"]),
    )


def _frequencies(table: StatedTable) -> Array:
    found = table.column({"frequency_radps": 1.0})
    if found is not None:
        return found
    period = table.column({"period_s": 1.0})
    if period is None:
        raise BadInput(f"{table.path}: a column frequency_radps or period_s is required")
    if not np.all(period > 0.0):
        raise BadInput(f"{table.path}: period_s must be above 0")
    return np.asarray(2.0 * np.pi / period)


def _directions(table: StatedTable) -> Array:
    found = table.column({f"direction_{unit}": factor for unit, factor in ANGLES.items()})
    if found is None:
        raise BadInput(f"{table.path}: a column direction_rad or direction_deg is required")
    return found


def _values(table: StatedTable) -> tuple[Kind, Complex]:
    """Return the kind of the table and its complex values (R, 6), as the file states them."""
    found = np.full((len(table.rows), 6), np.nan + 0j)
    kinds: dict[str, str] = {}
    for place, axis in enumerate(AXES):
        for kind, units in UNITS.items():
            names = {f"{axis}_{unit}": size for unit, size in units[axis in ROTATIONS].items()}
            size = table.column(names)
            if size is not None:
                kinds.setdefault(kind, next(name for name in names if name in table.columns))
                found[:, place] = size * np.exp(1j * _phase(table, axis))
    if not kinds:
        raise BadInput(
            f"{table.path}: a column such as heave_m_per_m, pitch_rad_per_m, heave_N_per_m or "
            "pitch_Nm_per_m is required"
        )
    if len(kinds) == 2:
        raise BadInput(
            f"{table.path}: {kinds['motion']} is a motion and {kinds['load']} a load; a table has "
            "one of both"
        )
    return cast(Kind, next(iter(kinds))), found


def _phase(table: StatedTable, axis: str) -> Array:
    found = table.column({f"{axis}_phase_{unit}": factor for unit, factor in ANGLES.items()})
    if found is None:
        raise BadInput(f"{table.path}: a column {axis}_phase_rad or {axis}_phase_deg is required")
    return found
