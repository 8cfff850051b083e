"""Response amplitude operators from a vessel structure of T. I. Fossen's MSS toolbox, NAME.mat.

The structure has SNAME axes, phases that lead the crest, and headings of 0 for waves from astern.
It does not contain the point to which motions refer: that of ShipX is an option of its run. The
vessel's origin is taken, at the mass centre and in the waterplane.
"""

from pathlib import Path
from typing import Any

import numpy as np

from boatsim.errors import BadInput
from boatsim.hydrodynamics.rao_table import RaoTable, complete_table
from boatsim.physics.signals import AXES, Array

FIELDS = {"motion": "motionRAO", "load": "forceRAO"}
SAME_SPEED = 1e-3  # [m/s]


def read_mss(path: Path, depth: float, speed: float) -> RaoTable:
    """Read the motions of a vessel structure, or its loads if it has no motions.

    Args:
        path: The file.
        depth: Depth of the water [m]; 0 for deep water.
        speed: Forward speed [m/s], one of those in the file.

    Raises:
        BadInput: The file has no such structure, or not this speed.
    """
    from scipy.io import loadmat

    if not path.is_file():
        raise BadInput(f"{path}: there is no such file")
    try:
        vessel: Any = loadmat(path, squeeze_me=True, struct_as_record=False)["vessel"]
        kind = "motion" if hasattr(vessel, FIELDS["motion"]) else "load"
        operators = getattr(vessel, FIELDS[kind])
        speeds = np.atleast_1d(np.asarray(vessel.velocities, dtype=float))
        heading = np.atleast_1d(np.asarray(vessel.headings, dtype=float))
        frequency = np.atleast_1d(np.asarray(operators.w, dtype=float))
        shape = (len(frequency), len(heading), -1)
        size = [np.asarray(one, dtype=float).reshape(shape) for one in operators.amp]
        phase = [np.asarray(one, dtype=float).reshape(shape) for one in operators.phase]
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
    return RaoTable(
        source=f"MSS, {path.name}",
        kind="motion" if kind == "motion" else "load",
        frequency=grid[0],
        heading=grid[1],
        values=grid[2],
        depth=depth,
        speed=float(speeds[place]),
    )


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
