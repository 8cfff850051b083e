"""What is drawn for each run: `KEY=normal(0.7, 0.05)` and other stated distributions."""

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import isfinite
from typing import Any, NamedTuple

from boatsim.errors import BadInput, unknown_name
from boatsim.physics.signals import Array
from boatsim.sweeps.axes import value_of
from boatsim.sweeps.keys import Target, Value, target

CALL = re.compile(r"(\w+)\s*\((.*)\)")


class Law(NamedTuple):
    """A distribution: what its numbers are called, whether they are right, and its quantiles."""

    numbers: tuple[str, ...]
    wrong: Callable[..., str]  # what is wrong with them, or ""
    made: Callable[..., Any]  # of scipy.stats and the numbers, a frozen distribution


def _spread(middle: float, sd: float) -> str:
    return "" if sd > 0.0 else "its spread must be above 0"


def _ends(low: float, high: float) -> str:
    return "" if low < high else "its low end must be below its high end"


LAWS = {
    "normal": Law(("mean", "sd"), _spread, lambda s, mean, sd: s.norm(mean, sd)),
    "uniform": Law(("low", "high"), _ends, lambda s, low, high: s.uniform(low, high - low)),
    "lognormal": Law(  # the spread is the standard deviation of its logarithm
        ("median", "spread"),
        lambda median, spread: (
            _spread(median, spread) or ("" if median > 0.0 else "its median must be above 0")
        ),
        lambda s, median, spread: s.lognorm(spread, scale=median),
    ),
    "truncated": Law(  # a normal one, what lies beyond the ends left out
        ("mean", "sd", "low", "high"),
        lambda mean, sd, low, high: _spread(mean, sd) or _ends(low, high),
        lambda s, mean, sd, low, high: s.truncnorm((low - mean) / sd, (high - mean) / sd, mean, sd),
    ),
    "triangular": Law(
        ("low", "mode", "high"),
        lambda low, mode, high: (
            _ends(low, high) or ("" if low <= mode <= high else "its mode must lie between")
        ),
        lambda s, low, mode, high: s.triang((mode - low) / (high - low), low, high - low),
    ),
    "loguniform": Law(
        ("low", "high"),
        lambda low, high: _ends(low, high) or ("" if low > 0.0 else "its low end must be above 0"),
        lambda s, low, high: s.loguniform(low, high),
    ),
}
CHOICE = "choice"


@dataclass(frozen=True)
class Draw:
    """One quantity that differs from run to run."""

    target: Target
    law: str
    numbers: tuple[Value, ...]  # of the law; of a choice its values

    def __str__(self) -> str:
        return f"{self.law}({', '.join(str(n) for n in self.numbers)})"

    def at(self, shares: Array) -> list[Value]:
        """The values that these shares (N,) of all draws, from 0 to 1, lie below."""
        if self.law == CHOICE:
            return [
                self.numbers[min(int(u * len(self.numbers)), len(self.numbers) - 1)] for u in shares
            ]
        from scipy import stats  # takes half a second

        found: list[Value] = LAWS[self.law].made(stats, *self.numbers).ppf(shares).tolist()
        return found


def draw(text: str) -> Draw:
    """The draw of an option. Raises BadInput."""
    key, sign, law = text.partition("=")
    if not sign or not key.strip():
        raise BadInput(
            f"--draw {text}: allowed is KEY=LAW(NUMBERS), such as fan_wind.speed=uniform(0,0.5)"
        )
    return draw_of(key.strip(), law.strip())


def draw_of(key: str, law: str) -> Draw:
    """The same of a key and a law in an option's words. Raises BadInput."""
    what, call = f"--draw {key}={law}", CALL.fullmatch(law)
    if not call:
        said = ", ".join(f"{name}({', '.join(one.numbers)})" for name, one in LAWS.items())
        raise BadInput(f"{what}: allowed is {said}, {CHOICE}(one, another, ...)")
    name, values = call[1], [value_of(part) for part in call[2].split(",")]
    if name == CHOICE:
        if len(values) < 2 or "" in values:
            raise BadInput(f"{what}: a choice needs two values or more")
        return Draw(target(key), name, tuple(values))
    if name not in LAWS:
        raise BadInput(f"{what}: {unknown_name('distribution', name, [*LAWS, CHOICE])}")
    return Draw(target(key), name, _numbers(what, name, values))


def _numbers(what: str, name: str, values: Sequence[Value]) -> tuple[Value, ...]:
    law = LAWS[name]
    if len(values) != len(law.numbers) or not all(
        isinstance(v, int | float) and isfinite(v) for v in values
    ):
        raise BadInput(f"{what}: {name} takes numbers: {', '.join(law.numbers)}")
    if wrong := law.wrong(*values):
        raise BadInput(f"{what}: {wrong} ({', '.join(law.numbers)})")
    return tuple(values)
