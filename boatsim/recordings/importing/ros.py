"""Decoding of the numbers in ROS 1 and 2 messages by their definitions, without generated code."""

import re
import struct
from array import array
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from boatsim.physics.base import Array
from boatsim.recordings.importing.frames import with_euler_angles
from boatsim.recordings.importing.log import MAX_SIGNALS, Log, MemoryBudget, Signal, stream_signals

# Type of number -> letter of `struct` and size; char is one byte, signed or not, time is two words
NUMBERS = {
    "bool": ("?", 1), "byte": ("b", 1), "char": ("B", 1), "int8": ("b", 1),
    "uint8": ("B", 1), "int16": ("h", 2),
    "uint16": ("H", 2), "int32": ("i", 4), "uint32": ("I", 4), "int64": ("q", 8),
    "uint64": ("Q", 8),
    "float32": ("f", 4), "float64": ("d", 8),
}  # fmt: skip
STAMP = {"time": ("uint32", "uint32"), "duration": ("int32", "int32")}  # of ROS 1
BUILT_IN = {  # may be missing in definitions of ROS 2
    "builtin_interfaces/Time": "int32 sec\nuint32 nanosec",
    "builtin_interfaces/Duration": "int32 sec\nuint32 nanosec",
}
FIELD = re.compile(r"^\s*([\w/]+)(?:<=\d+)?(\[(?:<=)?(\d*)\])?\s+([A-Za-z]\w*)\s*(.*)$")
SECTION = re.compile(r"^=+\s*$\s*^MSG:\s*(\S+)\s*$", re.MULTILINE)
MAX_NESTING = 20  # of messages in messages
MAX_ELEMENTS = 16  # of a list of numbers that is kept; images and point clouds have more
MAX_PARTS = 4  # kept of a list of messages
MAX_EMPTY = 1000  # messages without content in a message
MAX_SIZE = 1_000_000  # [bytes] of a message that is read; only images and point clouds are larger
MAX_CLOCK_OFFSET = 10.0  # [s] between the stamp of a message and the time of its logging

# of vectors x, y, z in common_interfaces and mavros_msgs; latitude and longitude are in degrees
VECTOR_UNITS = {
    "angular_velocity": "rad/s",
    "angular": "rad/s",
    "linear": "m/s",
    "position": "m",
    "linear_acceleration": "m/s^2",
}


@dataclass(frozen=True)
class MessageField:
    """One field of a message."""

    name: str
    kind: str  # a type of number or text, or the full name of a message
    count: int | None = None  # length of a list, -1 if the message has the length; None for no list


@dataclass
class Topic:
    """Values of one topic while a bag is read."""

    decode: "Callable[[bytes], dict[str, float]]"
    logged: array = field(default_factory=lambda: array("d"))  # type: ignore[type-arg]
    columns: dict[str, array] = field(default_factory=dict)  # type: ignore[type-arg]

    def add_message(self, when: float, data: bytes, room: MemoryBudget) -> None:
        """Add a message that was logged at `when` [s].

        Raises ValueError if it does not fit its definition.
        """
        found = self.decode(data)
        rows = len(self.logged)
        for name, value in found.items():
            column = self.columns.setdefault(name, array("d"))
            column.extend([float("nan")] * (rows - len(column)))
            column.append(value)
        self.logged.append(when)
        room.count_values(len(found) + 1, len(self.columns))


def parse_definitions(text: str, root: str) -> dict[str, list[MessageField]]:
    """Return the fields of a message and of the messages in it, by name of the message.

    Args:
        text: The definitions.
        root: Name of the message.

    Raises:
        ValueError: If a definition is missing.
    """
    pieces = SECTION.split(text)
    texts = (
        BUILT_IN
        | dict(zip(map(_full_type_name, pieces[1::2]), pieces[2::2], strict=True))
        | {_full_type_name(root): pieces[0]}
    )
    found: dict[str, list[MessageField]] = {}
    for name, body in texts.items():
        found[name] = []
        for line in body.splitlines():
            if part := _parse_field(line, name, texts):
                found[name].append(part)
    return found


def _full_type_name(name: str) -> str:
    """The name in the form geometry_msgs/Pose."""
    return name.replace("/msg/", "/")


def _parse_field(line: str, owner: str, known: Mapping[str, str]) -> MessageField | None:
    """The field that a line defines; None for constants, comments and blank lines."""
    found = FIELD.match(line.partition("#")[0])
    if found is None or found[5].startswith("="):
        return None
    kind, brackets, count, name = _full_type_name(found[1]), found[2], found[3], found[4]
    if kind not in NUMBERS and kind not in STAMP and kind not in ("string", "wstring"):
        if kind == "Header" and kind not in known:
            kind = "std_msgs/Header"
        elif kind not in known:  # a message of the same package
            kind = f"{owner.rpartition('/')[0]}/{kind}"
        if kind not in known:
            raise ValueError(f"{owner} has a part {found[1]} without a definition")
    if not brackets:
        return MessageField(name, kind)
    if count and "<=" not in brackets:
        return MessageField(name, kind, int(count))
    return MessageField(name, kind, -1)


class Decoder:
    """Decoder of the numbers in messages of one type."""

    def __init__(self, text: str, root: str, cdr: bool) -> None:
        """Prepare the decoder.

        Args:
            text: The definitions.
            root: Name of the message.
            cdr: Whether messages are in the encoding of ROS 2, aligned and with the byte order in
                front.

        Raises:
            ValueError: If a definition is missing or recursive.
        """
        self.parts, self.root, self.cdr = parse_definitions(text, root), _full_type_name(root), cdr
        self._check()

    def _check(self) -> None:
        """Check that messages are not nested too deeply. Raises ValueError."""
        level = {self.root}
        for _ in range(MAX_NESTING + 1):
            inner: set[str] = set()
            for name in level:
                inner.update(part.kind for part in self.parts[name])
            level = inner & self.parts.keys()
        if level:
            raise ValueError(f"{self.root} holds itself, or messages in messages too deep to read")

    def __call__(self, data: bytes) -> dict[str, float]:
        """Return the numbers of a message by name, `pose.position.x` or `channels[3]`.

        Raises:
            ValueError: If the message is cut or has another encoding.
        """
        if self.cdr and (len(data) < 4 or data[1] > 1):
            raise ValueError("message in an encoding other than plain CDR")
        order = "<"
        content = data
        if self.cdr:
            content = data[4:]
            if data[1] == 0:
                order = ">"
        found: dict[str, float] = {}
        try:
            _Cursor(content, order, self.cdr, self.parts).decode_message(self.root, "", found)
        except (struct.error, IndexError) as error:
            raise ValueError(str(error)) from error
        return found


class _Cursor:
    """Position in a message."""

    def __init__(
        self, data: bytes, order: str, aligned: bool, parts: Mapping[str, list[MessageField]]
    ) -> None:
        self.data, self.order, self.aligned, self.parts, self.at = data, order, aligned, parts, 0
        # Number of messages that are still decoded; messages without content have no other limit
        self.remaining = MAX_EMPTY + len(data)

    def decode_message(self, name: str, prefix: str, found: dict[str, float] | None) -> None:
        self.remaining -= 1
        if self.remaining < 0:
            raise ValueError("more messages in the message than it has bytes")
        parts = self.parts[name]
        if not parts and self.aligned:
            self.at += 1  # ROS 2 gives an empty message one byte
        for part in parts:
            if part.count is None:
                self.decode_field(part.kind, prefix + part.name, found)
            else:
                self.decode_array(part, prefix + part.name, found)

    def number(self, kind: str) -> float:
        letter, size = NUMBERS[kind]
        self.align(size)
        (value,) = struct.unpack_from(self.order + letter, self.data, self.at)
        self.at += size
        return float(value)

    def align(self, size: int) -> None:
        if self.aligned:
            self.at += -self.at % size

    def decode_field(self, kind: str, name: str, found: dict[str, float] | None) -> None:
        if kind in NUMBERS:
            value = self.number(kind)
            if found is not None:
                found[name] = value
        elif kind in STAMP:
            for part, word in zip(("sec", "nanosec"), STAMP[kind], strict=True):
                self.decode_field(word, f"{name}.{part}", found)
        elif kind in self.parts:
            self.decode_message(kind, f"{name}.", found)
        else:  # a text
            size = int(self.number("uint32"))
            if kind == "wstring":
                size *= 4
            self.skip(size)

    def decode_array(self, part: MessageField, name: str, found: dict[str, float] | None) -> None:
        count = part.count or 0
        if count == -1:
            count = int(self.number("uint32"))
        if count > len(self.data) - self.at:
            raise ValueError(
                f"{name} has {count} elements by its length, more than the message has bytes"
            )
        if part.kind in NUMBERS:
            letter, size = NUMBERS[part.kind]
            if count:
                self.align(size)
            if found is not None and count <= MAX_ELEMENTS and "covariance" not in name:
                values = struct.unpack_from(f"{self.order}{count}{letter}", self.data, self.at)
                for i, value in enumerate(values):
                    found[f"{name}[{i}]"] = float(value)
            self.skip(count * size)
            return
        for i in range(count):
            if i == MAX_PARTS:
                found = None  # the others are skipped
            self.decode_field(part.kind, f"{name}[{i}]", found)

    def skip(self, size: int) -> None:
        self.at += size
        if self.at > len(self.data):
            raise ValueError("the message is cut")


def log_from_topics(path: Path, topics: Mapping[str, Topic], remarks: list[str]) -> Log:
    """Return all topics that have messages as one log.

    Messages have the time of their stamps if these agree with the time of logging, else the time of
    logging.

    Args:
        path: The bag.
        topics: Topics by name.
        remarks: Remarks of the log.
    """
    signals: dict[str, Signal] = {}
    for name, topic in topics.items():
        if not len(topic.logged):
            continue
        logged = np.array(topic.logged)
        columns = {n: _filled(c, len(logged)) for n, c in topic.columns.items()}
        stamped = [columns.pop(f"header.stamp.{part}", None) for part in ("sec", "nanosec")]
        columns.pop("header.seq", None)
        t = logged
        if stamped[0] is not None and stamped[1] is not None:
            own = stamped[0] + 1e-9 * stamped[1]
            if abs(float(np.median(own - logged))) < MAX_CLOCK_OFFSET:
                t = own
            else:
                remarks.append(
                    f"{path}: the stamps of {name} are of another clock; the times of logging "
                    "are used"
                )
        units = dict(zip(columns, map(_unit_of, columns), strict=True))
        signals |= stream_signals(name, t, columns, units)
        if len(signals) > MAX_SIGNALS:
            MemoryBudget(path).count_values(0, len(signals))
    return Log(path, with_euler_angles(signals), "ENU", tuple(dict.fromkeys(remarks)))


def _unit_of(name: str) -> str:
    *_, vector, field = ("", *name.split("."))
    if field in ("latitude", "longitude"):
        return "deg"
    if field in ("x", "y", "z"):
        return VECTOR_UNITS.get(vector, "")
    return ""


def _filled(column: "array[float]", rows: int) -> Array:
    full = np.full(rows, np.nan)
    full[: len(column)] = column
    return full
