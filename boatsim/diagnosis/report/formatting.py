"""Numbers and sentences as a person reads them: degrees, handy units, as many digits as the spread allows."""

import math
import re
from collections.abc import Iterable, Mapping, Sequence

from boatsim.diagnosis.report.schema import Answer, EffectEntry
from boatsim.recordings.notes import unit_of

DEGREE = 180.0 / math.pi
IN_DEGREES = {"rad": "°", "rad/s": "°/s", "rad/s^2": "°/s²"}
FORCES = (
    (1e6, 1e6, "M"),
    (1e3, 1e3, "k"),
    (1e-2, 1.0, ""),
    (0.0, 1e-3, "m"),
)  # from this size on, factor, prefix
STEPS = {  # unit -> from this size on, size of the unit taken instead, its name
    "m": ((1.0, 1.0, "m"), (1e-2, 1e-2, "cm"), (0.0, 1e-3, "mm")),
    "m/s": ((0.1, 1.0, "m/s"), (1e-2, 1e-2, "cm/s"), (0.0, 1e-3, "mm/s")),
    "s": ((0.1, 1.0, "s"), (0.0, 1e-3, "ms")),
} | {
    unit: tuple((least, size, name + unit) for least, size, name in FORCES) for unit in ("N", "N m")
}
COUNTS = (
    "nothing",
    "one thing",
    "two things",
    "three things",
    "four things",
    "five things",
    "six things",
)
UNTRIED = "nothing was tried to explain it (facts or the vessel's reasons leave every entry out)"
MOST = 3  # numbers of one effect in the sentence; the table has all of them
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
    return (
        max(0, digits - 1 - math.floor(math.log10(size)))
        if size > 0.0 and math.isfinite(size)
        else 0
    )


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


def nats(gain: float) -> str:
    """A gain in nats; tenths are enough to judge by."""
    return f"{gain:.{1 if abs(gain) < 100.0 else 0}f}".replace("-", "−").replace("−0.0", "0.0")


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


def quantity(value: float, unit: str, sd: float = 0.0, digits: int = 3) -> str:
    """Value ± deviation in a handy unit; angles in degrees. Without a deviation, to so many digits."""
    name, factor = handy(unit, max((abs(v) for v in (value, sd) if math.isfinite(v)), default=0.0))
    text = spread(value * factor, sd * factor) if sd > 0.0 else number(value * factor, digits)
    if name.startswith("°"):
        return f"{text.replace(' ± ', f'{name} ± ') if '×' not in text else text}{name}"
    return f"{text} {name}".rstrip()


def shown(key: str, value: float, unit: str = "", sd: float = 0.0) -> tuple[str, str]:
    """(name, value ± deviation) of a parameter as people say it: shares in %, bearings from 0 to 360°."""
    name, unit = parameter(key, unit)
    if name.endswith("fraction") and not unit:
        return name.removesuffix(
            "fraction"
        ).strip() or name, f"{spread(100.0 * value, 100.0 * sd)} %"
    if name == "toward" and unit == "rad":
        value %= 2.0 * math.pi
    if (
        name == "frequency" and unit == "rad/s" and value > 0.0
    ):  # of a wave, which nobody counts in degrees
        return name, f"{spread(value, sd)} rad/s, a period of {number(2.0 * math.pi / value)} s"
    return name, quantity(value, unit, sd)


def limit(key: str, value: float) -> tuple[str, str]:
    """(name, largest strength) of a parameter that was not found: 3.9 mm/s; factors and shares in %."""
    name, unit = parameter(key)
    if not unit and name.endswith(("factor", "fraction")):
        return name.removesuffix("fraction").strip() or name, f"{number(100.0 * value, 2)} %"
    return name, quantity(value, unit, digits=2)


def readable(words: str) -> str:
    """A sentence of the answer for people: degrees by their sign, no p-value at its end (the table has it)."""
    words = re.sub(
        r"([\d.]+) rad(?![/\w])", lambda found: f"{float(found[1]) * DEGREE:.2g}°", words
    )
    return re.sub(r"(\d) deg\b", r"\1°", re.sub(r"; p [<=] \S+$", "", words))


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
    parts = (
        " ".join(f"{u}^{n}" if n else u for u, n in re.findall(FACTOR, part))
        for part in (above, below)
    )
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
    if unit in STEPS and largest > 0.0:
        _, size, name = next(s for s in STEPS[unit] if largest >= s[0])
        return name, 1.0 / size
    return unit_words(unit), 1.0


def alike(values: Sequence[float], unit: str) -> list[str]:
    """Several values of one unit, all in the same handy one."""
    name, factor = handy(unit, max((abs(v) for v in values if math.isfinite(v)), default=0.0))
    gap = "" if name.startswith("°") else " "
    return [f"{number(v * factor)}{gap}{name}" for v in values]


def said(words: str) -> str:
    """What an entry says; that it is not physics is said once, not in every clause."""
    return words.removesuffix(" (not physics)")


def parameters(effect: EffectEntry, words: Mapping[str, str]) -> str:
    """The fitted numbers of an effect in a row: astern factor 0.694 ± 0.012; the first few, none that may be zero."""
    found = []
    for key, p in effect["parameters"].items():
        name, text = shown(key, p["value"], p["unit"], p["sd"])
        if effect["kind"] == "measurement":  # "cos" says little, "error heading north" does
            name = words.get(f"{effect['name']}.{key}", name)
        if abs(p["value"]) > p["sd"] or "factor" in key:
            found.append(
                f"{name} {text}{', as far as the entry goes' if p.get('at_bound') else ''}"
            )
    return ", ".join(found[:MOST])


def sentence(answer: Answer, words: Mapping[str, str] | None = None) -> str:
    """The verdict of a diagnosis in one sentence, made of the words of the effects it names.

    `words` is what parameters mean, by "effect.parameter".
    """
    effects = answer["effects"]
    if not tried(answer):
        return f"{capital(_untried(answer))}."
    physics = [_clause(e, words or {}) for e in effects if e["kind"] != "measurement"]
    measured = [_clause(e, words or {}) for e in effects if e["kind"] == "measurement"]
    unknown, described = answer["unknown"]["flag"], _described(answer, bool(effects))
    parts = []
    if unknown and not described:
        parts = [
            f"something is missing that no entry of the library explains{_sizes(answer)}{_with(answer)}"
        ]
    if physics:
        count = COUNTS[len(physics)] if len(physics) < len(COUNTS) else f"{len(physics)} things"
        parts.append(
            f"{'besides, ' if parts else ''}the model leaves out {count}: {_clauses(physics)}"
        )
    if measured:
        also, only = (
            "the measurement is off as well, which is not physics",
            "the measurement is off, not the physics",
        )
        parts.append(f"{also if parts else only}: {_clauses(measured)}")
    if described:
        parts += [f"{'besides, ' if parts else ''}{described[0]}", *described[1:]]
    if not parts:
        return "Nothing is missing that these recordings could show: the vessel explains them to within their noise."
    ties = [
        f"{plain(e['name'])} from {listed(map(plain, e['tied_with']), 'or')}"
        for e in effects
        if e["tied_with"]
    ]
    if ties:
        parts.append(f"but these recordings cannot tell {listed(ties)}")
    return f"{capital('; '.join(parts))}."


def _described(answer: Answer, beside: bool) -> list[str]:
    """Laws that were written down, those first that carry over; events of runs in full only where there is no more."""
    lasting = [d["statement"] for d in answer["described"] if d["carries_over"]][:MOST]
    events = [d["statement"] for d in answer["described"] if not d["carries_over"]]
    if not events or not (lasting or beside):
        return lasting + events[:MOST]
    count = (
        "one event of a run is" if len(events) == 1 else f"{len(events)} events of single runs are"
    )
    return [*lasting, f"{count} left over, {'' if len(events) == 1 else 'first '}{events[0]}"]


def tried(answer: Answer) -> bool:
    """Whether there was any entry to explain the recordings with."""
    return bool(answer["candidates"])


def _untried(answer: Answer) -> str:
    """What can be said all the same: whether more force is left than the vessel file tolerates."""
    if answer["verdict"] == "unknown":
        return f"something is missing{_sizes(answer)}, and {UNTRIED}"
    return f"no more force is missing than moving water makes, but {UNTRIED}"


def _sizes(answer: Answer) -> str:
    """How large what nothing explains is, per axis; in brackets."""
    axes = answer["unknown"].get("rest") or answer["where"]["axes"]
    sizes = [f"{quantity(a['rms'], a['unit'], digits=2)} rms in {axis}" for axis, a in axes.items()]
    return f" ({listed(sizes)})" if sizes else ""


def _with(answer: Answer) -> str:
    """What it goes with, if with anything."""
    found = answer["unknown"].get("structure")
    return f", which in {found['axis']} goes with {found['goes_with']}" if found else ""


def _clause(effect: EffectEntry, words: Mapping[str, str]) -> str:
    numbers = parameters(effect, words)
    return said(effect["words"]) + (f" ({numbers})" if numbers else "")


def _clauses(clauses: Sequence[str]) -> str:
    """A, B, and C: clauses have commas of their own."""
    *head, tail = clauses
    return f"{', '.join(head)}, and {tail}" if head else tail
