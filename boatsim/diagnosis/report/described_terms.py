"""Described laws in words: what a term goes with, its unit, and the statement that a person reads."""

from collections import Counter, defaultdict
from collections.abc import Sequence
from itertools import groupby

from boatsim.diagnosis.description import Description, Written
from boatsim.diagnosis.report.formatting import (
    listed,
    number,
    parameter,
    plain,
    quantity,
    spread,
    unit_words,
)
from boatsim.diagnosis.report.schema import DescribedEntry, TermEntry
from boatsim.physics.described_laws import EVER, Described
from boatsim.physics.effects.described_force import DescribedForce
from boatsim.physics.effects.described_thrust import DescribedThrust
from boatsim.physics.terms import BEYOND, RIPPLES, UNITS, looking
from boatsim.physics.vessel import Vessel

FORCES = {
    "surge": "a force along the hull",
    "sway": "a side force",
    "heave": "a vertical force",
    "roll": "a roll moment",
    "pitch": "a trimming moment",
    "yaw": "a yaw moment",
    "north": "a force towards north",
    "east": "a force towards east",
}
FACTORS = {
    "cos_heading": "the cosine of the heading",
    "sin_heading": "the sine of the heading",
    "cos_twice_heading": "the cosine of twice the heading",
    "sin_twice_heading": "the sine of twice the heading",
    "north": "how far north she is",
    "east": "how far east she is",
    "depth": "how deep she floats",
}
POWERS = {2: " squared", 3: " cubed"}
TURNING = ("roll", "pitch", "yaw")
FADED = 37  # [%] what is left after one span of what fades: exp(-1)


def described_entries(description: Description | None, vessel: Vessel) -> list[DescribedEntry]:
    """The laws of a description, those that gain most first; what carries over apart from what does not."""
    if description is None:
        return []

    def key(w: Written) -> tuple[str, bool, str]:
        return axis_of(w.term), w.carries, w.term.run

    gains = defaultdict[tuple[str, bool, str], float](float)
    for w in description.terms:
        gains[key(w)] += w.gain
    ordered = sorted(description.terms, key=lambda w: (-gains[key(w)], key(w), -w.gain))
    return [_entry(list(group), vessel) for _, group in groupby(ordered, key)]


def axis_of(term: Described) -> str:
    """Axis of a described law; "thrust" of one that is about the drives."""
    return term.axis if isinstance(term, DescribedForce) else "thrust"


def what_of(axis: str) -> str:
    """What a described law is of: a side force."""
    return FORCES.get(axis, "a change of thrust")


def over_words(over: str) -> str:
    """What a curve is drawn over, with its unit."""
    if over in RIPPLES:
        return f"how far {over.removeprefix('ripple_')} she is [m]"
    if over in ("time", "product"):
        return "time [s]" if over == "time" else "product of the factors [SI]"
    how, signal = looking(over, ())
    if how:
        words = "of late" if how == "recent" else "beyond what it was of late"
        size = "the size of " if signal.startswith("abs_") else ""
        name, _, unit = over_words(signal.removeprefix("abs_")).partition(" [")
        return f"{size}{name} {words} [{unit}" if unit else f"{size}{name} {words}"
    unit = UNITS.get(over, "")
    return f"{FACTORS.get(over, plain(over))} [{unit}]" if unit else parameter(over)[0]


def share_or_force(term: Described) -> str:
    """Unit of what a term amounts to: "N", "N m", or "" of a share of the thrust."""
    axis = axis_of(term)
    return "" if axis == "thrust" else "N m" if axis in TURNING else "N"


def _entry(written: Sequence[Written], vessel: Vessel) -> DescribedEntry:
    axis, first = axis_of(written[0].term), written[0]
    statement = f"{what_of(axis)} that no entry explains: {listed((_said(w, vessel) for w in written), 'plus')}"
    if not first.carries:
        where = f"of {first.term.run}" if first.term.run else "of the recordings fitted"
        statement += f" (an event {where}: no law that unseen recordings bear out)"
    return {
        "axis": axis,
        "statement": statement,
        "terms": [_term(w, vessel) for w in written],
        "carries_over": first.carries,
    }


def _term(w: Written, vessel: Vessel) -> TermEntry:
    entry: TermEntry = {
        "of": _of(w.term, vessel),
        "value": w.term.coefficient,
        "sd": w.sd,
        "unit": unit_of(w.term, vessel),
        "gain_nats": round(w.gain, 2),
    }
    if w.term.run:
        entry["run"] = w.term.run
    return entry


def _said(w: Written, vessel: Vessel) -> str:
    """One term: 4.1 ± 0.2 N s²/m² times surge speed times yaw rate."""
    term = w.term
    if isinstance(term, DescribedThrust):
        more = "more" if term.coefficient > 0.0 else "less"
        per = unit_words(unit_of(term, vessel)).removeprefix("1")
        size = f"{spread(100.0 * abs(term.coefficient), 100.0 * w.sd)} %{f' {per}' if per else ''} {more}"
        size += {"all": "", "port": " to port", "starboard": " to starboard"}[term.side]
        size += {"both": "", "ahead": " when pushing ahead", "astern": " when pushing astern"}[
            term.sense
        ]
    else:
        size = quantity(term.coefficient, unit_of(term, vessel), w.sd)
    times = f" times {factors(term, vessel)}" if term.of else ""
    when = _when(term).removeprefix(", ")
    return f"{size}{times}{f' ({when})' if when else ''}"


def _of(term: Described, vessel: Vessel) -> str:
    """What a term goes with."""
    if isinstance(term, DescribedThrust):
        side = {"all": "", "port": " to port", "starboard": " to starboard"}[term.side]
        thrust = f"thrust{side}{'' if term.sense == 'both' else f' {term.sense}'}"
        return f"{thrust}{f' times {factors(term, vessel)}' if term.of else ''}{_when(term)}"
    return f"{factors(term, vessel) or 'nothing, it is constant'}{_when(term)}"


def _when(term: Described) -> str:
    """When it acts, with a comma; nothing of what always does."""
    begin, span = number(term.begin), term.end - term.begin
    if term.acts == "within":
        until = (
            f", from {begin} s on"
            if term.end >= EVER
            else f", from {begin} to {number(term.end)} s"
        )
        return until + (f" of {term.run}" if term.run else "")
    if term.acts == "rising":
        return f", rising from nothing at {begin} s to all of it at {number(term.end)} s"
    if term.acts == "fading":
        return f", fading from {begin} s on, to {FADED} % of it {number(span)} s later"
    if term.acts == "swinging":
        return f", swinging with a period of {number(span)} s" + (
            f" in {term.run}" if term.run else ""
        )
    return ""


def factors(term: Described, vessel: Vessel) -> str:
    """The product of its factors in words."""
    parts = []
    for name, power in Counter(term.of).items():
        own = f"abs_{name}"
        if name.startswith("abs_") and name.removeprefix("abs_") in term.of:
            continue
        parts.append(_factor(name, term) + POWERS.get(power, ""))
        if own in term.of:
            parts.append("its size")
    return " times ".join(parts)


def _factor(name: str, term: Described) -> str:
    if name in FACTORS:
        return FACTORS[name]
    if name in RIPPLES:
        along = name.removeprefix("ripple_")
        return f"a pattern that repeats every {number(term.wavelength)} m {along}, with a crest at {number(term.crest)} m"
    if name in BEYOND:
        speed = name.removeprefix("beyond_")
        return f"what {plain(speed)} is beyond {quantity(term.beyond, UNITS[speed])}"
    for mark, words in (("abs_", "the size of "), ("sign_", "the sense of ")):
        if name.startswith(mark):
            return words + _factor(name.removeprefix(mark), term)
    if term.looks_back and (looks := looking(name, ()))[0]:
        how, signal = looks
        said = _factor(signal, term)
        late = f"of the last {number(term.memory)} s"
        return f"{said} {late}" if how == "recent" else f"what {said} is beyond that {late}"
    return parameter(name)[0] if name not in UNITS else plain(name)


def unit_of(term: Described, vessel: Vessel) -> str:
    """Unit of its coefficient: force or moment per product of the factors, radians left out; "" of a share."""
    powers = Counter[str]()
    if isinstance(term, DescribedForce):
        powers["N"] = 1
        powers["m"] = int(term.axis in TURNING)
    for name in term.of:
        signal = looking(name, vessel.described_signals)[1] or name
        unit = UNITS.get(name) or vessel.unit(signal.removeprefix("abs_"))
        above, _, below = unit.partition("/")
        for part, sign in ((above, -1), (below, 1)):
            for symbol in part.split():
                base, _, power = symbol.partition("^")
                powers[base] += sign * int(power or 1)
    del powers["rad"], powers["1"], powers[""]
    above = " ".join(_power(b, n) for b, n in powers.items() if n > 0)
    below = " ".join(_power(b, -n) for b, n in powers.items() if n < 0)
    return f"{above or '1'}/{below}" if below else above


def _power(symbol: str, n: int) -> str:
    return symbol if n == 1 else f"{symbol}^{n}"
