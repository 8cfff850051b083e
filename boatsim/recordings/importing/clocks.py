"""The column of a table that holds the times of its rows, and its conversion to seconds."""

import re
from collections.abc import Collection, Mapping
from typing import NamedTuple

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
    r"[\s_.\[(/]*(?<![a-z])(seconds?|secs?|milliseconds?|millis|micros|s|ms|us|µs|ns|usec|msec"
    r"|nsec)[\])]*$"
)
UNIT_WORDS = {
    **dict.fromkeys(("second", "seconds", "sec", "secs"), "s"),
    **dict.fromkeys(("millisecond", "milliseconds", "millis", "msec"), "ms"),
    **dict.fromkeys(("µs", "usec", "micros"), "us"),
    "nsec": "ns",
}
YEAR_2000, YEAR_2100 = 946684800.0, 4102444800.0  # [s] since 1970
EPOCH_UNITS = (1.0, 1e-3, 1e-6, 1e-9)  # [s] units in which times since 1970 are counted
TIME_WORDS = {
    *("time", "times", "timestamp", "stamp", "clock", "date", "datetime", "utc", "epoch"),
    *("gpstime", "uptime", "millis", "micros", "zeit", "tid"),
}
# Words of a time that is not that of the row: a duration, or the time of another row
NOT_NOW = set("previous prev last next cycle delta diff step dt start begin end period up".split())
MIN_TIMES = 20  # fewer values do not show that a column increases as times do
MIN_FORWARD = 0.5  # share of steps forward in a column of times; messages may share a time
MAX_BACKWARD = 0.05  # share of steps back, where rows are out of order
# Spreadsheets count days since 1899-12-30; these are the years 2000 to 2100
SHEET_DAYS = (36526.0, 73051.0)
SHEET_EPOCH = 25569.0  # [days] 1970-01-01
# [days] A larger median step between rows, 43 s, is of no log; seconds have larger steps than this
MAX_SHEET_STEP = 5e-4
DAY = 86400.0  # [s]
# Last word of a column of whole seconds -> none; of its fraction -> unit [s]
WHOLE_SECONDS = {"s", "sec", "secs", "second", "seconds"}
FRACTIONS = {
    **dict.fromkeys(("ns", "nsec", "nsecs", "nanosec", "nanosecs", "nanoseconds"), 1e-9),
    **dict.fromkeys(("us", "usec", "usecs", "micros", "microseconds"), 1e-6),
    **dict.fromkeys(("ms", "msec", "msecs", "millis", "milliseconds"), 1e-3),
}
# [s] between rows: no recording has larger steps, see `recordings.table.MAX_GAP`
MAX_STEP = 60.0
MIN_COUNTED_STEP = 0.002  # [s] of rows whose times are counted in a smaller unit; 500 Hz


def time_column(columns: Mapping[str, Array], dates: Collection[str] = ()) -> str | None:
    """Return the name of the column of a table that holds the times of its rows.

    It is the first column of a usual name whose values increase. Without one it is a column of
    dates, then one whose name contains a word for time, then one that counts since 1970. Values of
    these may repeat but hardly ever decrease; the one with the most different values is chosen.

    Args:
        columns: Name -> values (N,).
        dates: Names of the columns that were dates or times of day.

    Returns:
        The name; None if there is no such column.
    """
    for name, values in columns.items():
        plain = re.sub(r"[\s.]+", "_", ENDING.sub("", name.lower())) or "t"
        finite = values[np.isfinite(values)]
        if CLOCK.match(plain) and len(finite) > 1 and finite[-1] > finite[0]:
            return name
    increasing = {}
    for name, values in columns.items():
        if _hardly_decreases(values):
            increasing[name] = values
    for is_likely in (dates.__contains__, _is_called_a_time, lambda n: _is_epoch(increasing[n])):
        names = list(filter(is_likely, increasing))
        if names:
            return max(names, key=lambda n: len(np.unique(increasing[n])))
    return None


def _hardly_decreases(values: Array) -> bool:
    """Whether values (N,) increase as times do, except for a few rows out of order."""
    finite = values[np.isfinite(values)]
    if len(finite) < MIN_TIMES or not finite[-1] > finite[0]:
        return False
    steps = np.diff(finite)
    forward = float(np.mean(steps > 0.0))
    return forward >= MIN_FORWARD and float(np.mean(steps < 0.0)) <= MAX_BACKWARD


def _is_called_a_time(name: str) -> bool:
    words = set(re.split(r"[^a-z]+", re.sub(r"(?<=[a-z])(?=[A-Z])", "_", name).lower()))
    return bool(words & TIME_WORDS) and not words & NOT_NOW


def _is_epoch(values: Array) -> bool:
    """Whether values (N,) are times since 1970, in any unit."""
    middle = float(np.nanmedian(values))
    return any(YEAR_2000 < middle * unit < YEAR_2100 for unit in EPOCH_UNITS)


class TimeParts(NamedTuple):
    """Times (N,) [s] from a column of whole seconds and a column of their fractions."""

    t: Array
    seconds: str
    fraction: str


def seconds_and_fraction(columns: Mapping[str, Array], clock: str | None) -> TimeParts | None:
    """Return the times of a table that has whole seconds and their fractions in two columns.

    Args:
        columns: Name -> values (N,).
        clock: Column that holds the times by its name; None if no column is one. A fraction is
            added to it if it has whole seconds.

    Returns:
        The times; None if no pair of columns increases as times do.
    """
    for fraction, of_fraction in columns.items():
        words = _words(fraction)
        unit = FRACTIONS.get(words[-1], 0.0)
        known = of_fraction[np.isfinite(of_fraction)]
        if not unit or not len(known) or known.min() < 0.0 or known.max() * unit >= 1.0:
            continue
        for seconds, values in columns.items():
            is_pair = seconds == clock
            own = _words(seconds)
            if own[-1] in WHOLE_SECONDS and own[:-1] == words[:-1]:
                is_pair = True
            whole = values[np.isfinite(values)]
            if not is_pair or seconds == fraction or (whole != np.round(whole)).any():
                continue
            t = times_in_seconds(seconds, values) + unit * of_fraction
            if _hardly_decreases(t):
                return TimeParts(t, seconds, fraction)
    return None


def _words(name: str) -> list[str]:
    """Words of a name in lower case, at least one."""
    return re.findall(r"[a-zµ]+", re.sub(r"(?<=[a-z])(?=[A-Z])", "_", name).lower()) or [""]


def unit_of_counted_times(name: str, values: Array) -> str:
    """Return "ms", "us" or "ns" if times without a unit are counted in it, "" for seconds.

    Two signs are needed: the times are whole numbers, and in seconds the rows would be farther
    apart than those of any recording.

    Args:
        name: Name of the column.
        values: Times (N,).
    """
    finite = values[np.isfinite(values)]
    if len(finite) < MIN_TIMES or ENDING.search(name.lower()) or _is_epoch(finite):
        return ""
    if (finite != np.round(finite)).any() or _are_sheet_days(finite):
        return ""
    step = float(np.median(np.diff(finite)))
    if not step > MAX_STEP:
        return ""
    for unit in ("ms", "us", "ns"):
        if MIN_COUNTED_STEP < step * UNITS[unit] < MAX_STEP:
            return unit
    return ""


def times_in_seconds(name: str, values: Array, unit: str = "") -> Array:
    """Convert the times (N,) of a log to seconds, by their size or by the column's unit.

    Args:
        name: Name of the column, which gives the unit of times that are not since 1970; s by
            default.
        values: Times (N,); the size of times since 1970 shows their unit, and the size and steps
            of a spreadsheet's days show these.
        unit: Unit of the times; by default it is found.
    """
    if unit:
        return values * UNITS[unit]
    finite = values[np.isfinite(values)]
    middle = 0.0
    if len(finite):
        middle = float(np.median(finite))
    for seconds in EPOCH_UNITS:
        if YEAR_2000 < middle * seconds < YEAR_2100:
            return values * seconds
    if _are_sheet_days(finite):
        return (values - SHEET_EPOCH) * DAY
    word = "s"
    if found := ENDING.search(name.lower()):
        word = UNIT_WORDS.get(found[1], found[1])
    return values * UNITS[word]


def _are_sheet_days(t: Array) -> bool:
    """Whether finite times (N,) are days as spreadsheets count them."""
    if len(t) < 2 or not (SHEET_DAYS[0] < t.min() and t.max() < SHEET_DAYS[1]):
        return False
    step = float(np.median(np.abs(np.diff(t))))
    return 0.0 < step < MAX_SHEET_STEP
