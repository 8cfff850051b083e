"""Times as logs write them: since the start or since 1970, in s, ms, us or ns, or as dates."""

import re
from collections.abc import Mapping, Sequence
from datetime import UTC, datetime

import numpy as np

from boatsim.physics.base import Array
from boatsim.recordings.expression import UNITS

# names of columns that are times, likeliest first; what follows may be the unit
CLOCK = re.compile(
    r"^(t|time|timestamp|stamp|date_?time|utc|gps_?time|epoch|elapsed|seconds?|time_?(s|ms|us|ns)?)$"
)
ENDING = re.compile(
    r"[\s_.\[(/]*(?<![a-z])(seconds?|secs?|milliseconds?|s|ms|us|µs|ns|usec|msec|nsec)[\])]*$"
)
SPELT = {
    "second": "s",
    "seconds": "s",
    "sec": "s",
    "secs": "s",
    "millisecond": "ms",
    "milliseconds": "ms",
    "msec": "ms",
    "µs": "us",
    "usec": "us",
    "nsec": "ns",
}
YEAR_2000, YEAR_2100 = 946684800.0, 4102444800.0  # [s] since 1970
SINCE_1970 = (
    ("s", 1.0),
    ("ms", 1e-3),
    ("us", 1e-6),
    ("ns", 1e-9),
)  # units in which that may be counted


def clock_of(columns: Mapping[str, Array]) -> str | None:
    """The column that is the time, by its name; None where none is, or where it does not run forward."""
    for name, values in columns.items():
        plain = re.sub(r"[\s.]+", "_", ENDING.sub("", name.lower())) or "t"
        there = values[np.isfinite(values)]
        if CLOCK.match(plain) and len(there) > 1 and there[-1] > there[0]:
            return name
    return None


def seconds(name: str, values: Array) -> Array:
    """A column of times (N,) in s: by the size of times since 1970, else by the unit in its name, else as it is."""
    there = values[np.isfinite(values)]
    middle = float(np.median(there)) if len(there) else 0.0
    for _, unit in SINCE_1970:
        if YEAR_2000 < middle * unit < YEAR_2100:
            return values * unit
    found = ENDING.search(name.lower())
    word = SPELT.get(found[1], found[1]) if found else "s"
    return values * UNITS[word]


def dates(cells: Sequence[str]) -> Array | None:
    """(N,) s since 1970 of dates as ISO 8601 writes them, UTC where no zone is given; None if they are none."""
    found = np.full(len(cells), np.nan)
    for i, cell in enumerate(cells):
        if text := cell.strip():
            try:
                when = datetime.fromisoformat(text)
            except ValueError:
                return None
            found[i] = (when if when.tzinfo else when.replace(tzinfo=UTC)).timestamp()
    return found if np.isfinite(found).any() else None
