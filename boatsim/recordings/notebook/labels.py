"""Names and units of signals as a person reads them: words, and degrees in place of radians."""

from math import degrees

from boatsim.recordings.notes import unit_of

WORDS = {
    "x_m": "north or forward x",
    "y_m": "east or starboard y",
    "z_m": "down z",
    "phi_rad": "roll phi",
    "theta_rad": "pitch theta",
    "psi_rad": "heading psi",
    "u_mps": "surge speed u",
    "v_mps": "sway speed v",
    "w_mps": "heave speed w",
    "p_radps": "roll rate p",
    "q_radps": "pitch rate q",
    "r_radps": "yaw rate r",
}
IN_DEGREES = {"rad": "deg", "rad/s": "deg/s", "rad/s^2": "deg/s^2"}


def column_in_words(name: str) -> str:
    """Return the name of a column in words, without its unit: `thrust_port_N` -> thrust port."""
    if name in WORDS:
        return WORDS[name]
    if unit_of(name):
        name = name.rpartition("_")[0]
    return name.replace("_", " ")


def display_unit(name: str) -> tuple[str, float]:
    """Return the unit in which a person reads a column, and the factor to it from the SI unit.

    Args:
        name: Name of the column.

    Returns:
        The unit, "1" for a number without one, and the factor.
    """
    unit = unit_of(name)
    if unit in IN_DEGREES:
        return IN_DEGREES[unit], degrees(1.0)
    return unit or "1", 1.0
