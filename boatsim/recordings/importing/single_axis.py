"""Names of signals on a body with one degree of freedom, whose logs call them position or angle.

"position" and "velocity" say nothing on a boat. On a body that only rolls, or only heaves, they can
be nothing else than its one coordinate and the rate of that.
"""

from collections.abc import Collection, Sequence

import numpy as np

from boatsim.physics.base import Array
from boatsim.recordings.units import MAX_TUMBLING, find_roll_in_degrees

COORDINATES = {
    "surge": ("x_m", "u_mps"),
    "sway": ("y_m", "v_mps"),
    "heave": ("z_m", "w_mps"),
    "roll": ("phi_rad", "p_radps"),
    "pitch": ("theta_rad", "q_radps"),
    "yaw": ("psi_rad", "r_radps"),
}  # degree of freedom -> its coordinate and the rate of that
POSITIONS = set("position pos angle deflection displacement joint encoder q phi theta".split())
VELOCITIES = set("velocity vel speed rate omega qd qdot".split())
LOADS = set("torque force moment load tension pull".split())  # words of measured loads
WHY = "the only coordinate of the vessel"


def column_of_single_axis(last: Sequence[str], dof: Sequence[str]) -> str | None:
    """Return the column of a signal on a vessel with one degree of freedom, None for another.

    Args:
        last: Words of the name without units and superfluous ones; the last one decides.
        dof: Degrees of freedom of the vessel.
    """
    if len(dof) != 1 or dof[0] not in COORDINATES:
        return None
    pose, rate = COORDINATES[dof[0]]
    if last[-1] in POSITIONS:
        return pose
    if last[-1] in VELOCITIES:
        return rate
    return None


def is_load_of_channel(tokens: Collection[str], words: Collection[str]) -> bool:
    """Return whether a signal and a channel have the same word for a load: both are a torque.

    Args:
        tokens: Words of the name of the signal.
        words: Words of the name of the channel.
    """
    return bool(LOADS & set(tokens) & set(words))


def names_load(words: Collection[str]) -> bool:
    """Return whether the words of a name contain that of a load, such as torque."""
    return not LOADS.isdisjoint(words)


def unit_of_tumbling(column: str, t: Array, values: Array) -> str:
    """Return the unit of the roll or roll rate of a body that may turn over, as a word of a map.

    Args:
        column: phi_rad or p_radps.
        t: Times (N,) [s].
        values: Samples (N,) as logged.

    Returns:
        "" for radians, "deg" or "degps".
    """
    known = np.isfinite(values)
    if column == "phi_rad":
        if find_roll_in_degrees(t[known], values[known], None, turns_over=True) is None:
            return ""
        return "deg"
    if float(np.percentile(np.abs(values[known]), 99)) > MAX_TUMBLING:
        return "degps"
    return ""
