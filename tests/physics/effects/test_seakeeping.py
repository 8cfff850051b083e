"""Waves, roll damping, rudder and what holds the speed: each law against a closed form or an
integral."""

import warnings
from dataclasses import replace
from math import cos, degrees, exp, hypot, pi, radians, sin, sqrt
from typing import Any

import numpy as np
import pytest
from alike import long
from scipy.integrate import quad
from scipy.special import exp1

from boatsim.errors import BadInput
from boatsim.metrics.sea_keeping import SeaKeeping
from boatsim.physics import vessel
from boatsim.physics.base import AXES, Array, Wrench, make_motion
from boatsim.physics.effects.bilge_keels import BilgeKeels
from boatsim.physics.effects.filtered_sea import FilteredSea
from boatsim.physics.effects.irregular_sea import IrregularSea
from boatsim.physics.effects.linear_hull import LinearHull
from boatsim.physics.effects.push import Push
from boatsim.physics.effects.roll_damping import RollDamping
from boatsim.physics.effects.rudder import Rudder, RudderStall
from boatsim.physics.effects.speed_hold import SpeedHold
from boatsim.physics.effects.wave_forcing import WaveForcing
from boatsim.physics.effects.yaw_rate_waves import YawRateWaves
from boatsim.physics.particulars import spheroid_added_mass
from boatsim.physics.vessel.wave_axes import UnforcedAxesWarning
from boatsim.physics.waves.hull_integrals import beam_attenuation, wave_slope_integrals
from boatsim.physics.waves.sea_state import components
from boatsim.recordings.table import Recording
from boatsim.simulate.batch import Batch

G, RHO = 9.81, 1025.0
SWAY, ROLL, YAW = (AXES.index(axis) for axis in ("sway", "roll", "yaw"))
SEEDS = 4000  # the error of an rms over them is 1.1 %


# of the thesis: waves up to 3 rad/s, and for the roll moment the slope of the surface
THESIS = {"cut": 3.0, "roll_depth": 0.0, "beam": 0.0}


def sea(**more: float) -> IrregularSea:
    """A sea on Eastward Ho, condition 1, by the formulas of the thesis."""
    return IrregularSea(significant_height=1.0, **THESIS, **more).with_all_parameters(
        vessel.load_vessel("eastward_ho", ["condition_1"])
    )


def ensemble(effect: Any, t: float = 0.0) -> Array:
    """(SEEDS, 6) wrenches at one time, over `AXES`."""
    m = make_motion(t=t)
    return np.array([effect.with_seed(seed).wrench(m) for seed in range(SEEDS)])


# ---- waves


@pytest.mark.parametrize("taper", [0.0, 1.0, 0.3])
@pytest.mark.parametrize("s", [-2.5, 1e-4, 0.019, 0.021, 0.8, 9.0])
def test_section_integrals(s: float, taper: float) -> None:
    even = quad(lambda x: (1 - taper * x * x) * cos(s * x), -1, 1)[0]
    odd = quad(lambda x: (1 - taper * x * x) * x * sin(s * x), -1, 1)[0]
    assert wave_slope_integrals(s, taper) == pytest.approx((even, odd), rel=1e-8, abs=1e-12)


@pytest.mark.slow
@pytest.mark.parametrize(("height", "period", "wanted"), [(0.88, 7.5, 2.09), (1.88, 8.8, 3.48)])
def test_slope_is_that_of_the_spectrum_up_to_the_cut(
    height: float, period: float, wanted: float
) -> None:
    """The slope's spectrum A / (w g^2) exp(-B / w^4) integrates to A / (4 g^2) E1(B / cut^4)."""
    b = 1.25 * (2 * pi / period) ** 4
    integral = sqrt(b * height**2 / 4 / (4 * G**2) * exp1(b / 3.0**4))
    across = sea(modal_period=period, toward=pi / 2, flat=1.0, sway=0.0)
    moment = ensemble(replace(across, significant_height=height))[:, ROLL].std()
    assert degrees(integral) == pytest.approx(wanted, abs=6e-3)
    assert moment / across.stiffness == pytest.approx(integral, rel=0.03)


@pytest.mark.parametrize(
    ("name", "condition", "encounter", "height", "period", "wanted"),
    [
        ("kynoc", 4, 90, 0.0, 7.732, (0.0, 11.5, 1.40)),
        ("kynoc", 3, 45, 0.88, 7.5, (0.73, 4.69, 0.98)),
        ("kynoc", 1, 60, 0.88, 7.5, (0.79, 6.18, 1.61)),
        ("kynoc", 2, 30, 1.88, 8.8, (0.84, 5.49, 1.55)),
        ("eastward_ho", 4, 90, 0.0, 6.832, (0.0, 10.6, 1.69)),
        ("eastward_ho", 3, 45, 0.88, 7.5, (0.33, 3.03, 1.25)),
        ("eastward_ho", 1, 60, 0.88, 7.5, (0.37, 4.11, 1.40)),
        ("eastward_ho", 2, 30, 1.88, 8.8, (0.37, 3.52, 1.35)),
    ],
)
def test_accelerations_that_the_thesis_seas_give(
    name: str,
    condition: int,
    encounter: int,
    height: float,
    period: float,
    wanted: tuple[float, float, float],
) -> None:
    """Rms of yaw, sway and direct roll [deg/s^2]; in the beam sea the height is a hundredth of the
    resonant length."""
    boat = vessel.load_vessel(name, [f"condition_{condition}"])
    beam = encounter == 90
    own = IrregularSea(
        significant_height=height or 0.01 * G * period**2 / (2 * pi),
        modal_period=period,
        toward=radians(encounter),
        flat=float(beam),
        course_kept=1.0,
        **THESIS,
    ).with_all_parameters(boat)
    w, water, body = ensemble(own), boat.effect("added_mass"), boat.body
    direct = w[:, ROLL] - own.arm * w[:, SWAY]
    mass = (body.yaw_inertia + water.yaw, body.mass + water.sway, body.roll_inertia + water.roll)  # type: ignore[union-attr]
    found = [
        degrees(a.std() / b) for a, b in zip((w[:, YAW], w[:, SWAY], direct), mass, strict=True)
    ]
    assert found == pytest.approx(wanted, rel=0.045, abs=0.006)


@pytest.mark.parametrize("angle", [20.0, 45.0, 135.0])
def test_a_ship_on_a_straight_course_meets_the_waves_of_the_formula(angle: float) -> None:
    """By place and heading, or by w - w^2 V cos(chi) / g: the same for a ship that keeps course and speed."""
    world = sea(toward=radians(angle))
    kept = replace(world, course_kept=1.0, speed=5.0)
    for t in (0.0, 3.7, 61.3):
        seen = world.wrench(make_motion(t=t, x=5.0 * t, u=5.0))
        assert seen == pytest.approx(kept.wrench(make_motion(t=t)), rel=1e-9)
    turned = replace(
        world, toward=radians(angle) + 0.3
    )  # only the angle between waves and ship counts
    course = make_motion(t=9.0, psi=0.3, x=45.0 * cos(0.3), y=45.0 * sin(0.3))
    assert turned.wrench(course) == pytest.approx(
        world.wrench(make_motion(t=9.0, x=45.0)), rel=1e-9
    )


def published(own: IrregularSea, w: float, angle: float, slope: float) -> tuple[float, float]:
    """Largest sway force and yaw moment of one wave: the thesis' integrals over the sections of an
    ellipsoid."""
    k, T, L = w * w / G, own.draught, own.length
    push = RHO * G * exp(-k * own.centre_depth) * sin(angle) * slope

    def along(x: float) -> float:
        return 0.5 * pi * T**2 * (1 - 4 * x * x / L**2)

    even = quad(lambda x: along(x) * cos(k * cos(angle) * x), -L / 2, L / 2)[0]
    odd = quad(lambda x: along(x) * x * sin(k * cos(angle) * x), -L / 2, L / 2)[0]
    return abs(push * even), abs(push * odd)


@pytest.mark.parametrize("angle", [0.3, 1.2, 2.6])
def test_one_wave_has_the_frequency_of_encounter_and_the_force_of_the_published_integrals(
    angle: float,
) -> None:
    one = replace(sea(toward=angle, components=1.0, course_kept=1.0), arm=0.0, speed=6.0)
    Y, K, N = np.array([one.wrench(make_motion(t=t)) for t in np.arange(0.0, 400.0, 0.04)])[
        :, [SWAY, ROLL, YAW]
    ].T
    up = np.flatnonzero((K[:-1] < 0) & (K[1:] >= 0))
    times = 0.04 * (up - K[up] / (K[up + 1] - K[up]))
    met = 2 * pi * (len(up) - 1) / (times[-1] - times[0])
    w = np.linspace(0.3, 3.0, 200001)  # up to three waves are met as often
    alike = w[np.flatnonzero(np.diff(np.sign(np.abs(w - w**2 * 6.0 * cos(angle) / G) - met)))]
    slope = K.max() / (one.stiffness * sin(angle))
    forces = [published(one, x, angle, slope) for x in alike]
    assert any((Y.max(), N.max()) == pytest.approx(f, rel=3e-3) for f in forces)


def spectrum(w: float, height: float, period: float) -> float:
    """Bretschneider's spectrum of the elevation [m^2 s]."""
    modal = 2 * pi / period
    return 5 / 16 * height**2 * modal**4 / w**5 * exp(-1.25 * (modal / w) ** 4)


def beam_sea_on_the_otter(period: float, **more: float) -> IrregularSea:
    """A beam sea of 0.3 m on the Otter, as if she had a righting moment of 1000 N m per rad."""
    own = IrregularSea(
        significant_height=0.3, modal_period=period, toward=pi / 2, stiffness=1000.0, **more
    )
    return own.with_all_parameters(vessel.load_vessel("otter"))


SHORT = pytest.mark.parametrize("period", [2.5, 1.5, 1.0])


@SHORT
def test_waves_of_a_short_sea_have_the_significant_height_that_is_stated(period: float) -> None:
    own = beam_sea_on_the_otter(period)
    waves = components(own.values())[:, :3]
    frequency, amplitude, _ = waves.T
    assert 0.5 * np.sum(amplitude**2) == pytest.approx(0.3**2 / 16, rel=0.02)
    assert frequency.max() > 3.9 * 2 * pi / period
    t = np.arange(0.0, 4000 * period, 0.05 * period)
    elevation = sum(a * np.cos(w * t + e) for w, a, e in waves)
    assert np.var(elevation) == pytest.approx(0.3**2 / 16, rel=0.02)


@SHORT
def test_sway_force_of_a_short_sea_is_the_integral_over_the_spectrum(period: float) -> None:
    own = beam_sea_on_the_otter(period)
    per_slope = 0.25 * pi * RHO * G * own.draught**2 * own.length * 4 / 3  # of an ellipsoid

    def density(w: float) -> float:
        force = per_slope * w * w / G * exp(-w * w / G * own.centre_depth)
        return spectrum(w, 0.3, period) * force**2

    modal = 2 * pi / period
    whole, to_cut = (sqrt(quad(density, 0.4 * modal, n * modal)[0]) for n in (40.0, 4.0))
    found = ensemble(own)[:, SWAY].std()
    assert found == pytest.approx(to_cut, rel=0.03)
    assert found == pytest.approx(whole, rel=0.08)


@pytest.mark.parametrize("period", [long(2.5), long(1.5), 1.0])
@pytest.mark.slow
def test_roll_moment_converges_when_the_cut_rises(period: float) -> None:
    modal = 2 * pi / period
    found = []
    for cut in (4.0, 8.0, 16.0):
        own = beam_sea_on_the_otter(period, cut=cut * modal, components=80.0 * cut)
        found.append(ensemble(own)[:, ROLL].std())
    assert found == pytest.approx([found[0]] * 3, rel=0.04)

    def density(w: float) -> float:
        k = w * w / G
        s = 0.5 * k * own.beam
        sides = quad(lambda y: y * sin(2 * s * y), -0.5, 0.5)[0] / (s / 6)
        return spectrum(w, 0.3, period) * (1000.0 * k * exp(-k * own.draught) * sides) ** 2

    assert found[0] == pytest.approx(sqrt(quad(density, 0.4 * modal, 10 * modal)[0]), rel=0.04)


@pytest.mark.parametrize("s", [1e-3, 0.049, 0.051, 1.0, 7.0])
def test_slope_over_the_beam_is_weighted_by_the_lever(s: float) -> None:
    moment = quad(lambda y: y * sin(s * y), -1.0, 1.0)[0]
    of_a_plane = quad(lambda y: y * s * y, -1.0, 1.0)[0]
    assert beam_attenuation(s) == pytest.approx(moment / of_a_plane, rel=1e-8)


def test_a_cut_that_loses_energy_is_refused_and_one_of_a_calm_sea_is_not() -> None:
    refusal = (
        r"kynoc/vessel.toml: irregular_sea.cut = 3 rad/s omits 26 % of the energy of waves of "
        r"3 s; allowed is at least 5.87 rad/s, or 0 for the default"
    )
    short = {"irregular_sea": {"significant_height": 0.3, "modal_period": 3.0}}
    with pytest.raises(BadInput, match=refusal):
        vessel.load_vessel("kynoc", settings=short)
    short["irregular_sea"]["significant_height"] = 0.0
    vessel.load_vessel("kynoc", settings=short)


@pytest.mark.parametrize("heading", [0.0, 2.0])
def test_a_boat_adrift_in_a_current_meets_the_waves_as_one_at_rest_in_still_water(
    heading: float,
) -> None:
    north, east = 0.4, -0.3  # [m/s]
    waves = sea(toward=1.0)
    for t in (0.0, 5.0, 600.0):
        still = waves.wrench(make_motion(t=t, psi=heading, x=1.0, y=2.0))
        adrift = make_motion(
            current=(north, east), t=t, psi=heading, x=1.0 + north * t, y=2.0 + east * t
        )
        assert waves.wrench(adrift) == pytest.approx(still, rel=1e-9)


@pytest.mark.parametrize("name", ["trial_boat", "otter"])
def test_a_boat_that_drifts_with_the_water_moves_in_waves_as_in_still_water(name: str) -> None:
    waves = {"significant_height": 0.1, "modal_period": 1.5, "toward": 2.5}
    found = []
    for current in (0.0, 0.5):
        flow = {"use": "current", "north": current, "east": 0.0}
        boat = vessel.load_vessel(name).with_effect({"use": "irregular_sea", **waves})
        boat = boat.with_effect(flow)
        start = np.zeros(2 * len(boat.dof))
        heading = len(boat.dof) - 1
        start[heading] = 0.3
        start[heading + 1 : heading + 3] = current * cos(0.3), -current * sin(0.3)
        neutral = np.zeros((1000, len(boat.inputs)))
        found.append(Batch(boat, step=0.02).rollout(start, neutral, 0.02)[:, : heading + 1])
    still, adrift = found
    adrift[:, 0] -= 0.5 * 0.02 * np.arange(len(still))
    assert adrift == pytest.approx(still, abs=1e-9)
    assert np.ptp(still[:, 1]) > 1e-3 and np.ptp(still[:, heading]) > 1e-3


def test_a_calm_sea_is_nothing_and_a_seed_is_another_course_of_the_same_sea() -> None:
    m, waves = make_motion(t=3.0), sea(toward=1.0)
    assert replace(waves, significant_height=0.0).wrench(m) == Wrench()
    assert waves.with_seed(0) == waves
    assert waves.with_seed(1).wrench(m) != pytest.approx(waves.wrench(m))
    assert waves.with_seed(1).wrench(m) == replace(waves, realisation=2.0).wrench(m)


def test_sea_needs_no_particular_vessel() -> None:
    boat = vessel.load_vessel("joystick_boat")
    small = IrregularSea(significant_height=0.02, modal_period=1.0, toward=1.0).with_all_parameters(
        boat
    )
    assert small.wrench(make_motion(t=1.0)).K == 0.0 and small.wrench(make_motion(t=1.0)).Y != 0.0


NOISES = [
    FilteredSea(sway=2.0, roll=3.0, yaw=5.0, frequency=1.25, damping=0.1),
    WaveForcing(surge=1.0, sway=2.0, roll=3.0, yaw=5.0, frequency=1.25, damping=0.1),
    YawRateWaves(rms=2.0, drag=1.0, frequency=1.25, damping=0.1),
]


@pytest.mark.parametrize("noise", NOISES, ids=lambda noise: noise.name)
def test_noise_has_the_filters_autocorrelation_and_independent_axes(noise: Any) -> None:
    """E[f(0) f(tau)] of white noise through s / (s^2 + 2 z w0 s + w0^2), the process the diagnosis
    follows."""
    start = ensemble(noise)
    level = np.array([getattr(noise, axis, 0.0) for axis in AXES])
    if isinstance(noise, YawRateWaves):
        level[YAW] = noise.drag * noise.rms  # of the moment, for a hull without inertia
    acts = level > 0.0
    assert start.std(axis=0) == pytest.approx(level, rel=0.04)
    assert np.corrcoef(start[:, acts].T) == pytest.approx(np.eye(acts.sum()), abs=0.06)
    damped = 1.25 * sqrt(1 - 0.01)
    for tau in (0.7, 2.5, 6.0):
        later = ensemble(noise, tau)
        wanted = exp(-0.125 * tau) * (cos(damped * tau) - 0.125 / damped * sin(damped * tau))
        assert (start * later).mean(axis=0)[acts] / level[acts] ** 2 == pytest.approx(
            wanted, abs=0.06
        )
    assert type(noise)().wrench(make_motion(t=2.0)) == Wrench()


@pytest.mark.parametrize("noise", NOISES[1:], ids=lambda noise: noise.name)
def test_other_seeds_are_other_courses_of_the_noise_and_still_water_stays_still(noise: Any) -> None:
    t = np.arange(0.0, 4000.0, 0.5)

    def course(seed: int) -> Array:
        """Yaw moment in time."""
        law, values = type(noise).law, noise.with_seed(seed).values()
        return np.array([law(make_motion(t=float(x)), values).N for x in t])

    first, second = course(1), course(2)
    assert (first == course(1)).all()
    assert abs(np.corrcoef(first, second)[0, 1]) < 0.1  # the error over 4000 s is 0.04
    assert noise.with_seed(10**12).realisation <= 1e9  # any seed will do
    assert replace(noise, realisation=0.0).with_seed(3).wrench(make_motion(t=3.0)) == Wrench()


# ---- roll damping


def test_bilge_keels_take_the_energy_of_the_published_equivalent_damping() -> None:
    """Over a cycle of amplitude a: pi B w a^2, B = 8 / (3 pi) rho r^3 w a b l f^2 (22.5 b / (pi r a f) + 2.4)."""
    keels = BilgeKeels(breadth=0.05, length=0.6, arm=0.3, flow=1.2, frequency=4.2)
    for a in (0.05, 0.3):

        def power(t: float, a: float = a) -> float:
            p = a * 4.2 * cos(4.2 * t)
            return -keels.wrench(make_motion(p=p)).K * p

        drag = 22.5 * 0.05 / (pi * 0.3 * a * 1.2) + 2.4
        damping = 8 / (3 * pi) * RHO * 0.3**3 * 4.2 * a * 0.05 * 0.6 * 1.2**2 * drag
        assert quad(power, 0, 2 * pi / 4.2, limit=200)[0] == pytest.approx(
            pi * damping * 4.2 * a**2, rel=1e-6
        )


def test_bilge_keels_take_size_and_frequency_of_their_vessel() -> None:
    fitted = BilgeKeels(breadth=0.02).with_all_parameters(vessel.load_vessel("martin_tank_model"))
    assert (fitted.length, fitted.arm) == pytest.approx((0.3 * 1.805, 0.8 * hypot(0.27, 0.22)))
    assert fitted.frequency == pytest.approx(2 * pi / 1.49, rel=1e-3)


def test_roll_damping_is_a_share_of_the_critical_one() -> None:
    boat = vessel.load_vessel("martin_tank_model")
    critical = 2 * sqrt(118.56 * (5.556 + 1.1112))
    share = RollDamping(at_rest=0.03).with_all_parameters(boat)
    assert share.wrench(make_motion(p=0.4)).K == pytest.approx(-0.03 * critical * 0.4)


def test_the_tank_model_has_the_printed_period_and_the_computed_damping() -> None:
    boat = vessel.load_vessel("martin_tank_model")
    arm, water, drag = (boat.effect(n) for n in ("righting_arm", "added_mass", "linear_damping"))
    inertia = boat.body.roll_inertia + water.roll  # type: ignore[union-attr]
    assert 2 * pi * sqrt(inertia / arm.stiffness) == pytest.approx(1.49, abs=1e-3)  # type: ignore[union-attr]
    assert drag.roll / (2 * sqrt(inertia * arm.stiffness)) == pytest.approx(0.0119, abs=1e-5)  # type: ignore[union-attr]
    assert boat.body.roll_inertia == pytest.approx(102 * (3.50094 / 15) ** 2, rel=1e-3)


# ---- steering and speed


def test_a_blade_pushes_at_its_place_and_a_little_more_than_alone() -> None:
    boat = vessel.load_vessel("eastward_ho", ["condition_3"])
    blade = Rudder(area=2.0, aspect=1.5, inflow=4.0, at=-10.0, below=2.0).with_all_parameters(boat)
    alone = 0.5 * RHO * 6.13 * 1.5 / 3.75 * 2.0 * 16.0
    force, arm = blade.wrench(make_motion(), angle=0.1), boat.effect("linear_hull").arm  # type: ignore[union-attr]
    assert -force.Y == pytest.approx(0.1 * alone * (1 + 0.627 * 0.514 - 0.153))
    assert force.N == pytest.approx(-10.0 * force.Y) and force.K == pytest.approx(
        (arm - 2.0) * force.Y
    )
    given = Rudder(sway=3.0, yaw=-4.0, roll=5.0).with_all_parameters(boat)
    assert given.wrench(make_motion(), angle=0.5) == Wrench(Y=1.5, K=2.5, N=-2.0)


@pytest.mark.parametrize(
    ("effect", "missing"),
    [(Rudder(area=1.0), "linear_hull"), (LinearHull(), "speed_hold"), (RollDamping(), "righting")],
)
def test_what_a_vessel_lacks_for_an_effect_is_said(effect: Any, missing: str) -> None:
    with pytest.raises(BadInput, match=f"kvlcc2: {effect.name} needs a vessel with {missing}"):
        effect.with_all_parameters(vessel.load_vessel("kvlcc2"))


def test_a_hull_too_short_for_a_spheroid_is_refused() -> None:
    with pytest.raises(BadInput, match="length = 2 m; allowed is more than twice the draught, 3 m"):
        spheroid_added_mass(2.0, 1.5)


@pytest.mark.parametrize("delta", [-0.6, -0.2, 0.3, 0.6])
def test_a_stalled_rudder_gives_what_it_gave_at_the_angle_of_stall(delta: float) -> None:
    boat = vessel.load_vessel("eastward_ho")
    own, stalling = (
        b.effect("rudder") for b in (boat, boat.with_completed_effect(RudderStall(angle=0.35)))
    )
    assert isinstance(own, Rudder) and isinstance(stalling, Rudder)
    stalled = min(max(delta, -0.35), 0.35)
    assert stalling.wrench(make_motion(), angle=delta) == pytest.approx(
        own.wrench(make_motion(), angle=stalled)
    )


def test_speed_hold_leaves_no_surge_but_towards_the_speed() -> None:
    hold = SpeedHold(speed=6.0, gain=100.0, mass=500.0)
    assert hold.wrench(make_motion(u=6.0, v=0.7, r=0.2)).X == pytest.approx(-500.0 * 0.7 * 0.2)
    assert hold.wrench(make_motion(u=5.5)).X == pytest.approx(50.0)


def test_a_push_is_the_same_on_every_heading() -> None:
    push = Push(surge=1.0, sway=2.0, roll=3.0, yaw=4.0, heel_arm=0.5)
    assert push.wrench(make_motion(psi=2.0, u=3.0)) == Wrench(X=1.0, Y=2.0, K=4.0, N=4.0)


def test_sea_keeping_is_the_rms_of_three_angles_in_degrees() -> None:
    t = np.linspace(0.0, 2 * pi, 1001)[:-1]
    log = Recording(
        "log",
        t,
        {"psi_rad": 0.1 * np.sin(t), "phi_rad": np.full(1000, -0.2), "rudder_rad": 0.0 * t},
    )
    found = SeaKeeping().values(log)
    assert found == pytest.approx(
        {"yaw_rms": degrees(0.1 / sqrt(2)), "roll_rms": degrees(0.2), "rudder_rms": 0.0}
    )


# ---- axes in which the waves exert no force


@pytest.mark.parametrize(
    ("name", "effect", "unforced"),
    [
        ("otter", {"use": "irregular_sea"}, "surge, heave, roll and pitch"),
        ("trial_boat", {"use": "irregular_sea"}, "surge"),
        ("trial_boat", {"use": "irregular_sea", "flat": 1.0}, "surge and yaw"),
        ("kynoc", {"use": "irregular_sea", "name": "swell"}, "surge"),
    ],
)
def test_waves_that_exert_no_force_in_an_axis_of_the_vessel_give_a_warning(
    name: str, effect: dict[str, Any], unforced: str
) -> None:
    called = effect.get("name", effect["use"])
    message = f"^{name}: the waves of {called} exert no force in {unforced}$"
    with pytest.warns(UnforcedAxesWarning, match=message):
        vessel.load_vessel(name, extra=[{**effect, "significant_height": 0.1, "modal_period": 5.0}])
    with pytest.warns(UnforcedAxesWarning, match=message):
        vessel.load_vessel(name).with_effect(
            {**effect, "significant_height": 0.1, "modal_period": 5.0}
        )


def test_effects_that_together_act_in_all_axes_and_calm_water_give_no_warning() -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        boat = vessel.load_vessel("trial_boat").with_effect({"use": "irregular_sea"})
        boat = boat.with_effect({"use": "wave_forcing", "surge": 0.1})
        boat.with_parameters({"irregular_sea": {"significant_height": 0.1}})
