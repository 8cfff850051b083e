"""Columns that are there under another name: what the vessel moves or is steered by and the file calls otherwise."""

from boatsim.diagnosis.checks.finding import Change, Finding
from boatsim.physics.vessel import Vessel
from boatsim.recordings.expression import UNITS
from boatsim.recordings.importing.log import Log, Signal
from boatsim.recordings.importing.signal_classification import Guess, guesses, side_of, tokens_of
from boatsim.recordings.table import Recording

PLACE = {"x_m": "surge", "y_m": "sway", "psi_rad": "yaw"}


def look(recording: Recording, vessel: Vessel) -> list[Finding]:
    """What is missing and can be made of a column that is not ours; nothing where two might be it."""
    missing = [n for n, axis in PLACE.items() if axis in vessel.dof and n not in recording.signals]
    if {"u_mps", "v_mps"} & recording.signals.keys():
        missing = [n for n in missing if n == "psi_rad"]
    orders = [n for n in vessel.actuators if n not in recording.signals]
    if not missing and not orders:
        return []
    signals = {
        n: Signal(recording.t, v)
        for n, v in recording.signals.items()
        if n not in (*PLACE, *vessel.inputs)
    }
    there = guesses(Log(recording.path or vessel.file, signals), vessel.actuators)
    found = [(n, [g for g in there if g.column == n]) for n in missing]
    found += [(n, _orders(n, there)) for n in orders]
    made = {n: found[0] for n, found in found if found and len(found) == 1}
    if not made:
        return []
    names = ", ".join(f"{n} is missing, and {g.name} may be it" for n, g in made.items())
    changes = tuple(Change(n, g.name, _factor(g)) for n, g in made.items())
    return [Finding("column_names", names, sure=0.9, changes=changes)]


def _orders(name: str, there: list[Guess]) -> list[Guess]:
    """Commands of the same side that speak of the same thing: thrust, rudder, revolutions."""
    words = set(tokens_of(name))
    alike = [
        g for g in there if g.column == "command" and side_of(g.tokens) == side_of(frozenset(words))
    ]
    same = [g for g in alike if words & g.tokens - {"port", "starboard"}]
    return same or alike


def _factor(g: Guess) -> float:
    factor = 1.0
    for word in g.word.split(" * ") if g.word else ():
        factor *= UNITS[word] if word in UNITS else float(word)
    return factor
