"""Lines of a proposed map for measured voltages of the supply."""

import numpy as np

from boatsim.recordings.importing.log import Log
from boatsim.recordings.importing.measured_lines import SUPPLY, InputSignal, lines_of_input
from boatsim.recordings.importing.signal_words import tokenize_name

# words in the name of a voltage
WORDS = {"voltage", "volt", "volts", "vbat", "vbatt", "vbus", "vsupply"}
UNITS = {"V": "", "mV": " * 0.001"}  # of a log -> factor to volts


def voltage_lines(column: str, about: str, log: Log) -> str:
    """Return lines of a map that propose signals for a measured voltage.

    Args:
        column: Column of the measured voltage, such as `battery_V`.
        about: Description of the quantity.
        log: The log.
    """
    return lines_of_input(column, about, voltage_inputs(log), SUPPLY)


def voltage_inputs(log: Log) -> list[InputSignal]:
    """Return the voltages of a log with their expressions in V.

    Args:
        log: The log.
    """
    found = []
    for name in voltage_signals(log):
        factor = UNITS.get(log.signals[name].unit, "")
        found.append(InputSignal(name, name + factor))
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
