"""The owner accepts the proposed map and adds each order's signal and full scale."""

import re
import tomllib
from dataclasses import dataclass
from math import radians
from pathlib import Path

from validation.owner_logs.boats import Boat
from validation.owner_logs.formats.log import Scale
from validation.owner_logs.instruments import drive_names


@dataclass(frozen=True)
class Line:
    """A correct line of the map."""

    channel: str
    text: str
    signal: str
    least: float
    most: float
    low: float
    high: float


def correct_lines(boat: Boat, vessel: Path, scales: dict[str, Scale]) -> list[Line]:
    """Return the command lines, with the limits of the vessel's own channels."""
    channels = tomllib.loads(vessel.read_text(encoding="utf-8"))["channels"]
    found = []
    for name, channel in zip(drive_names(boat), boat.channels, strict=True):
        found.append(
            _line(channel, scales[name], channels[channel]["low"], channels[channel]["high"])
        )
    most = boat.helm_sign * boat.helm_most
    found += [_line(channel, scales["helm"], -most, most) for channel in boat.helms]
    return found


def _line(channel: str, s: Scale, least: float, most: float) -> Line:
    ends = (
        f"low = {s.low:g}, neutral = {s.neutral:g}, high = {s.high:g}, least = "
        f"{least:.4g}, most = {most:.4g}"
    )
    return Line(
        channel,
        f'{channel} = {{ signal = "{s.signal}", {ends} }}',
        s.signal,
        least,
        most,
        s.low,
        s.high,
    )


def correct_map(text: str, lines: list[Line]) -> tuple[str, list[str]]:
    """Return the map with the owner's lines, and what had to be added or corrected.

    The latter is 'absent', 'signal', 'sign' or 'scale'.
    """
    edits = []
    for line in lines:
        pattern = re.compile(rf'^(# )?"?{re.escape(line.channel)}"? = .*$', re.MULTILINE)
        there = pattern.search(text)
        if there is None:
            edits.append(f"absent {line.channel}")
            head, mark, rest = text.partition("# commands: what was sent to the drives\n")
            text = f"{head}{mark}{line.text}\n{rest}" if mark else f"{text}{line.text}\n"
            continue
        if fault := _mistake_in_line(there[0], line):
            edits.append(f"{fault} {line.channel}")
            text = text[: there.start()] + _corrected(there[0], line) + text[there.end() :]
    return text, edits


def _corrected(proposed: str, line: Line) -> str:
    """The owner's line, with the exponent of a proposed line: full scale does not contradict it."""
    if proposed.startswith("#"):
        return line.text
    value = tomllib.loads(proposed)[line.channel]
    if isinstance(value, str) or "exponent" not in value:
        return line.text
    return line.text.replace(" }", f", exponent = {value['exponent']:g} }}")


def _mistake_in_line(proposed: str, line: Line) -> str:
    if proposed.startswith("#"):
        return "absent"
    value = tomllib.loads(proposed)[line.channel]
    if isinstance(value, str):
        parts = value.split(" * ")
        signal, unit = parts[0].lstrip("-").strip(), parts[1] if len(parts) > 1 else ""
        slope = radians(1.0) if unit == "deg" else 1.0
        slope *= -1.0 if value.startswith("-") else 1.0
    else:
        signal = value["signal"]
        slope = (value["most"] - value["least"]) / (value["high"] - value["low"])
    if signal != line.signal:
        return "signal"
    right = (line.most - line.least) / (line.high - line.low)
    if slope * right < 0.0:
        return "sign"
    if not 0.9 < slope / right < 1.1:
        return "scale"
    return ""
