"""Units of variables in terms of the SI base units, as FMI defines them."""

import re
from collections import Counter
from collections.abc import Mapping
from math import pi
from typing import NamedTuple

from boatsim.errors import BadInput


class BaseUnit(NamedTuple):
    """A unit as a product of powers of base units, times a factor."""

    exponents: Mapping[str, int]  # base unit of FMI -> exponent that is not zero
    factor: float = 1.0


# Units that have a name of their own
NAMED: Mapping[str, BaseUnit] = {
    "kg": BaseUnit({"kg": 1}),
    "m": BaseUnit({"m": 1}),
    "s": BaseUnit({"s": 1}),
    "rad": BaseUnit({"rad": 1}),
    "N": BaseUnit({"kg": 1, "m": 1, "s": -2}),
    "V": BaseUnit({"kg": 1, "m": 2, "s": -3, "A": -1}),
    "A": BaseUnit({"A": 1}),
    "1": BaseUnit({}),
    "us": BaseUnit({"s": 1}, 1e-6),
    "rpm": BaseUnit({"rad": 1, "s": -1}, 2.0 * pi / 60.0),
    "rps": BaseUnit({"rad": 1, "s": -1}, 2.0 * pi),
}
# Last part of a channel's name -> its unit
SUFFIXES = {
    "N": "N",
    "Nm": "N m",
    "m": "m",
    "mps": "m/s",
    "mps2": "m/s^2",
    "rad": "rad",
    "radps": "rad/s",
    "rpm": "rpm",
    "rps": "rps",
    "s": "s",
    "us": "us",
    "V": "V",
    "A": "A",
}
FACTOR = re.compile(r"([A-Za-z]+|1)(?:\^(\d+))?")


def unit_of_channel(name: str) -> str:
    """Return the unit in which the name of a channel ends, "" for none.

    Args:
        name: Name such as `thrust_port_N`.
    """
    return SUFFIXES.get(name.rpartition("_")[2], "")


def base_unit(unit: str) -> BaseUnit:
    """Return a unit as powers of base units.

    Args:
        unit: Unit such as "N s^2/m^2": factors, of which those after "/" have negative exponents.

    Raises:
        BadInput: A factor is not a known unit.
    """
    exponents = Counter[str]()
    scale = 1.0
    above, _, below = unit.partition("/")
    for part, sign in ((above, 1), (below, -1)):
        for text in part.split():
            found = FACTOR.fullmatch(text)
            if found is None or found[1] not in NAMED:
                raise BadInput(f"unit {unit!r}: {text!r} is not known; {', '.join(NAMED)} are")
            power = sign * int(found[2] or 1)
            named = NAMED[found[1]]
            scale *= named.factor**power
            for base, exponent in named.exponents.items():
                exponents[base] += power * exponent
    kept = {base: exponent for base, exponent in exponents.items() if exponent}
    return BaseUnit(kept, scale)
