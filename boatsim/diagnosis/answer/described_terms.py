"""Formulas in words: what a term varies with, its unit, and the statement of a formula."""

from collections import Counter, defaultdict
from collections.abc import Iterable, Sequence
from itertools import groupby

from boatsim.diagnosis.answer.schema import DescribedEntry, TermEntry
from boatsim.diagnosis.description import FittedTerm, SymbolicDescription
from boatsim.physics.described_laws import EVER, SymbolicTerm
from boatsim.physics.effects.described_force import DescribedForce
from boatsim.physics.effects.described_thrust import DescribedThrust
from boatsim.physics.signals import ROTATIONS
from boatsim.physics.terms import BEYOND, RIPPLES, UNITS, split_history_name
from boatsim.physics.vessel import Vessel
from boatsim.view.formatting import (
    format_number,
    format_quantity,
    format_unit,
    format_with_sd,
    name_and_unit,
    name_in_words,
)

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
    "north": "the position north",
    "east": "the position east",
    "depth": "the depth",
}
SIDES = {"all": "", "port": " to port", "starboard": " to starboard"}
SENSES = {"both": "", "ahead": " when pushing ahead", "astern": " when pushing astern"}
POWERS = {2: " squared", 3: " cubed"}
AT_FIRST = "at first"
MINUS = "−"  # as numbers are written
FADED = 37  # [%] what remains of a fading term after one time span: exp(-1)


def described_entries(
    description: SymbolicDescription | None, vessel: Vessel
) -> list[DescribedEntry]:
    """Return the formulas found by symbolic regression in the form used in diagnosis.json.

    Args:
        description: Terms found by symbolic regression; None if there are none.
        vessel: The vessel, for the units of its commands.

    Returns:
        One entry for each axis, recording of events, and whether it holds for held-out recordings;
        those with most evidence first.
    """
    if description is None:
        return []
    gains = defaultdict[tuple[str, bool, str], float](float)
    for w in description.terms:
        gains[_group(w)] += w.gain
    ordered = sorted(description.terms, key=lambda w: (-gains[_group(w)], _group(w), -w.gain))
    entries = []
    for _, group in groupby(ordered, _group):
        entries.append(_entry(list(group), vessel))
    return entries


def _group(w: FittedTerm) -> tuple[str, bool, str]:
    """Return what the terms of one formula have in common."""
    return term_axis(w.term), w.carries, w.term.run


def term_axis(term: SymbolicTerm) -> str:
    """Return the axis of the force of a term found by symbolic regression.

    It is "thrust" if the term changes the thrust of the drives.
    """
    if isinstance(term, DescribedForce):
        return term.axis
    return "thrust"


def axis_force_words(axis: str) -> str:
    """Return words for what a formula describes, by its axis, such as "a side force"."""
    return FORCES.get(axis, "a change of thrust")


def abscissa_label(over: str) -> str:
    """Return the label and unit of the variable over which a symbolic term's curve is drawn.

    Args:
        over: Name of a factor, "time" or "product".
    """
    if over == "time":
        return "time [s]"
    if over == "product":
        return "product of the factors [SI]"
    if over in RIPPLES:
        return f"position {over.removeprefix('ripple_')} [m]"
    how, signal = split_history_name(over, ())
    if how:
        return _recent_words(how, signal)
    if unit := UNITS.get(over, ""):
        return f"{FACTORS.get(over, name_in_words(over))} [{unit}]"
    return name_and_unit(over)[0]


def _recent_words(how: str, signal: str) -> str:
    """Return the label of the recent average of a signal, or of the deviation from it."""
    name, _, unit = abscissa_label(signal.removeprefix("abs_")).partition(" [")
    if signal.startswith("abs_"):
        name = f"the size of {name}"
    words = f"the recent average of {name}"
    if how != "recent":
        words = f"the deviation of {name} from its recent average"
    if unit:
        return f"{words} [{unit}"
    return words


def term_unit(term: SymbolicTerm) -> str:
    """Return the unit of the force of a term found by symbolic regression.

    It is "N", "N m", or "" for a share of the thrust.
    """
    axis = term_axis(term)
    if axis == "thrust":
        return ""
    if axis in ROTATIONS:
        return "N m"
    return "N"


def _entry(written: Sequence[FittedTerm], vessel: Vessel) -> DescribedEntry:
    """Return the entry of the terms of one formula."""
    axis, first = term_axis(written[0].term), written[0]
    statement = f"{axis_force_words(axis)} that no candidate effect explains: "
    statement += _sum(_statement(w, vessel) for w in written)
    return {
        "axis": axis,
        "statement": statement,
        "terms": [_term(w, vessel) for w in written],
        "carries_over": first.carries,
    }


def _sum(statements: Iterable[str]) -> str:
    """Return the sum of terms in words: 2 N times a, plus 3 N times b, minus 1 N times c."""
    text = ""
    for statement in statements:
        if not text:
            text = statement
        elif statement.startswith(MINUS):
            text += f", minus {statement.removeprefix(MINUS)}"
        else:
            text += f", plus {statement}"
    return text


def _term(w: FittedTerm, vessel: Vessel) -> TermEntry:
    entry: TermEntry = {
        "of": _varies_with(w.term, vessel),
        "value": w.term.coefficient,
        "sd": w.sd,
        "unit": coefficient_unit(w.term, vessel),
        "gain_nats": round(w.gain, 2),
    }
    if w.term.run:
        entry["run"] = w.term.run
    return entry


def _statement(w: FittedTerm, vessel: Vessel) -> str:
    """Return a term with its coefficient: 4.1 ± 0.2 N s²/m² times surge speed times yaw rate."""
    term, unit = w.term, coefficient_unit(w.term, vessel)
    if isinstance(term, DescribedThrust):
        text = _change_of_thrust(term, unit, w.sd)
    else:
        text = format_quantity(term.coefficient, unit, w.sd)
    if term.of:
        text += f" times {factors_in_words(term)}"
    if when := _activity_condition(term):
        text += f" {when}" if when.startswith(AT_FIRST) else f", {when}"
    return text


def _change_of_thrust(term: DescribedThrust, unit: str, sd: float) -> str:
    """Return the size of a change of thrust: 15.0 ± 2.0 % less thrust to port, when astern."""
    text = f"{format_with_sd(100.0 * abs(term.coefficient), 100.0 * sd)} %"
    if per := format_unit(unit).removeprefix("1"):
        text += f" {per}"
    more = "more thrust" if term.coefficient > 0.0 else "less thrust"
    return f"{text} {more}{SIDES[term.side]}{SENSES[term.sense]}"


def _varies_with(term: SymbolicTerm, vessel: Vessel) -> str:
    """Return what a term varies with, and when it acts."""
    parts = []
    if isinstance(term, DescribedThrust):
        sense = "" if term.sense == "both" else f" {term.sense}"
        thrust = f"thrust{SIDES[term.side]}{sense}"
        if term.of:
            thrust += f" times {factors_in_words(term)}"
        parts.append(thrust)
    elif term.of:
        parts.append(factors_in_words(term))
    elif term.acts == "always":
        parts.append("nothing (constant)")
    else:
        parts.append("time")
    if when := _activity_condition(term):
        parts.append(when)
    return ", ".join(parts)


def _activity_condition(term: SymbolicTerm) -> str:
    """Return when a term acts; "" if it always does."""
    begin, span = format_number(term.begin), term.end - term.begin
    recording = f" of {term.run}" if term.run else ""
    if term.acts == "within" and term.end >= EVER:
        return f"from {begin} s on{recording}"
    if term.acts == "within":
        return f"from {begin} to {format_number(term.end)} s{recording}"
    if term.acts == "rising":
        return f"rising from zero at {begin} s to its full value at {format_number(term.end)} s"
    if term.acts == "fading":
        start = AT_FIRST if term.begin == 0.0 else f"from {begin} s on"
        return f"{start}, falling to {FADED} % of that after {format_number(span)} s"
    if term.acts == "swinging":
        period = f"oscillating with a period of {format_number(span)} s"
        return f"{period} in {term.run}" if term.run else period
    return ""


def factors_in_words(term: SymbolicTerm) -> str:
    """Return in words what a term found by symbolic regression is proportional to.

    The text is empty if the term is constant.
    """
    parts = []
    for name, power in Counter(term.of).items():
        if name.startswith("abs_") and name.removeprefix("abs_") in term.of:
            continue
        parts.append(_factor(name, term) + POWERS.get(power, ""))
        if f"abs_{name}" in term.of:
            parts.append("its size")
    return " times ".join(parts)


def _factor(name: str, term: SymbolicTerm) -> str:
    if name in FACTORS:
        return FACTORS[name]
    if name in RIPPLES:
        along = name.removeprefix("ripple_")
        wavelength, crest = format_number(term.wavelength), format_number(term.crest)
        return f"a pattern that repeats every {wavelength} m {along}, with a crest at {crest} m"
    if name in BEYOND:
        speed = name.removeprefix("beyond_")
        limit = format_quantity(term.beyond, UNITS[speed])
        return f"the excess of {name_in_words(speed)} over {limit}"
    if name.startswith("abs_"):
        return f"the size of {_factor(name.removeprefix('abs_'), term)}"
    if name.startswith("sign_"):
        return f"the sign of {_factor(name.removeprefix('sign_'), term)}"
    how, signal = "", name
    if term.uses_history:
        how, signal = split_history_name(name, ())
    if how:
        average = f"average over the last {format_number(term.memory)} s"
        if how == "recent":
            return f"the {average} of {_factor(signal, term)}"
        return f"the deviation of {_factor(signal, term)} from its {average}"
    if name in UNITS:
        return name_in_words(name)
    return name_and_unit(name)[0]


def coefficient_unit(term: SymbolicTerm, vessel: Vessel) -> str:
    """Return the unit of the coefficient of a term found by symbolic regression.

    Args:
        term: A term of the symbolic regression.
        vessel: The vessel, for the units of its commands.

    Returns:
        Force or moment per product of the factors, without radians; "" for a share of the thrust.
    """
    powers = Counter[str]()
    if isinstance(term, DescribedForce):
        powers["N"] = 1
        powers["m"] = int(term.axis in ROTATIONS)
    for name in term.of:
        signal = split_history_name(name, vessel.described_signals)[1] or name
        unit = UNITS.get(name) or vessel.unit(signal.removeprefix("abs_"))
        above, _, below = unit.partition("/")
        _multiply(powers, above, -1)
        _multiply(powers, below, 1)
    del powers["rad"], powers["1"], powers[""]
    above, below = _product(powers, 1), _product(powers, -1)
    if below:
        return f"{above or '1'}/{below}"
    return above


def _multiply(powers: Counter[str], unit: str, sign: int) -> None:
    """Multiply the powers of a unit by another unit, or divide by it (sign -1)."""
    for part in unit.split():
        base, _, power = part.partition("^")
        powers[base] += sign * int(power or 1)


def _product(powers: Counter[str], sign: int) -> str:
    """Return the product of the units above the fraction line, or below it (sign -1)."""
    units = []
    for symbol, power in powers.items():
        n = sign * power
        if n == 1:
            units.append(symbol)
        elif n > 1:
            units.append(f"{symbol}^{n}")
    return " ".join(units)
