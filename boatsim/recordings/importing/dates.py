"""Dates and times of day as programs write them, converted to seconds."""

import re
from collections.abc import Callable, Sequence
from datetime import UTC, datetime, timedelta, timezone

import numpy as np

from boatsim.physics.base import Array
from boatsim.recordings.importing.clock_units import DAY

MONTHS = {  # first letters of months in English, German, Nordic, French, Spanish, Italian, Dutch
    **dict.fromkeys(("jan", "ene", "gen", "janv", "januari"), 1),
    **dict.fromkeys(("feb", "fév", "fev", "févr", "febr"), 2),
    **dict.fromkeys(("mar", "mär", "mrz", "mrt", "mars", "märz", "maart"), 3),
    **dict.fromkeys(("apr", "avr", "abr", "avril", "april"), 4),
    **dict.fromkeys(("may", "mai", "maj", "mei", "mag"), 5),
    **dict.fromkeys(("jun", "juin", "giu", "june", "juni"), 6),
    **dict.fromkeys(("jul", "juil", "lug", "july", "juli"), 7),
    **dict.fromkeys(("aug", "août", "aou", "ago", "aoû"), 8),
    **dict.fromkeys(("sep", "sept", "set"), 9),
    **dict.fromkeys(("oct", "okt", "ott"), 10),
    **dict.fromkeys(("nov",), 11),
    **dict.fromkeys(("dec", "des", "dez", "déc", "dic"), 12),
}
CLOCK_OF_DAY = r"(?:(?P<hour>\d{1,2})[:.h](?P<minute>\d{2})(?:[:.m](?P<second>\d{2}))?"
FRACTION = r"(?:[.,:](?P<fraction>\d{1,9}))?)"
ZONE = r"\s*(?P<half>[ap]m)?\s*(?P<zone>z|utc|gmt|[+-]\d{2}:?\d{2})?"
TIME = f"{CLOCK_OF_DAY}{FRACTION}{ZONE}"
YEAR_FIRST = re.compile(
    rf"(?P<year>\d{{4}})[-/._](?P<month>\d{{1,2}})[-/._](?P<day>\d{{1,2}})(?:[t_\s;,-]+{TIME})?",
    re.IGNORECASE,
)
YEAR_LAST = re.compile(
    rf"(?P<first>\d{{1,2}})(?P<mark>[-/.])(?P<other>\d{{1,2}})[-/.](?P<year>\d{{4}}|\d{{2}}(?=\D))"
    rf"(?:[t_\s;,-]+{TIME})?",
    re.IGNORECASE,
)  # a year of two digits is one only before a time of day
NAMED_MONTH = re.compile(
    rf"(?P<day>\d{{1,2}})[.\s-]+(?P<name>[^\W\d_]{{3,9}})\.?[\s-]+(?P<year>\d{{4}})"
    rf"(?:[t_\s;,-]+{TIME})?",
    re.IGNORECASE,
)
MONTH_FIRST = re.compile(
    rf"(?P<name>[^\W\d_]{{3,9}})\.?\s+(?P<day>\d{{1,2}}),?\s+(?P<year>\d{{4}})"
    rf"(?:[t_\s;,-]+{TIME})?",
    re.IGNORECASE,
)  # Apr 23, 2024 12:18:12
YEAR_AT_END = re.compile(
    rf"(?P<name>[^\W\d_]{{3,9}})\s+(?P<day>\d{{1,2}})\s+{TIME}\s+(?P<year>\d{{4}})", re.IGNORECASE
)  # Apr 23 12:18:12 2024, as the C library writes it after the day of the week
DAY_OF_YEAR = re.compile(
    rf"(?P<year>\d{{4}})[-:/ ]?(?P<days>\d{{3}})(?:[t_\s:;,-]+{TIME})?", re.IGNORECASE
)  # 2024-114T12:18:12
DASHED = re.compile(
    r"(\d{4})[-_](\d\d?)[-_](\d\d?)[-_](\d\d?)[-_](\d\d?)[-_](\d\d?)(?:[-_.](\d{1,9}))?"
)
DIGITS = re.compile(r"(\d{4})(\d{2})(\d{2})(\d{2})(\d{2})(\d{2})(?:[.,]?(\d{0,9}))?")
DURATION = re.compile(rf"(?P<days>\d+) days?,?\s+{TIME}", re.IGNORECASE)  # 0 days 00:00:01.5
WEEKDAY = re.compile(
    r"(?:mon|tues?|wed(?:nes)?|thu(?:rs)?|fri|sat(?:ur)?|sun)(?:day)?\.?,?\s+", re.IGNORECASE
)
# CEST, EDT, MESZ; the names are of several zones each, so that none states a difference to UTC
ZONE_NAME = re.compile(r"(?<=\d)\s+(?P<zone>(?!GMT)[A-Z]{2,4}T|MES?Z|BST)(?=$|\s+\d{4}$)")
ENCLOSED = (("[", "]"), ("'", "'"), ('"', '"'))  # signs around the times of some programs
TIME_OF_DAY = re.compile(TIME, re.IGNORECASE)
MINUTES = re.compile(r"(?P<minute>\d{1,3}):(?P<second>\d{2})[.,](?P<fraction>\d{1,9})")
HOUR = 3600.0  # [s]
MAX_DAYS = 366  # of a year
CENTURY = 2000  # of a year of two digits
MIN_DATES = 0.9  # share of the cells with text that are dates, in a column of dates


def seconds_from_dates(cells: Sequence[str]) -> Array | None:
    """Return the times (N,) in s of a column of dates or times of day.

    Dates are in any usual order, with any usual separators and fractions of a second, and count
    from 1970, UTC without a zone. The name of a zone that all cells have, such as CEST, is ignored.
    A year may have two digits if a time of day follows. Times of day count from midnight, go on
    after the next midnight, and need seconds. A day of the week may stand first.

    Args:
        cells: Cells of the column; an empty one becomes nan.

    Returns:
        The times; nan for the few cells that are not dates, None if more than a tenth are not.
    """
    texts = _plain_texts(cells)
    filled = sum(map(bool, texts))
    for read in _readers(texts):
        found = np.full(len(texts), np.nan)
        for i, text in enumerate(texts):
            if text:
                found[i] = read(text)
                if i >= 20 and not np.isfinite(found[: i + 1]).any():
                    break
        known = int(np.isfinite(found).sum())
        if known and known >= MIN_DATES * filled:
            return _continued(found, read)
    return None


def _readers(texts: Sequence[str]) -> list[Callable[[str], float]]:
    """Functions that read a date of each form; nan for any other text."""
    return [
        *(_digits, _iso, _year_first, _year_last(texts), _named_month, _dashed(texts)),
        *(_time_of_day, _minutes, _duration, _day_of_year),
    ]


def zone_name(cells: Sequence[str]) -> str:
    """Return the name of the zone behind all dates of a column, such as CEST; "" without one.

    Args:
        cells: Cells of the column.
    """
    names = set()
    for cell in cells:
        if cell.strip():
            found = ZONE_NAME.search(_without_enclosure(cell.strip()))
            if not found:
                return ""
            names.add(found["zone"])
    if len(names) != 1:
        return ""
    return str(names.pop())


def may_be_digits_of_date(cell: str) -> bool:
    """Return whether a number is a date and a time of day written as YYYYMMDDhhmmss.

    Args:
        cell: Text of the number.
    """
    return bool(np.isfinite(_digits(cell.strip())))


def _plain_texts(cells: Sequence[str]) -> list[str]:
    """Texts of cells without brackets, quotes, days of the week, and zone names that are alike."""
    zone = zone_name(cells)
    texts = []
    for cell in cells:
        text = WEEKDAY.sub("", _without_enclosure(cell.strip()), count=1)
        if zone:
            text = ZONE_NAME.sub("", text)
        texts.append(text)
    return texts


def _without_enclosure(text: str) -> str:
    for begin, end in ENCLOSED:
        if len(text) > 2 and text[0] == begin and text[-1] == end:
            return text[1:-1].strip()
    return text


def _continued(t: Array, read: Callable[[str], float]) -> Array:
    """Times (N,) that go on where a time of day begins again at midnight, or minutes at an hour."""
    turn = float("inf")
    if read is _time_of_day:
        turn = DAY
    elif read is _minutes:
        turn = HOUR
    else:
        return t
    known = np.isfinite(t)
    back = np.append(0.0, np.diff(t[known])) < -0.5 * turn
    t = t.copy()
    t[known] += turn * np.cumsum(back)
    return t


def _iso(text: str) -> float:
    try:
        when = datetime.fromisoformat(text)
    except ValueError:
        return float("nan")
    if text.isdigit():
        return float("nan")  # a number such as 20240423 may be anything
    if not when.tzinfo:
        when = when.replace(tzinfo=UTC)
    return when.timestamp()


def _year_first(text: str) -> float:
    found = YEAR_FIRST.fullmatch(text)
    if not found:
        return float("nan")
    return _seconds(found, int(found["year"]), int(found["month"]), int(found["day"]))


def _year_last(texts: Sequence[str]) -> Callable[[str], float]:
    """Reader of dates that end in the year; the day is first unless the numbers contradict it."""
    pairs = [m for m in map(YEAR_LAST.fullmatch, texts) if m]
    month_first = any(int(m["other"]) > 12 for m in pairs)
    if pairs and pairs[0]["mark"] == "/" and not any(int(m["first"]) > 12 for m in pairs):
        month_first = True  # the form of the United States

    def seconds_from_date(text: str) -> float:
        found = YEAR_LAST.fullmatch(text)
        if not found:
            return float("nan")
        day, month = int(found["first"]), int(found["other"])
        if month_first:
            day, month = month, day
        year = int(found["year"])
        if year < 100:
            year += CENTURY
        return _seconds(found, year, month, day)

    return seconds_from_date


def _named_month(text: str) -> float:
    found = None
    for form in (NAMED_MONTH, MONTH_FIRST, YEAR_AT_END):
        found = found or form.fullmatch(text)
    if not found or not (month := month_number(found["name"])):
        return float("nan")
    return _seconds(found, int(found["year"]), month, int(found["day"]))


def _digits(text: str) -> float:
    found = DIGITS.fullmatch(text)
    if not found or not 2000 <= int(found[1]) < 2100:
        return float("nan")
    return _seconds_of_parts(list(map(int, found.groups()[:6]))) + float(f"0.{found[7] or 0}")


def _dashed(texts: Sequence[str]) -> Callable[[str], float]:
    """Reader of dates such as 2024-04-23-12-18-12-345, whose last number is a fraction.

    Fractions of different lengths are whole numbers of ms, or of us where one is larger.
    """
    fractions = [m[7] for m in map(DASHED.fullmatch, texts) if m and m[7]]
    lengths = set(map(len, fractions))
    counted = 0.0
    if len(lengths) > 1:
        counted = 1e-6
        if max(lengths) <= len("999"):
            counted = 1e-3

    def seconds_from_date(text: str) -> float:
        found = DASHED.fullmatch(text)
        if not found:
            return float("nan")
        fraction = counted * int(found[7] or 0)
        if not counted:
            fraction = float(f"0.{found[7] or 0}")
        return _seconds_of_parts(list(map(int, found.groups()[:6]))) + fraction

    return seconds_from_date


def _seconds_of_parts(parts: Sequence[int]) -> float:
    """Seconds since 1970 of year, month, day, hour, minute and second; nan for no date."""
    year, month, day, hour, minute, second = parts
    try:
        return datetime(year, month, day, hour, minute, second, tzinfo=UTC).timestamp()
    except ValueError:
        return float("nan")


def _duration(text: str) -> float:
    found = DURATION.fullmatch(text)
    if not found or not found["second"]:
        return float("nan")
    return DAY * int(found["days"]) + _seconds(found, 1970, 1, 1)


def _day_of_year(text: str) -> float:
    found = DAY_OF_YEAR.fullmatch(text)
    if not found or not found["second"] or not 1 <= int(found["days"]) <= MAX_DAYS:
        return float("nan")
    return DAY * (int(found["days"]) - 1) + _seconds(found, int(found["year"]), 1, 1)


def _time_of_day(text: str) -> float:
    found = TIME_OF_DAY.fullmatch(text)
    if not found or not found["second"] or ":" not in text:
        return float("nan")
    return _seconds(found, 1970, 1, 1)


def _minutes(text: str) -> float:
    found = MINUTES.fullmatch(text)
    if not found:
        return float("nan")
    return 60.0 * int(found["minute"]) + float(f"{found['second']}.{found['fraction']}")


def _seconds(found: "re.Match[str]", year: int, month: int, day: int) -> float:
    """Seconds since 1970 of a date with the time of day that its text has."""
    part = found.groupdict()
    hour = int(part["hour"] or 0)
    if part["half"]:
        hour = hour % 12 + 12 * (part["half"].lower() == "pm")
    zone = UTC
    if part["zone"] and part["zone"][0] in "+-":
        digits = part["zone"][1:].replace(":", "")
        ahead = timedelta(hours=int(digits[:2]), minutes=int(digits[2:]))
        zone = timezone(ahead if part["zone"][0] == "+" else -ahead)
    minute, second = int(part["minute"] or 0), int(part["second"] or 0)
    try:
        when = datetime(year, month, day, hour, minute, second, tzinfo=zone)
    except ValueError:
        return float("nan")
    return when.timestamp() + float(f"0.{part['fraction'] or 0}")


def month_number(name: str) -> int:
    """Return the number of a month by its name or abbreviation in several languages; 0 for none."""
    word = name.lower().rstrip(".")
    return MONTHS.get(word, MONTHS.get(word[:3], 0))
