"""Winds of a log: pairs of speed and direction, with their frame and units."""

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np

from boatsim.recordings.importing.log import Log, Signal
from boatsim.recordings.importing.signal_classification import (
    NOT_MEASURED,
    Classification,
)
from boatsim.recordings.importing.signal_units import stated_speed_unit, unit_word
from boatsim.recordings.importing.signal_words import tokenize_name
from boatsim.recordings.importing.track import Track
from boatsim.recordings.importing.wind_evidence import APPARENT, TRUE, wind_evidence

FRAMES = {
    **dict.fromkeys(("apparent", "aws", "awa", "relative", "rel"), APPARENT),
    **dict.fromkeys(("true", "tws", "twd"), TRUE),
}  # word of a name -> frame
SPEEDS = {"speed", "velocity", "vel", "strength", "aws", "tws", "kn", "m/s", "km/h", "mps", "kmh"}
ANGLES = {"angle", "direction", "dir", "from", "awa", "twd", "deg", "rad", "bearing"}
TO = {"to", "toward", "towards"}  # words of a direction to which the wind goes
WINDS = {"wind", "aws", "awa", "tws", "twd", "anemometer"}
# words of other quantities: a true wind relative to the bow, gusts, forecasts, north and east
OTHER = {"twa", "gust", "forecast", "mean", "x", "y", "north", "east", "chill", "temperature"}
LARGEST_ANGLE = 2.0 * np.pi + 0.3  # [rad] a larger number is in degrees
HALF_TURN = " + 180 * deg"
ASK_UNIT = "the unit of the speed is not stated: add * kn or * kmh unless it is m/s"
ASK_SENSE = (
    "its name says to which direction the wind goes, but the motion of the boat shows from which "
    "it comes"
)
ASK_FRAME = "names and motion do not show whether it is relative to the bow or to north"


class Wind(NamedTuple):
    """A wind of a log.

    Attributes:
        frame: APPARENT, relative to hull and bow; TRUE, over ground and from north; "" unknown.
        speed: Expression of the speed in m/s.
        comes_from: Expression of the direction from which it comes, in rad.
        notes: Assumptions that the owner must check.
        questions: What the log does not show, in words.
    """

    frame: str
    speed: str
    comes_from: str
    notes: Sequence[str]
    questions: Sequence[str]


def winds_of_log(log: Log, track: Track | None, heading: Classification | None) -> list[Wind]:
    """Return the winds of a log, those with known frame and units first.

    Args:
        log: The log.
        track: Motion by the positions; None if unknown.
        heading: The heading; None if unknown.
    """
    found = []
    for speed, angle in _pairs(log.signals):
        found.append(_wind(speed, angle, log, track, heading))
    return sorted(found, key=lambda wind: len(wind.questions))


def _pairs(signals: Mapping[str, Signal]) -> list[tuple[str, str]]:
    """Names of speeds and of the directions that belong to them, by stream and frame."""
    speeds: list[str] = []
    angles: list[str] = []
    for name, signal in signals.items():
        words = tokenize_name(name)
        kind = _kind(words)
        known = signal.values[np.isfinite(signal.values)]
        if not kind or not len(known) or np.ptp(known) == 0.0:
            continue
        (speeds if kind == "speed" else angles).append(name)
    pairs = []
    for speed in speeds:
        alike = [a for a in angles if _frame(a) == _frame(speed)]
        stream = speed.rpartition(".")[0]
        alike.sort(key=lambda angle: angle.rpartition(".")[0] != stream)
        if alike:
            pairs.append((speed, alike[0]))
    return pairs


def _kind(words: Sequence[str]) -> str:
    """Return "speed", "angle" or "" by the words of a name."""
    tokens = set(words)
    if not tokens & WINDS or tokens & (OTHER | NOT_MEASURED):
        return ""
    if {"true", "angle"} <= tokens:
        return ""  # relative to the bow, as TWA
    if tokens & (ANGLES - {"deg", "rad"} | TO):
        return "angle"
    if tokens & SPEEDS:
        return "speed"
    return "angle" if tokens & ANGLES else ""


def _frame(name: str) -> str:
    """The frame that the words of a name state; "" for none."""
    found = {FRAMES[word] for word in tokenize_name(name) if word in FRAMES}
    return found.pop() if len(found) == 1 else ""


def _wind(
    speed: str, angle: str, log: Log, track: Track | None, heading: Classification | None
) -> Wind:
    notes, questions = [], []
    unit, is_stated = stated_speed_unit(speed, log.signals[speed])
    of_angle = unit_word(angle, log.signals[angle])
    if not of_angle and not set(tokenize_name(angle)) & {"rad"}:
        known = log.signals[angle].values
        if float(np.nanmax(np.abs(known))) > LARGEST_ANGLE:
            of_angle = "deg"
        notes.append(f"{'degrees' if of_angle else 'radians'} by the range of the direction")
    of_speed = Classification(speed, log.signals[speed], "speed", unit, 0.0)
    of_direction = Classification(angle, log.signals[angle], "angle", of_angle, 0.0)
    shown = wind_evidence(of_speed, of_direction, track, heading, _frame(speed))
    is_named_to = bool(set(tokenize_name(angle)) & TO)
    if not is_stated:
        if shown.unit is None:
            questions.append(ASK_UNIT)
        else:
            unit = shown.unit
            notes.append(f"speed in {unit or 'm/s'} by the motion of the boat")
    if not shown.frame:
        questions.append(ASK_FRAME)
    elif not _frame(speed):
        notes.append(f"{shown.frame} wind by the motion of the boat")
    if shown.to_port:
        notes.append("sign inverted, for by the motion of the boat it counts to port")
    if is_named_to and shown.unit is not None and not shown.goes_to:
        questions.append(ASK_SENSE)
    elif is_named_to:
        notes.append("half a turn added, for it is the direction to which the wind goes")
    elif shown.goes_to:
        notes.append("half a turn added, for by the motion of the boat the wind goes there")
    sign = "-" if shown.to_port else ""
    direction = sign + angle + (f" * {of_angle}" if of_angle else "")
    if is_named_to or shown.goes_to:
        direction += HALF_TURN
    return Wind(shown.frame, speed + (f" * {unit}" if unit else ""), direction, notes, questions)
