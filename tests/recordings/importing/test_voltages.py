"""Voltages of a log are proposed for a measured voltage of the vessel."""

from pathlib import Path

import numpy as np
import pytest

from boatsim.recordings.importing.log import Log, Signal
from boatsim.recordings.importing.voltages import voltage_lines, voltage_signals

T = np.arange(30.0)


def log_of(**signals: tuple[float, str]) -> Log:
    found = {name: Signal(T, np.full(30, value), unit) for name, (value, unit) in signals.items()}
    return Log(Path("run.csv"), found)


LOG = log_of(
    motor_voltage=(24.0, ""),
    battery_voltage=(24100.0, "mV"),
    heading=(90.0, "deg"),
    spare_volt=(0.0, "V"),
)


def test_voltages_are_known_by_their_names_and_units_and_are_not_always_zero() -> None:
    assert voltage_signals(LOG) == ["motor_voltage", "battery_voltage"]


def test_the_best_name_is_proposed_in_volts_and_the_others_are_comments() -> None:
    first, second = voltage_lines("battery_V", "supply", 24.0, LOG).splitlines()
    assert first == 'battery_V = "battery_voltage * 0.001"  # CHECK: supply'
    assert second == '# or battery_V = "motor_voltage"  # CHECK: supply'


def test_a_log_without_voltage_leaves_the_line_to_its_owner() -> None:
    assert voltage_lines("battery_V", "supply", 24.0, log_of()) == (
        '# battery_V = "..."  # CHECK: supply\n'
    )


@pytest.mark.parametrize("name", ["vbat_mV", "voltage [mV]", "VBAT.mV"])
def test_a_unit_at_the_end_of_the_name_is_converted_and_to_be_checked(name: str) -> None:
    line = voltage_lines("battery_V", "supply", 0.0, log_of(**{name: (24100.0, "")}))
    assert f'"{name} * 0.001"' in line and "CHECK: supply; in mV by its name" in line


@pytest.mark.parametrize(("value", "factor"), [(24100.0, " * 0.001"), (24.0, ""), (26500.5, "")])
def test_whole_numbers_far_beyond_the_nominal_voltage_are_in_millivolts(
    value: float, factor: str
) -> None:
    line = voltage_lines("battery_V", "supply", 24.0, log_of(vbat=(value, "")))
    assert line.startswith(f'battery_V = "vbat{factor}"')
    assert ("whole numbers" in line) == bool(factor)
