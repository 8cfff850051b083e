"""Speeds through the water in a log, and the table of a map that makes a current of one."""

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np

from boatsim.files import toml_key, toml_value
from boatsim.recordings.importing.log import Log
from boatsim.recordings.importing.signal_classification import NOT_MEASURED, Classification
from boatsim.recordings.importing.signal_units import stated_speed_unit
from boatsim.recordings.importing.signal_words import tokenize_name
from boatsim.recordings.importing.track import Track
from boatsim.recordings.importing.unnamed_inputs import NewInput
from boatsim.recordings.importing.water_speed_table import EAST, NORTH, WaterSpeed
from boatsim.recordings.importing.wind_evidence import water_speed_unit

CERTAIN = {"stw", "paddlewheel", "paddle"}
SPEEDS = {"speed", "velocity", "vel", "kn", "m/s", "km/h", "mps"}
# words beside a word of a speed
OF_WATER = {"water", "log", "surface"}
OTHER = {"wind", "sog", "ground", "current", "temperature", "depth", "course", "trip", "distance"}
ASK_UNIT = "the unit is not stated: add * kn or * kmh unless it is m/s"
ABOUT = {
    NORTH: "velocity of the water to north, from the speed through the water",
    EAST: "velocity of the water to east",
}


class WaterSpeedSignal(NamedTuple):
    """A speed through the water.

    Attributes:
        expression: Expression of the speed in m/s.
        note: What the owner must check; "" for nothing.
        is_open: Whether the owner must state the unit.
    """

    expression: str
    note: str
    is_open: bool


def water_speeds_of_log(
    log: Log, track: Track | None, heading: Classification | None
) -> list[WaterSpeedSignal]:
    """Return the speeds through the water of a log, those with a known unit first.

    A unit that the log does not state follows from the motion: the slope of the speed, along the
    bow, on the velocity over ground. The current does not change with the heading.

    Args:
        log: The log.
        track: Motion by the positions; None if unknown.
        heading: The heading; None if unknown.
    """
    found = []
    for name, signal in log.signals.items():
        known = signal.values[np.isfinite(signal.values)]
        if not _is_water_speed(name) or not len(known) or np.ptp(known) == 0.0:
            continue
        unit, is_stated = stated_speed_unit(name, signal)
        note = ""
        if not is_stated:
            speed = Classification(name, signal, "speed", "", 0.0)
            shown = water_speed_unit(speed, track, heading)
            unit, is_stated = shown or "", shown is not None
            note = f"in {unit or 'm/s'} by the motion of the boat" if is_stated else ASK_UNIT
        expression = f"{name} * {unit}" if unit else name
        found.append(WaterSpeedSignal(expression, note, not is_stated))
    return sorted(found, key=lambda one: one.is_open)


def current_table(
    columns: Mapping[str, str], speeds: Sequence[WaterSpeedSignal], is_named: bool
) -> str:
    """Return the table of a map that makes a current of the most probable speed; "" without one.

    Args:
        columns: Columns of the current, by "north" and "east".
        speeds: Speeds through the water of the log.
        is_named: Whether the vessel's file names these columns. For another vessel the table is a
            comment.
    """
    if not speeds:
        return ""
    best = speeds[0]
    sign = "" if is_named and not best.is_open else "# "
    window = WaterSpeed.model_fields["window"].default
    note = f"  # CHECK: {best.note}" if best.note else ""
    lines = [
        "",
        "# current: the velocity over ground less that through the water, along the bow",
        f"{sign}[current]",
        f"{sign}speed = {toml_value(best.expression)}{note}",
        f"{sign}window = {window}  # [s] over which it is averaged",
    ]
    for one in speeds[1:]:
        lines.append(f"# or speed = {toml_value(one.expression)}")
    for key, usual in (("north", NORTH), ("east", EAST)):
        if columns.get(key, usual) != usual:
            lines.append(f"{sign}{toml_key(key)} = {toml_value(columns[key])}")
    return "\n".join(lines) + "\n"


def unnamed_current(columns: Mapping[str, str], speeds: Sequence[object]) -> list[NewInput]:
    """Return the columns of a current that a vessel's file may name; [] if it names them.

    Args:
        columns: Columns of the current that the vessel's file names.
        speeds: Speeds through the water of the log.
    """
    if columns or not speeds:
        return []
    return [NewInput(column, about, ()) for column, about in ABOUT.items()]


def _is_water_speed(name: str) -> bool:
    words = set(tokenize_name(name))
    if words & (OTHER | NOT_MEASURED):
        return False
    return bool(words & CERTAIN or words & OF_WATER and words & SPEEDS)
