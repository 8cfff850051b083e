"""Numbers and sentences as a person reads them: degrees, handy units, as many digits as the spread allows."""

import math
import re
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from boatsim.recording_notes import unit_of

DEGREE = 180.0 / math.pi
IN_DEGREES = {"rad": "°", "rad/s": "°/s", "rad/s^2": "°/s²"}
FORCES = ((1e6, 1e6, "M"), (1e3, 1e3, "k"), (1e-2, 1.0, ""), (0.0, 1e-3, "m"))  # from this size on, factor, prefix
LENGTHS = ((1.0, 1.0, "m"), (1e-2, 1e-2, "cm"), (0.0, 1e-3, "mm"))
FACTOR = "(kg|rad|N|m|s)([2-9]?)"
UNIT = re.compile(f"({FACTOR})+(p({FACTOR})+)?|per({FACTOR})+")  # how keys spell a unit
SUPERSCRIPTS = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


def plain(name: str) -> str:
    """A name of a file or key as words: `weak_reverse` -> weak reverse."""
    return name.replace("_", " ")


def listed(words: Iterable[str], last: str = "and") -> str:
    """A, B and C."""
    *head, tail = list(words) or [""]
    return f"{', '.join(head)} {last} {tail}" if head else tail


def capital(words: str) -> str:
    """First letter large, the rest as it is."""
    return words[:1].upper() + words[1:]


def _decimals(size: float, digits: int) -> int:
    return max(0, digits - 1 - math.floor(math.log10(size))) if size > 0.0 and math.isfinite(size) else 0


def number(value: float, digits: int = 3) -> str:
    """To this many significant digits; a power of ten only where plain digits would be hard to read."""
    if not math.isfinite(value):
        return "none" if math.isnan(value) else "∞"
    size, value = abs(value), value + 0.0  # -0 becomes 0
    if value == 0.0 or 1e-4 <= size < 1e6:
        text = f"{value:.{_decimals(size, digits)}f}"
    else:
        power = math.floor(math.log10(size))
        text = f"{value / 10.0**power:.{digits - 1}f} × 10{str(power).translate(SUPERSCRIPTS)}"
    return text.replace("-", "−")


def spread(value: float, sd: float) -> str:
    """Value ± standard deviation, both to the digits the deviation allows: 0.694 ± 0.012."""
    if not (math.isfinite(value) and math.isfinite(sd) and sd > 0.0):
        return number(value)
    largest = max(abs(value), sd)
    power = 0 if 1e-3 <= largest < 1e5 else math.floor(math.log10(largest))
    value, sd = value / 10.0**power, sd / 10.0**power
    places = min(_decimals(sd, 2), 6)
    text = f"{value:.{places}f} ± {sd:.{places}f}".replace("-", "−")
    return f"({text}) × 10{str(power).translate(SUPERSCRIPTS)}" if power else text


def unit_words(unit: str) -> str:
    """Unit as printed: N s^2/m^2 -> N s²/m²."""
    for digit in "234":
        unit = unit.replace(f"^{digit}", digit.translate(SUPERSCRIPTS))
    return unit


def quantity(value: float, unit: str, sd: float = 0.0) -> str:
    """Value ± deviation with its unit; angles in degrees."""
    if unit in IN_DEGREES:
        value, sd, unit = value * DEGREE, sd * DEGREE, IN_DEGREES[unit]
    gap = "" if unit.startswith("°") or not unit else " "
    text = spread(value, sd)
    return f"({text}){gap}{unit}" if gap == "" and unit and "±" in text else f"{text}{gap}{unit_words(unit)}"


def parameter(key: str, unit: str = "") -> tuple[str, str]:
    """(name in words, unit) of a parameter key of the answer: `toward_rad` -> (toward, rad)."""
    compact = unit.replace("1/", "per").replace("/", "p").replace("^", "").replace(" ", "")
    if compact and key.endswith(f"_{compact}"):
        return plain(key.removesuffix(f"_{compact}")), unit
    if unit:
        return plain(key), unit
    name, _, ending = key.rpartition("_")
    unit = unit_of(key) or (_spelt(ending) if name and UNIT.fullmatch(ending) else "")
    return plain(name if unit else key), unit


def _spelt(compact: str) -> str:
    """Ns2pm2 -> N s^2/m^2."""
    if compact.startswith("per"):
        return f"1/{_spelt(compact.removeprefix('per'))}"
    above, _, below = compact.partition("p")
    parts = (" ".join(f"{u}^{n}" if n else u for u, n in re.findall(FACTOR, part)) for part in (above, below))
    return "/".join(part for part in parts if part)


def percent(share: float) -> str:
    """A probability; never 0 or 100 %."""
    if share > 0.999:
        return "> 99.9 %"
    if share < 0.001:
        return "< 0.1 %"
    return f"{100 * share:.{0 if 0.01 < share < 0.99 else 1}f} %"


def handy(unit: str, largest: float) -> tuple[str, float]:
    """(unit, factor) that make a number of this size readable: m -> cm, N -> kN, rad -> °."""
    if unit in IN_DEGREES:
        return IN_DEGREES[unit], DEGREE
    if unit in ("m", "N", "N m"):
        steps = LENGTHS if unit == "m" else FORCES
        _, size, name = next((s for s in steps if largest >= s[0]), steps[-1])
        return name if unit == "m" else name + unit, 1.0 / size
    return unit_words(unit), 1.0


def alike(values: Sequence[float], unit: str) -> list[str]:
    """Several values of one unit, all in the same handy one."""
    name, factor = handy(unit, max((abs(v) for v in values if math.isfinite(v)), default=0.0))
    gap = "" if name.startswith("°") else " "
    return [f"{number(v * factor)}{gap}{name}" for v in values]


def parameters(effect: Mapping[str, Any]) -> str:
    """The fitted numbers of an effect in a row: astern factor 0.694 ± 0.012; without those that may well be zero."""
    found = [(p["value"], p["sd"], *parameter(key, p["unit"])) for key, p in effect["parameters"].items()]
    return ", ".join(f"{name} {quantity(value, unit, sd)}" for value, sd, name, unit in found if abs(value) > sd)


def sentence(answer: Mapping[str, Any]) -> str:
    """The verdict of a diagnosis in one sentence, made of the words of the effects it names."""
    effects = answer["effects"]
    physics = [_clause(e) for e in effects if e["kind"] != "measurement"]
    measured = [_clause(e) for e in effects if e["kind"] == "measurement"]
    named = ""
    if physics:
        count = {1: "one thing", 2: "two things", 3: "three things"}.get(len(physics), f"{len(physics)} things")
        named = f"the model leaves out {count}: {listed(physics)}"
    if measured:
        alone = "the physics is right, the measurement is not: "
        named += ("; beside it, in the measurement and not in the physics: " if named else alone) + listed(measured)
    if answer["verdict"] == "unknown":
        strong = [f"{a['rms']:.2g} {a['unit']} rms in {axis}" for axis, a in answer["where"]["axes"].items()]
        size = f" ({listed(strong)})" if strong else ""
        beside = f"; beside it, {named}" if named else ""
        return f"Something is missing that no entry of the library explains{size}{beside}."
    if not named:
        return "Nothing is missing that these recordings could show: the vessel explains them to within their noise."
    ties = [e for e in effects if e["tied_with"]]
    doubt = "; but these recordings can not tell " + listed(
        f"{plain(e['name'])} from {listed(map(plain, e['tied_with']), 'or')}" for e in ties
    )
    return capital(named) + (doubt if ties else "") + "."


def _clause(effect: Mapping[str, Any]) -> str:
    numbers = parameters(effect)
    return f"{effect['words']} ({numbers})" if numbers else str(effect["words"])
