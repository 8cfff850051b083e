"""Commands that are constant are not proposed for a channel, and the proposed map says so."""

from pathlib import Path

import numpy as np
import pytest

from boatsim.recordings.importing.channels import VesselChannel
from boatsim.recordings.importing.log import Log, Signal
from boatsim.recordings.importing.mapping_proposal import propose_map

T = 0.1 * np.arange(600)
SHAFTS = [
    VesselChannel("n_port_radps", -100.0, 100.0, 0, 0.4, (0.01, 0.01)),
    VesselChannel("n_starboard_radps", -100.0, 100.0, 0, -0.4, (0.01, 0.01)),
]
THRUSTS = [
    VesselChannel("thrust_port_N", -100.0, 100.0, 0, 0.4),
    VesselChannel("thrust_starboard_N", -100.0, 100.0, 0, -0.4),
]


def open_lines(drives: list[VesselChannel], **constant: float) -> list[str]:
    """Lines of channels without a signal, where only the port drive varies."""
    signals = {
        "x_m": Signal(T, 0.5 * T),
        "y_m": Signal(T, np.sin(0.1 * T)),
        "heading_deg": Signal(T, 10.0 * np.cos(0.1 * T)),
        "RPM port": Signal(T, 500.0 + 200.0 * np.sin(0.3 * T)),
    }
    for name, value in constant.items():
        signals[name] = Signal(T, np.full(len(T), value))
    text = propose_map(Log(Path("log.csv"), signals), None, drives, ("surge", "sway", "yaw"))
    return [line for line in text.splitlines() if '= "..."' in line]


@pytest.mark.parametrize("drives", [SHAFTS, THRUSTS])
def test_the_map_names_the_constant_command_of_a_channel_and_its_value(
    drives: list[VesselChannel],
) -> None:
    lines = open_lines(drives, **{"RPM starboard": 650.0})
    (line,) = [line for line in lines if drives[1].name in line]
    assert line.endswith(
        "the signal RPM starboard is constant (650) and was therefore not proposed"
    )


def test_a_channel_without_any_command_is_said_to_have_no_signal() -> None:
    lines = open_lines(SHAFTS, **{"RPM bow": 650.0})
    (line,) = [line for line in lines if SHAFTS[1].name in line]
    assert line.endswith("no signal has a similar name")
