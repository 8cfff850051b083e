"""Entries of the library found, with their values, in recordings of a boat that shares no code with
the tool.

Here are those that a boat in the plane shows and that no other test diagnoses on such data.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import pytest
from alike import long
from answers import diagnosed, named, nothing_missing
from real_boat import FURTHER, Real, recorded

pytestmark = pytest.mark.slow


@dataclass(frozen=True)
class Case:
    """A boat, what must be said of it, and how it is driven."""

    entry: str
    real: Real
    true: Mapping[str, float]
    # rows of a random step: long ones reach the speeds at which damping is not linear
    hold: int = 5
    start: tuple[float, float, float] = (0.0, 0.0, 0.0)  # [m], [m], [rad]
    more: bool = False  # the boat's law differs from the entry's by more than the tolerated force
    also: tuple[str, ...] = ()  # entries that its law contains besides


CASES = (
    Case(
        "current", Real(stream=(0.03, -0.05)), {"north_mps": 0.03, "east_mps": -0.05}, more=True
    ),  # it ebbs
    Case("thrust_lag", Real(lag=0.45), {"time_constant_s": 0.45}, more=True),
    Case("thrust_deadband", Real(dead=0.12), {"width_N": 0.12}),
    Case("thrust_exponent", Real(throttle=True), {"exponent": 2.0}),
    Case("thrust_limit", Real(most=0.6), {"share": 0.6}),
    Case("thrust_fade", Real(fade=0.008), {"rate_pers": 0.008}),
    Case("thrust_imbalance", Real(power=(1.15, 0.85)), {"fraction": 0.15}),
    # the loss grows with the load
    Case("thrust_gain_error", Real(power=(0.7, 0.7)), {"factor": 0.7}, also=("thrust_exponent",)),
    Case("steering_offset", Real(bent=(0.1, -0.06)), {"port_rad": 0.1, "starboard_rad": -0.06}),
    Case("prop_walk", Real(walk=0.15), {"side_force_per_thrust": 0.15}),
    Case("lateral_centre_shift", Real(skeg=-0.12), {"shift_m": -0.12}),
    Case("mass_centre_shift", Real(trim=0.12), {"shift_m": 0.12}),
    Case(
        "damping_error",
        Real(linear=(1.6, 1.6, 0.6)),
        {"surge_factor": 1.6, "sway_factor": 1.6, "yaw_factor": 0.6},
    ),
    Case(
        "cross_flow_drag",
        Real(strips=(1.2, 4.0)),
        {"section_drag_coefficient": 1.2, "surge_quadratic_Ns2pm2": 4.0},
        hold=20,
    ),
    Case(
        "quadratic_damping",
        Real(square=(6.0, 50.0, 1.0)),
        {"surge_Ns2pm2": 6.0, "sway_Ns2pm2": 50.0, "yaw_Nms2": 1.0},
        hold=20,
    ),
    # in sway the boat is too slow for the cube of its speed
    Case(
        "cubic_damping",
        Real(cube=(10.0, 0.0, 1.5)),
        {"surge_Ns3pm3": 10.0, "yaw_Nms3": 1.5},
        hold=20,
    ),
    Case(
        "forward_speed_damping",
        Real(lift=(20.0, 3.0)),
        {"sway_Ns2pm2": 20.0, "yaw_Ns2": 3.0},
        hold=20,
    ),
    Case("sway_yaw_coupling", Real(way=(-6.0, 10.0)), {"sway_kg": -6.0, "yaw_kg": 10.0}, hold=20),
    Case(
        "wall_effect",
        Real(walls=(1.5, 0.1)),
        {"damping_rise": 1.5, "pull_N": 0.1},
        start=(-3.0, -2.0, 0.0),
    ),
    # a short stiff line; it is as long as stated to within the 2 cm over which the entry's law
    # becomes taut
    Case(
        "tether",
        Real(line=(2.0, 0.3, 0.5, 0.5)),
        {"stiffness_Npm": 2.0, "north_m": 0.5, "east_m": 0.5},
    ),
)


# Other tests diagnose the first three on other data, or an effect of the same kind is among the rest.
REPEATED = {
    "current",
    "quadratic_damping",
    "damping_error",
    "thrust_lag",
    "tether",
    "thrust_imbalance",
    "cubic_damping",
    "forward_speed_damping",
    "lateral_centre_shift",
    "sway_yaw_coupling",
    "thrust_gain_error",
}


def marked(case: Case) -> Any:
    """A case, among the long tests if its statement is repeated."""
    marks = []
    if case.entry in REPEATED:
        marks.append(pytest.mark.long)
    return pytest.param(case, marks=marks, id=case.entry)


@pytest.mark.parametrize("case", [marked(case) for case in CASES])
def test_an_entry_is_named_with_its_values(tmp_path: Path, case: Case) -> None:
    runs = [recorded(case.real, seed, case.hold, case.start) for seed in (1, 2, 3)]
    named(
        diagnosed(runs, tmp_path, "trial_boat", FURTHER),
        case.entry,
        case.true,
        case.more,
        case.also,
    )


@pytest.mark.parametrize("entry", [long("current"), long("quadratic_damping"), "wall_effect"])
def test_the_same_runs_of_a_boat_without_it_miss_nothing(tmp_path: Path, entry: str) -> None:
    case = next(c for c in CASES if c.entry == entry)
    sound = replace(case, real=Real())
    runs = [recorded(sound.real, seed, sound.hold, sound.start) for seed in (1, 2, 3)]
    nothing_missing(diagnosed(runs, tmp_path, "trial_boat", FURTHER))
