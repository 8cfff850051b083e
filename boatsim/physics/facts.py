"""Facts of a run or a vessel: their allowed values and their descriptions.

Some facts are read by laws (the position of the walls), others exclude effects (no wind blows
indoors).
"""

from collections.abc import Mapping
from math import isfinite

WALLS = "walls_m"  # x_low, x_high, y_low, y_high [m]
# middle of all tracks, north and east, and half of their extent [m]; from the recordings
TRACK = "track_m"
BEGIN = "begin_s"  # time of the first row of all recordings [s]; from the recordings
DEPTH = "water_depth_m"  # mean depth of the water [m]
FORWARD = "forward_speed_mps"  # mean speed ahead [m/s]
WORDS = {
    WALLS: "the position of the walls",
    TRACK: "a track that stays within a few lengths of the boat",
    BEGIN: "the time of the first row",
    DEPTH: "the depth of the water",
    FORWARD: "the mean forward speed",
    "indoors": "whether it was recorded indoors",
    "still_water": "whether the water is still",
    "no_waves": "whether there are no waves",
    "no_water": "whether the craft moves without water",
    "moored": "whether a line holds the boat",
    "towing": "whether the boat tows something",
    "guided": "whether bearings or rails guide the boat",
    "weighed": "whether the mass was weighed as recorded",
    "steering_measured": "whether the steering angle is measured or the command",
    "position_fix": "the kind of position measurement",
    "position_wander_sd_m": "the rms of the slowly varying position error",
    "position_wander_time_s": "the correlation time of the slowly varying position error",
}
FLAGS = (  # true or false
    "indoors",
    "still_water",
    "no_waves",
    "no_water",
    "moored",
    "towing",
    "guided",
    "weighed",
    "steering_measured",
)
# rms [m] and correlation time [s] of the slowly varying error of positions
WANDER = ("position_wander_sd_m", "position_wander_time_s")
# kinds of position measurement: marks in a picture, satellites, motion capture, inertial
FIXES = ("camera", "gnss", "tracking", "inertial")


def describe_fact(fact: str) -> str:
    """Return a description in words of a fact about a recording, such as `still_water`.

    Args:
        fact: Key of the fact.
    """
    return WORDS.get(fact, fact)


def excluding_fact(by: Mapping[str, tuple[object, ...]], facts: Mapping[str, object]) -> str:
    """Return the fact that rules out an effect, as "fact = value", or "" if none does.

    An example is `indoors = true`, which rules out wind.

    Args:
        by: Values that exclude the effect, by fact (`Effect.ruled_out_by`).
        facts: The facts of a recording or vessel.
    """
    for fact, values in by.items():
        if fact in facts and facts[fact] in values:
            value = facts[fact]
            return f"{fact} = {str(value).lower() if isinstance(value, bool) else value}"
    return ""


def first_invalid_fact(facts: Mapping[str, object]) -> tuple[str, str] | None:
    """Return the first fact with an invalid value and a description of what is allowed, or None.

    Args:
        facts: The facts of a recording or vessel.
    """
    if WALLS in facts and not _are_walls(facts[WALLS]):
        return WALLS, "[x_low, x_high, y_low, y_high], four numbers, each low below its high"
    if FORWARD in facts and not _is_number(facts[FORWARD]):
        return FORWARD, "a number"
    for fact in FLAGS:
        if fact in facts and not isinstance(facts[fact], bool):
            return fact, "true or false"
    for fact in (*WANDER, DEPTH):
        if fact in facts and not _is_positive(facts[fact]):
            return fact, "a number above 0"
    given = [fact for fact in WANDER if fact in facts]
    if len(given) == 1:
        return given[0], f"both of {' and '.join(WANDER)}, or neither"
    if facts.get("position_fix", FIXES[0]) not in FIXES:
        return "position_fix", f"one of {', '.join(FIXES)}"
    return None


def _are_walls(found: object) -> bool:
    if not isinstance(found, list) or len(found) != 4 or not all(map(_is_number, found)):
        return False
    x_low, x_high, y_low, y_high = found
    return bool(x_low < x_high and y_low < y_high)


def _is_positive(found: object) -> bool:
    return isinstance(found, int | float) and _is_number(found) and found > 0


def _is_number(x: object) -> bool:
    return isinstance(x, int | float) and not isinstance(x, bool) and abs(x) < 1e300 and isfinite(x)
