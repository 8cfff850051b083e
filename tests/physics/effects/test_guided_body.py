"""Effects of a body that bearings guide, against closed forms and an independent integrator."""

from collections.abc import Callable
from math import pi, sin, sqrt

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.special import ellipk

from boatsim.diagnosis.candidates import candidate_library
from boatsim.physics import vessel
from boatsim.physics.base import make_motion
from boatsim.physics.effects.applied_load import AppliedLoad, LoadGainError
from boatsim.physics.effects.dry_friction import DryFriction
from boatsim.physics.effects.righting_moment import RightingMoment
from boatsim.physics.effects.weight_on_arm import WeightOnArm
from boatsim.physics.particulars import GRAVITY

INERTIA = 0.147  # [kg m^2]


def simulated(moment: Callable[[float, float], float], phi: float, p: float, seconds: float):
    """Free motion in roll under a moment of phi and p, by an integrator of scipy."""

    def rates(t, y):
        return y[1], moment(y[0], y[1]) / INERTIA

    return solve_ivp(
        rates, (0.0, seconds), (phi, p), method="LSODA", rtol=1e-9, atol=1e-10, dense_output=True
    )


def test_a_measured_force_acts_at_its_point_and_a_measured_moment_about_its_axis() -> None:
    load = AppliedLoad(
        surge=0.6, heave=-0.8, roll=1.0, yaw=-0.5, x=0.3, y=-0.2, z=0.1, gain=1.2, force_offset=0.5
    )
    seen = load.wrench(make_motion(), AppliedLoad.signals(force=2.0, moment=3.0))
    force = 1.2 * 2.5 * np.array([0.6, 0.0, -0.8])
    turning = 1.2 * 3.0 * np.array([1.0, 0.0, -0.5]) + np.cross([0.3, -0.2, 0.1], force)
    assert seen == pytest.approx([*force, *turning], abs=1e-15)


@pytest.mark.parametrize("amplitude", [0.1, 1.5, 3.0])
def test_the_period_of_a_pendulum_follows_the_elliptic_integral(amplitude: float) -> None:
    weight = RightingMoment(moment=3.0)
    run = simulated(lambda phi, p: weight.wrench(make_motion(phi=phi, p=p)).K, amplitude, 0.0, 8.0)
    t = np.linspace(0.0, 8.0, 80_001)
    p = run.sol(t)[1]
    half = t[1:][(p[:-1] < 0.0) & (p[1:] >= 0.0)][0]  # it turns back on the other side
    period = 4.0 * sqrt(INERTIA / 3.0) * ellipk(sin(0.5 * amplitude) ** 2)
    assert 2.0 * half == pytest.approx(period, rel=1e-3)


def test_the_restoring_moment_is_the_same_after_any_number_of_turns() -> None:
    arm = RightingMoment(moment=3.0, second=0.3, third=-0.1, list=0.2)
    for phi in (-2.0, 0.2, 1.0, 3.0):
        turned = [arm.wrench(make_motion(phi=phi + 2.0 * pi * k)).K for k in (-3, 0, 5)]
        assert turned == pytest.approx([turned[0]] * 3, abs=1e-12)
    assert arm.wrench(make_motion(phi=0.2)).K == 0.0


def test_dry_friction_takes_the_same_from_each_swing() -> None:
    """Each cycle of a linear oscillator with Coulomb friction loses 4 F / k (Den Hartog)."""
    stiffness, level = 3.0, 0.06
    friction = DryFriction(roll=level, creep_rate=1e-3, creep=1e-3)
    run = simulated(
        lambda phi, p: -stiffness * phi + friction.wrench(make_motion(p=p)).K, 1.0, 0.0, 6.0
    )
    t = np.linspace(0.0, 6.0, 60_001)
    phi, p = run.sol(t)
    peaks = phi[1:][(p[:-1] > 0.0) & (p[1:] <= 0.0)]
    assert len(peaks) >= 3
    assert -np.diff([1.0, *peaks]) == pytest.approx(4.0 * level / stiffness, rel=5e-3)


def test_dry_friction_holds_what_is_smaller_than_itself() -> None:
    friction = DryFriction(roll=0.2, creep_rate=0.01, creep=0.01)
    held = simulated(lambda phi, p: 0.1 + friction.wrench(make_motion(p=p)).K, 0.0, 0.0, 10.0)
    assert 0.0 < held.y[1][-1] < friction.creep_rate  # it creeps
    loose = simulated(lambda phi, p: 0.3 + friction.wrench(make_motion(p=p)).K, 0.0, 0.0, 2.0)
    assert loose.y[1][-1] == pytest.approx(2.0 * 0.1 / INERTIA, rel=0.02)


@pytest.mark.parametrize("ratio", [1.0, 1.5, 3.0])
def test_friction_at_rest_is_larger_by_the_static_ratio_and_falls_to_that_of_sliding(
    ratio: float,
) -> None:
    friction = DryFriction(surge=2.0, static_ratio=ratio, creep=0.01, creep_rate=0.01)
    speeds = np.geomspace(1e-4, 10.0, 4000)
    forces = np.array([-friction.wrench(make_motion(u=u)).X for u in speeds])
    assert forces.max() == pytest.approx(2.0 * ratio, rel=0.1)
    assert forces[-1] == pytest.approx(2.0)
    assert friction.wrench(make_motion(u=-0.3)).X == -friction.wrench(make_motion(u=0.3)).X


def test_a_weight_on_an_arm_is_a_point_mass() -> None:
    boat = vessel.load_vessel("pendulum")
    mass, arm = 0.454, 0.5
    extra = WeightOnArm(inertia=mass * arm**2, moment=mass * GRAVITY * arm)
    heavy = boat.with_completed_effect(extra)
    assert heavy.body.roll_inertia == pytest.approx(boat.body.roll_inertia + 0.1135)
    own, changed = boat.effect("righting_moment"), heavy.effect("righting_moment")
    assert isinstance(own, RightingMoment) and isinstance(changed, RightingMoment)
    assert changed.moment - own.moment == pytest.approx(2.227, abs=1e-3)
    ratios = extra.identifiable_ratios(boat)
    assert (ratios["mass"][0], ratios["arm"][0]) == pytest.approx((mass, arm))


def test_errors_of_a_load_are_candidates_only_where_a_load_was_measured() -> None:
    tested = candidate_library(vessel.load_vessel("pendulum")).tested_names
    assert {"load_gain_error", "moment_offset", "dry_friction"} <= set(tested)
    boat = candidate_library(vessel.load_vessel("kvlcc2_roll"))
    for name in ("load_gain_error", "dry_friction", "righting_moment_error"):
        assert name in boat.inapplicable, name
    assert "guided" in boat.inapplicable["dry_friction"]


def test_a_load_gain_error_scales_the_measured_moment() -> None:
    boat = vessel.load_vessel("pendulum").with_completed_effect(LoadGainError(factor=0.8))
    load = boat.effect("applied_load")
    assert isinstance(load, AppliedLoad)
    assert load.wrench(make_motion(), AppliedLoad.signals(moment=2.0)).K == pytest.approx(1.6)
