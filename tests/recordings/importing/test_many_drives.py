"""Orders of many drives that only a number tells apart are matched in the order of the drives."""

from pathlib import Path

import numpy as np
import pytest

from boatsim.recordings.importing.channels import VesselChannel
from boatsim.recordings.importing.log import Log, Signal
from boatsim.recordings.importing.mapping_proposal import propose_map

T = 0.1 * np.arange(600)
PLACES = ("bow_port", "bow_starboard", "stern_starboard", "stern_port")
THRUSTS = [VesselChannel(f"thrust_{place}_N", -250.0, 400.0) for place in PLACES]
ANGLES = [VesselChannel(f"steer_{place}_rad", -np.pi, np.pi) for place in PLACES]
DRIVES = [one for pair in zip(THRUSTS, ANGLES, strict=True) for one in pair]


def wave(number: int, low: float, high: float) -> Signal:
    phase = np.sin((0.1 + 0.03 * number) * T + number)
    return Signal(T, 0.5 * (low + high) + 0.5 * (high - low) * phase)


def log_of_drives(numbers: tuple[int, ...], largest: float = 390.0) -> Log:
    signals = {
        "fix.latitude": Signal(T, 63.0 + 1e-5 * np.sin(0.1 * T)),
        "fix.longitude": Signal(T, 10.0 + 1e-5 * np.cos(0.1 * T)),
        "heading.heading_rad": Signal(T, 0.2 * np.sin(0.05 * T)),
    }
    for number in numbers:
        signals[f"reference_{number}.throttle_reference"] = wave(number, -100.0, largest)
        signals[f"reference_{number}.angle_reference"] = wave(number, 0.0, 359.0)
        signals[f"azimuth_{number}.data"] = wave(number, 5.0, 350.0)
    return Log(Path("log.csv"), signals)


def proposed(log: Log, drives: list[VesselChannel] = DRIVES) -> dict[str, str]:
    lines = {}
    for line in propose_map(log, "ferry", drives, ("surge", "sway", "yaw")).splitlines():
        name, equals, rest = line.partition(" = ")
        if equals:
            lines[name] = rest
    return lines


@pytest.mark.parametrize("first", [0, 1])
def test_orders_go_to_the_drives_in_the_order_of_their_numbers(first: int) -> None:
    lines = proposed(log_of_drives(tuple(range(first, first + 4))))
    for i, (thrust, angle) in enumerate(zip(THRUSTS, ANGLES, strict=True), first):
        assert lines[thrust.name].startswith(f'"reference_{i}.throttle_reference"')
        assert lines[angle.name].startswith(f'"reference_{i}.angle_reference * deg"')
        assert "CHECK: by number" in lines[thrust.name]
        assert "CHECK: by number" in lines[angle.name]


def test_signals_of_another_number_of_drives_are_not_matched_by_number() -> None:
    for numbers in ((1, 2, 3), (1, 2, 3, 5), (1, 2, 3, 4, 5)):
        lines = proposed(log_of_drives(numbers))
        assert not any("by number" in line for line in lines.values()), numbers


def test_two_drives_are_matched_by_their_sides_and_the_motion() -> None:
    drives = [VesselChannel(f"thrust_{side}_N", -250.0, 400.0) for side in ("port", "starboard")]
    lines = proposed(log_of_drives((1, 2)), drives)
    assert not any("by number" in line for line in lines.values())


def test_a_number_that_is_too_large_for_a_force_is_pointed_out() -> None:
    lines = proposed(log_of_drives((1, 2, 3, 4), largest=880.0))
    assert "CHECK: as N up to 2.2 times the vessel's range" in lines[THRUSTS[0].name]
    usual = proposed(log_of_drives((1, 2, 3, 4)))
    assert "the vessel's range" not in usual[THRUSTS[0].name]


def test_an_angle_beside_no_thrust_is_no_order() -> None:
    log = log_of_drives((1, 2, 3, 4))
    signals = {name: s for name, s in log.signals.items() if "throttle" not in name}
    lines = proposed(Log(log.path, signals))
    assert "reference" not in lines.get(ANGLES[0].name, "")
    assert lines[ANGLES[2].name].startswith('"azimuth_3.data * deg"')


def test_signals_with_the_names_of_the_channels_keep_them() -> None:
    drives = [VesselChannel(f"thruster_{number}_N", -250.0, 400.0) for number in (3, 1, 2)]
    log = log_of_drives((1, 2, 3))
    signals = {f"thruster_{number}_N": wave(number, -100.0, 390.0) for number in (1, 2, 3)}
    lines = proposed(Log(log.path, {**log.signals, **signals}), drives)
    for drive in drives:
        assert lines[drive.name].startswith(f'"{drive.name}"')
    lines = proposed(log, drives)
    for drive, number in zip(drives, (3, 1, 2), strict=True):
        assert lines[drive.name].startswith(f'"reference_{number}.throttle_reference"')


def test_a_heading_to_be_held_is_no_order_of_a_drive() -> None:
    log = log_of_drives((1,))
    signals = {name: s for name, s in log.signals.items() if "_1." not in name}
    signals["ctrl.heading_angle_ref"] = wave(1, -3.0, 3.0)
    signals["ctrl.thrust_ref"] = wave(2, 0.0, 300.0)
    drives = [VesselChannel("thrust_N", -250.0, 400.0), VesselChannel("rudder_rad", -0.6, 0.6)]
    lines = proposed(Log(log.path, signals), drives)
    assert "heading_angle_ref" not in lines.get("rudder_rad", "")


def test_pulses_with_an_empty_cell_are_no_force_that_is_too_large() -> None:
    pulses = wave(1, 1100.0, 1900.0)
    pulses.values[3] = np.nan
    log = log_of_drives(())
    signals = {**log.signals, "servo_port": pulses}
    drives = [VesselChannel("thrust_port_N", -60.0, 60.0)]
    lines = proposed(Log(log.path, signals), drives)
    assert "the vessel's range" not in lines["thrust_port_N"]
