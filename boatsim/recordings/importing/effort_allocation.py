"""Lines of a map that distribute orders of another form to the drives of a vessel.

These are a force and a moment, or the throttle and the steering of a stick.
"""

from collections.abc import Mapping, Sequence

import numpy as np

from boatsim.files import toml_key, toml_value
from boatsim.recordings.importing.channels import VesselChannel
from boatsim.recordings.importing.drive_names import PULSE
from boatsim.recordings.importing.log import median_sampling_rate
from boatsim.recordings.importing.signal_classification import Classification
from boatsim.recordings.importing.signal_words import side_from_tokens
from boatsim.recordings.importing.turning import MIN_CORRELATION, Turning

EFFORTS = ("effort_x", "effort_n")  # force ahead and moment to starboard
MIN_SHARE = 1e-6  # smaller shares of a force are rounding
THROTTLE = {"throttle", "thrust", "gas", "surge", "forward", "speed"}
STEERING = {"steer", "steering", "turn", "yaw", "helm", "rudder"}
FULL_SHARES = (1.0, 100.0)  # numbers of a full order: a share, or per cent
PULSES = -1.0  # in their place, for pulses of a servo
USUAL_PULSE = (1100.0, 1500.0, 1900.0)  # [us] low, neutral, high of most motor controllers
EXCESS = 1.01  # by which a full order may exceed its number, by rounding


def allocation_lines(
    drives: Sequence[VesselChannel], best: Mapping[str, Sequence[Classification]]
) -> dict[str, str]:
    """Return the lines of fixed drives that together give a force ahead and a moment.

    The thrusts are those of the pseudoinverse of the configuration matrix (Fossen 2021, section
    9.5), without limits, for the log does not show them.

    Args:
        drives: Channels of the vessel.
        best: Column -> classified signals, the most probable first.

    Returns:
        Channel -> line; none if a channel is no fixed drive, or the log has no such orders.
    """
    found = [best[kind][0] for kind in EFFORTS if best.get(kind)]
    if len(found) < len(EFFORTS) or len(drives) < len(EFFORTS):
        return {}
    levers = [drive.lever for drive in drives]
    if None in levers:
        return {}
    configuration = np.array([np.ones(len(drives)), np.array(levers, dtype=float)])
    if np.linalg.matrix_rank(configuration) < len(EFFORTS):
        return {}
    shares = np.linalg.pinv(configuration)
    lines = {}
    for drive, row in zip(drives, shares, strict=True):
        lines[drive.name] = _line(drive, found, row.tolist())
    return lines


def mixing_lines(
    drives: Sequence[VesselChannel], orders: Sequence[Classification], turning: Turning
) -> tuple[dict[str, str], list[Classification]]:
    """Return the lines of fixed drives on both sides that a throttle and a steering order mix.

    Each drive gets the throttle, plus the steering on one side and minus it on the other, as the
    usual mixers do. The turning of the vessel shows the sign.

    Args:
        drives: Channels of the vessel.
        orders: Commands of the log, or the sticks of the pilot.
        turning: Turning of the vessel.

    Returns:
        Channel -> line, and the two orders; both empty if the drives are not all fixed, or there
        are no two such orders.
    """
    throttle = [g for g in orders if g.tokens & THROTTLE and not g.tokens & STEERING]
    steering = [g for g in orders if g.tokens & STEERING and not g.tokens & THROTTLE]
    if len(throttle) != 1 or len(steering) != 1:
        return {}, []
    if side_from_tokens(throttle[0].tokens) or side_from_tokens(steering[0].tokens):
        return {}, []
    lines = lines_of_mixer(drives, throttle[0], steering[0], turning)
    return lines, [throttle[0], steering[0]] if lines else []


def lines_of_mixer(
    drives: Sequence[VesselChannel],
    throttle: Classification,
    steering: Classification,
    turning: Turning,
) -> dict[str, str]:
    """Return the lines of fixed drives on both sides for a throttle and a steering order.

    Args:
        drives: Channels of the vessel.
        throttle: Order of the sum of the thrusts.
        steering: Order of their difference; the turning of the vessel shows the sign.
        turning: Turning of the vessel.

    Returns:
        Channel -> line; none if the drives are not fixed on both sides, or the orders no shares.
    """
    levers = [drive.lever for drive in drives if drive.lever is not None]
    if len(levers) < len(drives) or not levers or not min(levers) < 0.0 < max(levers):
        return {}
    full = [_full_order(g) for g in (throttle, steering)]
    if 0.0 in full:
        return {}
    correlation = turning.correlation((steering, 1.0))
    lines = {}
    for drive in drives:
        lines[drive.name] = _mixed_line(drive, throttle, steering, full, correlation)
    return lines


def _full_order(g: Classification) -> float:
    """The number of a full order, 1 or 100, or -1 for pulses; 0 for an order that is no share."""
    if PULSE[0] <= np.nanmin(g.signal.values) and np.nanmax(g.signal.values) <= PULSE[1]:
        return PULSES
    largest = float(np.nanmax(np.abs(g.signal.values)))
    for full in FULL_SHARES:
        if largest <= EXCESS * full:
            return full
    return 0.0


def _mixed_line(
    drive: VesselChannel,
    throttle: Classification,
    steering: Classification,
    full: Sequence[float],
    correlation: float,
) -> str:
    span = max(abs(drive.low), abs(drive.high))
    to_starboard = 1.0
    if correlation < -MIN_CORRELATION:
        to_starboard = -1.0
    sign = ""
    if to_starboard * (drive.lever or 0.0) < 0.0:
        sign = "-"
    terms = [
        _term_of_mixer(throttle, full[0], span, ""),
        _term_of_mixer(steering, full[1], span, sign),
    ]
    return (
        f"{toml_key(drive.name)} = {{ sum = [{', '.join(terms)}], low = {drive.low:g}, high = "
        f"{drive.high:g} }}  # {median_sampling_rate(throttle.signal.t):.3g} Hz; CHECK: "
        f"{throttle.name} and {steering.name} are assumed to be mixed in equal shares of full "
        f"command; sign by the turning of the boat (correlation {correlation:+.2f})"
    )


def _term_of_mixer(g: Classification, full: float, span: float, sign: str) -> str:
    """An order as a share of the largest command of a drive."""
    if full == PULSES:
        low, neutral, high = g.signal.pulse or USUAL_PULSE
        ends = f"low = {low:g}, neutral = {neutral:g}, high = {high:g}"
        most = -span if sign else span
        return f"{{ signal = {toml_value(g.name)}, {ends}, least = {-most:g}, most = {most:g} }}"
    return toml_value(f"{sign}{g.name} * {span / full:.6g}")


def _line(drive: VesselChannel, found: Sequence[Classification], row: Sequence[float]) -> str:
    terms = []
    for g, share in zip(found, row, strict=True):
        if abs(share) > MIN_SHARE:
            sign = "-" if share < 0.0 else ""
            terms.append(toml_value(f"{sign}{g.name} * {abs(share):.6g}"))
    content = f"sum = [{', '.join(terms)}]"
    law = ""
    if drive.coefficients:
        ahead, astern = drive.coefficients
        law = f", coefficient = {ahead:g}, exponent = 2, inverse = true"
        if astern != ahead:
            law = (
                f", coefficient = {ahead:g}, coefficient_below = {astern:g}"
                + law.split(f"{ahead:g}", 1)[1]
            )
    names = " and ".join(g.name for g in found)
    return (
        f"{toml_key(drive.name)} = {{ {content}{law} }}  # "
        f"{median_sampling_rate(found[0].signal.t):.3g} Hz; CHECK: {names} by the vessel's levers "
        "and thrust; add the limits of the program, low and high"
    )
