"""Reader of NMEA 0183: sentences of instruments.

The time of day of one holds for the sentences after it.
"""

import re
from collections.abc import Callable
from datetime import UTC, date, datetime, time
from math import isfinite
from pathlib import Path
from typing import Any

import numpy as np

from boatsim.physics.base import Array
from boatsim.recordings.expression import UNITS
from boatsim.recordings.importing.log import (
    MAX_TEXT_BYTES,
    Log,
    MemoryBudget,
    Signal,
    missing_library_error,
)
from boatsim.recordings.raw_table import file_error

SUFFIXES = (".nmea", ".0183", ".txt", ".log")
# Sentence -> signal -> attribute of the library and unit
FIELDS: dict[str, dict[str, tuple[str, str]]] = {
    "GGA": {
        "latitude": ("latitude", "deg"),
        "longitude": ("longitude", "deg"),
        "quality": ("gps_qual", ""),
    },
    "GLL": {"latitude": ("latitude", "deg"), "longitude": ("longitude", "deg")},
    "RMC": {
        "latitude": ("latitude", "deg"),
        "longitude": ("longitude", "deg"),
        "speed": ("spd_over_grnd", "kn"),
        "course": ("true_course", "deg"),
    },
    "VTG": {"course": ("true_track", "deg"), "speed": ("spd_over_grnd_kts", "kn")},
    "HDT": {"heading": ("heading", "deg")},
    "HDM": {"heading_magnetic": ("heading", "deg")},
    "HDG": {"heading_magnetic": ("heading", "deg")},
    "ROT": {"yaw_rate": ("rate_of_turn", "deg/min")},
    "RSA": {"rudder_starboard": ("rsa_starboard", "deg"), "rudder_port": ("rsa_port", "deg")},
    "RPM": {"shaft": ("speed", "rpm")},
    "VHW": {"speed_water": ("water_speed_knots", "kn")},
    "VBW": {"speed_water": ("lon_water_spd", "kn")},
    "MWD": {
        "true_wind_direction": ("direction_true", "deg"),
        "true_wind_speed": ("wind_speed_meters", "m/s"),
    },
    "MWV": {  # the reference of a sentence selects two of them
        "apparent_wind_angle": ("wind_angle", "deg"),
        "apparent_wind_speed": ("wind_speed", "m/s"),
        "true_wind_angle": ("wind_angle", "deg"),
        "true_wind_speed": ("wind_speed", "m/s"),
    },
    "ZDA": {},  # date, and the time if no fix has one
}
NUMBERED = {"RPM": "engine_no"}  # sentence -> attribute with the number of the device
DATE_ONLY = "ZDA"  # its time is that of a fix and may be sent after the next one
VALID = "data_validity_water_spd"
STATUS = {
    "RMC": "status",
    "GLL": "status",
    "MWV": "status",
    "VBW": VALID,
}  # "A" where the values are valid
REFERENCES = {"R": "apparent", "T": "true"}  # of MWV -> first word of its signals
WIND_UNITS = {"K": UNITS["kmh"], "N": UNITS["kn"], "M": 1.0, "S": UNITS["mph"]}  # -> m/s
SENTENCE = re.compile(r"[$!][A-Za-z]{1,5}[\w]*,[^\r\n]*")
# Time of the logger: s or ms since 1970
STAMP = re.compile(r"(?:^|[\s,;\\]|c:)(\d{9,13}(?:\.\d+)?)(?=[\s,;*\\])")
DAY = 86400.0  # [s]


def read(path: Path) -> Log:
    """Return the numbers of sentences about motion and drives: `RMC.latitude`, `HDT.heading`.

    Raises BadInput.
    """
    try:
        import pynmea2
    except ImportError as error:
        raise missing_library_error(path, "pynmea2", "nmea") from error
    if path.stat().st_size > MAX_TEXT_BYTES:
        raise file_error(
            path,
            f"has {path.stat().st_size:,} bytes; at most {MAX_TEXT_BYTES:,} of text are read: "
            "cut the log",
        )
    lines = path.read_bytes().decode("ascii", "replace").splitlines()
    kept, bad = _sentences(path, lines, pynmea2.parse)
    if not kept:
        raise file_error(
            path, "has no NMEA 0183 sentence that can be read; if it is a table, call it .csv"
        )
    t, counted = _times(kept)
    remarks = []
    if bad:
        remarks.append(
            f"{path}: {bad} of {len(lines)} lines are no whole sentences and are left out"
        )
    if counted is None:
        raise file_error(
            path,
            "no sentence has a time (GGA, RMC, GLL, ZDA, or a logger's stamp in front); a time "
            "is needed",
        )
    if counted:
        remarks.append(
            f"{path}: {counted} of {len(t)} sentences have no time; each has the time of the "
            "last sentence "
            "with one, several of one name are spread evenly"
        )
    return Log(path, _signals(kept, t), "NED", tuple(remarks))


def _sentences(
    path: Path, lines: list[str], parse: "Callable[..., Any]"
) -> tuple[list[tuple[float | None, str, dict[str, float]]], int]:
    """Time or None, name and numbers of every sentence, and the number of other lines."""
    found: list[tuple[float | None, str, dict[str, float]]] = []
    room, bad = MemoryBudget(path), 0
    stamped, clock = any(_logger_time(line) is not None for line in lines[:50]), _Clock()
    for line in lines:
        sentence = _parse_line(line, parse)
        if sentence is None:
            bad += bool(line.strip())
            continue
        name = getattr(sentence, "sentence_type", "")
        if name not in FIELDS:
            continue
        if stamped:
            when = _logger_time(line)
        else:
            when = clock.read(sentence)
        valid = name not in STATUS or getattr(sentence, STATUS[name], "A") == "A"
        numbers: dict[str, float] = {}
        if valid:
            for signal, (attribute, _) in FIELDS[name].items():
                numbers[signal] = _float(sentence, attribute)
            if name == "MWV":
                numbers = _wind_numbers(sentence, numbers)
            elif name == "MWD":
                numbers = _with_wind_in_knots(sentence, numbers)
        room.count_values(len(numbers) + 1)
        if name in NUMBERED:
            name += f"[{_float(sentence, NUMBERED[name]):.0f}]"
        found.append((when, name, numbers))
    if any(when is not None and name != DATE_ONLY for when, name, _ in found):
        found = [kept for kept in found if kept[1] != DATE_ONLY]
    for i, (when, name, numbers) in enumerate(found):
        if when is not None:
            found[i] = (when + clock.midnight, name, numbers)
    return found, bad


def _wind_numbers(sentence: Any, numbers: dict[str, float]) -> dict[str, float]:
    """The angle and the speed in m/s of a wind, for the reference of its sentence."""
    frame = REFERENCES.get(getattr(sentence, "reference", ""), "no")
    unit = WIND_UNITS.get(getattr(sentence, "wind_speed_units", ""), float("nan"))
    found: dict[str, float] = {}
    for name, value in numbers.items():
        if name.startswith(frame):
            found[name] = value * unit if name.endswith("speed") else value
    return found


def _with_wind_in_knots(sentence: Any, numbers: dict[str, float]) -> dict[str, float]:
    """The numbers of a true wind, whose speed a sentence may state in knots only."""
    if isfinite(numbers["true_wind_speed"]):
        return numbers
    return {**numbers, "true_wind_speed": _float(sentence, "wind_speed_knots") * UNITS["kn"]}


class _Clock:
    """Time of day that continues after midnight, and the first midnight if it is known."""

    def __init__(self) -> None:
        self.last, self.days, self.midnight = -1.0, 0.0, 0.0

    def read(self, sentence: Any) -> float | None:
        """Return the time since the first midnight [s]; None for a sentence without a time."""
        of_day = getattr(sentence, "timestamp", None)
        if not isinstance(of_day, time):
            return None
        now = (
            of_day.hour * 3600.0 + of_day.minute * 60.0 + of_day.second + of_day.microsecond * 1e-6
        )
        if now > self.last + 0.5 * DAY and self.days:  # sent after midnight, of before
            return now + self.days - DAY
        if now < self.last - 0.5 * DAY:
            self.days += DAY
        self.last = now
        day = _date(sentence)
        if not self.midnight and isinstance(day, date):
            self.midnight = datetime.combine(day, time(), UTC).timestamp() - self.days
        return now + self.days


def _date(sentence: Any) -> date | None:
    """The date of a sentence; None without a valid one."""
    try:
        found = getattr(sentence, "datestamp", None)
    except (TypeError, ValueError):  # the library makes the date of ZDA on request
        return None
    if isinstance(found, date):
        return found
    return None


def _parse_line(line: str, parse: "Callable[..., Any]") -> Any:
    """The sentence in a line; None where there is none or its checksum is wrong."""
    found = SENTENCE.search(line)
    if found is None or not _checksum_is_valid(found[0]):
        return None
    try:
        return parse(found[0], check=False)
    except Exception:  # the library raises any exception on a line of noise
        return None


def _checksum_is_valid(text: str) -> bool:
    """Whether the checksum of a sentence is right; true for a sentence without one."""
    body, star, given = text[1:].partition("*")
    if not star:
        return True
    total = 0
    for character in body:
        total ^= ord(character)
    return given[:2].upper() == f"{total:02X}"


def _logger_time(line: str) -> float | None:
    """The time of the logger in front of a sentence [s since 1970]."""
    found = STAMP.search(line.partition("$")[0].partition("!")[0])
    if not found:
        return None
    value = float(found[1])
    if value > 1e11:
        return value * 1e-3
    return value


def _float(sentence: Any, name: str) -> float:
    try:
        return float(getattr(sentence, name))
    except (TypeError, ValueError, AttributeError, IndexError):
        return float("nan")


def _times(kept: "list[tuple[float | None, str, dict[str, float]]]") -> tuple[Array, int | None]:
    """Times (N,) [s], and the number of sentences without one; None where fewer than two have one.

    A sentence that occurs once between two times has the first of them, for instruments send
    sentences in groups; several of one name are spread evenly.
    """
    t = np.array([when for when, *_ in kept], dtype=float)  # None becomes nan
    known = np.flatnonzero(np.isfinite(t))
    if len(known) < 2:
        return t, None
    first = known[np.append(True, np.diff(t[known]) != 0.0)]  # of each time
    if len(first) < 2:
        return t, None
    usual = float(np.median(np.diff(t[first])))
    for begin, end in zip(first, np.append(first[1:], len(t)), strict=True):
        step = usual
        if end < len(t):
            step = min(t[end] - t[begin], usual)  # limited at a gap of the log
        rows = dict[str, list[int]]()
        for i in range(begin, end):
            if np.isnan(t[i]):
                rows.setdefault(kept[i][1], []).append(i)
        for places in rows.values():
            t[places] = t[begin] + step * np.arange(len(places)) / len(places)
    return t, int(len(t) - len(known))


def _signals(kept: list[tuple[float | None, str, dict[str, float]]], t: Array) -> dict[str, Signal]:
    rows: dict[str, list[int]] = {}
    for i, (_, name, _) in enumerate(kept):
        if np.isfinite(t[i]):
            rows.setdefault(name, []).append(i)
    found: dict[str, Signal] = {}
    for name, at in rows.items():
        for ours, (_, unit) in FIELDS[name.partition("[")[0]].items():
            values = np.array([kept[i][2].get(ours, np.nan) for i in at])
            if np.isfinite(values).any():
                found[f"{name}.{ours}"] = Signal(t[at], values, unit)
    return found
