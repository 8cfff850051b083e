"""Names of signals of the motion: poses, velocities and rates."""

import re

from boatsim.recordings.importing.foreign_words import is_also_course
from boatsim.recordings.importing.log import Log
from boatsim.recordings.importing.signal_words import SATELLITES, SPEEDS, WORDS, words_as_written

PLACES = set("pos position local pose odom odometry location".split())
MOTIONS = set(
    "velocity vel twist linear angular speed acc accel "
    "acceleration mag orientation quat force torque".split()
)
TURNS = {
    "r_radps": ("z", "yaw"),
    "q_radps": ("y", "pitch"),
    "p_radps": ("x", "roll"),
}  # rate -> axis and name of the rotation
POSE_WORDS = {
    **dict.fromkeys(("yaw", "heading", "hdg", "psi", "compass"), "psi_rad"),
    **dict.fromkeys(("roll", "phi", "heel"), "phi_rad"),
    **dict.fromkeys(("pitch", "theta", "trim"), "theta_rad"),
    **dict.fromkeys(("north", "northing", "pn"), "x_m"),
    **dict.fromkeys(("east", "easting", "pe"), "y_m"),
}  # last word of a name -> column
# words in the name of a signal whose positive sense is the opposite of that of recordings
TO_PORT = {"left", "port"}
COUNTERCLOCKWISE = {"ccw", "counterclockwise", "anticlockwise"}
FROM_EAST = {"enu"}  # x east, y north, angles counterclockwise from east
CLOCKWISE = {"ned", "cw", "clockwise", "compass"}
FRAMES = FROM_EAST | {"ned"}
DISPLACEMENTS = {"surge": "x_m", "sway": "y_m", "heave": "z_m"}  # of a body on a rig
VELOCITIES = SPEEDS | {"m/s", "mps", "kn", "km/h"}
LENGTHS = {"m", "mm", "cm"}
BODY = {"odom", "odometry", "body", "base"}  # frames with x forward
# Words of three numbered signals, such as orientation_1 to _3: about x, y and z
ROTATIONS = set("orientation attitude euler rpy angles".split())
TURNING = set("rotational rotation angular gyro gyr omega rates".split())
BY_NUMBER = {
    "angles": ("phi_rad", "theta_rad", "psi_rad"),
    "rates": ("p_radps", "q_radps", "r_radps"),
}


def column_of_motion(last: list[str], tokens: frozenset[str], log: Log) -> str | None:
    """Return the column of the pose or velocity of a name; None for another.

    Args:
        last: Words of the name in their order, without units at the end.
        tokens: All words of the name.
        log: The log.
    """
    last = [word for word in last if word not in TO_PORT | COUNTERCLOCKWISE | FRAMES] or last
    end = last[-1]
    if found := _angular_rate(end, tokens):
        return found
    if end in POSE_WORDS:
        column = POSE_WORDS[end]
        if column in ("x_m", "y_m") and tokens & VELOCITIES:
            return None  # a velocity to the north, of the vessel or of a current
        return column
    if (
        end in ("x", "y")
        and not tokens & MOTIONS
        and (tokens & (PLACES | SATELLITES) or len(last) == 1)
    ):
        if tokens & FROM_EAST and not log.frame:
            return {"x": "y_m", "y": "x_m"}[end]
        return {"x": "x_m", "y": "y_m"}[end]
    if end in ("x", "y") and {"twist", "linear"} <= tokens and tokens & BODY and log.frame == "ENU":
        return {"x": "u_mps", "y": "v_mps"}[end]
    if end in DISPLACEMENTS and tokens & LENGTHS and not tokens & SPEEDS:
        return DISPLACEMENTS[end]
    if end in ("surge", "sway") or tokens & {"surge", "sway"} and tokens & SPEEDS:
        if "surge" in tokens:
            return "u_mps"
        return "v_mps"
    if len(last) == 1:
        return {"u": "u_mps", "v": "v_mps"}.get(end)
    return None


def column_of_numbered(name: str, tokens: frozenset[str], log: Log) -> str | None:
    """Return the angle or rate of one of three signals that differ by a number only.

    Args:
        name: Name of the signal.
        tokens: Words of its name.
        log: The log.

    Returns:
        The column; None for another signal.
    """
    found = re.fullmatch(r"(.*\D)(\d)([\])]?)", name)
    if not found:
        return None
    there = [n for n in range(4) if f"{found[1]}{n}{found[3]}" in log.signals]
    if there not in ([0, 1, 2], [1, 2, 3]):
        return None
    axis = int(found[2]) - there[0]
    if tokens & TURNING and tokens & (SPEEDS | {"velocities", "rates", "gyro", "gyr", "omega"}):
        return BY_NUMBER["rates"][axis]
    if tokens & ROTATIONS and not tokens & (SPEEDS | {"quaternion", "quat"}):
        return BY_NUMBER["angles"][axis]
    return None


def has_opposite_sense(column: str, tokens: frozenset[str]) -> bool:
    """Whether a name states that the positive sense is to port or counterclockwise.

    Args:
        column: Column of the signal, whose positive sense is to starboard and clockwise.
        tokens: Words of its name.
    """
    if column in ("y_m", "v_mps"):
        return bool(tokens & TO_PORT)
    if column in ("psi_rad", "r_radps"):
        return bool(tokens & (COUNTERCLOCKWISE | FROM_EAST))
    return False


def may_be_course(name: str) -> bool:
    """Return whether the word of a name for a heading may also be a course over ground.

    Args:
        name: Name of the signal.
    """
    return is_also_course(words_as_written(name))


def _angular_rate(end: str, tokens: frozenset[str]) -> str | None:
    """The angular rate of a name; None for another."""
    for column, (axis, spelt) in TURNS.items():
        number = str("xyz".index(axis))
        by_axis = end == axis or end == number and tokens & {"xyz", "rad"}
        if (
            tokens & {"gyr", "gyro", "angular", "omega"}
            and by_axis
            or end in (f"g{axis}", f"gyr{axis}", f"gyro{axis}")
        ):
            return column
        if tokens & {spelt} and (
            tokens & SPEEDS or tokens & {"rad/s", "deg/s", "dps", "radps", "degps"}
        ):
            return column
        if end in (f"{spelt}rate", f"{spelt}speed"):
            return column
    rates = (
        {"rot", "omega"} & {end}
        or "turn" in tokens
        and tokens & SPEEDS
        or end == "r"
        and not tokens - {"r"} - set(WORDS)
    )
    if rates:
        return "r_radps"
    return None
