"""Messages of ROS 1 and 2 by their definitions: the numbers in them, without making or running any code."""

import re
import struct
from array import array
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from boatsim.physics.base import Array
from boatsim.recordings.importing.frames import with_angles
from boatsim.recordings.importing.log import MOST_SIGNALS, Log, Room, Signal, signals_of

# types of numbers -> letter of `struct` and size; char is one byte of either sign, time two words
NUMBERS = {
    "bool": ("?", 1), "byte": ("b", 1), "char": ("B", 1), "int8": ("b", 1), "uint8": ("B", 1), "int16": ("h", 2),
    "uint16": ("H", 2), "int32": ("i", 4), "uint32": ("I", 4), "int64": ("q", 8), "uint64": ("Q", 8),
    "float32": ("f", 4), "float64": ("d", 8),
}  # fmt: skip
STAMP = {"time": ("uint32", "uint32"), "duration": ("int32", "int32")}  # of ROS 1
BUILT_IN = {  # which definitions of ROS 2 do not always bring along
    "builtin_interfaces/Time": "int32 sec\nuint32 nanosec",
    "builtin_interfaces/Duration": "int32 sec\nuint32 nanosec",
}
FIELD = re.compile(r"^\s*([\w/]+)(?:<=\d+)?(\[(?:<=)?(\d*)\])?\s+([A-Za-z]\w*)\s*(.*)$")
SECTION = re.compile(r"^=+\s*$\s*^MSG:\s*(\S+)\s*$", re.MULTILINE)
DEEPEST = 20  # messages in messages
# of a list of numbers that are kept; covariances and pictures have more, or are called so
MOST_ELEMENTS = 16
MOST_PARTS = 4  # of a list of messages
MOST_EMPTY = 1000  # messages of no size in a message
MOST_SIZE = 1_000_000  # [bytes] of a message that is read; only pictures and clouds are larger
AGREE = 10.0  # [s] by which a message's own stamp and the time of its logging may differ

UNITS = {  # of the usual messages (common_interfaces, mavros_msgs), by the end of the name
    "angular_velocity.x": "rad/s",
    "angular_velocity.y": "rad/s",
    "angular_velocity.z": "rad/s",
    "angular.x": "rad/s",
    "angular.y": "rad/s",
    "angular.z": "rad/s",
    "linear.x": "m/s",
    "linear.y": "m/s",
    "linear.z": "m/s",
    "position.x": "m",
    "position.y": "m",
    "position.z": "m",
    "latitude": "deg",
    "longitude": "deg",
    "linear_acceleration.x": "m/s^2",
    "linear_acceleration.y": "m/s^2",
    "linear_acceleration.z": "m/s^2",
}


@dataclass(frozen=True)
class Part:
    """One field of a message."""

    name: str
    kind: str  # a number, a text, or the full name of a message
    count: int | None = None  # of a list: how many, -1 where the message says it; None: no list


@dataclass
class Topic:
    """What is kept of one topic while a bag is read."""

    decode: "Callable[[bytes], dict[str, float]]"
    logged: array = field(default_factory=lambda: array("d"))  # type: ignore[type-arg]
    columns: dict[str, array] = field(default_factory=dict)  # type: ignore[type-arg]

    def add(self, when: float, data: bytes, room: Room) -> None:
        """One more message, logged at `when` [s]. Raises ValueError if it does not fit its definition."""
        found = self.decode(data)
        rows = len(self.logged)
        for name, value in found.items():
            column = self.columns.setdefault(name, array("d"))
            column.extend([float("nan")] * (rows - len(column)))
            column.append(value)
        self.logged.append(when)
        room.take(len(found) + 1, len(self.columns))


def definitions(text: str, root: str) -> dict[str, list[Part]]:
    """Parts of a message and of those in it, from definitions written one below the other. Raises ValueError."""
    pieces = SECTION.split(text)
    texts = (
        BUILT_IN
        | dict(zip(map(_full, pieces[1::2]), pieces[2::2], strict=True))
        | {_full(root): pieces[0]}
    )
    return {
        name: [part for line in body.splitlines() if (part := _part(line, name, texts))]
        for name, body in texts.items()
    }


def _full(name: str) -> str:
    """geometry_msgs/msg/Pose and geometry_msgs/Pose are one."""
    return name.replace("/msg/", "/")


def _part(line: str, owner: str, known: Mapping[str, str]) -> Part | None:
    """The field that a line defines; None for constants, comments and blank lines."""
    found = FIELD.match(line.partition("#")[0])
    if found is None or found[5].startswith("="):
        return None
    kind, brackets, count, name = _full(found[1]), found[2], found[3], found[4]
    if kind not in NUMBERS and kind not in STAMP and kind not in ("string", "wstring"):
        beside = f"{owner.rpartition('/')[0]}/{kind}"
        kind = kind if kind in known else "std_msgs/Header" if kind == "Header" else beside
        if kind not in known:
            raise ValueError(f"{owner} has a part {found[1]} that nothing defines")
    fixed = bool(count) and "<=" not in brackets
    return Part(name, kind, None if not brackets else int(count) if fixed else -1)


class Decoder:
    """Takes the numbers out of a message of one type."""

    def __init__(self, text: str, root: str, cdr: bool) -> None:
        """`cdr`: as ROS 2 writes it, aligned and with its byte order in front; else as ROS 1. Raises ValueError."""
        self.parts, self.root, self.cdr = definitions(text, root), _full(root), cdr
        self._check()

    def _check(self) -> None:
        """Each level of messages in messages once, however many ways lead there."""
        level = {self.root}
        for _ in range(DEEPEST + 1):
            level = {
                part.kind for name in level for part in self.parts[name] if part.kind in self.parts
            }
        if level:
            raise ValueError(f"{self.root} holds itself, or messages in messages too deep to read")

    def __call__(self, data: bytes) -> dict[str, float]:
        """Numbers by their names: `pose.position.x`, `channels[3]`. Raises ValueError where the message is cut."""
        if self.cdr and (len(data) < 4 or data[1] > 1):
            raise ValueError("message in an encoding other than plain CDR")
        order = ">" if self.cdr and data[1] == 0 else "<"
        found: dict[str, float] = {}
        try:
            _Cursor(data[4:] if self.cdr else data, order, self.cdr, self.parts).message(
                self.root, "", found
            )
        except (struct.error, IndexError) as error:
            raise ValueError(str(error)) from error
        return found


class _Cursor:
    """Where in a message one is."""

    def __init__(
        self, data: bytes, order: str, aligned: bool, parts: Mapping[str, list[Part]]
    ) -> None:
        self.data, self.order, self.aligned, self.parts, self.at = data, order, aligned, parts, 0
        self.left = MOST_EMPTY + len(
            data
        )  # messages in it that are looked at: those of no size have no other bound

    def message(self, name: str, prefix: str, found: dict[str, float] | None) -> None:
        self.left -= 1
        if self.left < 0:
            raise ValueError("more messages in the message than it has bytes")
        parts = self.parts[name]
        if not parts and self.aligned:
            self.at += 1  # ROS 2 gives an empty message one byte
        for part in parts:
            if part.count is None:
                self.one(part.kind, prefix + part.name, found)
            else:
                self.several(part, prefix + part.name, found)

    def number(self, kind: str) -> float:
        letter, size = NUMBERS[kind]
        self.align(size)
        (value,) = struct.unpack_from(self.order + letter, self.data, self.at)
        self.at += size
        return float(value)

    def align(self, size: int) -> None:
        if self.aligned:
            self.at += -self.at % size

    def one(self, kind: str, name: str, found: dict[str, float] | None) -> None:
        if kind in NUMBERS:
            value = self.number(kind)
            if found is not None:
                found[name] = value
        elif kind in STAMP:
            for part, word in zip(("sec", "nanosec"), STAMP[kind], strict=True):
                self.one(word, f"{name}.{part}", found)
        elif kind in self.parts:
            self.message(kind, f"{name}.", found)
        else:  # a text
            self.skip(int(self.number("uint32")) * (4 if kind == "wstring" else 1))

    def several(self, part: Part, name: str, found: dict[str, float] | None) -> None:
        count = int(self.number("uint32")) if part.count == -1 else part.count or 0
        if count > len(self.data) - self.at:
            raise ValueError(
                f"{name} is said to have {count} elements, more than the message has bytes"
            )
        if part.kind in NUMBERS:
            letter, size = NUMBERS[part.kind]
            if count:
                self.align(size)
            if found is not None and count <= MOST_ELEMENTS and "covariance" not in name:
                values = struct.unpack_from(f"{self.order}{count}{letter}", self.data, self.at)
                found.update({f"{name}[{i}]": float(v) for i, v in enumerate(values)})
            self.skip(count * size)
            return
        for i in range(count):
            self.one(part.kind, f"{name}[{i}]", found if i < MOST_PARTS else None)

    def skip(self, size: int) -> None:
        self.at += size
        if self.at > len(self.data):
            raise ValueError("the message is cut")


def log_of(path: Path, topics: Mapping[str, Topic], remarks: list[str]) -> Log:
    """All topics as one log: messages at their own stamps where those agree with the time of logging, else at that."""
    signals: dict[str, Signal] = {}
    for name, topic in topics.items():
        logged = np.array(topic.logged)
        columns = {n: _filled(c, len(logged)) for n, c in topic.columns.items()}
        stamped = [columns.pop(f"header.stamp.{part}", None) for part in ("sec", "nanosec")]
        columns.pop("header.seq", None)
        t = logged
        if stamped[0] is not None and stamped[1] is not None:
            own = stamped[0] + 1e-9 * stamped[1]
            if abs(float(np.median(own - logged))) < AGREE:
                t = own
            else:
                remarks.append(
                    f"{path}: the stamps of {name} are of another clock; the times of logging are used"
                )
        units = {
            n: next((u for end, u in UNITS.items() if f".{n}".endswith(f".{end}")), "")
            for n in columns
        }
        signals |= signals_of(name, t, columns, units)
        if len(signals) > MOST_SIGNALS:
            Room(path).take(0, len(signals))
    return Log(path, with_angles(signals), "ENU", tuple(dict.fromkeys(remarks)))


def _filled(column: "array[float]", rows: int) -> Array:
    full = np.full(rows, np.nan)
    full[: len(column)] = column
    return full
