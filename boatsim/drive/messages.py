"""Messages of the driver's page: their form and their parsing."""

import json
from math import isfinite
from typing import Literal, NamedTuple, TypeAlias

from boatsim.drive.driver_input import Sticks

LATEST = 1e11  # [s since 1970] largest time of a movement; the clock of a page shows less


class Movement(NamedTuple):
    """Message with the stick deflections of a driver.

    Attributes:
        sticks: Stick deflections, each from -1 to 1.
        moved: Time at which the sticks came to these deflections [s since 1970].
    """

    sticks: Sticks
    moved: float


Message: TypeAlias = Movement | Literal["end", "hidden"]


def parse_message(text: str | bytes) -> Message | None:
    """Parse a message of the driver's page.

    Args:
        text: The message as it arrived.

    Returns:
        Stick deflections; "end" for a request to end the run; "hidden" for the notice that the page
        is hidden; None for anything else.
    """
    try:
        data: object = json.loads(text)
    except (ValueError, RecursionError):
        return None
    if not isinstance(data, dict):
        return None
    if len(data) == 1 and data.get("end") is True:
        return "end"
    if len(data) == 1 and data.get("hidden") is True:
        return "hidden"
    return _parse_movement(data)


def _parse_movement(data: dict[str, object]) -> Movement | None:
    if set(data) != {"sticks", "moved"}:
        return None
    deflections = data["sticks"]
    if not isinstance(deflections, list) or len(deflections) != len(Sticks._fields):
        return None
    numbers: list[float] = []
    for value, largest in zip((*deflections, data["moved"]), (1.0, 1.0, 1.0, LATEST), strict=True):
        number = _number_up_to(value, largest)
        if number is None:
            return None
        numbers.append(number)
    *sticks, moved = numbers
    return Movement(Sticks(*sticks), moved)


def _number_up_to(value: object, largest: float) -> float | None:
    """A number as a float, None for another value, nan or a larger number."""
    if isinstance(value, bool) or not isinstance(value, int | float):
        return None
    if not abs(value) <= largest or not isfinite(value):  # compares integers of any size
        return None
    return float(value)
