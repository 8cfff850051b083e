"""Axes of a grid: `KEY=0:0.5:11`, `KEY=0.01:1:5:log` or `KEY=light,heavy`."""

from collections.abc import Sequence
from dataclasses import dataclass
from math import isfinite

import numpy as np

from boatsim.errors import BadInput
from boatsim.files import INTEGER_LIMIT
from boatsim.sweeps.keys import Target, Value, parse_target

MOST_VALUES = 100_000  # of one axis; more is a mistake in the number
MOST_DIGITS = 18  # of an integer, so that it has at most 64 bits
SIGNIFICANT_DIGITS = 12  # of a value, so that 0.1 is not written as 0.10000000000000001


@dataclass(frozen=True)
class Axis:
    """One axis of the parameter grid of a sweep: a scenario key and its values.

    Attributes:
        target: Key or keys of a scenario that the axis changes.
        values: Values along the axis.
    """

    target: Target
    values: tuple[Value, ...]

    @property
    def is_numeric(self) -> bool:
        """Whether all values of the grid axis are numbers."""
        return all(map(is_number, self.values))


def is_number(value: object) -> bool:
    """Return whether a value is a number; True and False do not count as numbers.

    Args:
        value: Any value.
    """
    return isinstance(value, int | float) and not isinstance(value, bool)


def parse_axis(text: str) -> Axis:
    """Parse a command-line option KEY=VALUES as an axis of the parameter grid of a sweep.

    Args:
        text: `KEY=VALUES`.

    Raises:
        BadInput: The text is not an axis.
    """
    key, sign, values = text.partition("=")
    if not sign or not key.strip() or not values.strip():
        raise BadInput(
            f"--vary {text}: allowed is KEY=LOW:HIGH:COUNT, KEY=LOW:HIGH:COUNT:log or "
            "KEY=VALUE,VALUE,..."
        )
    return make_axis(key.strip(), values.strip())


def make_axis(key: str, values: str | Sequence[Value]) -> Axis:
    """Return an axis of the parameter grid of a sweep for a scenario key and its values.

    Args:
        key: Key or keys, as `parse_target` takes them.
        values: Values, or their text in a command-line option.

    Raises:
        BadInput: The values are wrong or repeat.
    """
    if isinstance(values, str):
        if ":" in values:
            values = _parse_range(key, values)
        else:
            values = parse_values(values)
    for value in values:
        if not isinstance(value, bool | int | float | str):
            raise BadInput(
                f"--vary {key}: {value!r} is no value; allowed are numbers, texts, true and false"
            )
        if isinstance(value, int) and abs(value) >= INTEGER_LIMIT:
            raise BadInput(f"--vary {key}: an integer has more than 64 bits")
    if not values or len(set(values)) < len(values):
        raise BadInput(f"--vary {key}: {len(values)} values, of which two are equal")
    return Axis(parse_target(key), tuple(values))


def parse_values(text: str) -> list[Value]:
    """Parse a comma-separated text of a command-line option as numbers, truth values and texts.

    Args:
        text: Values; each is true, false, a number, or else a text.

    Raises:
        BadInput: An integer has more than 64 bits.
    """
    return list(map(_parse_value, text.split(",")))


def _parse_value(text: str) -> Value:
    text = text.strip()
    if text in ("true", "false"):
        return text == "true"
    digits = text.lstrip("+-")
    if digits.isdecimal() and len(digits) > MOST_DIGITS:
        raise BadInput(
            f"{text[:12]}... is an integer of {len(digits)} digits; allowed are {MOST_DIGITS}"
        )
    for kind in (int, float):
        try:
            return kind(text)
        except ValueError:
            continue
    return text


def _parse_range(key: str, text: str) -> list[Value]:
    """Values of LOW:HIGH:COUNT or LOW:HIGH:COUNT:log, both ends included."""
    parts = list(map(_parse_value, text.split(":")))
    log = len(parts) == 4 and parts[3] == "log"
    numbers = [part for part in parts[:3] if isinstance(part, int | float) and isfinite(part)]
    if len(numbers) != 3 or len(parts) != 3 + log:
        raise BadInput(
            f"--vary {key}={text}: allowed is LOW:HIGH:COUNT, such as 0:0.5:11, or "
            "LOW:HIGH:COUNT:log"
        )
    low, high, count = map(float, numbers)
    if count != int(count) or not 2 <= count <= MOST_VALUES:
        raise BadInput(f"--vary {key}={text}: COUNT = {count:g}; allowed are 2 to {MOST_VALUES}")
    if not isfinite(high - low):
        raise BadInput(f"--vary {key}={text}: allowed are ends whose difference is a number")
    if low == high or (log and min(low, high) <= 0.0):
        both = ", both above 0" if log else ""
        raise BadInput(f"--vary {key}={text}: allowed are two different ends{both}")
    if log:
        values = np.geomspace(low, high, int(count))
    else:
        values = np.linspace(low, high, int(count))
        integers = all(isinstance(number, int) for number in numbers)
        if integers and np.all(values == np.round(values)):
            return list(map(int, values))
    return [float(f"{value:.{SIGNIFICANT_DIGITS}g}") for value in values]
