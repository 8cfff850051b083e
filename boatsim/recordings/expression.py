"""Expressions that compute a column from a signal: `[-] name [* unit or number].

[+ number [* unit]]`.

The text is parsed, never executed as code.
"""

import math
import re
from collections.abc import Collection
from dataclasses import dataclass

from boatsim.errors import BadInput, nearest_hint
from boatsim.physics.base import Array

UNITS = {  # word -> factor to the SI unit (rad, s, m, m/s, rad/s, N, m/s^2, 1)
    "rad": 1.0, "deg": math.pi / 180.0, "rev": 2.0 * math.pi,
    "radps": 1.0, "degps": math.pi / 180.0, "degpmin": math.pi / 180.0 / 60.0,
    "rpm": 2.0 * math.pi / 60.0, "rps": 2.0 * math.pi,
    "percent": 0.01, "permille": 0.001,
    "s": 1.0, "ms": 1e-3, "us": 1e-6, "ns": 1e-9, "min": 60.0, "h": 3600.0,
    "m": 1.0, "mm": 1e-3, "cm": 1e-2, "km": 1e3, "ft": 0.3048, "nmi": 1852.0,
    "mps": 1.0, "cmps": 1e-2, "mmps": 1e-3, "kmh": 1.0 / 3.6, "kn": 1852.0 / 3600.0, "mph": 0.44704,
    "mps2": 1.0, "g": 9.80665,  # standard gravity, 3rd CGPM 1901
    "N": 1.0, "kN": 1e3, "kgf": 9.80665, "lbf": 4.4482216152605,
}  # fmt: skip
NUMBER = r"(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?"
OFFSET = re.compile(rf"(?<![*/\s])\s+([+-])\s*({NUMBER})(?:\s*\*\s*([A-Za-z]\w*))?\s*$")
FACTOR = re.compile(r"(?:\s*\*\s*|\s+(/)\s+)([^\s*/]+)\s*$")
MAX_FACTORS = 6


@dataclass(frozen=True)
class Expression:
    """Formula for a column of a recording: a signal of a log times a factor plus an offset.

    Attributes:
        signal: Name of the signal in a log or table.
        factor: Factor to the unit of the column.
        offset: Offset in the unit of the column.
    """

    signal: str
    factor: float = 1.0
    offset: float = 0.0

    def convert(self, values: Array) -> Array:
        """Apply the formula to the signal's values (N,); return the values (N,) of the column."""
        return values * self.factor + self.offset


def parse(text: str, known: Collection[str] = ()) -> Expression:
    """Parse the text of a formula for a column, such as "-delta" or "heading_deg * deg".

    Args:
        text: The text.
        known: Names of signals; a text that is one of them is the name, whatever characters it has.

    Raises:
        BadInput: With what is allowed, without file and key.
    """
    rest = text.strip()
    if rest in known:
        return Expression(rest)
    sign = 1.0
    if rest.startswith("-"):
        sign = -1.0
        rest = rest[1:].strip()
    if rest in known:
        return Expression(rest, sign)
    offset, factor = 0.0, sign
    if found := OFFSET.search(rest):
        offset = float(f"{found[1]}{found[2]}")
        if found[3]:
            offset *= _unit(found[3])
        rest = rest[: found.start()]
    for _ in range(MAX_FACTORS):
        if rest in known:
            break
        found = FACTOR.search(rest)
        if found is None:
            break
        value = _value(found[2])
        if not found[1]:
            factor *= value
        elif value == 0.0:
            raise BadInput(f"{text!r} divides by zero")
        else:
            factor /= value
        rest = rest[: found.start()]
    name = rest.strip()
    if not name or "*" in name:
        raise BadInput(
            f"{text[:80]!r} is no expression; allowed is [-] name [* unit or number] [+ number]"
        )
    if not (math.isfinite(factor) and math.isfinite(offset)):
        raise BadInput(f"{text[:80]!r} has a number too large to use")
    return Expression(name, factor, offset)


def _value(word: str) -> float:
    if re.fullmatch(rf"[+-]?{NUMBER}", word):
        return float(word)
    return _unit(word)


def _unit(word: str) -> float:
    if word in UNITS:
        return UNITS[word]
    hint = nearest_hint(word, UNITS)
    raise BadInput(f"there is no unit {word[:40]!r}{hint} (there are: {', '.join(sorted(UNITS))})")
