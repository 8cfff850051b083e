"""Standard manoeuvres: each measure against a closed form, the IMO's limits, every vessel that can
turn, mistakes."""

from dataclasses import replace
from math import cos, degrees, exp, log, pi, radians, sin, sqrt
from pathlib import Path
from typing import Any

import boats
import numpy as np
import pytest
from alike import few
from scipy.optimize import brentq
from typer.testing import CliRunner

from boatsim.cli import app
from boatsim.control.base import Sense
from boatsim.metrics.crash_stop import CrashStop
from boatsim.metrics.pull_out import PullOut
from boatsim.metrics.roll_decay import RollDecay
from boatsim.metrics.spiral import Spiral
from boatsim.metrics.turning_circle import TurningCircle
from boatsim.metrics.zigzag import Zigzag
from boatsim.physics import content, vessel
from boatsim.physics.base import Array
from boatsim.physics.content import load_class
from boatsim.recordings.table import Recording
from boatsim.simulate import imo
from boatsim.simulate.batch import Batch
from boatsim.simulate.evaluation import requested_metrics
from boatsim.simulate.manoeuvre import (
    approach_summary,
    complete_manoeuvring_table,
    manoeuvre_scenario,
    steady_approach,
)
from boatsim.simulate.run import run
from boatsim.simulate.steady_course import steering_commands

LENGTH = 2.0  # [m] of the ships here
EXECUTE = 10.03  # [s] between two rows of a log
SIDES = pytest.mark.parametrize("side", [1.0, -1.0], ids=["starboard", "port"])


def logged(t: Array, **signals: Array) -> Recording:
    return Recording("log", t, signals)


# Measures on tracks known in closed form


def circle(side: float, radius: float, speed: float, drift: float, course: float) -> Recording:
    """Straight ahead on a course until EXECUTE, then at once round a circle; the bow points inwards
    by the drift."""
    t = np.arange(0.0, 60.0, 0.02)
    s = speed * (t - EXECUTE)
    turned = np.maximum(s, 0.0) / radius
    ahead, aside = (
        np.where(s < 0.0, s, radius * np.sin(turned)),
        side * radius * (1.0 - np.cos(turned)),
    )
    c, n, still = cos(course), sin(course), s < 0.0
    return logged(
        t,
        x_m=c * ahead - n * aside,
        y_m=n * ahead + c * aside,
        psi_rad=course + side * turned,
        u_mps=np.full(len(t), speed * cos(drift)),
        v_mps=np.full(len(t), -side * speed * sin(drift)),
        r_radps=np.where(still, 0.0, side * speed / radius),
    )


@SIDES
def test_turning_circle_of_a_ship_that_goes_round_a_circle(side: float) -> None:
    found = TurningCircle(execute=EXECUTE, length=LENGTH).values(circle(side, 6.0, 1.5, 0.2, 0.7))
    assert found == pytest.approx(
        {
            "advance": 3.0,
            "transfer": 3.0,
            "tactical_diameter": 6.0,
            "steady_radius": 3.0,
            "steady_speed": 1.5,
            "steady_rate": degrees(1.5 / 6.0),
            "steady_drift": degrees(0.2),
            "time_to_90": 0.5 * pi * 6.0 / 1.5,
        },
        rel=2e-3,
    )


def test_turning_circle_that_was_not_finished() -> None:
    whole = circle(1.0, 6.0, 1.5, 0.0, 0.0)
    measure = TurningCircle(execute=EXECUTE, length=LENGTH)
    assert set(measure.values(whole.between(0.0, 17.0))) == {"advance", "transfer", "time_to_90"}
    assert measure.values(whole.between(0.0, 12.0)) == measure.values(whole.between(0.0, 5.0)) == {}


@SIDES
def test_crash_stop_of_a_ship_that_loses_her_way_evenly(side: float) -> None:
    slowing, bend, speed = 0.05, 40.0, 1.2  # [m/s^2], [m], [m/s]
    t = np.arange(0.0, 60.0, 0.02)
    after = np.maximum(t - EXECUTE, 0.0)
    s = speed * np.minimum(t - EXECUTE, 0.0) + speed * after - 0.5 * slowing * after**2
    psi = side * np.maximum(s, 0.0) / bend
    x, y = np.where(s < 0.0, s, bend * np.sin(np.abs(psi))), side * bend * (1.0 - np.cos(psi))
    found = CrashStop(execute=EXECUTE, length=LENGTH).values(
        logged(t, x_m=x, y_m=y, psi_rad=psi, u_mps=speed - slowing * after)
    )
    reach = speed**2 / (2.0 * slowing)
    wanted = {
        "track_reach": reach / LENGTH,
        "head_reach": bend * sin(reach / bend) / LENGTH,
        "side_reach": side * bend * (1.0 - cos(reach / bend)) / LENGTH,
        "time_to_stop": speed / slowing,
    }
    assert found == pytest.approx(wanted, rel=2e-3)
    assert CrashStop().values(logged(t, x_m=x, y_m=y, psi_rad=psi, u_mps=np.ones(len(t)))) == {}


@pytest.mark.parametrize("zeta", [0.01, 0.1, 0.3])
def test_roll_decay_of_a_linear_oscillator(zeta: float) -> None:
    own = 2.5  # [rad/s] undamped
    damped = own * sqrt(1.0 - zeta**2)
    t = np.arange(0.0, 12 * 2 * pi / own, 0.01)
    phi = (
        0.2
        * np.exp(-zeta * own * t)
        * (np.cos(damped * t) + zeta * own / damped * np.sin(damped * t))
    )
    found = RollDecay().values(logged(t, phi_rad=phi))
    assert found["period"] == pytest.approx(2 * pi / damped, rel=1e-4)
    for part in ("first", "mean", "last"):
        assert found[f"damping_{part}"] == pytest.approx(zeta, rel=1e-3)


def test_a_roll_that_does_not_swing_has_no_period() -> None:
    t = np.arange(0.0, 10.0, 0.01)
    assert RollDecay().values(logged(t, phi_rad=0.2 * np.exp(-t))) == {}
    assert RollDecay().values(logged(t, phi_rad=0.2 * np.sin(t))) == {}


def test_helm_never_used_or_not_brought_back_measures_nothing() -> None:
    t = np.arange(40.0)
    still = logged(t, reference_helm_rad=np.zeros(40), r_radps=np.full(40, 0.01))
    cut = logged(
        t, reference_helm_rad=np.repeat([0.0, 0.2, 0.1, 0.0], 10), r_radps=np.full(40, 0.01)
    )
    assert PullOut().values(still) == Spiral().values(still) == Spiral().values(cut) == {}


# A first-order ship (Nomoto): T r' + r = K delta, at constant speed without drift, its helm over at
# once


class Nomoto:
    """Played by a controller with exact steps; its log."""

    T, K, U = 3.0, 0.4, 1.0  # [s], [1/s], [m/s]

    def __init__(self, controller: Any, duration: float) -> None:
        self.dt = controller.period
        psi = r = x = y = 0.0
        rows = []
        controller.reset()
        for i in range(round(duration / self.dt) + 1):
            controller.step(Sense(i * self.dt, psi, r, 0.0, 0.0, self.U, 0.0, x, y), {})
            delta = controller.estimates()["reference_helm_rad"].value
            rows.append((i * self.dt, x, y, psi, r, delta))
            if controller.done:
                break
            gone = self.K * delta + (r - self.K * delta) * exp(-self.dt / self.T)
            half = psi + 0.5 * r * self.dt
            x, y = x + self.U * cos(half) * self.dt, y + self.U * sin(half) * self.dt
            psi, r = psi + self.K * delta * self.dt + self.T * (r - gone), gone
        t, x_, y_, psi_, r_, helm = np.array(rows).T
        u, v = np.full(len(t), self.U), np.zeros(len(t))
        self.log = logged(
            t, x_m=x_, y_m=y_, psi_rad=psi_, r_radps=r_, u_mps=u, v_mps=v, reference_helm_rad=helm
        )


def controller(name: str, period: float = 0.01, **settings: Any) -> Any:
    return load_class("controller", name)(period=period, steer={"delta_rad": 1.0}, **settings)


@SIDES
def test_steady_turn_of_a_first_order_ship(side: float) -> None:
    ship = Nomoto(controller("turning_circle", angle=0.3 * side, execute=5.0), 80.0)
    found = TurningCircle(execute=5.0, length=LENGTH).values(ship.log)
    assert found["steady_radius"] == pytest.approx(Nomoto.U / (Nomoto.K * 0.3) / LENGTH, rel=1e-6)
    assert found["steady_rate"] == pytest.approx(degrees(Nomoto.K * 0.3), rel=1e-6)
    late = brentq(
        lambda t: Nomoto.K * 0.3 * (t - Nomoto.T * (1.0 - exp(-t / Nomoto.T))) - pi / 2, 1.0, 50.0
    )
    assert found["time_to_90"] == pytest.approx(late, abs=1e-3)
    assert found["transfer"] > 0.0


@SIDES
def test_zigzag_of_a_first_order_ship(side: float) -> None:
    angle, heading, T, K = 0.2, 0.3, Nomoto.T, Nomoto.K
    made = controller("zigzag", angle=angle * side, heading=heading, reversals=3, execute=5.0)
    found = Zigzag(execute=5.0, heading=heading, length=LENGTH).values(Nomoto(made, 200.0).log)
    late = brentq(lambda t: K * angle * (t - T * (1.0 - exp(-t / T))) - heading, 0.1, 50.0)
    rate = K * angle * (1.0 - exp(-late / T))  # when the helm is reversed
    until = T * log(1.0 + rate / (K * angle))  # the ship turns no more
    assert found["time_to_reversal"] == pytest.approx(late, abs=1e-3)
    assert found["track_to_reversal"] == pytest.approx(Nomoto.U * late / LENGTH, abs=1e-3)
    assert found["first_overshoot"] == pytest.approx(
        degrees(T * rate - K * angle * until), abs=0.05
    )
    assert found["first_overshoot_at"] == pytest.approx(late + until, abs=0.03)
    assert (
        "second_overshoot" in found and "third_overshoot" not in found
    )  # which needs a fourth reversal


def test_zigzag_without_a_reversal_measures_nothing() -> None:
    short = Nomoto(controller("zigzag", angle=0.2, heading=3.0), 5.0)
    assert Zigzag(heading=3.0).values(short.log) == {}


@SIDES
def test_pull_out_of_a_first_order_ship(side: float) -> None:
    made = controller("pull_out", angle=0.3 * side, hold=20.0, execute=5.0)
    found = PullOut().values(Nomoto(made, 85.0).log)
    turn, left = degrees(Nomoto.K * 0.3), exp(-20.0 / Nomoto.T)
    assert found["rate_first_turn"] == pytest.approx(side * turn, rel=2 * left)
    assert found["rate_second_turn"] == pytest.approx(-side * turn, rel=2 * left)
    assert abs(found["rate_after_first"]) < 2 * left * turn
    assert found["residual_difference"] < 4 * left * turn


@SIDES
def test_spiral_of_a_ship_that_is_not_course_stable(side: float) -> None:
    """Rate = 2 helm + 0.1 in the sense of the last turn, until the helm is 0.1 over the other way."""
    angles = side * 0.2 * np.array([4, 3, 2, 1, 0, -1, -2, -3, -4, -3, -2, -1, 0, 1, 2, 3, 4]) / 4
    sense, rates = side, []
    for a in angles:
        sense = np.sign(a) if abs(a) > 0.11 else sense
        rates.append(2.0 * abs(a) * np.sign(a) * (np.sign(a) == sense) + 0.1 * sense)
    helm, r = np.repeat([0.0, *angles], 10), np.repeat([0.0, *rates], 10)
    found = Spiral().values(logged(np.arange(float(len(helm))), reference_helm_rad=helm, r_radps=r))
    assert found["loop_height"] == pytest.approx(degrees(0.2))
    assert found["loop_width"] == pytest.approx(degrees(0.2))
    assert found["rate_at_largest"] == pytest.approx(side * degrees(0.5))
    assert found["rate_midships"] == pytest.approx(side * degrees(0.1))


@SIDES
def test_spiral_of_a_first_order_ship_has_no_loop(side: float) -> None:
    ship = Nomoto(
        controller("spiral", 0.05, angle=0.3 * side, hold=30.0, execute=5.0), 5.0 + 17 * 30.0
    )
    steps = ship.log["reference_helm_rad"][round((5.0 + 15.0) / 0.05) :: round(30.0 / 0.05)]
    assert steps == pytest.approx(side * 0.3 * np.array([*range(4, -5, -1), *range(-3, 5)]) / 4)
    found = Spiral().values(ship.log)
    assert found["loop_width"] == 0.0 and found["loop_height"] < 0.01
    assert found["rate_at_largest"] == pytest.approx(side * degrees(Nomoto.K * 0.3), rel=1e-3)


def test_crash_stop_goes_astern_until_there_is_no_way_on() -> None:
    stopping = load_class("controller", "crash_stop")(
        execute=2.0, ahead={"n": 5.0}, astern={"n": -4.0}
    )
    stopping.reset()

    def sent(t: float, u: float) -> dict[str, float]:
        found: dict[str, float] = stopping.step(Sense(t, 0.0, 0.0, 0.0, 0.0, u, 0.0, 0.0, 0.0), {})
        return found

    assert [sent(1.0, 1.0), sent(2.0, 1.0), sent(3.0, 0.5)] == [
        {"n": 5.0},
        {"n": -4.0},
        {"n": -4.0},
    ]
    assert not stopping.done
    sent(4.0, -0.01)
    assert stopping.done


# Limits of the IMO


def test_limits_of_the_10_10_zigzag_meet_at_their_boundaries() -> None:
    for ratio, first, second in ((10.0, 10.0, 25.0), (30.0, 20.0, 40.0)):
        for beside in (ratio * (1 - 1e-9), ratio, ratio * (1 + 1e-9)):
            assert imo.FIRST_OVERSHOOT_10.overshoot_limit(beside, 1.0) == pytest.approx(first)
            assert imo.SECOND_OVERSHOOT_10.overshoot_limit(beside, 1.0) == pytest.approx(second)
    assert (
        imo.FIRST_OVERSHOOT_10.overshoot_limit(1.2, 0.5),
        imo.SECOND_OVERSHOOT_10.overshoot_limit(1.2, 0.5),
    ) == (
        10.0,
        25.0,
    )
    assert (
        imo.FIRST_OVERSHOOT_10.overshoot_limit(400.0, 10.0),
        imo.SECOND_OVERSHOOT_10.overshoot_limit(400.0, 10.0),
    ) == (
        20.0,
        40.0,
    )
    assert imo.FIRST_OVERSHOOT_10.overshoot_limit(160.0, 8.0) == pytest.approx(15.0)


@pytest.mark.parametrize(
    ("manoeuvre", "angle", "wanted"),
    [
        ("turning_circle", -35.0, {"advance": 4.5, "tactical_diameter": 5.0}),
        (
            "zigzag",
            10.0,
            {"track_to_reversal": 2.5, "first_overshoot": 15.0, "second_overshoot": 32.5},
        ),
        ("zigzag", -20.0, {"first_overshoot": 25.0}),
        ("crash_stop", 0.0, {"track_reach": 15.0}),
        ("turning_circle", 20.0, {}),
        ("pull_out", 20.0, {}),
    ],
)
def test_limits_stand_beside_the_manoeuvres_they_are_for(
    manoeuvre: str, angle: float, wanted: dict[str, float]
) -> None:
    assert imo.imo_limits(manoeuvre, angle, 160.0, 8.0) == pytest.approx(wanted)


# Vessels

STEERED = [
    name
    for name in content.shipped_content_names("vessel")
    if "yaw" in vessel.load_vessel(name).dof
]


@pytest.mark.parametrize("name", few(STEERED, 1, 3))
def test_every_vessel_that_can_turn_does_a_short_zigzag_and_a_turning_circle(name: str) -> None:
    zigzag, turn = (
        manoeuvre_scenario("zigzag", name, angle=10.0),
        manoeuvre_scenario("turning_circle", name),
    )
    boat, unit = zigzag.vessel, zigzag.vessel.length / zigzag.file.start.u
    seen = run(
        replace(zigzag, file=zigzag.file.model_copy(update={"duration": 12.0 * unit}))
    ).recording
    begun = seen.t > turn.controller.execute + unit  # type: ignore[attr-defined]
    assert set(np.sign(seen["reference_helm_rad"][begun])) == {1.0, -1.0}
    assert degrees(seen["psi_rad"].max()) > 10.0
    assert (
        seen["psi_rad"][np.argmax(seen["reference_helm_rad"] > 0.0) :][3] > -1e-4
    )  # a positive angle is to starboard
    for command, channel in boat.commands.items():
        assert channel.low <= seen[command].min() and seen[command].max() <= channel.high
    made = run(replace(turn, file=turn.file.model_copy(update={"duration": 100.0 * unit})))
    found = {k: norm.value for k, norm in requested_metrics(made).items()}
    assert made.recording["psi_rad"][-1] > pi
    # [L] the jet ski goes eight lengths a second; the supply vessel's damping is that of low speed
    widest = {"jet_ski": 25.0, "osv": 15.0}.get(name, 10.0)
    assert 0.1 < found["tactical_diameter"] < widest and 0.5 < found["advance"] < widest  # type: ignore[operator]
    assert found["steady_drift"] > 0.0 or name == "catamaran"  # type: ignore[operator]  # whose thruster is at the bow


@pytest.mark.parametrize("manoeuvre", ["turning_circle", "zigzag"])
def test_a_symmetric_boat_does_the_same_to_both_sides(manoeuvre: str) -> None:
    one, other = (
        {
            k: n.value
            for k, n in requested_metrics(
                run(manoeuvre_scenario(manoeuvre, "trial_boat", angle=angle))
            ).items()
        }
        for angle in (20.0, -20.0)
    )
    assert one == pytest.approx(other, rel=1e-6)
    assert None not in one.values()


@pytest.mark.slow
def test_helm_is_reversed_at_the_heading_and_not_at_the_end_of_a_step() -> None:
    """Within 0.2 % of what steps a twentieth as long give; the row of a reversal is the instant of
    it."""
    found = []
    for share in (1.0, 0.05):
        made = manoeuvre_scenario("zigzag", "kvlcc2_mmg", angle=15.0)
        made = replace(made, file=made.file.model_copy(update={"step": share * made.file.step}))
        made.controller.period, made.controller.reversals = made.file.step, 2  # type: ignore[attr-defined]
        done = run(made)
        found.append({k: n.value for k, n in requested_metrics(done).items()}["first_overshoot"])
        helm, psi = done.recording["reference_helm_rad"], done.recording["psi_rad"]
        turned = np.flatnonzero(np.sign(helm[1:]) * np.sign(helm[:-1]) < 0.0) + 1
        assert np.abs(psi[turned]) == pytest.approx(radians(15.0), abs=1e-6)
    assert found[0] == pytest.approx(found[1], rel=2e-4)


@pytest.mark.parametrize("angle", [20.0, -20.0])
def test_a_20_10_zigzag_puts_20_degrees_of_helm_on_and_reverses_at_10(angle: float) -> None:
    made = manoeuvre_scenario("zigzag", "mariner", angle=angle, heading=10.0)
    assert not made.file.norms  # the limits are those of 10/10 and 20/20
    done = run(made)
    helm, psi = done.recording["reference_helm_rad"], done.recording["psi_rad"]
    turned = np.flatnonzero(np.sign(helm[1:]) * np.sign(helm[:-1]) < 0.0) + 1
    assert np.abs(helm).max() == pytest.approx(radians(20.0))
    assert np.degrees(psi[turned]) == pytest.approx(
        np.sign(angle) * np.resize([10.0, -10.0], len(turned)), abs=1e-4
    )


def test_roll_decay_of_a_vessel_shows_its_damping() -> None:
    """kvlcc2_roll is linear: inertia 135.4 kg m^2, damping 6.7 N m s, stiffness 822.3 N m."""
    found = {
        k: n.value
        for k, n in requested_metrics(run(manoeuvre_scenario("roll_decay", "kvlcc2_roll"))).items()
    }
    zeta = 6.7 / (2.0 * sqrt(822.3 * 135.4))
    assert found["damping_mean"] == pytest.approx(zeta, rel=1e-3)
    assert found["period"] == pytest.approx(2 * pi / sqrt(822.3 / 135.4 * (1 - zeta**2)), rel=1e-4)


def test_a_hull_that_also_turns_is_heeled_before_it_is_released() -> None:
    """Eastward Ho's roll is linear: 2 pi / sqrt(m g GM / I) = 7.14 s; sway and yaw add a little."""
    made = manoeuvre_scenario("roll_decay", "eastward_ho", angle=5.0)
    assert made.file.duration == pytest.approx(12 * 7.14, rel=0.02)
    assert requested_metrics(run(made))["period"].value == pytest.approx(7.14, rel=0.005)


def test_a_tunnel_across_the_bow_drives_no_boat_ahead(tmp_path: Path) -> None:
    bow = '[[effect]]\nuse = "thruster"\nname = "bow"\non = { thrust = "bow_N", angle = 1.5708 }\nx = 0.4\n'
    text = (
        boats.PLANAR.replace("[channels]\n", "[channels]\nbow_N = { low = -8.0, high = 8.0 }\n")
        + bow
    )
    table = complete_manoeuvring_table(
        vessel.load_vessel(str(boats.written(tmp_path, "test_boat", text) / "vessel.toml"))
    )
    assert set(table.ahead) == set(table.astern) == {"thrust_port_N", "thrust_starboard_N"}


def test_a_boat_without_a_table_is_handled_by_its_channels() -> None:
    table = complete_manoeuvring_table(vessel.load_vessel("trial_boat"))
    assert table.ahead == {"thrust_port_N": 0.5, "thrust_starboard_N": 0.5}
    assert table.astern == {"thrust_port_N": -0.5, "thrust_starboard_N": -0.5}
    assert table.steer == {
        "steer_port_rad": -1.0,
        "steer_starboard_rad": -1.0,
    }  # to port, so that the bow swings right


# Approach


@pytest.mark.slow
def test_a_ship_with_a_bias_begins_her_turning_circle_without_a_yaw_rate() -> None:
    """The Mariner's propeller turns her; 1.1 deg of port helm hold her course."""
    found = []
    for lengths in (2.0, 10.0):
        made = manoeuvre_scenario("turning_circle", "mariner", angle=-15.0)
        begin = made.file.step * round(lengths * 160.93 / 7.7175 / made.file.step)
        made.controller.execute = begin  # type: ignore[attr-defined]
        done = run(replace(made, measure=TurningCircle(execute=begin, length=160.93)))
        before = done.recording.between(0.0, begin - 1.0)
        assert np.abs(np.degrees(before["r_radps"])).max() < 1e-5  # the turn has 0.53 deg/s
        assert np.ptp(before["u_mps"]) < 1e-5
        summary = approach_summary(made, done.recording)
        assert "yaw rate 0.0000 deg/s, speed 7.716 m/s; helm of the approach -1.11" in summary
        found.append(requested_metrics(done)["advance"].value)
    assert found[0] == pytest.approx(found[1], rel=1e-3)


@pytest.mark.parametrize("manoeuvre", ["zigzag", "pull_out", "spiral"])
def test_manoeuvres_share_the_trimmed_approach(manoeuvre: str) -> None:
    controller = manoeuvre_scenario(manoeuvre, "mariner").controller
    assert degrees(controller.trim) == pytest.approx(-1.108, abs=1e-3)  # type: ignore[attr-defined]
    assert controller.initial_commands() == {"delta_rad": controller.trim}  # type: ignore[attr-defined]


def pushed_otter(**push: float) -> vessel.Vessel:
    """The Otter with a steady force, such as that of a towed load."""
    boat = vessel.load_vessel("otter").with_effect({"use": "push", **push})
    return replace(boat, manoeuvring=complete_manoeuvring_table(boat))


@pytest.mark.slow
def test_a_steady_course_is_where_a_simulation_with_its_helm_stays() -> None:
    boat = pushed_otter(roll=20.0, yaw=3.0, sway=5.0)
    found = steady_approach(boat)
    state = found.state
    begin = [0.0, 0.0, state["z"], state["phi"], state["theta"], 0.0, *map(state.get, "uvwpqr")]
    table = boat.manoeuvring
    batch = Batch(boat, step=0.01)
    commands = batch.program.command_array({**table.ahead, **steering_commands(table, found.helm)})
    after = batch.rollout(begin, np.tile(commands, (2000, 1)), 0.01)[-1]
    assert abs(state["phi"]) > 0.01 and abs(state["v"]) > 0.01 and abs(found.helm) > 0.01
    assert after[2:] == pytest.approx(begin[2:], abs=1e-6)


def test_a_speed_that_is_given_is_kept_and_a_helm_that_is_too_weak_stays_midships() -> None:
    assert steady_approach(pushed_otter(yaw=3.0), 1.0).state["u"] == pytest.approx(1.0, abs=1e-3)
    weak = steady_approach(pushed_otter(yaw=500.0))
    assert weak.helm == 0.0 and list(weak.state) == ["u"]


@pytest.mark.slow
def test_waves_do_not_change_the_helm_of_the_approach() -> None:
    waves = {"use": "irregular_sea", "significant_height": 0.2, "modal_period": 3.0, "toward": 1.0}
    boat = vessel.load_vessel("otter").with_effect(waves)
    found = steady_approach(replace(boat, manoeuvring=complete_manoeuvring_table(boat)))
    assert found.helm == pytest.approx(0.0, abs=1e-9)


# Mistakes


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (
            ("zigzig", "--vessel", "mariner"),
            "manoeuvre 'zigzig' does not exist; did you mean 'zigzag'",
        ),
        (
            ("zigzag", "--vessel", "marinor"),
            "vessel 'marinor' does not exist; did you mean 'mariner'",
        ),
        (("zigzag", "--vessel", "kvlcc2_roll"), "kvlcc2_roll is not free to turn"),
        (
            ("roll_decay", "--vessel", "mariner"),
            "mariner does not roll; its degrees of freedom are surge, sway, yaw",
        ),
        (
            ("crash_stop", "--vessel", "kvlcc2"),
            "kvlcc2: no thrust astern; specify it by [manoeuvring] astern = ",
        ),
        (
            ("zigzag", "--vessel", "mariner", "--angle", "50"),
            "means delta_rad = 0.872665; allowed -0.6981 to 0.6981",
        ),
        (
            ("zigzag", "--vessel", "mariner", "--angle", "0"),
            "angle = 0 deg; a zigzag needs another",
        ),
        (("zigzag", "--vessel", "mariner", "--angle", "nan"), "mariner: nan deg of helm means"),
        (
            ("turning_circle", "--vessel", "mariner", "--heading", "10"),
            "heading = 10 deg; only a zigzag reverses",
        ),
        (
            ("zigzag", "--vessel", "mariner", "--heading", "-10"),
            "heading = -10 deg; allowed 0.1 to 170 deg",
        ),
        (
            ("zigzag", "--vessel", "mariner", "--heading", "nan"),
            "heading = nan deg; allowed 0.1 to 170 deg",
        ),
        (
            ("zigzag", "--vessel", "mariner", "--speed", "inf"),
            "speed = inf m/s; allowed is more than 0 m/s",
        ),
        (("zigzag", "--vessel", "mariner", "--load", "light"), "load 'light' does not exist"),
    ],
)
def test_a_mistake_is_one_line_and_leaves_nothing(
    arguments: tuple[str, ...], message: str, tmp_path: Path
) -> None:
    result = CliRunner().invoke(
        app, ["manoeuvre", *arguments, "--out", str(tmp_path / "out")], catch_exceptions=False
    )
    assert result.exit_code == 2
    assert message in result.stderr and len(result.stderr.strip().splitlines()) == 1
    assert not list(tmp_path.iterdir())
