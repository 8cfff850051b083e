"""Distributions of episode parameters.

Examples are `uniform(0, 0.5)`, `normal(0.7, 0.05)` and `loguniform(0.1, 1)`.
The quantiles are computed directly, not with scipy.stats as in boatsim.sweeps.sampled_keys, because
environments sample at every reset and a frozen distribution of scipy.stats is many times slower.
"""

import re
from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from boatsim.errors import BadInput, unknown_name_message
from boatsim.physics.signals import Array

CALL = re.compile(r"\s*(\w+)\s*\(([^,]+),([^,]+)\)\s*")


class Distribution(NamedTuple):
    """Family of probability distributions with two parameters, such as uniform or normal."""

    numbers: str  # names of the two numbers
    valid: Callable[[float, float], bool]
    quantiles: Callable[[Array, float, float], Array]


def _uniform(probabilities: Array, low: float, high: float) -> Array:
    return low + (high - low) * probabilities


def _normal(probabilities: Array, mean: float, sd: float) -> Array:
    from scipy.special import ndtri  # only here, because its import is slow

    return np.asarray(mean + sd * ndtri(probabilities), dtype=float)


def _loguniform(probabilities: Array, low: float, high: float) -> Array:
    return np.asarray(low * np.exp(np.log(high / low) * probabilities), dtype=float)


DISTRIBUTIONS = {
    "uniform": Distribution("low, high", lambda low, high: low < high, _uniform),
    "normal": Distribution("mean, sd", lambda mean, sd: sd > 0.0, _normal),
    "loguniform": Distribution("low, high", lambda low, high: 0.0 < low < high, _loguniform),
}


@dataclass(frozen=True)
class SampledParameter:
    """Parameter of an effect that is sampled for each episode, with its distribution."""

    key: str
    distribution: str
    first: float
    second: float

    def quantiles(self, probabilities: Array) -> Array:
        """Return quantiles (k,) of the parameter's distribution, for given probabilities.

        Args:
            probabilities: Probabilities (k,) between 0 and 1.
        """
        family = DISTRIBUTIONS[self.distribution]
        return family.quantiles(probabilities, self.first, self.second)


def make_sampled_parameter(key: str, text: str) -> SampledParameter:
    """Return a parameter that is sampled for each episode, from a text that names its distribution.

    Args:
        key: Key of the parameter, such as "wind.speed".
        text: The distribution, such as "uniform(0, 0.5)".

    Raises:
        BadInput: The text is not a distribution.
    """
    call = CALL.fullmatch(text)
    if not call:
        allowed = ", ".join(f"{name}({family.numbers})" for name, family in DISTRIBUTIONS.items())
        raise BadInput(f"vary {key} = {text!r}; allowed is {allowed}, a number, or for load a list")
    name = call[1]
    if name not in DISTRIBUTIONS:
        raise BadInput(unknown_name_message(f"vary {key}: distribution", name, DISTRIBUTIONS))
    family = DISTRIBUTIONS[name]
    try:
        first = float(call[2])
        second = float(call[3])
    except ValueError:
        expected = f"{name} takes two numbers: {family.numbers}"
        raise BadInput(f"vary {key} = {text!r}; {expected}") from None
    if not family.valid(first, second):
        raise BadInput(f"vary {key} = {text!r}; its numbers {family.numbers} are out of order")
    return SampledParameter(key, name, first, second)
