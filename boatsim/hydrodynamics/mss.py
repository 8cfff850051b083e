"""Response amplitude operators from a vessel structure of T. I. Fossen's MSS toolbox, NAME.mat.

The structure has SNAME axes, phases that lead the crest, and headings of 0 for waves from astern.
Its mean drift has the axes surge, sway and yaw, and none of phase.
It does not contain the point to which motions refer: that of ShipX is an option of its run. The
vessel's origin is taken, at the mass centre and in the waterplane.
"""

from pathlib import Path
from typing import Any

import numpy as np

from boatsim.errors import BadInput
from boatsim.hydrodynamics.rao_table import Kind, RaoTable, complete_table
from boatsim.physics.signals import AXES, Array

FIELDS: dict[Kind, str] = {"motion": "motionRAO", "load": "forceRAO"}
DRIFT_AXES = (0, 1, 5)  # surge, sway and yaw, in this order in the structure
DRIFT_NEEDS = "needs w, and amp of surge, sway and yaw at each of the headings and velocities"
SAME_SPEED = 1e-3  # [m/s]


def read_mss(path: Path, depth: float, speed: float, kind: Kind = "motion") -> RaoTable:
    """Read motions or loads of a vessel structure, and its mean drift if it has one.

    Args:
        path: The file.
        depth: Depth of the water [m]; 0 for deep water.
        speed: Forward speed [m/s], one of those in the file.
        kind: Motions or loads; a structure that has only the other ones gives these.

    Raises:
        BadInput: The file has no such structure, or not this speed.
    """
    from scipy.io import loadmat

    if not path.is_file():
        raise BadInput(f"{path}: there is no such file")
    try:
        vessel: Any = loadmat(path, squeeze_me=True, struct_as_record=False)["vessel"]
        if not hasattr(vessel, FIELDS[kind]):
            kind = "load" if kind == "motion" else "motion"
        operators = getattr(vessel, FIELDS[kind])
        speeds = np.atleast_1d(np.asarray(vessel.velocities, dtype=float))
        heading = np.atleast_1d(np.asarray(vessel.headings, dtype=float))
        frequency, size = _tables(operators, operators.amp, len(heading))
        _, phase = _tables(operators, operators.phase, len(heading))
    except Exception:  # whatever the reader raises for damaged files and those of other programs
        raise BadInput(
            f"{path}: there is no structure `vessel` of MSS with motionRAO or forceRAO"
        ) from None
    same = np.flatnonzero(np.abs(speeds - speed) < SAME_SPEED)
    if not len(same):
        known = ", ".join(f"{one:g}" for one in speeds)
        raise BadInput(f"{path}: --speed = {speed:g} m/s; the table has {known} m/s")
    place = int(same[0])
    _check_sizes(size, phase, len(speeds), path)
    values = np.full((len(frequency), len(heading), 6), np.nan + 0j)
    for axis in range(min(6, len(size))):
        values[:, :, axis] = size[axis][:, :, place] * np.exp(1j * phase[axis][:, :, place])
    waves = np.stack(np.meshgrid(frequency, heading, indexing="ij"), axis=-1).reshape(-1, 2)
    waves[:, 1] = (waves[:, 1] + np.pi + 1e-9) % (2.0 * np.pi) - np.pi - 1e-9
    grid = complete_table(waves, values.reshape(-1, 6), path)
    drift = _drift_tables(vessel, len(heading), path)
    return RaoTable(
        source=f"MSS, {path.name}",
        kind=kind,
        frequency=grid[0],
        heading=grid[1],
        values=grid[2],
        depth=depth,
        speed=float(speeds[place]),
        drift=None if drift is None else _mean_drift(drift, frequency, waves, place, path),
    )


def _tables(operators: Any, values: Any, headings: int) -> tuple[Array, list[Array]]:
    """Return frequencies (N,) and a table (N, H, speeds) of each axis of a part of a structure."""
    frequency = np.atleast_1d(np.asarray(operators.w, dtype=float))
    shape = (len(frequency), headings, -1)
    return frequency, [np.asarray(one, dtype=float).reshape(shape) for one in values]


def _drift_tables(vessel: Any, headings: int, path: Path) -> tuple[Array, list[Array]] | None:
    """Return frequencies and tables of the mean drift in surge, sway and yaw.

    Args:
        vessel: The structure.
        headings: Number of its headings.
        path: File, for messages.

    Returns:
        Frequencies (M,) and three tables (M, H, speeds), or None if the structure has no drift.

    Raises:
        BadInput: Axes, frequencies or headings are missing.
    """
    part = getattr(vessel, "driftfrc", None)
    if part is None or np.size(part) == 0 or np.size(getattr(part, "amp", 0.0)) == 0:
        return None
    try:
        found = _tables(part, part.amp[: len(DRIFT_AXES)], headings)
        complete = len(found[1]) == len(DRIFT_AXES)
    except Exception:  # whatever damaged structures and those of other programs raise
        complete = False
    if not complete:
        raise BadInput(f"{path}: driftfrc {DRIFT_NEEDS}")
    return found


def _mean_drift(
    drift: tuple[Array, list[Array]], frequency: Array, waves: Array, place: int, path: Path
) -> Array:
    """Return the mean drift (N, H, 3) at the frequencies of the operators.

    Args:
        drift: Frequencies of the drift, and a table of each axis.
        frequency: Frequencies of the operators (N,) [rad/s].
        waves: Frequency and direction of each row of the grid (R, 2).
        place: Number of the speed.
        path: File, for messages.

    Raises:
        BadInput: A number is not finite, or the speed has no drift.
    """
    own, tables = drift
    if any(one.shape[2] <= place for one in tables):
        raise BadInput(f"{path}: driftfrc {DRIFT_NEEDS}")
    order = np.argsort(own)
    rows = np.zeros((len(frequency), len(waves) // len(frequency), 6), dtype=complex)
    for axis, table in zip(DRIFT_AXES, tables, strict=True):
        for h, column in enumerate(table[:, :, place].T):
            rows[:, h, axis] = np.interp(frequency, own[order], column[order])
    if not np.isfinite(rows).all():
        raise BadInput(f"{path}: a number of driftfrc is not finite")
    values = complete_table(waves, rows.reshape(-1, 6), path)[2]
    return np.asarray(values[..., DRIFT_AXES].real)


def _check_sizes(size: list[Array], phase: list[Array], speeds: int, path: Path) -> None:
    """Raise BadInput unless amplitude and phase have the same axes, and a value at each speed."""
    if len(size) != len(phase):
        raise BadInput(f"{path}: {len(size)} axes of amp and {len(phase)} of phase")
    for name, tables in (("amp", size), ("phase", phase)):
        for axis, table in zip(AXES, tables, strict=False):
            if table.shape[2] < speeds:
                raise BadInput(
                    f"{path}: {name} of {axis} has {table.shape[2]} of the {speeds} velocities"
                )
