"""Unit of the times of a table by the name of their column, such as `Time [min]` or `time_ms`."""

import re

from boatsim.recordings.expression import UNITS

DAY = 86400.0  # [s]
# Units of a word that is not part of another word; t, s and ms may be the whole name
SHORT = re.compile(
    r"[\s_.\[(/]*(?<![a-z])(seconds?|secs?|milliseconds?|millis|micros|s|ms|us|µs|ns|usec|msec"
    r"|nsec|microseconds?|nanoseconds?)[\])]*$"
)
# A column `min` or `day` alone is a part of a date, and a time of day has any unit; after another
# word these are units
LONG = re.compile(
    r"(?<=[\w\s])(?<!of)[\s_.\[(/]+(minutes?|mins?|hours?|hrs?|h|days?|(?<=[\[(])d)[\])]*$"
)
UNIT_WORDS = {
    **dict.fromkeys(("second", "seconds", "sec", "secs"), "s"),
    **dict.fromkeys(("millisecond", "milliseconds", "millis", "msec"), "ms"),
    **dict.fromkeys(("µs", "usec", "micros", "microsecond", "microseconds"), "us"),
    **dict.fromkeys(("nsec", "nanosecond", "nanoseconds"), "ns"),
    **dict.fromkeys(("minute", "minutes", "mins"), "min"),
    **dict.fromkeys(("hour", "hours", "hr", "hrs"), "h"),
    **dict.fromkeys(("day", "days"), "d"),
}
SECONDS = {"d": DAY, **UNITS}  # unit -> [s]


def unit_of_clock(name: str) -> str:
    """Return the unit at the end of a column's name: s, ms, us, ns, min, h or d; "" without one.

    Args:
        name: Name of a column of times.
    """
    found = SHORT.search(name.lower()) or LONG.search(name.lower())
    if not found:
        return ""
    return UNIT_WORDS.get(found[1], found[1])


def without_unit(name: str) -> str:
    """Return the name of a column of times in lower case, without the unit at its end.

    Args:
        name: The name.
    """
    return LONG.sub("", SHORT.sub("", name.lower()))


def with_unit(name: str, unit: str) -> str:
    """Return the name of a column with the unit that stands elsewhere, if the name has none.

    Args:
        name: Name of the column.
        unit: Unit of the row below the header or behind every number; without one of a time the
            name stays unchanged.
    """
    if unit_of_clock(name) or not unit_of_clock(f"t [{unit}]"):
        return name
    return f"{name} [{unit}]"
