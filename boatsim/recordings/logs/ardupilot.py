"""Reader of ArduPilot's `.BIN`: self-describing messages.

The log's parameters give the functions of outputs.
"""

from collections.abc import Mapping
from dataclasses import replace
from itertools import repeat
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from boatsim.errors import BadInput
from boatsim.recordings.importing.log import (
    Log,
    MemoryBudget,
    Signal,
    damaged_log_error,
    missing_library_error,
    names_of_streams,
    stream_signals,
    suppress_output,
)
from boatsim.recordings.raw_table import file_error

SUFFIXES = (".bin",)
# Letter of a FMT message -> numpy type and factor (libraries/AP_Logger/LogStructure.h); arrays and
# texts have no factor
LETTERS: dict[str, tuple[str, float | None]] = {
    "a": ("V64", None), "b": ("i1", 1.0), "B": ("u1", 1.0), "g": ("f2", 1.0),
    "h": ("i2", 1.0), "H": ("u2", 1.0),
    "i": ("i4", 1.0), "I": ("u4", 1.0), "f": ("f4", 1.0), "d": ("f8", 1.0),
    "n": ("V4", None), "N": ("V16", None),
    "Z": ("V64", None), "c": ("i2", 0.01), "C": ("u2", 0.01), "e": ("i4", 0.01), "E": ("u4", 0.01),
    "L": ("i4", 1e-7), "M": ("u1", 1.0), "q": ("i8", 1.0), "Q": ("u8", 1.0),
}  # fmt: skip
CLOCKS = {"TimeUS": 1e-6, "TimeMS": 1e-3}  # [s]
LOG_MESSAGES = (
    "FMT",
    "FMTU",
    "UNIT",
    "MULT",
    "PARM",
    "MSG",
    "FILE",
)  # messages about the log itself
UNITS = {
    "degheading": "deg",
    "deglatitude": "deg",
    "deglongitude": "deg",
    "µs": "us",
}  # unit in the log -> unit
FUNCTIONS = {  # values of SERVOn_FUNCTION, from the parameter list of Rover
    0: "disabled",
    1: "passed through from the pilot",
    26: "ground steering",
    70: "throttle",
    73: "throttle left",
    74: "throttle right",
    **{32 + k: f"motor {k}" for k in range(1, 9)},
}
STICK, OUTPUT = "pilot's stick", "output"


class _Formats(dict[int, Any]):
    """Formats of messages by number.

    A format without length is refused, for the library would loop endlessly.
    """

    def __setitem__(self, number: int, format: Any) -> None:
        if format.len <= 0:
            raise ValueError(f"messages {number} have no length")
        super().__setitem__(number, format)

    kept = property(
        lambda self: self._formats, lambda self, found: setattr(self, "_formats", _Formats(found))
    )


def read(path: Path) -> Log:
    """Return all messages with a time and numbers: `ATT.Yaw`, `GPS[1].Lat`. Raises BadInput."""
    try:
        from pymavlink import DFReader
    except ImportError as error:
        raise missing_library_error(path, "pymavlink", "ardupilot") from error
    if path.stat().st_size == 0:
        raise file_error(path, "is empty")
    # No search for a clock: times are since the start of the autopilot
    methods = {"init_clock": lambda self: None, "formats": _Formats.kept}
    quick = type("Quick", (DFReader.DFReader_binary,), methods)
    try:
        with suppress_output():
            index = quick(str(path))
        return _log(path, index)
    except BadInput:
        raise
    except Exception as error:  # the library raises any exception on a damaged file
        raise damaged_log_error(path, "an ArduPilot log", error) from error


def _log(path: Path, index: Any) -> Log:
    data, room = np.fromfile(path, dtype=np.uint8), MemoryBudget(path)
    streams: dict[tuple[str, int], dict[str, Signal]] = {}
    skipped: list[str] = []
    for number, format in index.formats.items():
        room.count_values(len(index.offsets[number]) * len(format.columns), len(streams))
        rows = _rows(data, np.asarray(index.offsets[number], dtype=np.int64), format)
        if rows is None:
            skipped.append(format.name)
        elif len(rows) and format.name not in LOG_MESSAGES:
            for instance, part in _instances(rows, format):
                if found := _signals(part, format):
                    streams[format.name, instance] = found
    stream_names = names_of_streams(list(streams))
    signals: dict[str, Signal] = {}
    for key, found in streams.items():
        for name, signal in found.items():
            signals[f"{stream_names[key]}.{name}"] = signal
    remarks = []
    if skipped:
        numbers = ", ".join(skipped)[:200]
        remarks.append(f"{path}: not read, its length is not that of its format: {numbers}")
    described = _with_descriptions(signals, _parameters(data, index))
    return Log(path, described, "NED", tuple(remarks))


def _rows(
    data: NDArray[np.uint8], offsets: NDArray[np.int64], format: Any
) -> "NDArray[Any] | None":
    """Complete records (N,) of a message; None where format and length disagree."""
    kinds = [LETTERS[letter][0] for letter in format.format]
    if len(format.columns) != len(kinds):
        return None
    fields = []
    for i, (name, kind) in enumerate(zip(format.columns, kinds, strict=True)):
        fields.append((f"{i} {name}", f"<{kind}"))
    record = np.dtype(fields)
    if record.itemsize != format.len - 3 or not record.itemsize:
        return None
    offsets = offsets[offsets + format.len <= len(data)]
    if not len(offsets):
        return np.zeros(0, dtype=record)
    windows = np.lib.stride_tricks.sliding_window_view(data, record.itemsize)
    return np.ascontiguousarray(windows[offsets + 3]).view(record)[:, 0]


def _instances(rows: "NDArray[Any]", format: Any) -> list[tuple[int, "NDArray[Any]"]]:
    """The records of each instance of a sensor, by its number."""
    if (
        not format.instance_field
        or LETTERS[format.format[format.columns.index(format.instance_field)]][1] is None
    ):
        return [(0, rows)]
    number = rows[_field(format, format.instance_field)]
    return [(int(i), rows[number == i]) for i in np.unique(number)]


def _field(format: Any, name: str) -> str:
    return f"{format.columns.index(name)} {name}"


def _signals(rows: "NDArray[Any]", format: Any) -> dict[str, Signal]:
    """The signals of one stream; {} without a time."""
    clocks = list(filter(format.columns.__contains__, CLOCKS))
    if not clocks:
        return {}
    clock = clocks[0]
    t = rows[_field(format, clock)] * CLOCKS[clock]
    units = format.units or [""] * len(format.columns)
    fields, known = {}, {}
    for i, (name, letter) in enumerate(zip(format.columns, format.format, strict=True)):
        factor = LETTERS[letter][1]
        if factor is not None and name not in (clock, format.instance_field):
            fields[name] = rows[f"{i} {name}"] * factor
            known[name] = UNITS.get(units[i], units[i])
    return stream_signals("", t, fields, known)


def _parameters(data: NDArray[np.uint8], index: Any) -> dict[str, float]:
    """The last value of each parameter of the autopilot in the log."""
    number = index.name_to_id.get("PARM")
    format = index.formats.get(number)
    if format is None or not {"Name", "Value"} <= set(format.columns):
        return {}
    rows = _rows(data, np.asarray(index.offsets[number], dtype=np.int64), format)
    if rows is None or LETTERS[format.format[format.columns.index("Value")]][1] is None:
        return {}
    values = rows[_field(format, "Value")].astype(float)
    parameters: dict[str, float] = {}
    for raw_name, value in zip(rows[_field(format, "Name")], values, strict=True):
        if np.isfinite(value):
            name = bytes(raw_name).split(b"\0")[0].decode("ascii", "replace")
            parameters[name] = float(value)
    return parameters


def _with_descriptions(
    signals: Mapping[str, Signal], parameters: Mapping[str, float]
) -> dict[str, Signal]:
    """The signals with a description of outputs and sticks, and the range of outputs [us]."""
    found = dict(signals)
    for name, signal in signals.items():
        stream, _, field = name.partition(".")
        number = field.removeprefix("C")
        if stream == "RCIN" and number.isdigit():
            found[name] = replace(signal, unit="us", about=f"{STICK} {number}")
        elif stream == "RCOU" and number.isdigit():
            function = int(parameters.get(f"SERVO{number}_FUNCTION", -1))
            about = FUNCTIONS.get(function, f"{OUTPUT} {number}")
            pulse = _pulse_range(parameters, f"SERVO{number}")
            found[name] = replace(signal, unit="us", about=about, pulse=pulse)
    return found


def _pulse_range(parameters: Mapping[str, float], servo: str) -> tuple[float, float, float] | None:
    """Low, neutral and high pulse [us] of an output; None where the log has no valid range."""
    keys = (f"{servo}_MIN", f"{servo}_TRIM", f"{servo}_MAX")
    low, neutral, high = map(parameters.get, keys, repeat(np.nan))
    if parameters.get(f"{servo}_REVERSED"):
        low, high = high, low
    if low < neutral < high or low > neutral > high:
        return low, neutral, high
    return None
