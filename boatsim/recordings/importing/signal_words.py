"""Words in the names of signals, which several rules of the classification share."""

import re

from boatsim.recordings.importing.foreign_words import UNKNOWN as LOST_LETTER
from boatsim.recordings.importing.foreign_words import english_unit, plain_name, translate_words

BRACKETED = re.compile(r"[\[(]([^\])]*)[\])]\s*$")  # Kurs [°]
WORDS = {  # unit as formats write it -> unit in expressions; "" is the SI unit
    **dict.fromkeys(("rad", "radian", "radians", "rad/s", "radps"), ""),
    **dict.fromkeys(("m", "metre", "meter", "metres", "meters", "m/s", "mps", "n"), ""),
    **dict.fromkeys(("deg", "degree", "degrees", "°"), "deg"),
    **dict.fromkeys(("deg/s", "degps", "°/s", "dps"), "degps"),
    **dict.fromkeys(("kn", "kt", "kts", "knots"), "kn"),
    **dict.fromkeys(("km/h", "kmh", "kph"), "kmh"),
    **dict.fromkeys(("%", "percent", "pct"), "percent"),
    **dict.fromkeys(("rpm", "1/min", "r/min"), "rpm"),
    **dict.fromkeys(("us", "µs"), "us"),
    "deg/min": "degpmin",
    "mm": "mm",
    "cdeg": "deg * 0.01",
    "cm": "cm",
    "km": "km",
    "ft": "ft",
}
SENSED = set("actual measured feedback fb telemetry esc state rsa sensed".split())
HELM = set("rudder steer steering nozzle azimuth azi helm delta jet angle pos wheel tiller".split())
ORDERED = set("reference ref setpoint sp desired des cmd command commanded order ordered".split())
SIDES = {
    **dict.fromkeys(("port", "left", "ps", "portside", "bb"), "port"),
    **dict.fromkeys(("starboard", "stbd", "stb", "right", "sb"), "starboard"),
}
LETTERS = {"l": "port", "p": "port", "r": "starboard", "s": "starboard"}  # sides of drives
ENDS = {
    **dict.fromkeys(("bow", "forward", "fwd", "fore", "front"), "forward"),
    **dict.fromkeys(("stern", "aft", "rear"), "aft"),
}
SATELLITES = set("gps gnss fix navsat rmc gga gll".split())
SPEEDS = {"rate", "speed", "velocity", "vel"}


def tokenize_name(name: str) -> list[str]:
    """Return the words and numbers of a name in lower case: ATT.DesYaw1 -> att, des, yaw, 1.

    Words of other European languages are translated: Ruderwinkel -> rudder, angle.
    """
    words: list[str] = []
    for word in translate_words(words_as_written(name)):
        words += filter(None, word.split(LOST_LETTER))
    return words


def words_as_written(name: str) -> list[str]:
    """Return the words and numbers of a name in lower case, without accents, not translated."""
    if not name.isascii() and (found := BRACKETED.search(name)):
        name = f"{name[: found.start()]} {english_unit(found[1]) or found[1]}"
    parted = re.sub(
        r"(?<=[a-z])(?=[A-Z])|(?<=[A-Za-z])(?=\d)|(?<=\d)(?=[A-Za-z])", " ", plain_name(name)
    ).lower()
    parted = re.sub(
        r"\b(rad|deg|grad|m)[_ ]?(?:/|p|per_?)?[_ ]?s(?:ec)?\b", r"\1/s", parted.replace("_", " ")
    )
    words: list[str] = []
    for token in re.split(rf"[^a-z0-9%°/{LOST_LETTER}]+", parted):
        unit = english_unit(token)
        if token in WORDS:
            words.append(token)
        elif "/" in token and unit:
            words.append(unit)
        else:
            words += token.split("/")
    return list(filter(None, words))


def side_from_tokens(tokens: frozenset[str]) -> str:
    """Return "port", "starboard" or "" by the words or single letters of a name."""
    for sides in (SIDES, LETTERS):
        for token in sorted(tokens):
            if token in sides:
                return sides[token]
    return ""


def end_from_tokens(tokens: frozenset[str]) -> str:
    """Return "forward", "aft" or "" by the words of a name for one end of the hull."""
    found = {ENDS[token] for token in tokens if token in ENDS}
    return found.pop() if len(found) == 1 else ""
