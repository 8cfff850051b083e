"""Conversion of times in logs to seconds, from numbers or dates."""

import re
from collections.abc import Mapping, Sequence
from datetime import UTC, datetime

import numpy as np

from boatsim.physics.base import Array
from boatsim.recordings.expression import UNITS

# Names of columns that are times; a unit may follow
CLOCK = re.compile(
    r"^(t|time|timestamp|stamp|date_?time|utc|gps_?time|epoch|elapsed|seconds?"
    r"|t_?(vec|vector|out|axis|log)"
    r"|time_?(s|ms|us|ns)?)$"
)
ENDING = re.compile(
    r"[\s_.\[(/]*(?<![a-z])(seconds?|secs?|milliseconds?|s|ms|us|µs|ns|usec|msec|nsec)[\])]*$"
)
UNIT_WORDS = {
    **dict.fromkeys(("second", "seconds", "sec", "secs"), "s"),
    **dict.fromkeys(("millisecond", "milliseconds", "msec"), "ms"),
    **dict.fromkeys(("µs", "usec"), "us"),
    "nsec": "ns",
}
YEAR_2000, YEAR_2100 = 946684800.0, 4102444800.0  # [s] since 1970
EPOCH_UNITS = (1.0, 1e-3, 1e-6, 1e-9)  # [s] units in which times since 1970 are counted


def time_column(columns: Mapping[str, Array]) -> str | None:
    """Return the name of the time column by the names.

    None if there is none whose values increase.
    """
    for name, values in columns.items():
        plain = re.sub(r"[\s.]+", "_", ENDING.sub("", name.lower())) or "t"
        finite = values[np.isfinite(values)]
        if CLOCK.match(plain) and len(finite) > 1 and finite[-1] > finite[0]:
            return name
    return None


def times_in_seconds(name: str, values: Array) -> Array:
    """Return times (N,) in s.

    Args:
        name: Name of the column, which gives the unit of times that are not since 1970; s by
            default.
        values: Times (N,); the size of times since 1970 shows their unit.
    """
    finite = values[np.isfinite(values)]
    middle = 0.0
    if len(finite):
        middle = float(np.median(finite))
    for unit in EPOCH_UNITS:
        if YEAR_2000 < middle * unit < YEAR_2100:
            return values * unit
    word = "s"
    if found := ENDING.search(name.lower()):
        word = UNIT_WORDS.get(found[1], found[1])
    return values * UNITS[word]


def seconds_from_dates(cells: Sequence[str]) -> Array | None:
    """Return the times (N,) [s] since 1970 of ISO 8601 dates, UTC without a zone.

    None if some cells are not dates.
    """
    found = np.full(len(cells), np.nan)
    for i, cell in enumerate(cells):
        if text := cell.strip():
            try:
                when = datetime.fromisoformat(text)
            except ValueError:
                return None
            if not when.tzinfo:
                when = when.replace(tzinfo=UTC)
            found[i] = when.timestamp()
    if np.isfinite(found).any():
        return found
    return None
