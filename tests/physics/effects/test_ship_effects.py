"""The library's entries for ships and craft, each against another form, some found in data by
scipy; the KVLCC2."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from math import asinh, cos, exp, hypot, pi, radians, sin, sinh, sqrt
from pathlib import Path
from typing import Any

import boats
import numpy as np
import pytest
from alike import long, slow
from scipy.integrate import solve_ivp

from boatsim.diagnosis import loading, pipeline
from boatsim.diagnosis.command_range import command_channels
from boatsim.errors import BadInput
from boatsim.physics import particulars, vessel
from boatsim.physics.base import Array, Effect, SignalSegment, Wrench, make_motion, segment_mean
from boatsim.physics.effects.added_mass import AddedMass
from boatsim.physics.effects.approach_balance import ApproachBalance
from boatsim.physics.effects.damping import LinearDamping
from boatsim.physics.effects.drive_map import ShaftRpm
from boatsim.physics.effects.forward_speed_damping import ForwardSpeedDamping
from boatsim.physics.effects.planing_lag import PlaningLag
from boatsim.physics.effects.rate_limit import SteeringRateLimit
from boatsim.physics.effects.righting_arm import MetacentricHeightError, RightingArm
from boatsim.physics.effects.rudder import Rudder, RudderStall
from boatsim.physics.effects.rudder_race import RudderRace
from boatsim.physics.effects.speed_scaled_steering import SpeedScaledSteering
from boatsim.physics.effects.steering_drag import SteeringDrag
from boatsim.physics.effects.sway_yaw_coupling import SpeedLossInTurn
from boatsim.physics.effects.thrust_loss_with_speed import ThrustLossWithSpeed
from boatsim.physics.effects.thruster import Thruster
from boatsim.recordings import table as recording
from boatsim.recordings.table import Notes, Recording

SHIP = vessel.load_vessel("kvlcc2")
TURN, HELM = {"u": 0.8, "v": 0.15, "r": -0.06}, 0.4  # of the 7 m model, to port


def test_a_stall_is_sought_among_rudder_angles_and_not_among_shaft_rates() -> None:
    """An MMG rudder is told angle and shaft; the threshold is an angle."""
    assert command_channels(vessel.load_vessel("kvlcc2_mmg"), RudderStall()) == ("delta_rad",)


def signals(kind: type[Effect], **given: float) -> Any:
    """Signals of a law's roles, with cosine and sine of those that are angles."""
    angles = {n: a for n, a in given.items() if kind.roles[n].unit == "rad"}
    parts = {f"cos_{n}": cos(a) for n, a in angles.items()} | {
        f"sin_{n}": sin(a) for n, a in angles.items()
    }
    return kind.signals_type()(**given, **parts)


# ---- laws


@pytest.mark.parametrize("revolutions", [-1.0, -0.5, -0.1, 0.1, 0.3, 1.0])
@pytest.mark.parametrize("u", [-1.0, 0.4, 2.0])
def test_the_loss_of_a_propeller_grows_with_its_revolutions(revolutions: float, u: float) -> None:
    """T = a n |n| - b |n| u, of which the first part is the thrust at rest."""
    ahead, astern, loss = 90.0, 64.0, 0.2
    full = ahead if revolutions > 0.0 else astern
    effect = ThrustLossWithSpeed(loss=loss, full_ahead=ahead, full_astern=astern)
    at_rest = full * revolutions * abs(revolutions)
    given = signals(Thruster, thrust=at_rest, angle=0.0)
    found = effect.wrench(make_motion(u=u), given, Thruster().values()).X
    assert found == pytest.approx(-loss * full * abs(revolutions) * u, rel=0.05)


def test_balance_holds_a_speed_in_proportion_to_the_propellers_rate() -> None:
    balance = ApproachBalance(damping=90.0, speed=1.2, shaft_rate=10.0)
    assert balance.wrench(make_motion(u=0.9), signals(ApproachBalance, shaft=7.5)) == pytest.approx(
        Wrench()
    )
    assert balance.wrench(
        make_motion(u=1.0), signals(ApproachBalance, shaft=10.0)
    ).X == pytest.approx(18.0)
    stronger = replace(balance, gain=1.1)
    assert stronger.wrench(
        make_motion(u=0.99), signals(ApproachBalance, shaft=7.5)
    ) == pytest.approx(Wrench(), abs=1e-12)


def test_speed_scaled_hull_and_rudder_are_the_nondimensional_form() -> None:
    hull, rudder = (
        LinearDamping(sway=591.4, sway_by_yaw=-801.8, yaw_by_sway=1800.6, yaw=4508.0),
        SHIP.effect("rudder"),
    )
    assert isinstance(rudder, Rudder)
    whole = SpeedScaledSteering(
        hull_sway=1, hull_yaw=1, rudder_sway=1, rudder_yaw=1
    ).with_all_parameters(SHIP)
    m, helm = make_motion(**TURN), signals(Rudder, angle=HELM)
    ratio = m.u / 1.179
    of_hull, of_rudder = np.array(hull.wrench(m)), np.array(rudder.wrench(m, helm))
    more = whole.wrench(m, signals(SpeedScaledSteering, angle=HELM))
    assert of_hull + of_rudder + more == pytest.approx(ratio * of_hull + ratio**2 * of_rudder)


def test_speed_scaling_vanishes_at_the_approach_speed_whatever_its_shares() -> None:
    shares = SpeedScaledSteering(
        hull_sway=2, hull_yaw=-1, rudder_sway=0.5, rudder_yaw=3
    ).with_all_parameters(SHIP)
    at_it = shares.wrench(
        make_motion(**{**TURN, "u": 1.179}), signals(SpeedScaledSteering, angle=HELM)
    )
    assert at_it == pytest.approx(Wrench(), abs=1e-12)


def test_astern_the_water_meets_the_rudder_from_behind_and_the_hull_still_damps() -> None:
    scaled = SpeedScaledSteering(
        hull_sway=1, hull_yaw=1, rudder_sway=1, rudder_yaw=1
    ).with_all_parameters(SHIP)
    hull, rudder = SHIP.effect("linear_damping"), SHIP.effect("rudder")
    assert isinstance(hull, LinearDamping) and isinstance(rudder, Rudder)

    def whole(u: float, v: float, helm: float) -> Array:
        m = make_motion(u=u, v=v)
        parts = hull.wrench(m), rudder.wrench(m, signals(Rudder, angle=helm))
        return np.array([*parts, scaled.wrench(m, signals(SpeedScaledSteering, angle=helm))])[
            :, [1, 5]
        ].sum(axis=0)

    assert whole(-0.8, 0.0, HELM) == pytest.approx(-whole(0.8, 0.0, HELM))
    assert whole(-0.8, 0.2, 0.0)[0] == pytest.approx(whole(0.8, 0.2, 0.0)[0])


def test_a_race_adds_to_a_blade_what_momentum_theory_adds_to_the_square_of_its_inflow() -> None:
    density, diameter, area, aspect, thrust, delta = 1000.0, 0.2, 0.05, 1.5, 30.0, 0.3
    disc = 0.25 * pi * diameter**2
    per_thrust = 6.13 * aspect / (aspect + 2.25) * area / disc
    race = RudderRace(normal_force_per_thrust=per_thrust, at=-1.4, side=-1.0)
    for u in (0.0, 0.7):
        faster = 8.0 * thrust / (pi * density * diameter**2)  # V_R^2 - u^2 [m^2/s^2] far behind
        slope = [
            particulars.rudder_force_slope(area, aspect, sqrt(u * u + more), density)
            for more in (0.0, faster)
        ]
        normal = (slope[1] - slope[0]) * sin(delta)
        seen = race.wrench(make_motion(u=u), signals(RudderRace, angle=delta, thrust=thrust))
        assert seen == pytest.approx(
            Wrench(X=-normal * sin(delta), Y=-normal * cos(delta), N=1.4 * normal * cos(delta)),
            rel=1e-12,
        )


def test_a_propeller_that_backs_washes_no_rudder_and_a_race_takes_its_place_from_the_rudder() -> (
    None
):
    race = RudderRace(normal_force_per_thrust=0.5).with_all_parameters(SHIP)
    rudder = SHIP.effect("rudder")
    assert isinstance(rudder, Rudder)
    assert not any(race.wrench(make_motion(u=0.5), signals(RudderRace, angle=0.4, thrust=-20.0)))
    ahead = race.wrench(make_motion(u=0.5), signals(RudderRace, angle=0.4, thrust=20.0))
    own = rudder.wrench(make_motion(u=0.5), signals(Rudder, angle=0.4))
    assert ahead.Y * own.Y > 0.0 and ahead.N / ahead.Y == pytest.approx(own.N / own.Y)


@pytest.mark.parametrize("u", [0.7, -0.7])
def test_forward_speed_damping_is_linear_damping_in_proportion_to_the_speed(u: float) -> None:
    m = make_motion(u=u, v=0.2, p=-0.3, r=0.4)
    linear = LinearDamping(sway=0.7 * 8.0, roll=0.7 * 2.0, yaw=0.7 * 3.0)
    assert ForwardSpeedDamping(sway=8.0, roll=2.0, yaw=3.0).wrench(m) == pytest.approx(
        linear.wrench(m)
    )
    assert not any(
        ForwardSpeedDamping(sway=8.0, roll=2.0, yaw=3.0).wrench(make_motion(v=0.2, p=-0.3, r=0.4))
    )


@pytest.mark.parametrize("u", [0.7, -0.7])
def test_lift_at_a_place_is_a_force_there_by_the_drift_there_and_astern_the_hull_turned_round_feels_the_same(
    u: float,
) -> None:
    lift = ForwardSpeedDamping(sway=8.0, at=-0.4)
    seen, there = lift.wrench(make_motion(u=u, v=0.2, r=0.3)), -0.4 if u > 0.0 else 0.4
    assert (
        lift.wrench(make_motion(u=u, v=0.2)).N / lift.wrench(make_motion(u=u, v=0.2)).Y
    ) == pytest.approx(there)
    assert seen.Y == pytest.approx(-8.0 * abs(u) * (0.2 + there * 0.3))
    assert seen.N == pytest.approx(there * seen.Y)


def test_speed_lost_in_a_turn_is_the_coriolis_force_of_the_sway_added_mass() -> None:
    m = make_motion(**TURN)
    assert SpeedLossInTurn(mass=2486.0).wrench(m).X == pytest.approx(
        AddedMass(sway=2486.0).wrench(m).X
    )
    assert SpeedLossInTurn(mass=2486.0).wrench(m).X < 0.0


def test_steering_drag_is_the_part_along_the_ship_of_a_force_normal_to_the_blade() -> None:
    slope = 53.0  # [N/rad] of the force normal to the blade
    for delta in (-0.2, 0.3):
        along = -slope * sin(delta) * sin(delta)
        seen = SteeringDrag(drag=slope).wrench(make_motion(), signals(Rudder, angle=delta), None)
        assert seen.X == pytest.approx(along, rel=delta**2 / 2.5)


def test_rate_limit_takes_the_time_of_a_ramp_and_its_mean_is_exact() -> None:
    limit, dt = SteeringRateLimit(rate=radians(15.8)), 0.07
    commands = np.repeat(np.random.default_rng(3).uniform(-0.6, 0.6, 12), 30)
    memory, fine = np.zeros(1), 2000
    angle = 0.0
    for x in commands:
        mean = segment_mean(
            SteeringRateLimit.transform_signal(
                SignalSegment(x, x, x), 0.0, 0.0, memory, 0, dt, limit.values()
            )
        )
        path = angle + np.sign(x - angle) * np.minimum(
            limit.rate * dt * np.arange(fine + 1) / fine, abs(x - angle)
        )
        assert mean == pytest.approx(np.trapezoid(path) / fine, abs=1e-7)
        angle = path[-1]
        assert memory[0] == pytest.approx(angle)
    assert angle == pytest.approx(commands[-1])  # 30 steps of 0.07 s turn 33 deg


def test_metacentric_height_changes_the_period_by_the_inverse_root() -> None:
    own = RightingArm(stiffness=822.3, list=0.01)
    boat = replace(SHIP, effects=(own,)).with_completed_effect(MetacentricHeightError(factor=0.64))
    inertia, m = 135.4, make_motion(phi=0.11)
    period = [2 * pi * sqrt(inertia * 0.1 / -arm.wrench(m).K) for arm in (own, boat.effects[0])]
    assert period[1] / period[0] == pytest.approx(1.25)


@pytest.mark.parametrize("angle", [0.0, 0.3, 0.5 * pi, 2.5])
@pytest.mark.parametrize("thrust", [0.8, -0.5])
def test_thrust_is_lost_with_the_speed_of_the_mount_along_the_axis(
    thrust: float, angle: float
) -> None:
    """The speed of advance is the velocity of the mount, w x r + V, along the thruster's axis."""
    own, loss = Thruster(x=-0.6, y=0.19, gain=1.2), ThrustLossWithSpeed(loss=0.2)
    m = make_motion(u=1.5, v=-0.4, r=0.7)
    mount = np.array([1.5, -0.4, 0.0]) + np.cross([0.0, 0.0, 0.7], [-0.6, 0.19, 0.0])
    advance = float(mount @ np.array([cos(angle), sin(angle), 0.0]))
    given, less = (
        signals(Thruster, thrust=t, angle=angle)
        for t in (thrust, thrust - 0.2 * advance * abs(thrust))
    )
    seen = np.add(own.wrench(m, given), loss.wrench(m, given, own.values()))
    assert seen == pytest.approx(own.wrench(m, less))


@pytest.mark.parametrize(("u", "kappa"), [(2.0, 0.2), (14.0, 0.5), (35.0, 1.0)])
def test_planing_lag_is_the_kappa_form(u: float, kappa: float) -> None:
    values = PlaningLag(full_speed=28.0, least=0.2, hull_mass=1.0).values()
    others = Wrench(X=5.0 - drag(u))
    force = others.X - 0.4 * 0.5  # per unit mass, with v r
    lag = PlaningLag.reaction(make_motion(u=u, v=-0.4, r=0.5), others, values)
    assert force + lag.X == pytest.approx(kappa * force)
    assert PlaningLag.reaction(make_motion(u=u), Wrench(), values).X == 0.0  # steady


def test_revolutions_a_minute_add_to_those_a_second() -> None:
    turning = ShaftRpm.transform_signal(
        SignalSegment(0.5, 0.5, 0.5), 0.0, 90.0, np.zeros(1), 0, 0.1, ShaftRpm().values()
    )
    assert turning == pytest.approx([2.0, 2.0, 2.0])


# ---- the vessel


def test_kvlcc2_has_the_published_derivatives() -> None:
    """Yasukawa and Yoshimura 2015: derivatives by 0.5 rho L d U0 and its arms, rudder by the linear
    MMG formulas."""
    L, d, U0, n = 7.0, 0.455, 1.179, 10.2295
    force = 500.0 * L * d * U0
    hull = SHIP.effect("linear_damping")
    water = SHIP.effect("added_mass")
    assert isinstance(hull, LinearDamping) and isinstance(water, AddedMass)
    assert hull.sway == pytest.approx(0.315 * force, rel=1e-3)
    assert hull.sway_by_yaw == pytest.approx(
        -0.083 * force * L + 0.022 * 500.0 * L**2 * d * U0, rel=1e-3
    )
    assert (hull.yaw_by_sway, hull.yaw) == pytest.approx(
        (0.137 * force * L, 0.049 * force * L**2), rel=1e-3
    )
    assert (water.surge, water.sway) == pytest.approx(
        (0.022 * 500 * L**2 * d, 0.223 * 500 * L**2 * d), rel=1e-3
    )
    J = 0.6 * U0 / (n * 0.204)
    KT = 0.2931 - 0.2753 * J - 0.1385 * J**2
    jet = 1.0 + 0.5 * (sqrt(1.0 + 8.0 * KT / (pi * J**2)) - 1.0)
    share = 0.204 / 0.345  # of the rudder's span behind the propeller
    inflow = 1.09 * 0.6 * U0 * sqrt(share * jet**2 + 1.0 - share)
    normal = 500.0 * 0.0539 * 2.747 * inflow**2
    rudder = SHIP.effect("rudder")
    assert isinstance(rudder, Rudder)
    assert rudder.sway == pytest.approx(-1.312 * normal, rel=2e-3)
    assert rudder.yaw == pytest.approx((3.5 + 0.312 * 0.464 * L) * normal, rel=2e-3)


def test_full_scale_kvlcc2_is_the_model_by_froudes_law() -> None:
    full = vessel.load_vessel("kvlcc2_full_scale")
    ratio = full.length / SHIP.length
    powers = {"N": (3, 1, -2), "kg": (3, 0, 0), "m": (0, 1, 0), "s": (0, 0, 1), "rad": (0, 0, 0)}

    def grows(unit: str) -> float:
        """Masses by the cube of the length, times by its root."""
        above, _, below = unit.partition("/")
        total = 0.0
        for part, sign in ((above, 1), (below, -1)):
            for factor in part.replace("1", "").split():
                symbol, _, power = factor.partition("^")
                mass, length, time = powers[symbol]
                total += sign * int(power or 1) * (mass + length + 0.5 * time)
        return float(ratio**total)

    for own in SHIP.effects:
        scaled = full.effect(own.name)
        for name, about in type(own).params().items():
            if getattr(own, name.replace("_equal", "_exponent")) == 1.0 and name.endswith("_equal"):
                continue  # where a linear law meets another power says nothing of it
            wanted = getattr(own, name) * grows(about.unit)
            loose = (
                1e-2 if name == "shaft_rate" else 1e-3
            )  # the tanks' propellers turned at slightly different rates
            assert getattr(scaled, name) == pytest.approx(wanted, rel=loose), f"{own.name}.{name}"
    assert full.body.mass == pytest.approx(SHIP.body.mass * ratio**3, rel=1e-3)
    assert full.body.yaw_inertia == pytest.approx(SHIP.body.yaw_inertia * ratio**5, rel=1e-3)


# ---- diagnoses of data from an integrator that shares no code with the tool


@dataclass(frozen=True)
class Real:
    """What the tanker model really has, in the words of this file."""

    drift: float = 0.0  # [kg] surge force per v r
    brake: float = 0.0  # [N/rad^2] surge force per rudder angle squared
    hull: float = 0.0  # share of the hull's linear forces that goes with u
    blade: float = 0.0  # share of the rudder's forces that goes with u^2
    rate: float = 10.0  # [rad/s] steering machine


def tanker(t: float, y: Array, angle: Callable[[float], float], shaft: float, real: Real) -> Array:
    """Newton's law about midship, mass centre 0.2436 m ahead, published derivatives about 1.179
    m/s."""
    psi, u, v, r = y[2:]
    m, ahead, delta = 3272.0, 0.2436, angle(t)
    way = hypot(u, v) / 1.179
    lift, steer = 1.0 + real.hull * (way - 1.0), 1.0 + real.blade * (way**1.9 - 1.0)
    X = (
        -97.6 * (u - 1.179 * shaft)
        + real.drift * (0.9 + abs(v)) * v * r
        - real.brake * sin(delta) ** 2
        + m * (v * r + ahead * r**2)
    )
    Y = lift * (-591.4 * v + 801.8 * r) - steer * 113.9 * delta - m * u * r
    N = lift * (-1800.6 * v - 4508.0 * r) + steer * 391.9 * delta - m * ahead * u * r
    matrix = np.array([[m + 2486.0, m * ahead], [m * ahead, 9908.6 + m * ahead**2 + 6009.0]])
    c, s = np.cos(psi), np.sin(psi)
    return np.array(
        [u * c - v * s, u * s + v * c, r, X / (m + 245.2), *np.linalg.solve(matrix, [Y, N])]
    )


def sailed(real: Real, seed: int) -> Recording:
    """90 s at 4 Hz of a zig-zag, another propeller rate in each run, seen by a tank's carriage."""
    rng = np.random.default_rng(seed)
    dt, n, shaft = 0.25, 360, 1.25 - 0.25 * seed
    y, order, angle = np.array([0.0, 0.0, 0.0, 1.179 * shaft, 0.0, 0.0]), radians(15.0), 0.0
    rows = []
    for i in range(n):
        if order * y[5] > abs(order) * shaft * radians(1.5):
            order = -np.sign(order) * radians(rng.uniform(10.0, 30.0))
        rows.append([i * dt, *y, order])

        def machine(t: float, begin: float = angle, goal: float = order) -> float:
            """It turns at its rate but for the last degrees, in which its valve closes."""
            if real.rate > 5.0:
                return goal
            near = 0.5 * real.rate  # [rad]
            return goal - near * asinh(sinh((goal - begin) / near) * exp(-real.rate * t / near))

        y = solve_ivp(tanker, (0.0, dt), y, args=(machine, shaft, real), rtol=1e-7, atol=1e-9).y[
            :, -1
        ]
        angle = machine(dt)
    table = np.array(rows)
    table[:, 1:7] += rng.standard_normal((n, 6)) * [0.002, 0.002, 4e-4, 1e-3, 1e-3, 2e-4]
    names = ("x_m", "y_m", "psi_rad", "u_mps", "v_mps", "r_radps", "delta_rad")
    signals = {name: table[:, i + 1] for i, name in enumerate(names)} | {
        "n_rps": np.full(n, 10.2295 * shaft)
    }
    return Recording(f"{seed}", table[:, 0], signals, Notes(vessel="kvlcc2"))


def diagnosed(
    made: Callable[[int], Recording], folder: Path, name: str, library: tuple[str, ...]
) -> dict[str, Any]:
    """The answer of a diagnosis of three runs."""
    files = [folder / f"{seed}.csv" for seed in (1, 2, 3)]
    for seed, file in enumerate(files, 1):
        recording.write_csv(made(seed), file)
    return pipeline.diagnose(files[:2], files[2:], name, library=library).findings.answer


def check(answer: dict[str, Any], wanted: dict[str, dict[str, float]]) -> None:
    """Exactly the wanted effects, each value within 3.5 sd and known to 30 %."""
    assert {e["name"] for e in answer["effects"]} == set(wanted)
    for effect in answer["effects"]:
        for key, true in wanted[effect["name"]].items():
            found = effect["parameters"][key]
            assert abs(found["value"] - true) < 3.5 * found["sd"] and found["sd"] < 0.3 * abs(
                true
            ), key


@pytest.mark.slow
@pytest.mark.parametrize(
    ("real", "wanted"),
    [
        long(Real(), {}),
        (
            Real(drift=2500.0, brake=60.0),
            {"speed_loss_in_turn": {"mass_kg": 2500.0}, "steering_drag": {"drag_Nprad2": 60.0}},
        ),
        long(
            Real(hull=1.0, blade=0.8, drift=2500.0),
            {
                "speed_loss_in_turn": {"mass_kg": 2500.0},
                "speed_scaled_steering": {"hull_sway": 1.0, "rudder_sway": 0.8, "rudder_yaw": 0.8},
            },
        ),
        long(Real(rate=0.06), {"steering_rate_limit": {"rate_radps": 0.06}}),
    ],
    ids=lambda case: "" if isinstance(case, Real) else "+".join(case) or "nothing",
)
def test_what_a_linear_tanker_lacks_is_named_with_its_values(
    tmp_path: Path, real: Real, wanted: Any
) -> None:
    check(
        diagnosed(lambda seed: sailed(real, seed), tmp_path, "kvlcc2", ("steering_rate_limit",)),
        wanted,
    )


CRAFT = """
about = "high-speed craft for tests: 3.25 m, 388 kg, drag of the published water-jet craft"
source = "C. Svendsen et al., IFAC MCMC 2012, Table 3"
freedoms = ["surge"]
length = 3.25
beam = 1.22
draught = 0.2
body = { mass = 388.0, roll_inertia = 50.0, yaw_inertia = 220.0 }

[channels]
thrust_port_N = { low = 0.0, high = 4000.0 }
thrust_starboard_N = { low = 0.0, high = 4000.0 }
steer_port_rad = { low = -0.3, high = 0.3 }
steer_starboard_rad = { low = -0.3, high = 0.3 }

[[effect]]
use = "surge_drag"
linear = 74.73
quadratic = 1.358

[[effect]]
use = "thruster"
name = "port"
on = { thrust = "thrust_port_N", angle = "steer_port_rad" }
x = -1.6
y = -0.3

[[effect]]
use = "thruster"
name = "starboard"
on = { thrust = "thrust_starboard_N", angle = "steer_starboard_rad" }
x = -1.6
y = 0.3

"""


def throttled(change: Callable[[float, float], float], seed: int) -> Recording:
    """60 s at 5 Hz straight ahead with throttle steps; `change` makes the real acceleration from
    thrust and speed."""
    rng = np.random.default_rng(seed)
    dt, n = 0.2, 300
    thrust = np.repeat(rng.uniform(0.5, 7.5, 10), 30)  # [m/s^2]
    y, rows = np.array([0.0, 3.0]), []
    for a in thrust:
        rows.append(y)
        y = solve_ivp(
            lambda t, z, a=a: [z[1], change(a, z[1])], (0.0, dt), y, rtol=1e-8, atol=1e-9
        ).y[:, -1]
    x, u = np.array(rows).T + rng.standard_normal((2, n)) * [[0.05], [0.15]]
    signals = {"x_m": x, "u_mps": u}
    signals |= {f"thrust_{side}_N": 0.5 * 388.0 * thrust for side in ("port", "starboard")}
    signals |= {f"steer_{side}_rad": np.zeros(n) for side in ("port", "starboard")}
    return Recording(f"{seed}", dt * np.arange(n), signals)


def drag(u: float) -> float:
    """Per mass [m/s^2], Table 3."""
    return 0.1926 * u + 0.0035 * u * abs(u)


def lagging(a: float, u: float) -> float:
    return min((0.2**4 + max(u / 28.0, 0.0) ** 4) ** 0.25, 1.0) * (
        a - drag(u)
    )  # it planes by and by


def slipping(a: float, u: float) -> float:
    return a * (1.0 - 0.015 * u * (0.8 + 0.2 * u / 12.0)) - drag(u)  # more than in proportion


@pytest.mark.slow
@pytest.mark.parametrize(
    ("change", "wanted"),
    [
        slow((lagging, {"planing_lag": {"full_speed_mps": 28.0, "least": 0.2}})),
        (
            slipping,
            {"thrust_loss_with_speed": {"loss_spm": 0.012, "curve_s2pm2": 0.015 * 0.2 / 12.0}},
        ),
    ],
)
def test_what_a_planing_craft_lacks_is_named_with_its_values(
    tmp_path: Path, change: Any, wanted: Any
) -> None:
    folder = boats.written(tmp_path, "craft", CRAFT)
    check(diagnosed(lambda seed: throttled(change, seed), tmp_path, str(folder), ()), wanted)


# ---- recordings of one hull that count the rudder the other way or are at another scale


def test_a_rudder_counted_to_port_is_turned_and_said_so(tmp_path: Path) -> None:
    run = sailed(Real(), 1)
    recording.write_csv(run, tmp_path / "ours.csv")
    theirs = {**run.signals, "delta_rad": -run["delta_rad"]}
    recording.write_csv(replace(run, signals=theirs), tmp_path / "theirs.csv")
    ours, said = (
        loading.open_recording(tmp_path / f"{n}.csv", "kvlcc2", ())[0] for n in ("ours", "theirs")
    )
    assert said["delta_rad"] == pytest.approx(ours["delta_rad"]) and not ours.remarks
    assert said.remarks[-1].endswith(
        "theirs.csv: positive delta_rad turns the hull to the other side; its sign is changed"
    )


def test_the_scale_of_a_recording_picks_the_vessel_or_is_refused(tmp_path: Path) -> None:
    run = sailed(Real(), 1)
    recording.write_csv(
        replace(run, signals={**run.signals, "n_rps": np.full(len(run), 1.5)}), tmp_path / "run.csv"
    )
    (tmp_path / "recording.toml").write_text('vessel = "kvlcc2"\nscale = 1.0\n')
    assert loading.open_recording(tmp_path / "run.csv", None, ())[1].name == "kvlcc2_full_scale"
    with pytest.raises(
        BadInput,
        match="scale = 1, but kvlcc2 is at scale 45.714; the vessel at that scale is kvlcc2_f",
    ):
        loading.open_recording(tmp_path / "run.csv", "kvlcc2", ())
    (tmp_path / "recording.toml").write_text('vessel = "kvlcc2"\nscale = 45.714\n')
    assert loading.open_recording(tmp_path / "run.csv", None, ())[1].name == "kvlcc2"
