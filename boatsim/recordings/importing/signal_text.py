"""Texts that the lines of a proposed map and of the list of signals have in common."""

from collections.abc import Sequence

import numpy as np

from boatsim.recordings.importing.log import Signal, median_sampling_rate
from boatsim.recordings.importing.signal_classification import Classification


def sampling_rate(signal: Signal) -> float:
    """Return the rate [Hz] of the values of a signal, without the rows in which it is empty."""
    return median_sampling_rate(np.sort(signal.t[np.isfinite(signal.values)]))


def printable_name(name: str) -> str:
    """Return a name of a log of at most 120 characters, without control characters."""
    safe = ""
    for character in name[:120]:
        if not character.isprintable():
            character = "?"
        safe += character
    return safe


def expression_of(g: Classification) -> str:
    """Return the expression of a signal with its unit, such as `heading * deg`."""
    if not g.word:
        return g.name
    return f"{g.name} * {g.word}"


def is_constant(g: Classification) -> bool:
    """Return whether a signal is constant."""
    return float(np.ptp(g.signal.values[np.isfinite(g.signal.values)])) == 0.0


def unique_names(names: Sequence[str]) -> list[str]:
    """Return the names, numbered where several are equal."""
    found: list[str] = []
    seen: dict[str, int] = {}
    for name in names:
        seen[name] = seen.get(name, 0) + 1
        if names.count(name) > 1:
            stem, separator, unit = name.partition("_rad")
            name = f"{stem}_{seen[name]}{separator}{unit}"
        found.append(name)
    return found
