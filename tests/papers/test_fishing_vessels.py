"""Kynoc and Eastward Ho against the worked example and the tables of Martin's thesis, and MuJoCo
against both."""

from math import pi, sqrt
from typing import Any

import numpy as np
import pytest
from scipy.integrate import quad

from benchmarks.martin_vessels import (
    PERIOD,
    WAVES,
    discretise,
    force_at_approach_speed,
    linear_model,
    mass_matrix,
    random_waves,
    simulate_on_mujoco,
    simulate_zigzag,
    speed_of,
)
from boatsim.physics import particulars, vessel
from boatsim.physics.base import Array
from boatsim.physics.signals import motion_signals
from boatsim.physics.vessel import Vessel
from boatsim.simulate.batch import Batch

TONNE = 1000.0  # [kg]; the thesis counts in tonnes and kilonewtons

# The worked example, Appendix IV: Eastward Ho, full load, 13 knots, dimensions from feet, added
# mass from a chart.
FOOT = 0.3048  # [m]
LONG_TON = 1016.047  # [kg]
EXAMPLE: dict[str, Any] = {
    "length": 101.0 * FOOT,
    "beam": 28.67 * FOOT,
    "draught": 13.25 * FOOT,
    "body": {"mass": 572.05e3, "roll_inertia": 7011.333e3, "yaw_inertia": 33883.16e3},
    "added_mass": {
        "spheroid": 0.0,
        "surge": 45.04215e3,
        "sway": 494.4331e3,
        "yaw": 19587.96e3,
        "roll": 1402.267e3,
    },
    "righting_arm": {"metacentric_height": 4.16 * FOOT},
    "linear_hull": {
        "trim": 1.0731,
        "block": 0.513686,
        "ahead": -6.21 * FOOT,
        "above_keel": 11.08 * FOOT,
    },
    "rudder": {"inflow": 7.430879, "at": -12.509, "below": 2.36584},
}
A_C = np.array(  # of (psi, r, v, phi, p), printed
    [
        [0, 1, 0, 0, 0],
        [0, -0.47796, -0.06447, -0.01247, 0],
        [0, -0.79606, -0.28987, 0, 0],
        [0, 0, 0, 0, 1],
        [0, -0.54394, 0.026761, -0.84572, -0.08029],
    ]
)
B_C = np.array([0, 0.060105, -0.24091, 0, 0.053022])
A_D = np.array(  # half a second later
    [
        [1, 0.445675, -0.00711, -0.00142, 0],
        [0, 0.792773, -0.02667, -0.00535, -0.0014],
        [0, -0.32935, 0.870468, 0.001073, 0],
        [0, -0.06138, 0.003745, 0.897635, 0.473025],
        [0, -0.23094, 0.01553, -0.39928, 0.859656],
    ]
)
B_D = np.array([0.007248, 0.028484, -0.11763, 0.005723, 0.020789])
K_D = np.array(
    [
        [0.11573, -0.00122, 0],
        [0.445675, -0.00713, 0],
        [-0.08775, 0.466396, 0],
        [-0.01052, 0.010064, 0.121193],
        [-0.06138, 0.040641, 0.473025],
    ]
)

# Vessel, condition: V; -a_rr, -a_rv, -a_rphi, -a_vr, -a_vv, a_pr, a_pv, -a_pphi, b_r, b_v, b_p;
# T_phi, zeta
TABLE = {
    (
        "kynoc",
        1,
    ): "5.659 .8135 .1550 .0283 .1237 .5305 -.6516 .0625 .8888 .3344 -.6948 .2814 6.66 .090",
    (
        "kynoc",
        2,
    ): "4.116 .5916 .1128 .0150 .0900 .3858 -.4739 .0454 .8888 .1113 -.2312 .0936 6.66 .090",
    (
        "kynoc",
        3,
    ): "5.659 .6875 .1710 .0270 .0354 .5464 -.4991 .0485 .6603 .2765 -.5903 .2392 7.73 .090",
    (
        "kynoc",
        4,
    ): "4.116 .5000 .1244 .0143 .0257 .3974 -.3630 .0353 .6603 .0920 -.1964 .0796 7.73 .090",
    (
        "eastward_ho",
        1,
    ): "6.688 .5212 .0566 .0131 1.0223 .2733 -.5990 .0289 .7744 .0764 -.3008 .0592 7.14 .051",
    (
        "eastward_ho",
        2,
    ): "5.144 .4009 .0435 .0077 .7864 .2102 -.4608 .0222 .7744 .0310 -.1220 .0240 7.14 .035",
    (
        "eastward_ho",
        3,
    ): "6.688 .4761 .0642 .0124 .8290 .2922 -.5417 .0270 .8457 .0598 -.2426 .0532 6.83 .044",
    (
        "eastward_ho",
        4,
    ): "4.630 .3296 .0444 .0059 .5739 .2023 -.3751 .0187 .8457 .0196 -.0797 .0175 6.83 .028",
}


def example(**more: dict[str, float]) -> Vessel:
    """The worked example as a vessel."""
    boat = vessel.load_vessel("eastward_ho", ["condition_3"], EXAMPLE)
    return vessel.load_vessel("eastward_ho", ["condition_3"], {**EXAMPLE, **more}) if more else boat


# ---- coefficients


def test_added_mass_is_that_of_a_spheroid_by_lambs_integrals() -> None:
    """Alpha and beta as integrals of the ellipsoid's potential (Lamb, section 114), in place of
    their closed forms."""
    a, b = 15.4, 4.04
    alpha = a * b * b * quad(lambda x: 1.0 / ((a * a + x) ** 1.5 * (b * b + x)), 0, np.inf)[0]
    beta = a * b * b * quad(lambda x: 1.0 / ((a * a + x) ** 0.5 * (b * b + x) ** 2), 0, np.inf)[0]
    over, under = (
        (a * a - b * b) ** 2 * (beta - alpha),
        2 * (a * a - b * b) + (b * b + a * a) * (alpha - beta),
    )
    found = particulars.spheroid_added_mass(2 * a, b)
    assert found.surge == pytest.approx(alpha / (2 - alpha), rel=1e-7)
    assert found.sway == pytest.approx(beta / (2 - beta), rel=1e-7)
    assert found.yaw == pytest.approx(over / under / (a * a + b * b), rel=1e-6)
    assert particulars.spheroid_added_mass(2.001, 1.0)[:2] == pytest.approx(
        (0.5, 0.5), abs=1e-3
    )  # a sphere


@pytest.mark.slow
def test_worked_example_coefficient_by_coefficient() -> None:
    boat = example()
    d = particulars.linear_derivatives(boat.length, boat.beam, boat.draught, 1.0731, 0.513686)
    assert d == pytest.approx((-0.72545, 0.249876, -0.21816, -0.07865), rel=3e-4)
    assert particulars.hull_force_ratio(0.513686) == pytest.approx(0.169081, abs=1e-6)
    assert particulars.rudder_force_slope(2.787091, 1.875, 7.430879) == pytest.approx(
        219.7674e3, rel=1e-5
    )
    mass, hull, roll = (
        mass_matrix(boat) / TONNE,
        -force_at_approach_speed(boat, v=1.0) / TONNE,
        boat.effect("roll_damping"),
    )
    assert mass.diagonal() == pytest.approx([53471.11, 1066.479, 8413.6], rel=1e-5)
    assert hull[:2] == pytest.approx([3447.02, 309.136], rel=3e-4)
    assert -force_at_approach_speed(boat, r=1.0)[:2] / TONNE == pytest.approx(
        [25557.17, 848.9842], rel=3e-4
    )
    assert -force_at_approach_speed(boat, phi=1.0)[[0, 2]] / TONNE == pytest.approx(
        [666.7563, 7115.55], rel=3e-4
    )
    assert roll.roll / TONNE == pytest.approx(675.5547, rel=3e-4)  # type: ignore[union-attr]
    own = boat.effect("linear_hull")
    below, arm = own.below, own.arm  # type: ignore[union-attr]
    assert arm * 1066.479 == pytest.approx(671.383, rel=3e-4)  # roll moment of a sway acceleration
    assert below * 309.136 == pytest.approx(419.771, rel=3e-4)
    rudder = force_at_approach_speed(boat, rudder=1.0) / TONNE
    assert rudder[:2] == pytest.approx([3213.883, -256.926], rel=3e-4)
    assert rudder[2] - arm * rudder[1] == pytest.approx(607.8455, rel=3e-4)
    assert -force_at_approach_speed(boat, r=1.0)[2] / TONNE - arm * 848.9842 == pytest.approx(
        4042.015, rel=3e-4
    )


def test_worked_example_as_matrices_and_half_a_second_later() -> None:
    A, B, _ = linear_model(example())
    assert A == pytest.approx(A_C, abs=1e-4)
    assert B == pytest.approx(B_C, abs=3e-6)
    found_A, found_B = discretise(
        A_C, B_C[:, None]
    )  # the printed step follows from the printed rates
    off = np.abs(found_A - A_D)
    off[[0, 2], 4] = 0.0  # printed as zero
    assert off.max() < 1e-5 and np.abs(found_A - A_D).max() < 3e-4
    assert found_B[:, 0] == pytest.approx(B_D, abs=3.1e-4)


@pytest.mark.parametrize(
    ("coupling", "follows"), [(494.4331 * 1.35789 / 8413.6, True), (0.197267, False)]
)
def test_the_printed_roll_by_sway_waves_does_not_give_the_printed_step(
    coupling: float, follows: bool
) -> None:
    """0.0798 is m_y z_H over the roll inertia; the continuous matrix prints 0.197267, the discrete one does not."""
    K = np.zeros((5, 3))
    K[1, 0] = K[2, 1] = K[4, 2] = 1.0
    K[4, 1] = coupling
    off = np.abs(discretise(A_C, K)[1] - K_D)
    assert (off.max() < 2e-3) == follows
    own, mass = example(), mass_matrix(example())
    assert own.effect("linear_hull").arm * mass[1, 1] / mass[2, 2] == pytest.approx(
        0.0798, abs=1e-4
    )  # type: ignore[union-attr]


@pytest.mark.parametrize(("name", "condition"), TABLE)
def test_every_condition_is_the_table(name: str, condition: int) -> None:
    boat = vessel.load_vessel(name, [f"condition_{condition}"])
    A, B, _ = linear_model(boat)
    found = [
        -A[1, 1],
        -A[1, 2],
        -A[1, 3],
        -A[2, 1],
        -A[2, 2],
        A[4, 1],
        A[4, 2],
        -A[4, 3],
        B[1],
        B[2],
        B[4],
    ]
    speed, *wanted, period, ratio = map(float, TABLE[name, condition].split())
    assert speed_of(boat) == pytest.approx(speed, abs=6e-4)
    assert found == pytest.approx(wanted, abs=7e-5)
    assert 2 * pi / sqrt(-A[4, 3]) == pytest.approx(period, abs=5.1e-3)
    assert -A[4, 4] / (2 * sqrt(-A[4, 3])) == pytest.approx(ratio, abs=5.1e-4)


@pytest.mark.parametrize(("name", "condition"), TABLE)
def test_inertias_of_a_load_are_its_mass_on_the_stated_radii(name: str, condition: int) -> None:
    boat = vessel.load_vessel(name, [f"condition_{condition}"])
    across = {"kynoc": 2.60, "eastward_ho": 3.50094}[name]
    assert boat.body.roll_inertia == pytest.approx(boat.body.mass * across**2, rel=1e-5)
    assert boat.body.yaw_inertia == pytest.approx(boat.body.mass * (boat.length / 4) ** 2, rel=1e-5)
    lever = boat.geometry["cg_from_transom"] - boat.length / 2
    assert boat.effect("linear_hull").ahead == pytest.approx(lever)  # type: ignore[union-attr]


def test_a_rudder_to_starboard_heels_inwards_first_and_outwards_in_the_turn() -> None:
    """Steady heel per rudder angle, Eastward Ho, conditions 3 and 4, water at the rudder 1.1111 V
    in both."""
    for condition, speed, wanted in ((3, 6.68777, -0.25), (4, 4.63, -0.12)):
        fast = {"rudder": {"inflow": 1.1111 * speed}}
        A, B, _ = linear_model(vessel.load_vessel("eastward_ho", [f"condition_{condition}"], fast))
        steady = np.linalg.solve(A[np.ix_([1, 2, 4], [1, 2, 3])], -B[[1, 2, 4]])
        assert B[4] > 0.0 and steady[2] == pytest.approx(wanted, abs=6e-3)


def roll_ratio_at_rest(
    length: float,
    beam: float,
    mass: float,
    bilge: float,
    amplitude: float,
    keels: float = 0.0,
    shape: float = 1.0,
) -> float:
    """Roll damping per critical without headway, of a round bilge.

    The formula, as C. R. Martin, UBC 1993, Appendix IV quotes it, is in feet and long tons; arguments are SI. `bilge`
    is the distance from waterline at the centre to the turn of the bilge, `amplitude` that of the roll, `keels` the
    area of both bilge keels, `shape` = sqrt(their length / bilge).
    """
    L, B, d, tons = length / FOOT, beam / FOOT, bilge / FOOT, mass / LONG_TON
    area = 0.0024 * L * B * sqrt(d) + keels / FOOT**2 * shape
    return 0.55 * area * d * d * sqrt(d) * sqrt(amplitude) / (tons * B * B)


@pytest.mark.parametrize(
    ("at_rest", "least", "most"), [(0.0119, 133.0, 143.0), (0.0437, 18.0, 19.0)]
)
def test_area_of_bilge_keels_that_the_damping_measured_in_the_tank_asks_for(
    at_rest: float, least: float, most: float
) -> None:
    """From each computed ratio to the measured 0.075, equal amplitude; turn of the bilge 13 to 15.1
    ft deep."""
    areas = []
    for bilge in (13.0 * FOOT, 15.1 * FOOT):
        hull, plate = (
            roll_ratio_at_rest(30.785, 8.7386, 572.05e3, bilge, 1.0, keels)
            for keels in (0.0, FOOT**2)
        )
        share = plate / hull - 1.0  # what a square foot adds, at any amplitude
        areas.append((0.075 / at_rest - 1.0) / share)
    assert areas == pytest.approx([least, most], abs=0.6)


def test_damping_at_rest_grows_with_the_root_of_the_amplitude() -> None:
    small, large = (roll_ratio_at_rest(30.8, 8.74, 572e3, 4.0, a) for a in (0.05, 0.2))
    assert large == pytest.approx(2.0 * small)


# ---- coupling of sway and roll


def test_sway_added_mass_heels_one_way_as_printed_or_both_ways_as_energy_demands() -> None:
    printed = vessel.load_vessel("eastward_ho", ["condition_3"])
    below = printed.effect("linear_hull").below  # type: ignore[union-attr]
    symmetric = vessel.load_vessel(
        "eastward_ho", ["condition_3"], {"added_mass": {"sway_below": below}}
    )
    one, both = linear_model(printed)[0], linear_model(symmetric)[0]
    assert one[2, 3] == one[2, 4] == 0.0  # a roll does not push the printed ship sideways
    mass = mass_matrix(symmetric)
    lever = -mass[1, 2]  # m_y z_H
    assert mass_matrix(printed)[1, 2] == 0.0 and lever > 0.0
    assert mass[2, 2] == pytest.approx(mass_matrix(printed)[2, 2])
    stiffness = printed.effect("righting_arm").stiffness  # type: ignore[union-attr]
    free = mass[2, 2] - lever**2 / mass[1, 1]
    assert both[4, 3] == pytest.approx(-stiffness / free)  # sway gives way: the period is shorter
    assert both[2, 3] == pytest.approx(both[4, 3] * lever / mass[1, 1])
    assert both[4, 3] < one[4, 3] < 0.0


# ---- MuJoCo


def on_twin(boat: Vessel, rudder: Array, waves: Array) -> Array:
    """(N + 1, 5) states of the run in the twin."""
    compiled, symbols = (
        Batch(boat, step=0.02),
        [signal.symbol for signal in motion_signals(boat.dof)],
    )
    y = np.array([speed_of(boat) if n == "u" else 0.0 for n in symbols])
    at, values, rows = (
        [compiled.program.parameter_index("push", n) for n in WAVES],
        compiled.program.values(),
        [y],
    )
    for i, (angle, wave) in enumerate(zip(rudder, waves, strict=True)):
        values[at] = wave * mass_matrix(boat).diagonal()
        y = compiled.rollout(y, np.array([[angle]]), PERIOD, values, t0=PERIOD * i)[-1]
        rows.append(y)
    return np.array(rows)[:, [symbols.index(n) for n in ("psi", "r", "v", "phi", "p")]]


@pytest.mark.parametrize("run", [simulate_on_mujoco, on_twin])
def test_mujoco_and_twin_follow_the_exact_step_through_a_zigzag_in_random_waves(run: Any) -> None:
    """120 s, accelerations of the waves drawn anew every half second: less than 1e-6 deg."""
    boat, waves = vessel.load_vessel("eastward_ho", ["condition_3"]), random_waves()
    truth, rudder = simulate_zigzag(boat, waves)
    assert np.degrees(np.abs(truth[:, 0]).max()) > 15 and np.degrees(np.abs(truth[:, 3]).max()) > 5
    off = np.degrees(np.abs(run(boat, rudder, waves) - truth).max(axis=0))
    assert off[0] < 1e-6 and off[3] < 1e-6
