"""Lines of a proposed map for measured voltages of the supply."""

import numpy as np

from boatsim.files import toml_key, toml_value
from boatsim.recordings.importing.log import Log
from boatsim.recordings.importing.signal_words import tokenize_name

# words in the name of a voltage
WORDS = {"voltage", "volt", "volts", "vbat", "vbatt", "vbus", "vsupply"}
SUPPLY = {"battery", "batt", "bat", "supply", "bus", "main"}  # more often that of the drives
UNITS = {"V": "", "mV": " * 0.001"}  # of a log -> factor to volts


def voltage_lines(column: str, about: str, log: Log) -> str:
    """Return lines of a map that propose signals for a measured voltage.

    The signal whose name has most words of the column and of a supply is proposed, and the others
    are listed in comments.

    Args:
        column: Column of the measured voltage, such as `battery_V`.
        about: Description of the quantity.
        log: The log.
    """
    found = voltage_signals(log)
    if not found:
        return f'# {toml_key(column)} = "..."  # CHECK: {about}\n'
    words = set(tokenize_name(column))

    def matches(name: str) -> int:
        own = set(tokenize_name(name))
        return 2 * len(own & words) + len(own & SUPPLY)

    names = sorted(found, key=matches, reverse=True)
    lines = ""
    for i, name in enumerate(names):
        sign = "" if i == 0 else "# or "
        factor = UNITS.get(log.signals[name].unit, "")
        lines += f"{sign}{toml_key(column)} = {toml_value(name + factor)}  # CHECK: {about}\n"
    return lines


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
