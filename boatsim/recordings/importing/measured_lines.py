"""Lines of a proposed map for a measured input of a vessel, from the signals that may be it."""

from collections.abc import Collection, Sequence
from typing import NamedTuple

from boatsim.files import toml_key, toml_value
from boatsim.recordings.importing.signal_words import tokenize_name

SUPPLY = {"battery", "batt", "bat", "supply", "bus", "main"}  # more often that of the drives


class InputSignal(NamedTuple):
    """A signal of a log that may be a measured input.

    Attributes:
        name: Name of the signal.
        expression: Expression that converts it to the unit of the input.
        note: What the owner must check; "" for nothing.
        is_open: Whether the owner must complete it, so that it is proposed as a comment only.
    """

    name: str
    expression: str
    note: str = ""
    is_open: bool = False


def lines_of_input(
    column: str, about: str, found: Sequence[InputSignal], preferred: Collection[str] = ()
) -> str:
    """Return lines of a map that propose signals for a measured input.

    The signal whose name has most words of the column and of the preferred ones is proposed, and
    the others are listed in comments.

    Args:
        column: Column of the input, such as `battery_V`.
        about: Description of the input.
        found: Signals that may be the input.
        preferred: Words of names that are more probable.
    """
    if not found:
        return f'# {toml_key(column)} = "..."  # CHECK: {about}\n'
    lines = ""
    for i, one in enumerate(most_probable_first(column, found, preferred)):
        sign = "" if i == 0 else "# or "
        if one.is_open:
            sign = "# "
        note = f"{about}; {one.note}" if one.note else about
        lines += f"{sign}{toml_key(column)} = {toml_value(one.expression)}  # CHECK: {note}\n"
    return lines


def most_probable_first(
    column: str, found: Sequence[InputSignal], preferred: Collection[str] = ()
) -> list[InputSignal]:
    """Return signals in the order of the words that their names share with a column.

    Args:
        column: Column of the input, such as `battery_V`.
        found: Signals that may be the input.
        preferred: Words of names that are more probable.
    """
    words = set(tokenize_name(column))

    def matches(one: InputSignal) -> tuple[bool, int]:
        own = set(tokenize_name(one.name))
        return not one.is_open, 2 * len(own & words) + len(own & set(preferred))

    return sorted(found, key=matches, reverse=True)
