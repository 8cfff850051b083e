"""Winds of a log as measured inputs of a vessel."""

from collections.abc import Collection, Mapping, Sequence
from typing import NamedTuple

from boatsim.recordings.importing.measured_lines import InputSignal, lines_of_input
from boatsim.recordings.importing.unnamed_inputs import NewInput
from boatsim.recordings.importing.wind_evidence import APPARENT, TRUE
from boatsim.recordings.importing.winds import Wind

SPEED, COMES_FROM = "speed", "comes_from"


class WindRole(NamedTuple):
    """Role of a column in a wind: the frame of the wind, and SPEED or COMES_FROM."""

    frame: str
    role: str


# Columns by which effects know a wind without further settings
USUAL = {
    "apparent_wind_mps": WindRole(APPARENT, SPEED),
    "apparent_wind_from_rad": WindRole(APPARENT, COMES_FROM),
    "wind_mps": WindRole(TRUE, SPEED),
    "wind_from_rad": WindRole(TRUE, COMES_FROM),
}
ABOUT = {
    "apparent_wind_mps": "speed of the wind past the hull, measured on board",
    "apparent_wind_from_rad": "direction from which it comes, clockwise from the bow",
    "wind_mps": "speed of the wind over ground",
    "wind_from_rad": "direction from which it comes, clockwise from north",
}


def wind_lines(
    column: str, about: str, roles: Mapping[str, WindRole], winds: Sequence[Wind]
) -> str:
    """Return lines of a map that propose signals for a column of a wind.

    Args:
        column: The column.
        about: Description of the quantity.
        roles: Column of the vessel -> what it is of a wind.
        winds: Winds of the log.
    """
    return lines_of_input(column, about, _signals(roles[column], winds))


def unnamed_wind(measured: Collection[str], winds: Sequence[Wind]) -> list[NewInput]:
    """Return the columns of the wind of a log that a vessel's file may name.

    The apparent wind is preferred, because instruments compute a true wind from it.

    Args:
        measured: Columns of a wind that the vessel's file names already.
        winds: Winds of the log.
    """
    frames = [frame for frame in (APPARENT, TRUE) if any(w.frame in (frame, "") for w in winds)]
    if measured or not frames:
        return []
    new = []
    for column, role in USUAL.items():
        if role.frame == frames[0]:
            new.append(NewInput(column, ABOUT[column], _signals(role, winds)))
    return new


def _signals(role: WindRole, winds: Sequence[Wind]) -> list[InputSignal]:
    found = []
    for wind in winds:
        if wind.frame not in (role.frame, ""):
            continue
        expression = wind.speed
        if role.role == COMES_FROM:
            expression = wind.comes_from
        note = "; ".join([*wind.notes, *wind.questions])
        found.append(InputSignal(expression, expression, note, bool(wind.questions)))
    return found
