"""Distributions of episode parameters: `uniform(0, 0.5)`, `normal(0.7, 0.05)`, `loguniform(0.1, 1)`.

The quantiles are computed directly, not with scipy.stats as in boatsim.sweeps.sampled_keys, because
environments sample at every reset and a frozen distribution of scipy.stats is many times slower.
"""

import re
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.special import ndtri

from boatsim.errors import BadInput, unknown_name
from boatsim.physics.signals import Array

CALL = re.compile(r"\s*(\w+)\s*\(([^,]+),([^,]+)\)\s*")
LAWS: dict[
    str, tuple[str, Callable[[float, float], bool], Callable[[Array, float, float], Array]]
] = {
    "uniform": (
        "low, high",
        lambda low, high: low < high,
        lambda p, low, high: low + (high - low) * p,
    ),
    "normal": ("mean, sd", lambda mean, sd: sd > 0.0, lambda p, mean, sd: mean + sd * ndtri(p)),
    "loguniform": (
        "low, high",
        lambda low, high: 0.0 < low < high,
        lambda p, low, high: low * np.exp(np.log(high / low) * p),
    ),
}


@dataclass(frozen=True)
class Draw:
    """One quantity and its distribution."""

    key: str
    law: str
    first: float
    second: float

    def at(self, shares: Array) -> Array:
        """Return the quantiles of the distribution.

        Args:
            shares: Probabilities (k,) between 0 and 1.
        """
        return LAWS[self.law][2](shares, self.first, self.second)


def draw(key: str, said: str) -> Draw:
    """Return the sampled quantity of a key and a distribution.

    Args:
        key: Key of the quantity.
        said: Text of the distribution.

    Raises:
        BadInput: The text is not a distribution.
    """
    call = CALL.fullmatch(said)
    allowed = ", ".join(f"{name}({numbers})" for name, (numbers, _, _) in LAWS.items())
    if not call:
        raise BadInput(f"vary {key} = {said!r}; allowed is {allowed}, a number, or for load a list")
    name = call[1]
    if name not in LAWS:
        raise BadInput(unknown_name(f"vary {key}: distribution", name, LAWS))
    try:
        first, second = float(call[2]), float(call[3])
    except ValueError:
        raise BadInput(
            f"vary {key} = {said!r}; {name} takes two numbers: {LAWS[name][0]}"
        ) from None
    if not LAWS[name][1](first, second):
        raise BadInput(f"vary {key} = {said!r}; its numbers {LAWS[name][0]} are out of order")
    return Draw(key, name, first, second)
