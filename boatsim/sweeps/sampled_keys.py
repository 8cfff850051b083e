"""Sampled quantities of a sweep: `KEY=normal(0.7, 0.05)` and other distributions."""

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import isfinite
from typing import Any, NamedTuple

import numpy as np

from boatsim.errors import BadInput, unknown_name_message
from boatsim.physics.signals import Array
from boatsim.sweeps.axes import is_number, parse_values
from boatsim.sweeps.keys import Target, Value, parse_target

CALL = re.compile(r"(\w+)\s*\((.*)\)")


class Distribution(NamedTuple):
    """A kind of probability distribution that a sweep can sample, with checks of its parameters.

    Attributes:
        numbers: Names of its parameters.
        fault: Function of the parameters that returns what is wrong with them, or "".
        frozen: Function of `scipy.stats` and the parameters that returns the frozen distribution.
    """

    numbers: tuple[str, ...]
    fault: Callable[..., str]
    frozen: Callable[..., Any]


def _fault_of_sd(mean: float, sd: float) -> str:
    if sd > 0.0:
        return ""
    return "its spread must be above 0"


def _fault_of_order(low: float, high: float) -> str:
    if low < high:
        return ""
    return "its low end must be below its high end"


def _fault_of_lognormal(median: float, spread: float) -> str:
    if median <= 0.0:
        return "its median must be above 0"
    return _fault_of_sd(median, spread)


def _fault_of_truncated(mean: float, sd: float, low: float, high: float) -> str:
    return _fault_of_sd(mean, sd) or _fault_of_order(low, high)


def _fault_of_triangular(low: float, mode: float, high: float) -> str:
    if not low <= mode <= high:
        return "its mode must lie between its ends"
    return _fault_of_order(low, high)


def _fault_of_loguniform(low: float, high: float) -> str:
    if low <= 0.0:
        return "its low end must be above 0"
    return _fault_of_order(low, high)


DISTRIBUTIONS = {
    "normal": Distribution(("mean", "sd"), _fault_of_sd, lambda s, mean, sd: s.norm(mean, sd)),
    "uniform": Distribution(
        ("low", "high"), _fault_of_order, lambda s, low, high: s.uniform(low, high - low)
    ),
    # The spread is the standard deviation of the logarithm.
    "lognormal": Distribution(
        ("median", "spread"),
        _fault_of_lognormal,
        lambda s, median, spread: s.lognorm(spread, scale=median),
    ),
    "truncated": Distribution(
        ("mean", "sd", "low", "high"),
        _fault_of_truncated,
        lambda s, mean, sd, low, high: s.truncnorm((low - mean) / sd, (high - mean) / sd, mean, sd),
    ),
    "triangular": Distribution(
        ("low", "mode", "high"),
        _fault_of_triangular,
        lambda s, low, mode, high: s.triang((mode - low) / (high - low), low, high - low),
    ),
    "loguniform": Distribution(
        ("low", "high"), _fault_of_loguniform, lambda s, low, high: s.loguniform(low, high)
    ),
}
CHOICE = "choice"


@dataclass(frozen=True)
class SampledKey:
    """Quantity of a scenario that a sweep samples from a distribution for each run.

    Attributes:
        target: Key or keys of a scenario that get the sampled value.
        distribution: Name of the distribution, or CHOICE.
        numbers: Parameters of the distribution; of a choice its values.
    """

    target: Target
    distribution: str
    numbers: tuple[Value, ...]

    def __str__(self) -> str:
        return f"{self.distribution}({', '.join(map(str, self.numbers))})"

    def quantiles(self, probabilities: Array) -> list[Value]:
        """Return the quantiles of the sampled quantity's distribution at given probabilities.

        Args:
            probabilities: Probabilities (N,) from 0 to 1.
        """
        if self.distribution == CHOICE:
            last = len(self.numbers) - 1
            indices = np.minimum((probabilities * len(self.numbers)).astype(int), last)
            return [self.numbers[index] for index in indices.tolist()]
        from scipy import stats  # its import takes half a second

        frozen = DISTRIBUTIONS[self.distribution].frozen(stats, *self.numbers)
        found: list[Value] = frozen.ppf(probabilities).tolist()
        return found


def parse_sampled_key(text: str) -> SampledKey:
    """Parse a command-line option KEY=DISTRIBUTION(NUMBERS) as a quantity that a sweep samples.

    Args:
        text: `KEY=DISTRIBUTION(NUMBERS)`.

    Raises:
        BadInput: The text is not a sampled quantity.
    """
    key, sign, call = text.partition("=")
    if not sign or not key.strip():
        raise BadInput(
            f"--draw {text}: allowed is KEY=DISTRIBUTION(NUMBERS), such as "
            "fan_wind.speed=uniform(0,0.5)"
        )
    return make_sampled_key(key.strip(), call.strip())


def make_sampled_key(key: str, call: str) -> SampledKey:
    """Return a quantity that a sweep samples, from a scenario key and the text of a distribution.

    Args:
        key: Key or keys, as `parse_target` takes them.
        call: `DISTRIBUTION(NUMBERS)`.

    Raises:
        BadInput: The distribution or its numbers are wrong.
    """
    option = f"--draw {key}={call}"
    match = CALL.fullmatch(call)
    if not match:
        allowed = ", ".join(f"{n}({', '.join(d.numbers)})" for n, d in DISTRIBUTIONS.items())
        raise BadInput(f"{option}: allowed is {allowed}, {CHOICE}(one, another, ...)")
    name = match[1]
    values = parse_values(match[2])
    if name == CHOICE:
        if len(values) < 2 or "" in values:
            raise BadInput(f"{option}: a choice needs two values or more")
    elif name in DISTRIBUTIONS:
        _check_numbers(option, name, values)
    else:
        names = [*DISTRIBUTIONS, CHOICE]
        raise BadInput(f"{option}: {unknown_name_message('distribution', name, names)}")
    return SampledKey(parse_target(key), name, tuple(values))


def _check_numbers(option: str, name: str, values: Sequence[Value]) -> None:
    distribution = DISTRIBUTIONS[name]
    expected = ", ".join(distribution.numbers)
    finite = [value for value in values if is_number(value) and isfinite(float(value))]
    if len(finite) < len(values) or len(values) != len(distribution.numbers):
        raise BadInput(f"{option}: {name} takes numbers: {expected}")
    if fault := distribution.fault(*values):
        raise BadInput(f"{option}: {fault} ({expected})")
