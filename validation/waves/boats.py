"""Vessels with coefficients of a boundary element method, and their linear response to waves."""

from pathlib import Path

import numpy as np
from scipy.interpolate import CubicSpline

from boatsim.physics.base import AXES, Array
from boatsim.physics.coefficients.table import Coefficients
from boatsim.physics.vessel import Vessel, load_vessel

HULL = """<mujoco><worldbody><body name="hull">
<geom type="box" size="1 0.5 0.1"/>
</body></worldbody></mujoco>
"""


def linear_response(
    found: Coefficients,
    body: Array,
    stiffness: Array,
    dof: tuple[str, ...],
    frequency: Array,
    heading: float,
) -> Array:
    """Return the motion per amplitude of the wave in the frequency domain.

    Args:
        found: Coefficients of the hull.
        body: Mass matrix (6, 6).
        stiffness: Stiffness (6, 6), of springs too.
        dof: Degrees of freedom of the vessel.
        frequency: Angular frequencies (N,) [rad/s].
        heading: Direction to which the waves run, relative to the hull [rad], 0 to pi.

    Returns:
        Complex amplitudes (N, dof) [m/m, rad/m] of the time dependence exp(i w t).
    """
    places = [AXES.index(axis) for axis in dof]
    own = np.ix_(places, places)
    added = CubicSpline(found.frequency, found.added_mass)(frequency)
    damping = CubicSpline(found.frequency, found.damping)(frequency)
    table = CubicSpline(found.heading, found.excitation, axis=1)(heading)
    excitation = CubicSpline(found.frequency, table)(frequency)
    rows = []
    for i, w in enumerate(frequency):
        dynamic = stiffness + 1j * w * damping[i] - w * w * (body + added[i])
        rows.append(np.linalg.solve(dynamic[own], excitation[i, places]))
    return np.array(rows)


def write_vessel(folder: Path, text: str) -> Vessel:
    """Write a vessel file with a plain hull, and load it.

    Args:
        folder: Folder of the vessel.
        text: Content of vessel.toml.
    """
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "hull.xml").write_text(HULL, encoding="utf-8")
    (folder / "vessel.toml").write_text(text, encoding="utf-8")
    return load_vessel(str(folder / "vessel.toml"))
