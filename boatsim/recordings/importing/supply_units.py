"""Units of measured voltages and electric currents: by the format, the name or the size."""

import re
from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from boatsim.physics.base import Array
from boatsim.recordings.importing.log import Signal


class SmallerUnit(NamedTuple):
    """A unit in which a log may state a voltage or a current.

    Attributes:
        factor: Factor to V or A.
        least: Whole numbers that exceed the nominal value by this factor are in this unit; an
            infinite one if numbers do not show it.
    """

    factor: float
    least: float = np.inf


def stated_unit(name: str, signal: Signal, units: Mapping[str, SmallerUnit]) -> str:
    """Return the unit by the format or the end of the name; "" if none is stated.

    Args:
        name: Name of the signal.
        signal: The signal.
        units: Unit -> how it is known.
    """
    if signal.unit in units:
        return signal.unit
    found = re.search(rf"(?<![A-Za-z])({'|'.join(units)})\W*$", name)
    return found[1] if found else ""


def factor_and_note(
    name: str, signal: Signal, units: Mapping[str, SmallerUnit], nominal: float
) -> tuple[str, str]:
    """Return the factor to V or A as the end of an expression, and what the owner must check.

    A unit that the log does not state is found by two signs, whole numbers and their size.

    Args:
        name: Name of the signal.
        signal: The signal; at least one value is known.
        units: Unit -> how it is known, the largest unit first.
        nominal: Nominal value in V or A; 0 if unknown.

    Returns:
        The factor, such as " * 0.001", "" for 1; the note, "" for nothing.
    """
    unit = stated_unit(name, signal, units)
    reason = "its name"
    if not unit:
        unit = _unit_by_size(signal.values[np.isfinite(signal.values)], units, nominal)
        reason = "whole numbers of this size"
    if not unit or units[unit].factor == 1.0:
        return "", ""
    note = ""
    if signal.unit != unit:
        note = f"in {unit} by {reason}"
    return f" * {units[unit].factor:g}", note


def _unit_by_size(values: Array, units: Mapping[str, SmallerUnit], nominal: float) -> str:
    """The unit of whole numbers far beyond the nominal value; "" for V or A."""
    is_whole = bool((values == np.round(values)).all())
    if not is_whole or nominal <= 0.0:
        return ""
    usual = float(np.percentile(np.abs(values), 90))
    unit = ""
    for smaller, known in units.items():
        if usual > known.least * nominal:
            unit = smaller
    return unit
