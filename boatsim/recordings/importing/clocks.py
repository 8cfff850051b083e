"""The column of a table that holds the times of its rows, and its conversion to seconds."""

import re
from collections.abc import Collection, Mapping
from typing import NamedTuple

import numpy as np

from boatsim.physics.base import Array
from boatsim.recordings.importing.clock_units import DAY, SECONDS, unit_of_clock, without_unit
from boatsim.recordings.importing.day_counts import day_count
from boatsim.recordings.importing.foreign_words import plain_name, translate_words

# Names of columns that are times; a unit may follow
CLOCK = re.compile(
    r"^(t|time|timestamp|stamp|date_?time|utc|gps_?time|epoch|elapsed|seconds?"
    r"|t_?(vec|vector|out|axis|log|rx|recv|received|sent|unix|utc|gps|pc)"
    r"|time_?(s|ms|us|ns)?)$"
)
YEAR_2000, YEAR_2100 = 946684800.0, 4102444800.0  # [s] since 1970
EPOCH_UNITS = (1.0, 1e-3, 1e-6, 1e-9)  # [s] units in which times since 1970 are counted
TIME_WORDS = {
    *("time", "times", "timestamp", "stamp", "clock", "date", "datetime", "utc", "epoch"),
    *("gpstime", "uptime", "millis", "micros", "zeit", "tid"),
    # seconds of a day or of a week of GPS
    *("hhmmss", "seconds", "secs", "sow", "tow", "itow"),
}
# Words of a time that is not that of the row: a duration, or the time of another row
NOT_NOW = set("previous prev last next cycle delta diff step dt start begin end period up".split())
MIN_TIMES = 20  # fewer values do not show that a column increases as times do
MIN_FORWARD = 0.5  # share of steps forward in a column of times; messages may share a time
MAX_BACKWARD = 0.05  # share of steps back, where rows are out of order
HOUR, MINUTE = 3600.0, 60.0  # [s]
# Numbers hhmmss leap by 40 and a step from 59 s to the next minute
MIN_MINUTE_LEAP = 40.0
# Last word of a column of a part of the time -> kind of the part
CALENDAR = {
    **dict.fromkeys(("year", "years", "yyyy", "yy"), "year"),
    **dict.fromkeys(("month", "months", "mon"), "month"),
    **dict.fromkeys(("day", "days", "dd"), "day"),
    **dict.fromkeys(("hour", "hours", "hh", "hr"), "hour"),
    **dict.fromkeys(("minute", "minutes", "min", "mm", "mi"), "minute"),
    **dict.fromkeys(("second", "seconds", "sec", "secs", "ss"), "second"),
}
CALENDAR_RANGES = {  # lowest number of each part, and the number that it stays below
    **{"year": (0.0, 2101.0), "month": (1.0, 13.0), "day": (1.0, 32.0)},
    **{"hour": (0.0, 24.0), "minute": (0.0, 60.0), "second": (0.0, 60.0)},
}
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

    It is the first column of a usual name whose values increase, or in rows out of order differ.
    Without one it is a column of dates, then one whose name contains a word for time, then one that
    counts since 1970 or in days. Values of these may repeat but hardly ever decrease; the one with
    the most different values is chosen.

    Args:
        columns: Name -> values (N,).
        dates: Names of the columns that were dates or times of day.

    Returns:
        The name; None if there is no such column.
    """
    for name, values in columns.items():
        plain = re.sub(r"[\s.]+", "_", without_unit(name)) or "t"
        finite = values[np.isfinite(values)]
        if CLOCK.match(plain) and len(finite) > 1 and _may_be_times(finite):
            return name
    increasing = {}
    for name, values in columns.items():
        if hardly_decreases(values):
            increasing[name] = values
    for is_likely in (dates.__contains__, is_called_a_time, lambda n: _is_date(increasing[n])):
        names = list(filter(is_likely, increasing))
        if names:
            return max(names, key=lambda n: len(np.unique(increasing[n])))
    return None


def _may_be_times(finite: Array) -> bool:
    """Whether finite values (N,) increase, or are different in most of the rows, out of order."""
    if finite[-1] > finite[0]:
        return True
    return len(finite) >= MIN_TIMES and len(np.unique(finite)) > MIN_FORWARD * len(finite)


def hardly_decreases(values: Array) -> bool:
    """Return whether values (N,) increase as times do, except for a few steps back.

    Rows may be out of order, or a clock is set back, or begins again at midnight.
    """
    finite = values[np.isfinite(values)]
    if len(finite) < MIN_TIMES:
        return False
    steps = np.diff(finite)
    forward = float(np.mean(steps > 0.0))
    return forward >= MIN_FORWARD and float(np.mean(steps < 0.0)) <= MAX_BACKWARD


def is_called_a_time(name: str) -> bool:
    """Return whether the name of a column has a word for the time of its row."""
    words = set(_words(name))
    return bool(words & TIME_WORDS) and not words & NOT_NOW


def _is_date(values: Array) -> bool:
    """Whether values (N,) are times since 1970, in any unit, or days since another epoch."""
    return _is_epoch(values) or day_count(values[np.isfinite(values)]) is not None


def _is_epoch(values: Array) -> bool:
    """Whether values (N,) are times since 1970, in any unit."""
    middle = float(np.nanmedian(values))
    return any(YEAR_2000 < middle * unit < YEAR_2100 for unit in EPOCH_UNITS)


class TimesOfColumns(NamedTuple):
    """Times (N,) [s] of the rows, and the names of the columns from which they follow."""

    t: Array
    names: tuple[str, ...]


def seconds_and_fraction(columns: Mapping[str, Array], clock: str | None) -> TimesOfColumns | None:
    """Return the times of a table that has whole seconds and their fractions in two columns.

    Args:
        columns: Name -> values (N,).
        clock: Column that holds the times by its name; None if no column is one. A fraction is
            added to it if it has whole seconds.

    Returns:
        The times; None if no pair of columns increases as times do.
    """
    of_one_name, of_clock = list[tuple[str, str]](), list[tuple[str, str]]()
    for fraction, values in columns.items():
        words = _words(fraction)
        if not _is_fraction(values, FRACTIONS.get(words[-1], 0.0)):
            continue
        for seconds in columns:
            own = _words(seconds)
            if own[-1] in WHOLE_SECONDS and own[:-1] == words[:-1]:
                of_one_name.append((seconds, fraction))
            elif seconds == clock != fraction and set(words[:-1]) <= TIME_WORDS | set(own):
                of_clock.append((seconds, fraction))
    for seconds, fraction in (*of_one_name, *of_clock):
        whole = times_in_seconds(seconds, columns[seconds])
        known = whole[np.isfinite(whole)]
        if (known != np.round(known)).any():
            continue
        t = whole + FRACTIONS[_words(fraction)[-1]] * columns[fraction]
        if hardly_decreases(t):
            return TimesOfColumns(t, (seconds, fraction))
    return None


def _is_fraction(values: Array, unit: float) -> bool:
    """Whether values (N,) in a unit [s] are fractions of a second; a unit of 0 is none."""
    known = values[np.isfinite(values)]
    return bool(unit and len(known) and known.min() >= 0.0 and known.max() * unit < 1.0)


def calendar_times(columns: Mapping[str, Array]) -> TimesOfColumns | None:
    """Return the times of a table that has hours, minutes and seconds in columns of their own.

    They count from 1970 if the table has year, month and day too, else from midnight.

    Args:
        columns: Name -> values (N,).

    Returns:
        The times; None without such columns, or if these do not increase as times do.
    """
    parts: dict[str, str] = {}
    for name, values in columns.items():
        kind = CALENDAR.get(_words(name)[-1], "")
        known = values[np.isfinite(values)]
        if not kind or kind in parts or not len(known):
            continue
        low, high = CALENDAR_RANGES[kind]
        is_whole = kind == "second" or bool((known == np.round(known)).all())
        if is_whole and known.min() >= low and known.max() < high:
            parts[kind] = name
    if not {"hour", "minute", "second"} <= parts.keys():
        return None
    at = {kind: columns[name] for kind, name in parts.items()}
    t = HOUR * at["hour"] + MINUTE * at["minute"] + at["second"]
    names = list(parts.values())
    fraction = _fraction_of_whole_seconds(columns, at["second"])
    if fraction:
        t = t + FRACTIONS[_words(fraction)[-1]] * columns[fraction]
        names.append(fraction)
    if {"year", "month", "day"} <= parts.keys():
        t = t + DAY * _days_since_1970(at["year"], at["month"], at["day"])
    else:
        t = _after_midnight(t)
    if not _is_in_order(t):
        return None
    return TimesOfColumns(t, tuple(names))


def _is_in_order(t: Array) -> bool:
    """Whether times (N,), of which several rows may share one, hardly ever decrease."""
    finite = t[np.isfinite(t)]
    if len(finite) < MIN_TIMES or not np.ptp(finite) > 0.0:
        return False
    return float(np.mean(np.diff(finite) < 0.0)) <= MAX_BACKWARD


def _fraction_of_whole_seconds(columns: Mapping[str, Array], seconds: Array) -> str:
    """Name of the column of the fractions of whole seconds (N,); "" without one."""
    if (seconds[np.isfinite(seconds)] % 1.0 != 0.0).any():
        return ""
    for name, values in columns.items():
        unit = FRACTIONS.get(_words(name)[-1], 0.0)
        known = values[np.isfinite(values)]
        if unit and len(known) and known.min() >= 0.0 and 0.0 < known.max() * unit < 1.0:
            return name
    return ""


def _days_since_1970(year: Array, month: Array, day: Array) -> Array:
    """Days (N,) since 1970 of dates; nan where a part is missing."""
    known = np.isfinite(year) & np.isfinite(month) & np.isfinite(day)
    days = np.full(len(year), np.nan)
    full = year[known] + np.where(year[known] < 100.0, 2000.0, 0.0)
    months = (full.astype(np.int64) - 1970) * 12 + month[known].astype(np.int64) - 1
    first = months.astype("M8[M]").astype("M8[D]").astype(np.int64)
    days[known] = first + day[known] - 1.0
    return days


def times_of_day_from_digits(values: Array) -> Array | None:
    """Return the seconds since midnight (N,) of times written as the number hhmmss.ss.

    Two signs are needed: all numbers have minutes and seconds below 60, and from minute to minute
    the number leaps by 40 more than the time does. Times go on after midnight.

    Args:
        values: Times (N,) as logged.

    Returns:
        The times; None if the numbers are no such times.
    """
    finite = values[np.isfinite(values)]
    if len(finite) < MIN_TIMES or finite.min() < 0.0 or finite.max() >= 240000.0:
        return None
    if (finite % 100.0 >= 60.0).any() or (finite // 100.0 % 100.0 >= 60.0).any():
        return None
    values = np.where(np.isfinite(values), values, np.nan)
    seconds = HOUR * (values // 10000.0) + MINUTE * (values // 100.0 % 100.0) + values % 100.0
    t = _after_midnight(seconds)
    steps, of_digits = np.diff(t[np.isfinite(t)]), np.diff(finite)
    leaps = of_digits >= MIN_MINUTE_LEAP
    usual = max(2.0 * float(np.median(np.abs(steps))), 1.0)
    if not leaps.any() or float(np.mean(np.abs(steps[leaps]) <= usual)) < MIN_FORWARD:
        return None
    return t


def _after_midnight(t: Array) -> Array:
    """Times of day (N,) [s], which go on after midnight."""
    known = np.isfinite(t)
    back = np.append(0.0, np.diff(t[known])) < -0.5 * DAY
    found = t.copy()
    found[known] += DAY * np.cumsum(back)
    return found


def _words(name: str) -> list[str]:
    """Words of a name in lower case, at least one."""
    parted = re.sub(r"(?<=[a-z])(?=[A-Z])", "_", plain_name(name)).lower()
    return translate_words(re.findall(r"[a-zµ\ufffd]+", parted)) or [""]


def unit_of_counted_times(name: str, values: Array) -> str:
    """Return "ms", "us" or "ns" if times without a unit are counted in it, "" for seconds.

    Two signs are needed: the times are whole numbers, and in seconds the rows would be farther
    apart than those of any recording.

    Args:
        name: Name of the column.
        values: Times (N,).
    """
    finite = values[np.isfinite(values)]
    if len(finite) < MIN_TIMES or unit_of_clock(name) or _is_epoch(finite):
        return ""
    if (finite != np.round(finite)).any() or day_count(finite) is not None:
        return ""
    step = float(np.median(np.diff(finite)))
    if not step > MAX_STEP:
        return ""
    for unit in ("ms", "us", "ns"):
        if MIN_COUNTED_STEP < step * SECONDS[unit] < MAX_STEP:
            return unit
    return ""


def times_in_seconds(name: str, values: Array, unit: str = "") -> Array:
    """Convert the times (N,) of a log to seconds, by their size or by the column's unit.

    Args:
        name: Name of the column, which gives the unit of times that are not since 1970; s by
            default.
        values: Times (N,); the size of times since 1970 shows their unit, and the size and steps
            of days since an epoch show these.
        unit: Unit of the times; by default it is found.
    """
    if unit:
        return values * SECONDS[unit]
    finite = values[np.isfinite(values)]
    middle, step, stated = 0.0, 0.0, unit_of_clock(name)
    if len(finite):
        middle = float(np.median(finite))
    if stated and len(finite) > 1:
        step = float(np.median(np.abs(np.diff(finite))))
    for seconds in EPOCH_UNITS:
        # 3e9 ns since the start are no date in s: the rows would be too far apart
        if YEAR_2000 < middle * seconds < YEAR_2100 and step * seconds <= MAX_STEP:
            return values * seconds
    days = day_count(finite)
    if days is not None:
        return days.seconds(values)
    return values * SECONDS[stated or "s"]
