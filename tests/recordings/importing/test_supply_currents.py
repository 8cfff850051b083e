"""Electric currents of a log are proposed for a measured current of the vessel."""

from pathlib import Path

import numpy as np
import pytest

from boatsim.recordings.importing.log import Log, Signal
from boatsim.recordings.importing.supply_currents import (
    supply_current_lines,
    supply_current_signals,
)

T = np.arange(30.0)
RISE = np.linspace(0.2, 1.0, 30)  # share of the largest current


def log_of(**signals: tuple[float, str]) -> Log:
    found = {name: Signal(T, largest * RISE, unit) for name, (largest, unit) in signals.items()}
    return Log(Path("run.csv"), found)


def proposed(column: str, log: Log, nominal: float = 40.0) -> str:
    return supply_current_lines(column, "battery", nominal, log).splitlines()[0]


@pytest.mark.parametrize(
    ("name", "unit"),
    [
        ("BAT.Curr", "A"),  # ArduPilot
        ("SYS_STATUS.current_battery", "cA"),  # MAVLink
        ("battery_status.current_a", ""),  # PX4
        ("battery_current_A", ""),
        ("Batteriestrom", ""),
        ("Motorstrom_links", ""),
        ("courant batterie [A]", ""),
        ("esc_1_amps", ""),
        ("I_port_A", ""),
        ("current", ""),  # of a size that no stream of water has
    ],
)
def test_currents_of_several_loggers_are_known_by_two_signs(name: str, unit: str) -> None:
    assert supply_current_signals(log_of(**{name: (60.0, unit)})) == [name]


@pytest.mark.parametrize(
    ("name", "unit"),
    [
        ("current", ""),  # perhaps of water
        ("current", "m/s"),
        ("current_speed", "kn"),
        ("current_direction_deg", ""),
        ("current_north_mps", ""),
        ("BAT.CurrTot", "mA.h"),
        ("battery_status.current_consumed", "mAh"),
        ("battery_voltage", "V"),
        ("qa", ""),
    ],
)
def test_a_stream_of_water_a_charge_and_other_signals_are_none(name: str, unit: str) -> None:
    assert supply_current_signals(log_of(**{name: (0.8, unit)})) == []


def test_numbers_too_large_for_a_stream_do_not_make_a_present_value_electric() -> None:
    assert supply_current_signals(log_of(current_orientation_1=(350.0, ""))) == []


def test_the_unit_by_format_or_name_is_converted() -> None:
    by_format = log_of(**{"SYS_STATUS.current_battery": (4000.0, "cA")})
    assert proposed("battery_A", by_format).startswith(
        'battery_A = "SYS_STATUS.current_battery * 0.01"'
    )
    assert '"battery_mA * 0.001"' in proposed("battery_A", log_of(battery_mA=(41000.0, "")))


@pytest.mark.parametrize(("largest", "factor"), [(60, ""), (6000, " * 0.01"), (60000, " * 0.001")])
def test_whole_numbers_far_beyond_the_nominal_current_show_its_unit(
    largest: int, factor: str
) -> None:
    log = Log(Path("run.csv"), {"battery_current": Signal(T, np.round(largest * RISE))})
    line = proposed("battery_A", log)
    assert line.startswith(f'battery_A = "battery_current{factor}"')
    assert ("whole numbers" in line) == bool(factor)


def test_a_current_that_is_negative_while_the_battery_gives_power_changes_its_sign() -> None:
    line = proposed("battery_A", log_of(battery_current=(-50.0, "A")))
    assert line.startswith('battery_A = "-battery_current"') and "sign inverted" in line


@pytest.mark.parametrize(("usual", "rare"), [(0.2, -30.0), (-0.2, 30.0)])
def test_rare_readings_or_a_small_offset_do_not_invert_a_current(usual: float, rare: float) -> None:
    amperes = np.where(np.arange(200) % 20 == 0, rare, usual)
    log = Log(Path("run.csv"), {"battery_current": Signal(np.arange(200.0), amperes, "A")})
    assert proposed("battery_A", log) == 'battery_A = "battery_current"  # CHECK: battery'


def test_each_drive_gets_the_current_that_is_called_like_it() -> None:
    log = log_of(current_motor_port=(30.0, "A"), current_motor_starboard=(31.0, "A"))
    assert '"current_motor_starboard"' in proposed("motor_starboard_A", log)
    assert '"current_motor_port"' in proposed("motor_port_A", log)


def test_a_log_without_an_electric_current_leaves_the_line_to_its_owner() -> None:
    assert proposed("battery_A", log_of(current_speed=(1.0, "kn"))).startswith("# battery_A")
