"""Corrections of the classification of signals by what several signals show of one motion.

Single names and ranges are ambiguous: N may be revolutions or the way north, and 0.5 may be a yaw
rate in degrees or in radians per second. The signals of one log tell it together: the way north and
east changes as fast as the vessel moves, and the yaw rate is the change of the heading.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from boatsim.physics.base import Array
from boatsim.recordings.expression import UNITS, parse
from boatsim.recordings.importing.heading_evidence import heading_by_course, rate_by_heading
from boatsim.recordings.importing.log import Log, Signal
from boatsim.recordings.importing.signal_classification import ANGLES, Classification
from boatsim.recordings.importing.signal_units import has_stated_unit
from boatsim.recordings.importing.signal_words import tokenize_name
from boatsim.recordings.importing.track import track_of

NORTH, EAST = "n", "e"  # names of two columns that may be a position
RATE_OF = {"r_radps": "psi_rad", "p_radps": "phi_rad", "q_radps": "theta_rad"}
TURNED = ("phi_rad", "theta_rad", "p_radps", "q_radps", "r_radps")
WINDOWS = (64, 16, 4)  # parts of a log over which changes are compared, from short to long
MIN_CORRELATION = 0.8  # of the changes of two signals that show one motion
TOLERANCE = 1.5  # factor between both sizes; units differ by 57
MIN_SAMPLES = 20


def correct_classification_by_motion(
    found: Sequence[Classification], log: Log
) -> list[Classification]:
    """Return the classification of the signals of a log, corrected by what they show together.

    Args:
        found: Classification of single signals by name, unit and range.
        log: The log.

    Returns:
        The same with a position of signals called N and E, if these move as the vessel does, and
        with the units of angles and rates that neither format nor name states.
    """
    best: dict[str, Classification] = {}
    for g in found:
        if g.column not in best or g.score > best[g.column].score:
            best[g.column] = g
    corrected = list(found)
    if "x_m" not in best and "y_m" not in best and "latitude" not in best:
        corrected = _with_north_and_east(corrected, log, best)
    if best.get("psi_rad") is None:
        return corrected
    if not log.frame:
        corrected = _with_heading_by_course(corrected)
        best |= {"psi_rad": _best_of(corrected, "psi_rad")[0]}
    heading = best["psi_rad"]
    corrected = [_with_unit(g, heading, best) for g in corrected]
    if log.frame:
        return corrected
    turned = []
    for g in corrected:
        turned.append(rate_by_heading(g, heading) if g.column == "r_radps" else g)
    return turned


def _best_of(found: Sequence[Classification], column: str) -> list[Classification]:
    """The classified signals of a column, the highest score first."""
    return sorted((g for g in found if g.column == column), key=lambda g: -g.score)


def _with_heading_by_course(found: Sequence[Classification]) -> list[Classification]:
    """The classification with the unit and the sense of headings that the track shows."""
    places = {}
    for column in ("latitude", "longitude", "x_m", "y_m"):
        places[column] = _best_of(found, column)
    track = track_of(places)
    corrected = []
    for g in found:
        corrected.append(heading_by_course(g, track) if g.column == "psi_rad" else g)
    return corrected


def _with_north_and_east(
    found: list[Classification], log: Log, best: Mapping[str, Classification]
) -> list[Classification]:
    """The classification with signals called N and E as a position, if the motion confirms it."""
    for name, north in log.signals.items():
        stream = name.rpartition(".")[0]
        if tokenize_name(name.rpartition(".")[2]) != [NORTH]:
            continue
        for other, east in log.signals.items():
            same = other.rpartition(".")[0] == stream and len(east.t) == len(north.t)
            if not same or tokenize_name(other.rpartition(".")[2]) != [EAST]:
                continue
            why = _motion_of_pair(north, east, best)
            if why:
                others = [g for g in found if g.name not in (name, other)]
                pair = [
                    Classification(name, north, "x_m", "", 10.0, why, frozenset((NORTH,))),
                    Classification(other, east, "y_m", "", 10.0, why, frozenset((EAST,))),
                ]
                return [*others, *pair]
    return found


def _motion_of_pair(north: Signal, east: Signal, best: Mapping[str, Classification]) -> str:
    """How the motion confirms that two signals are a position, in words; "" if it does not."""
    forward, heading = best.get("u_mps"), best.get("psi_rad")
    t, x, y = _common(north, east)
    if len(t) < MIN_SAMPLES:
        return ""
    rows = max(1, len(t) // WINDOWS[0])
    if forward is not None:
        known = np.isfinite(forward.signal.values)
        speed = np.interp(t, forward.signal.t[known], np.abs(_in_si(forward)[known]))
        travelled = (0.5 * (speed[rows:] + speed[:-rows])) * (t[rows:] - t[:-rows])
        moved = np.hypot(x[rows:] - x[:-rows], y[rows:] - y[:-rows])
        usual = float(np.sum(travelled))
        if usual > 0.0 and 1.0 / TOLERANCE < float(np.sum(moved)) / usual < TOLERANCE:
            return f"north: N and E change as fast as {forward.name}"
    if heading is not None:
        course = np.arctan2(y[rows:] - y[:-rows], x[rows:] - x[:-rows])
        known = np.isfinite(heading.signal.values)
        bow = np.interp(
            t[: len(course)], heading.signal.t[known], np.unwrap(_in_si(heading)[known])
        )
        agree = float(np.abs(np.mean(np.exp(1j * (course - bow)))))
        spread = float(np.abs(np.mean(np.exp(1j * bow))))
        if agree > 0.9 and spread < 0.9:
            return f"north: N and E change in the direction of {heading.name}"
    return ""


def _common(north: Signal, east: Signal) -> tuple[Array, Array, Array]:
    """Times and values at which both signals are finite and the time increases."""
    known = np.isfinite(north.values) & np.isfinite(east.values) & np.isfinite(north.t)
    return north.t[known], north.values[known], east.values[known]


def _in_si(g: Classification) -> Array:
    """Values (N,) of a signal in the unit of its column."""
    if g.word:
        return parse(f"x * {g.word}", ()).convert(g.signal.values)
    return g.signal.values


def _with_unit(
    g: Classification, heading: Classification, best: Mapping[str, Classification]
) -> Classification:
    """A classification with the unit that the motion or the heading of the log shows."""
    if has_stated_unit(g.name, g.signal):
        return g
    degrees = "deg"
    if g.column.endswith("_radps"):
        degrees = "degps"
    angle = best.get(RATE_OF.get(g.column, ""))
    if angle is not None:
        ratio = _ratio_of_changes(angle, g.signal)
        for word, factor, unit in _units_of(degrees):
            if 1.0 / TOLERANCE < ratio / factor < TOLERANCE:
                return replace(g, word=word, why=f"{unit} by the changes of {angle.name}")
    in_degrees = heading.word.startswith("deg")
    is_helm = g.column == "command" and bool(g.tokens & ANGLES)
    if in_degrees and not g.word and (g.column in TURNED or is_helm):
        return replace(g, word=degrees, why=f"CHECK: degrees as {heading.name}")
    return g


def _units_of(degrees: str) -> list[tuple[str, float, str]]:
    """Units that an angle or a rate without a unit may have: word, factor to SI, and name."""
    units = [(degrees, UNITS["deg"], "degrees"), ("", 1.0, "radians")]
    if degrees == "degps":
        units.append(("degpmin", UNITS["degpmin"], "degrees per minute"))
    return units


def _ratio_of_changes(angle: Classification, rate: Signal) -> float:
    """Changes of an angle [rad] over those of the integral of a signal; nan if unrelated."""
    known = np.isfinite(rate.values) & np.isfinite(rate.t)
    t, values = rate.t[known], rate.values[known]
    valid = np.isfinite(angle.signal.values) & np.isfinite(angle.signal.t)
    if len(t) < MIN_SAMPLES or valid.sum() < MIN_SAMPLES:
        return float("nan")
    integral = np.concatenate(([0.0], np.cumsum(0.5 * (values[1:] + values[:-1]) * np.diff(t))))
    turned = np.interp(t, angle.signal.t[valid], np.unwrap(_in_si(angle)[valid]))
    for parts in WINDOWS:
        rows = max(1, len(t) // parts)
        a, b = integral[rows:] - integral[:-rows], turned[rows:] - turned[:-rows]
        size = float(np.sqrt((a @ a) * (b @ b)))
        if size > 0.0 and float(a @ b) > MIN_CORRELATION * size:
            return float(np.sqrt((b @ b) / (a @ a)))
    return float("nan")
