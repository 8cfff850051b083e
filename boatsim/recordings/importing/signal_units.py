"""Units of signals by their format, their name or their range."""

from math import pi

import numpy as np

from boatsim.recordings.importing.foreign_words import english_unit
from boatsim.recordings.importing.log import Signal
from boatsim.recordings.importing.signal_words import WORDS, tokenize_name

FULL_CIRCLE = 360.0  # [deg] largest order to a thruster that turns around
MANY_TURNS = 10.0 * FULL_CIRCLE  # [deg] no heading in whole degrees is counted on as far
MAX_WHEEL = 1080.0  # [deg] three turns from the middle; a larger number is no angle of a wheel
SI_SPEEDS = {"m/s", "mps"}
BY_RANGE = "radians by its range"


def has_stated_unit(name: str, signal: Signal) -> bool:
    """Return whether the format or the name of a signal states its unit."""
    words = set(tokenize_name(name))
    return bool(signal.unit or unit_word(name, signal) or words & {"rad", "radps", "rad/s"})


def unit_word(name: str, signal: Signal) -> str:
    """Return the unit as a word of expressions, by the format, else by the name.

    Args:
        name: Name of the signal.
        signal: The signal.
    """
    if signal.unit:
        word = WORDS.get(signal.unit.lower())
        if word is None:
            word = WORDS.get(english_unit(signal.unit), "")
        return word
    words = tokenize_name(name) or [""]
    if "rpm" in words:
        return "rpm"
    return WORDS.get(words[-1], "")


def stated_speed_unit(name: str, signal: Signal) -> tuple[str, bool]:
    """Return the unit of a speed as a word of expressions, and whether format or name state it.

    Args:
        name: Name of the signal.
        signal: The signal.
    """
    word = unit_word(name, signal)
    in_name = bool(set(tokenize_name(name)) & SI_SPEEDS)
    return word, bool(word) or signal.unit.lower() in WORDS or in_name


def unit_of_angle(
    column: str, signal: Signal, tokens: frozenset[str], word: str
) -> tuple[str, str]:
    """Return the unit of an angle or its rate, by the range if unknown, and the assumption.

    Args:
        column: Column of the signal.
        signal: The signal.
        tokens: Words of its name.
        word: Its unit by format or name; "" if unknown.
    """
    if (
        not column.endswith(("_rad", "_radps"))
        or signal.unit
        or word
        or tokens & {"rad", "radps", "rad/s"}
    ):
        return word, ""
    unit, largest = "degps", pi
    if column.endswith("_rad"):
        unit, largest = "deg", 2.0 * pi + 0.3
    if float(np.nanmax(np.abs(signal.values))) > largest:
        if column == "psi_rad" and _is_in_hundredths(signal):
            return "deg * 0.01", "hundredths of degrees by its range and whole numbers"
        return unit, "degrees by its range"
    return word, BY_RANGE


def most_degrees(tokens: frozenset[str]) -> float:
    """Return the largest number that may be an angle of a rudder, thruster or wheel [deg]."""
    if tokens & {"wheel", "azimuth", "azi"}:  # these turn around, and may be counted on
        return MAX_WHEEL
    return 90.0


def _is_in_hundredths(signal: Signal) -> bool:
    """Whether a heading is in 0.01 degrees: whole numbers up to 36000, far beyond a circle."""
    values = signal.values[np.isfinite(signal.values)]
    is_whole = bool((values == np.round(values)).all())
    return is_whole and values.min() >= 0.0 and MANY_TURNS < values.max() <= 100.0 * FULL_CIRCLE
