"""Facts of a run or a vessel: what shape each must have, and what it says in words.

Some are read by laws (where the walls are), others rule entries of the library out (no wind blows indoors).
"""

from collections.abc import Mapping
from math import isfinite

WALLS, FORWARD = (
    "walls_m",
    "forward_speed_mps",
)  # walls x_low, x_high, y_low, y_high [m]; mean speed ahead [m/s]
WORDS = {
    WALLS: "where the walls are",
    FORWARD: "the mean speed ahead",
    "indoors": "it was recorded indoors",
    "still_water": "the water stands still",
    "no_waves": "there are no waves",
    "moored": "whether a line holds the boat",
    "steering_measured": "the steering angle is the measured one, not the command",
    "position_fix": "what the position was fixed with",
    "position_wander_sd_m": "how far the error of a position wanders",
    "position_wander_time_s": "over which time it does",
}
FLAGS = ("indoors", "still_water", "no_waves", "moored", "steering_measured")  # true or false
WANDER = (
    "position_wander_sd_m",
    "position_wander_time_s",
)  # rms [m] and correlation time [s] of an error of fixes
FIXES = (
    "camera",
    "gnss",
    "tracking",
    "inertial",
)  # what a position is fixed with: marks in a picture, satellites, ...


def in_words(fact: str) -> str:
    """What a fact says, for a report."""
    return WORDS.get(fact, fact)


def ruled_out(by: Mapping[str, tuple[object, ...]], facts: Mapping[str, object]) -> str:
    """The fact that rules an entry out, as it is stated; "" where none does."""
    return next(
        (
            f"{f} = {_toml(facts[f])}"
            for f, values in by.items()
            if f in facts and facts[f] in values
        ),
        "",
    )


def _toml(value: object) -> str:
    return str(value).lower() if isinstance(value, bool) else str(value)


def wrong(facts: Mapping[str, object]) -> tuple[str, str] | None:
    """The first fact that no law could read, and what is allowed; None where all are well."""
    if WALLS in facts and not _walls(facts[WALLS]):
        return WALLS, "[x_low, x_high, y_low, y_high], four numbers, each low below its high"
    if FORWARD in facts and not _number(facts[FORWARD]):
        return FORWARD, "a number"
    if fact := next((f for f in FLAGS if f in facts and not isinstance(facts[f], bool)), None):
        return fact, "true or false"
    if fact := next((f for f in WANDER if f in facts and not _positive(facts[f])), None):
        return fact, "a number above 0"
    if fact := next(
        (f for f in WANDER if (WANDER[0] in facts) != (WANDER[1] in facts) and f in facts), None
    ):
        return fact, f"both of {' and '.join(WANDER)}, or neither"
    if facts.get("position_fix", FIXES[0]) not in FIXES:
        return "position_fix", f"one of {', '.join(FIXES)}"
    return None


def _walls(found: object) -> bool:
    if not isinstance(found, list) or len(found) != 4 or not all(_number(x) for x in found):
        return False
    x_low, x_high, y_low, y_high = found
    return bool(x_low < x_high and y_low < y_high)


def _positive(found: object) -> bool:
    return isinstance(found, int | float) and _number(found) and found > 0


def _number(x: object) -> bool:
    return isinstance(x, int | float) and not isinstance(x, bool) and abs(x) < 1e300 and isfinite(x)
