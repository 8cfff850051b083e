"""Facts of a run or a vessel that laws read: what shape each must have."""

from collections.abc import Mapping
from math import isfinite

WALLS, FORWARD = "walls_m", "forward_speed_mps"  # walls x_low, x_high, y_low, y_high [m]; mean speed ahead [m/s]


def wrong(facts: Mapping[str, object]) -> tuple[str, str] | None:
    """The first fact that no law could read, and what is allowed; None where all are well."""
    if WALLS in facts and not _walls(facts[WALLS]):
        return WALLS, "[x_low, x_high, y_low, y_high], four numbers, each low below its high"
    if FORWARD in facts and not _number(facts[FORWARD]):
        return FORWARD, "a number"
    return None


def _walls(found: object) -> bool:
    if not isinstance(found, list) or len(found) != 4 or not all(_number(x) for x in found):
        return False
    x_low, x_high, y_low, y_high = found
    return bool(x_low < x_high and y_low < y_high)


def _number(x: object) -> bool:
    return isinstance(x, int | float) and not isinstance(x, bool) and abs(x) < 1e300 and isfinite(x)
