"""Lines of a proposed map for measured electric currents of the supply."""

import re

import numpy as np

from boatsim.physics.base import Array
from boatsim.recordings.importing.log import Log, Signal
from boatsim.recordings.importing.measured_lines import SUPPLY, InputSignal, lines_of_input
from boatsim.recordings.importing.signal_words import SIDES, tokenize_name

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
UNITS = {"A": 1.0, "mA": 0.001, "cA": 0.01}  # of a log -> factor to amperes
SUFFIX = re.compile(r"(?<![A-Za-z])(A|mA|cA)\W*$")  # unit at the end of a name
FASTEST_STREAM = 10.0  # [m/s] no water is faster; a larger number is in A
# A reading in whole numbers that exceeds the nominal current by this factor is in cA, and by the
# second one in mA. A current is up to a few times the nominal one
LEAST_FACTORS = {"cA": 20.0, "mA": 200.0}


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

    A unit that the log does not state is found by two signs, whole numbers and their size. The sign
    of a current that is mostly negative is inverted, for a vessel under way discharges its battery.

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
    by_suffix = bool(_unit(name, signal))
    if words & AMBIGUOUS:
        if words & ELECTRIC or by_suffix:
            return True
        return not words - AMBIGUOUS and float(np.max(np.abs(known))) > FASTEST_STREAM
    return by_suffix and bool(words & ELECTRIC)


def _unit(name: str, signal: Signal) -> str:
    """The unit by the format or the end of the name; "" if none is stated."""
    if signal.unit in UNITS:
        return signal.unit
    found = SUFFIX.search(name)
    return found[1] if found else ""


def _input_signal(name: str, signal: Signal, nominal: float) -> InputSignal:
    notes = []
    values = signal.values[np.isfinite(signal.values)]
    unit = _unit(name, signal)
    if not unit:
        unit = _unit_by_size(values, nominal)
        if unit:
            notes.append(f"in {unit} by whole numbers of this size")
    factor = ""
    if unit and UNITS[unit] != 1.0:
        factor = f" * {UNITS[unit]:g}"
    sign = ""
    if float(np.mean(values)) < 0.0:
        sign = "-"
        notes.append("sign inverted, for the readings are mostly negative")
    return InputSignal(name, f"{sign}{name}{factor}", "; ".join(notes))


def _unit_by_size(values: Array, nominal: float) -> str:
    """The unit of whole numbers far beyond the nominal current; "" for amperes."""
    is_whole = bool((values == np.round(values)).all())
    if not is_whole or nominal <= 0.0:
        return ""
    unit = ""
    for smaller, factor in LEAST_FACTORS.items():
        if float(np.percentile(np.abs(values), 90)) > factor * nominal:
            unit = smaller
    return unit
