"""Lines of a proposed map for measured electric currents of the supply."""

import numpy as np

from boatsim.physics.base import Array
from boatsim.recordings.importing.log import Log, Signal
from boatsim.recordings.importing.measured_lines import SUPPLY, InputSignal, lines_of_input
from boatsim.recordings.importing.signal_words import SIDES, tokenize_name
from boatsim.recordings.importing.supply_units import (
    SmallerUnit,
    factor_and_note,
    stated_unit,
)

# words in the name of an electric current; "current" is also a stream of water
CERTAIN = {"amp", "amps", "ampere", "amperes", "amperage", "ibat", "ibatt", "ibus", "isupply"}
AMBIGUOUS = {"current", "curr"}
# words of what draws or gives an electric current
ELECTRIC = SUPPLY | set("motor motors esc drive thruster propeller power pack pdb bms".split())
ELECTRIC |= set(SIDES)
# words of the stream of water, of settings and of a charge
OTHER = set(
    "speed velocity vel direction dir set drift north east x y sea tidal tide water stream mps "
    "m/s kn heading course time max limit consumed used total tot ah mah".split()
)
# A current is up to a few times the nominal one: larger whole numbers are in cA or mA
UNITS = {"A": SmallerUnit(1.0), "cA": SmallerUnit(0.01, 20.0), "mA": SmallerUnit(0.001, 200.0)}
FASTEST_STREAM = 10.0  # [m/s] no water is faster; a larger number is in A
MOSTLY = 0.5  # share of the readings other than 0


def supply_current_lines(column: str, about: str, nominal: float, log: Log) -> str:
    """Return lines of a map that propose signals for a measured electric current.

    Args:
        column: Column of the measured current, such as `battery_A`.
        about: Description of the quantity.
        nominal: Nominal current [A]; 0 if unknown.
        log: The log.
    """
    return lines_of_input(column, about, supply_current_inputs(log, nominal), SUPPLY)


def supply_current_inputs(log: Log, nominal: float = 0.0) -> list[InputSignal]:
    """Return the electric currents of a log with their expressions in A.

    The sign of a current that is mostly negative, and negative on average, is inverted, for a
    vessel under way discharges its battery.

    Args:
        log: The log.
        nominal: Nominal current [A]; 0 if unknown.
    """
    found = []
    for name in supply_current_signals(log):
        found.append(_input_signal(name, log.signals[name], nominal))
    return found


def supply_current_signals(log: Log) -> list[str]:
    """Return the names of the signals of a log that are electric currents and not always 0.

    The name and the unit, or the name and the size of the numbers show that no stream of water is
    meant.

    Args:
        log: The log.
    """
    found = []
    for name, signal in log.signals.items():
        known = signal.values[np.isfinite(signal.values)]
        if known.any() and _is_electric(name, signal, known):
            found.append(name)
    return found


def _is_electric(name: str, signal: Signal, known: Array) -> bool:
    words = set(tokenize_name(name))
    if words & OTHER:
        return False
    if signal.unit:
        return signal.unit in UNITS
    if words & CERTAIN:
        return True
    by_suffix = bool(stated_unit(name, signal, UNITS))
    if words & AMBIGUOUS:
        if words & ELECTRIC or by_suffix:
            return True
        return not words - AMBIGUOUS and float(np.max(np.abs(known))) > FASTEST_STREAM
    return by_suffix and bool(words & ELECTRIC)


def _input_signal(name: str, signal: Signal, nominal: float) -> InputSignal:
    factor, note = factor_and_note(name, signal, UNITS, nominal)
    notes = [note] if note else []
    values = signal.values[np.isfinite(signal.values)]
    negative = float(np.mean(values[values != 0.0] < 0.0))
    sign = ""
    if negative > MOSTLY and float(np.mean(values)) < 0.0:
        sign = "-"
        notes.append(
            f"sign inverted, for {100.0 * negative:.0f} % of the readings other than 0 are negative"
        )
    return InputSignal(name, f"{sign}{name}{factor}", "; ".join(notes))
