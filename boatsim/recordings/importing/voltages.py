"""Lines of a proposed map for measured voltages of the supply."""

import numpy as np

from boatsim.recordings.importing.log import Log
from boatsim.recordings.importing.measured_lines import SUPPLY, InputSignal, lines_of_input
from boatsim.recordings.importing.signal_words import tokenize_name
from boatsim.recordings.importing.supply_units import SmallerUnit, factor_and_note

# words in the name of a voltage
WORDS = {"voltage", "volt", "volts", "vbat", "vbatt", "vbus", "vsupply"}
# A voltage is about the nominal one: far larger whole numbers are in mV
UNITS = {"V": SmallerUnit(1.0), "mV": SmallerUnit(0.001, 200.0)}


def voltage_lines(column: str, about: str, nominal: float, log: Log) -> str:
    """Return lines of a map that propose signals for a measured voltage.

    Args:
        column: Column of the measured voltage, such as `battery_V`.
        about: Description of the quantity.
        nominal: Nominal voltage [V]; 0 if unknown.
        log: The log.
    """
    return lines_of_input(column, about, voltage_inputs(log, nominal), SUPPLY)


def voltage_inputs(log: Log, nominal: float = 0.0) -> list[InputSignal]:
    """Return the voltages of a log with their expressions in V.

    Args:
        log: The log.
        nominal: Nominal voltage [V]; 0 if unknown.
    """
    found = []
    for name in voltage_signals(log):
        factor, note = factor_and_note(name, log.signals[name], UNITS, nominal)
        found.append(InputSignal(name, name + factor, note))
    return found


def voltage_signals(log: Log) -> list[str]:
    """Return the names of the signals of a log that are voltages and not always 0.

    Args:
        log: The log.
    """
    found = []
    for name, signal in log.signals.items():
        is_voltage = signal.unit in UNITS or bool(WORDS & set(tokenize_name(name)))
        known = signal.values[np.isfinite(signal.values)]
        if is_voltage and known.any():
            found.append(name)
    return found
