"""Declaration of a setting of a diagnosis: default, unit, reason and allowed range."""

from dataclasses import field
from math import inf
from typing import Any, TypeAlias

Number: TypeAlias = int | float


def setting(
    default: Number | tuple[Number, ...],
    unit: str,
    reason: str,
    low: float = 0.0,
    high: float = inf,
) -> Any:
    """Declare a numerical setting of a diagnosis with its unit, reason and allowed range.

    It is a field of a dataclass that holds the settings of one group.

    Args:
        default: Value used unless the user gives another; its type is the type of the setting.
        unit: Unit of the value, "1" for a ratio, "count" for an integer.
        reason: What the setting does, and why it has this value.
        low: Smallest value allowed.
        high: Largest value allowed.

    Returns:
        A dataclass field that carries the unit, the reason and the range as metadata.
    """
    about = {"unit": unit, "reason": reason, "low": low, "high": high}
    return field(default=default, metadata=about)
