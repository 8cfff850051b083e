"""Lines of a proposed map for the position and the columns of the motion."""

from collections.abc import Collection, Mapping, Sequence

import numpy as np

from boatsim.files import toml_value
from boatsim.recordings.importing.log import Log
from boatsim.recordings.importing.motion_names import FROM_EAST, has_opposite_sense, may_be_course
from boatsim.recordings.importing.signal_classification import Classification
from boatsim.recordings.importing.signal_text import (
    expression_of,
    is_constant,
    printable_name,
    sampling_rate,
)

# Column -> column of the signal and sign, for logs with z up (ROS, REP 103: x east, y north; x
# forward, y port)
FROM_ENU = {
    "x_m": ("y_m", ""),
    "y_m": ("x_m", ""),
    "v_mps": ("v_mps", "-"),
    "theta_rad": ("theta_rad", "-"),
    "q_radps": ("q_radps", "-"),
    "r_radps": ("r_radps", "-"),
    "psi_rad": ("psi_rad", "-"),
}
QUARTER_TURN = " + 90 * deg"  # heading from north = 90 degrees - yaw from east
POSE_COLUMNS = ("x_m", "y_m", "psi_rad", "r_radps", "u_mps", "v_mps")
INCLINATIONS = {"phi_rad": "roll", "p_radps": "roll", "theta_rad": "pitch", "q_radps": "pitch"}


def motion_lines(
    log: Log, best: Mapping[str, list[Classification]], dof: Sequence[str], known: Collection[str]
) -> tuple[list[str], list[Classification]]:
    """Return the lines of the position and the columns of motion, and their signals.

    Args:
        log: The log.
        best: Column -> classified signals, the most probable first.
        dof: Degrees of freedom of the vessel; none if unknown.
        known: Columns that the vessel's file states.
    """
    lines: list[str] = []
    used: list[Classification] = []
    pair = _latitude_and_longitude(best.get("latitude", []), best.get("longitude", []))
    if pair:
        used += pair
        lines.append("[position]")
        for g in pair:
            lines.append(
                f"{g.column} = {toml_value(expression_of(g))}{_comment(g, best[g.column])}"
            )
        if pair[0].word == "deg":
            middle = ", ".join(f"{np.nanmedian(g.signal.values):.4f}" for g in pair)
            lines.append(f"# origin = [{middle}]  # [deg]; else the first fix")
        lines.append("")
    lines.append("[columns]")
    enu = log.frame == "ENU"
    if enu and not pair and best.get("x_m"):
        lines.append(
            "# x east, y north, z up, hull x forward, y port, as in ROS; recordings have x "
            "north, y east, angles clockwise"
        )
    if not log.frame and best.get("psi_rad"):
        lines.append(
            "# assumed: x north or ahead, y east or to starboard, heading and its rate clockwise"
        )
    for column in (*POSE_COLUMNS, *INCLINATIONS):
        source, sign = column, ""
        if enu:
            source, sign = FROM_ENU.get(column, (column, ""))
        if column in ("x_m", "y_m") and pair or source not in best:
            continue
        g = best[source][0]
        quarter = ""
        if column == "psi_rad" and "yaw" not in g.tokens:
            sign = ""  # a compass heading is clockwise from north
        elif column == "psi_rad" and enu:
            quarter = QUARTER_TURN
        elif not enu and has_opposite_sense(column, g.tokens):
            sign = "-"
            if column == "psi_rad" and g.tokens & FROM_EAST:
                quarter = QUARTER_TURN
        expression = toml_value(sign + expression_of(g) + quarter)
        line = f"{column} = {expression}{_comment(g, best[source])}"
        if column in INCLINATIONS and (INCLINATIONS[column] not in dof or is_constant(g)):
            lines.append(f"# {line}")
        else:
            lines.append(line)
            used.append(g)
    if "psi_rad" not in {*best, *known} and (not dof or "yaw" in dof):
        lines.append(
            '# psi_rad = "..."  # no heading was found; it is needed for a vessel that turns'
        )
    return lines, used


def _latitude_and_longitude(
    latitudes: Sequence[Classification], longitudes: Sequence[Classification]
) -> list[Classification]:
    """The most probable latitude with the longitude of its stream."""
    for lat in latitudes:
        stream = lat.name.rpartition(".")[0]
        for lon in longitudes:
            if lon.name.rpartition(".")[0] == stream and len(lon.signal.t) == len(lat.signal.t):
                return [lat, lon]
    return []


def _comment(g: Classification, others: Sequence[Classification]) -> str:
    """A comment with the rate, the assumption and further possible signals."""
    parts = [f"{sampling_rate(g.signal):.3g} Hz"]
    if g.why:
        parts.append(g.why)
    if g.column == "psi_rad" and may_be_course(g.name):
        parts.append("CHECK: a heading, or a course over ground, which is none?")
    if also := [printable_name(o.name) for o in others if o is not g][:4]:
        parts.append(f"also {', '.join(also)}")
    return "  # " + "; ".join(parts)
