"""What is varied from one grid point to the next: `KEY=0:0.5:11`, `KEY=0.01:1:5:log`, `KEY=light,heavy`."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from boatsim.errors import BadInput
from boatsim.sweeps.keys import Target, Value, target

MOST = 100_000  # values of one axis


@dataclass(frozen=True)
class Axis:
    """One direction of the grid."""

    target: Target
    values: tuple[Value, ...]

    @property
    def ranged(self) -> bool:
        """Whether its values are numbers, which have an order and a distance."""
        return all(
            isinstance(value, int | float) and not isinstance(value, bool) for value in self.values
        )


def axis(text: str) -> Axis:
    """The axis of an option. Raises BadInput."""
    key, sign, values = text.partition("=")
    if not sign or not key.strip() or not values.strip():
        raise BadInput(
            f"--vary {text}: allowed is KEY=LOW:HIGH:COUNT, KEY=LOW:HIGH:COUNT:log or KEY=VALUE,VALUE,..."
        )
    return axis_of(key.strip(), values.strip())


def axis_of(key: str, values: str | Sequence[Value]) -> Axis:
    """The same of a key and its values, in an option's words or as they are. Raises BadInput."""
    if isinstance(values, str):
        values = (
            _range(key, values) if ":" in values else [value_of(part) for part in values.split(",")]
        )
    if not values or len(set(values)) < len(values):
        raise BadInput(
            f"--vary {key}: {len(values)} values, of which one is there twice; each makes its own runs"
        )
    return Axis(target(key), tuple(values))


def value_of(text: str) -> Value:
    """A value as it is written: true, false, a number, else a text."""
    text = text.strip()
    if text in ("true", "false"):
        return text == "true"
    for kind in (int, float):
        try:
            return kind(text)
        except ValueError:
            continue
    return text


def _range(key: str, text: str) -> list[Value]:
    """LOW:HIGH:COUNT, both ends among the values."""
    parts = [value_of(part) for part in text.split(":")]
    log = len(parts) == 4 and parts[3] == "log"
    numbers = parts[:3]
    if len(parts) != 3 + log or not all(
        isinstance(p, int | float) and np.isfinite(p) for p in numbers
    ):
        raise BadInput(
            f"--vary {key}={text}: allowed is LOW:HIGH:COUNT, such as 0:0.5:11, or LOW:HIGH:COUNT:log"
        )
    low, high, count = (float(p) for p in numbers)
    if count != int(count) or not 2 <= count <= MOST:
        raise BadInput(f"--vary {key}={text}: COUNT = {count:g}; allowed are 2 to {MOST}")
    if low == high or (log and min(low, high) <= 0.0):
        raise BadInput(
            f"--vary {key}={text}: allowed are two different ends{', both above 0' if log else ''}"
        )
    found = np.geomspace(low, high, int(count)) if log else np.linspace(low, high, int(count))
    whole = (
        not log
        and all(isinstance(p, int) for p in numbers)
        and bool(np.all(found == np.round(found)))
    )
    return [int(x) if whole else float(f"{x:.12g}") for x in found]
