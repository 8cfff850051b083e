"""The catamaran of Huang and Ji: its tables and trials, its effects in closed form, recordings that
differ from it."""

from dataclasses import replace
from functools import cache
from math import cos, pi, sin, sqrt
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from alike import long
from real_catamaran import Real, navigation, recording

from boatsim.cli import diagnosis as commands
from boatsim.control.base import Sense
from boatsim.diagnosis import pipeline
from boatsim.diagnosis.checks.position_frame import (
    drop_rotated_positions,
    position_rotation_fraction,
)
from boatsim.errors import BadInput
from boatsim.metrics.arrival import Arrival
from boatsim.metrics.speed_reached import SpeedReached
from boatsim.metrics.turning_radius import TurningRadius
from boatsim.physics import vessel
from boatsim.physics.base import Array, Wrench, make_motion
from boatsim.physics.content import load_class, shipped_content_names
from boatsim.physics.effects.added_mass import AddedMassError
from boatsim.physics.effects.damping import DampingExponent
from boatsim.physics.effects.extra_mass import Payload
from boatsim.physics.effects.push import Gust, GustOffCentre
from boatsim.physics.effects.speed_hold import SpeedHold
from boatsim.physics.effects.thruster import Thruster
from boatsim.recordings import table as recordings
from boatsim.recordings.table import Recording
from boatsim.simulate import scenario
from boatsim.simulate.batch import Batch
from boatsim.simulate.engine import Engine, State
from boatsim.simulate.evaluation import requested_metrics
from boatsim.simulate.run import Run, run
from boatsim.simulate.run_files import run_into_folder

SHIPPED = [name for name in shipped_content_names("scenario") if name.startswith("catamaran/")]
TABLE_III = {
    0: (2.4, 2.7),
    45: (2.6, 2.8),
    90: (3.0, 3.0),
    135: (4.1, 3.1),
    180: (5.1, 3.2),
}  # s, m
STEADY = {
    5: 0.199,
    10: 0.223,
    20: 0.263,
    40: 0.289,
    60: 0.265,
    80: 0.228,
}  # N -> m, steady circle at full azimuth
TRIALS = {  # bearing of the disturbance [rad], its steady part [N]; T IV
    1: (pi / 4, 10.0), 3: (pi / 4, 30.0), 5: (pi / 2, 20.0), 6: (pi / 2, 30.0), 7: (3 * pi / 4, 10.0),
}  # fmt: skip


@cache
def sailed(name: str) -> Run:
    return run(scenario.load(f"catamaran/{name}"))


def values(name: str) -> dict[str, float | None]:
    return {n: norm.value for n, norm in requested_metrics(sailed(name)).items()}


# Published numbers


def test_particulars_are_those_of_table_1_with_a_mean_submerged_depth_of_45_mm() -> None:
    boat, L, W, m, D = vessel.load_vessel("catamaran"), 1.0, 0.55, 7.0, 0.045
    assert boat.body.yaw_inertia == pytest.approx(m * (W**2 + L**2) / 12, rel=1e-4)
    water: Any = boat.effect("added_mass")
    assert water.surge == pytest.approx(0.05 * m)
    assert water.sway == pytest.approx(1000 * pi * D**2 * L / 2, rel=1e-4)
    assert water.yaw == pytest.approx((0.1 * m * W**2 + 1000 * pi * D**2 * L**3) / 24, rel=1e-4)


def test_table_3_is_met_to_its_last_digit_in_all_ten_cells() -> None:
    found = {a: values(f"speed_{a}") for a in TABLE_III}
    assert {
        a: (round(f["time"] or 0, 1), round(f["distance"] or 0, 1)) for a, f in found.items()
    } == TABLE_III


def test_table_3_needs_the_criterion_of_99_percent() -> None:
    """1.400 m/s, the printed figure, is 98 % of F/d1: straight ahead it is crossed at 2.05 s, not at 2.4 s."""
    reached = SpeedReached(speed=1.4).values(sailed("speed_0").recording)
    assert reached["time"] == pytest.approx(2.05, abs=0.01)


@pytest.mark.slow
@pytest.mark.long
def test_the_published_kinematics_let_the_boat_arrive_where_the_right_ones_do_not() -> None:
    assert (
        values("disturbance_6")["time"] is None
        and values("disturbance_6_replay")["time"] is not None
    )
    assert (
        values("disturbance_8")["time"] is None
        and values("disturbance_8_replay")["time"] is not None
    )
    assert (
        values("disturbance_9")["time"] is None and values("disturbance_9_replay")["time"] is None
    )


@pytest.mark.parametrize(("trial", "arrives"), [(6, 12.6), (8, 43.0), (9, None)])
def test_a_disturbance_fixed_to_the_hull_gives_the_published_outcomes_too(
    trial: int, arrives: float | None
) -> None:
    told = scenario.load(f"catamaran/disturbance_{trial}").file.set["gust"]
    hull = {"set": {"gust": told | {"turns_with_hull": 1.0}}, "duration": 60.0}
    found = requested_metrics(run(scenario.load(f"catamaran/disturbance_{trial}", hull)))[
        "time"
    ].value
    assert found == (None if arrives is None else pytest.approx(arrives, rel=0.02))


@pytest.mark.parametrize("thrust", STEADY)
def test_steady_circle_at_full_azimuth(thrust: int) -> None:
    u, v, r = Batch(vessel.load_vessel("catamaran"), step=0.01).hold_commands(
        [0.0] * 6, held(thrust), 6000
    )[3:]
    assert sqrt(u * u + v * v) / r == pytest.approx(STEADY[thrust], abs=5e-4)


def test_a_weak_thrust_turns_in_a_circle_of_damping_alone() -> None:
    u, v, r = Batch(vessel.load_vessel("catamaran"), step=0.01).hold_commands(
        [0.0] * 6, held(0.01), 6000
    )[3:]
    b = 0.47 * pi
    limit = sqrt((cos(b) / 14) ** 2 + (sin(b) / 80) ** 2) / (0.4 * sin(b) / 5)
    assert sqrt(u * u + v * v) / r == pytest.approx(limit, rel=1e-3)
    assert limit == pytest.approx(0.18, abs=0.005)


def held(thrust: float) -> dict[str, float]:
    return {"thrust_N": float(thrust), "azimuth_rad": 0.47 * pi}


# The boat against its printed equations


def track(name: str) -> Array:
    log = sailed(name).recording
    return np.column_stack(
        [log.t, *(log[n] for n in ("x_m", "y_m", "psi_rad", "u_mps", "v_mps", "r_radps"))]
    )


@pytest.mark.parametrize("trial", [1, 5])
def test_engine_and_controller_follow_the_printed_equations(trial: int) -> None:
    toward, steady = TRIALS[trial]
    real = Real(gust=(steady, 5.0, toward))
    ours = track(f"disturbance_{trial}")
    assert ours == pytest.approx(
        real.run(navigation(20.0, 0.0), ours[-1, 0], held=0.01)[:, :7], abs=1e-6
    )
    at_every_stage = real.run(navigation(20.0, 0.0), ours[-1, 0])
    arrived = at_every_stage[
        np.argmax(np.hypot(20 - at_every_stage[:, 1], at_every_stage[:, 2]) <= 2.5), 0
    ]
    assert values(f"disturbance_{trial}")["time"] == pytest.approx(arrived, abs=0.02)


def test_replayed_positions_are_those_of_the_printed_equation_1() -> None:
    toward, steady = TRIALS[5]
    log = sailed("disturbance_5_replay").recording
    rows = Real(gust=(steady, 5.0, toward), replay=True).run(
        navigation(20.0, 0.0), log.t[-1], held=0.01
    )
    assert log["estimate_x_m"] == pytest.approx(rows[:, 1], abs=1e-3)
    assert log["estimate_y_m"] == pytest.approx(rows[:, 2], abs=1e-3)


def test_left_and_right_are_mirror_images() -> None:
    def one(side: float) -> Array:
        told = {
            "goal": [{"x_m": 15.0, "y_m": side * 8.0}],
            "set": {"gust": {"mean": 20.0, "amplitude": 5.0, "toward": side * 1.9}},
        }
        log = run(scenario.load("catamaran/disturbance_5", told)).recording
        return np.column_stack([log["x_m"], side * log["y_m"], side * log["psi_rad"]])

    assert one(1.0) == pytest.approx(one(-1.0), abs=1e-6)


def test_without_thrust_and_disturbance_the_energy_only_falls() -> None:
    engine = Engine(vessel.load_vessel("catamaran"), step=0.01)
    engine.reset(State(psi=0.3, u=1.2, v=-0.4, r=1.5))
    mass, energy = np.array([7.35, 7.0 + 3.1809, 0.75979 + 0.27389]), []
    for _ in range(500):
        s = engine.state
        energy.append(0.5 * float(mass @ np.square([s.u, s.v, s.r])))
        engine.advance()
    assert np.all(np.diff(energy) < 0.0) and energy[-1] < 1e-3 * energy[0]


@pytest.mark.slow
def test_boat_replays_a_recording_of_its_own(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """The disturbance goes with the recording, in its notes."""
    run_into_folder(tmp_path / "run", scenario.load("catamaran/disturbance_5"))
    assert commands.compare(tmp_path / "run" / "recording.csv", None, [], None, tmp_path) == 0
    errors = {
        line.split()[0]: float(line.split()[1])
        for line in capsys.readouterr().out.splitlines()[1:-1]
    }
    assert errors.keys() == {"x_m", "y_m", "psi_rad"} and max(errors.values()) < 1e-6


# Navigation


def sense(x: float, y: float, psi: float = 0.0, t: float = 0.0) -> Sense:
    return Sense(t, psi, 0.0, 0.0, 0.0, 0.0, 0.0, x, y)


def waypoint(**settings: Any) -> Any:
    return load_class("controller", "waypoint").from_settings(settings)


@pytest.mark.parametrize(
    ("x", "y", "psi", "thrust", "azimuth"),
    [
        (2.0, 1.0, 0.0, 0.0, 0.0),  # inside the circle
        (20.0, 0.0, 0.5, 20.0, -0.47 * pi * 0.5 / (pi / 2)),  # full thrust, steering in proportion
        (-20.0, 5.0, 0.0, 10.0, 0.47 * pi),  # far astern: half thrust, all the way round
        (-6.0, -1.0, 0.0, 20.0 / 3 * sqrt(37) / 10, -0.47 * pi),  # near: less the nearer
        (20.0, 0.0, 2 * pi + 0.5, 20.0, -0.47 * pi * 0.5 / (pi / 2)),  # headings beyond a turn
    ],
)
def test_navigation_is_appendix_b(
    x: float, y: float, psi: float, thrust: float, azimuth: float
) -> None:
    found = waypoint().step(sense(0.0, 0.0, psi), {"x_m": x, "y_m": y})
    assert found == pytest.approx({"thrust_N": thrust, "azimuth_rad": azimuth}, abs=1e-12)


def test_several_points_are_visited_in_their_order_and_each_is_waited_for() -> None:
    told = {
        "goal": [{"x_m": 8.0, "y_m": 0.0}, {"from": 1.0, "x_m": 8.0, "y_m": 8.0}],
        "duration": 14.0,
    }
    log = run(scenario.load("catamaran/heading_0", told)).recording
    first, second = (np.hypot(log["x_m"] - 8.0, log["y_m"] - y) <= 2.5 for y in (0.0, 8.0))
    assert first.any() and second.any() and np.argmax(first) < np.argmax(second)
    assert not log["thrust_N"][np.argmax(second) + 1]


def test_no_goal_means_no_thrust() -> None:
    assert waypoint().step(sense(0.0, 0.0), {}) == {"thrust_N": 0.0, "azimuth_rad": 0.0}


# Measures


def straight(u: float, seconds: float = 10.0) -> Recording:
    t: Array = np.linspace(0.0, seconds, 101)
    still = np.zeros_like(t)
    signals = {
        "x_m": u * t,
        "y_m": still,
        "u_mps": np.full_like(t, u),
        "v_mps": still,
        "thrust_N": still,
    }
    return Recording("straight", t, signals | {"r_radps": still})


def test_arrival_on_a_straight_line() -> None:
    found = Arrival(x=7.0, radius=2.0).values(straight(1.0))
    assert found == pytest.approx(
        {
            "time": 5.0,
            "distance": 5.0,
            "straight_line": 5.0,
            "closest": 0.0,
            "end_x": 10.0,
            "end_y": 0.0,
        }
    )
    missed = Arrival(x=7.0, y=3.0, radius=2.0).values(straight(1.0))
    assert missed == pytest.approx({"closest": 3.0, "end_x": 10.0, "end_y": 0.0})


def test_speed_reached_in_closed_form() -> None:
    """u = U (1 - e^-at) crosses 99 % of U after ln(100)/a, having gone U (t - 0.99/a)."""
    log = sailed("speed_0").recording
    a, top = 14.0 / 7.35, 20.0 / 14.0
    found = SpeedReached(speed=0.99 * top).values(log)
    time = np.log(100.0) / a
    assert found["time"] == pytest.approx(time, abs=1e-4)
    assert found["distance"] == pytest.approx(top * (time - 0.99 / a), abs=1e-4)
    assert "time" not in SpeedReached(speed=2.0).values(log)


def test_turning_radius_of_a_circle() -> None:
    t: Array = np.linspace(0.0, 10.0, 1001)
    on = (t < 8.0).astype(float)
    signals = {
        "x_m": 2 * np.sin(t),
        "y_m": 2 - 2 * np.cos(t),
        "u_mps": np.full_like(t, 2.0),
        "v_mps": 0 * t,
    }
    found = TurningRadius().values(
        Recording("circle", t, signals | {"r_radps": np.ones_like(t), "thrust_N": on})
    )
    assert found == pytest.approx({"radius": 2.0, "half_width": 2.0, "time": 8.0}, abs=0.02)
    assert TurningRadius().values(straight(1.0)) == {}


# Effects in closed form


def test_a_thruster_is_a_force_on_a_lever() -> None:
    ahead, astern = (
        Thruster(x=x).wrench(make_motion(), thrust=20.0, angle=0.3) for x in (0.4, -0.4)
    )
    assert ahead == pytest.approx(Wrench(X=20 * cos(0.3), Y=20 * sin(0.3), N=8 * sin(0.3)))
    assert astern == pytest.approx(ahead._replace(N=-ahead.N))


def test_gust_is_a_sine_in_one_direction_of_the_world() -> None:
    gust = Gust(mean=10.0, amplitude=5.0, frequency=0.4 * pi, toward=2.0, arm=0.1)
    m = make_motion(t=1.0, psi=0.7)
    force = 10 + 5 * sin(0.4 * pi)
    X, Y = force * cos(2.0 - 0.7), force * sin(2.0 - 0.7)
    assert gust.wrench(m) == pytest.approx(Wrench(X=X, Y=Y, N=0.1 * Y))
    Y = force * sin(2.0)
    assert replace(gust, turns_with_hull=1.0).wrench(m) == pytest.approx(
        Wrench(X=force * cos(2.0), Y=Y, N=0.1 * Y)
    )


def test_gust_off_centre_is_what_a_lever_adds_to_the_vessels_own_gust() -> None:
    told = {"mean": 10.0, "amplitude": 5.0, "toward": 2.0}
    boat, m = vessel.load_vessel("catamaran", settings={"gust": told}), make_motion(t=1.0, psi=0.7)
    own: Any = boat.effect("gust")
    off: Any = boat.with_completed_effect(GustOffCentre(arm=0.1)).effect("gust")
    Y = own.wrench(m).Y
    assert off.wrench(m) == pytest.approx(own.wrench(m)._replace(N=own.wrench(m).N + 0.1 * Y))


def test_speed_hold_keeps_the_speed_whatever_the_turn() -> None:
    held = SpeedHold(speed=2.0, gain=100.0, mass=7.0)
    assert held.wrench(make_motion(u=2.0, v=0.5, r=0.3)).X == pytest.approx(
        -7.0 * 0.5 * 0.3
    )  # m(u' - v r) = X: u' = 0
    assert held.wrench(make_motion(u=2.1)).X == pytest.approx(-10.0)
    assert SpeedHold().with_all_parameters(vessel.load_vessel("catamaran")).mass == 7.0


def test_payload_and_deeper_draught_make_the_heavier_boat() -> None:
    boat = vessel.load_vessel("catamaran")
    more = boat.with_completed_effect(Payload(mass=2.0))
    assert more.body.mass == 9.0
    assert more.body.yaw_inertia - boat.body.yaw_inertia == pytest.approx(
        2.0 * (0.55**2 + 1.0) / 12, rel=1e-4
    )
    own: Any = boat.effect("added_mass")
    error = AddedMassError(surge_factor=1.3, sway_factor=1.5, yaw_factor=0.8)
    off: Any = boat.with_completed_effect(error).effect("added_mass")
    assert (off.surge, off.sway, off.yaw) == pytest.approx(
        (1.3 * own.surge, 1.5 * own.sway, 0.8 * own.yaw)
    )
    with pytest.raises(BadInput, match="body.mass = -1"):
        boat.with_completed_effect(Payload(mass=-8.0))


def test_damping_exponent_makes_a_power_law_of_the_vessels_linear_damping() -> None:
    boat, m = vessel.load_vessel("catamaran"), make_motion(u=0.5, v=-0.2, r=0.4)
    release = DampingExponent(
        surge_exponent=1.5, sway_exponent=2.0, sway_equal=0.5, yaw_exponent=3.0
    )
    power: Any = boat.with_completed_effect(release).effect("linear_damping")
    assert power.wrench(m) == pytest.approx(
        Wrench(X=-14 * 0.5**1.5, Y=80 * 0.2**2 / 0.5, N=-5 * 0.4**3)
    )
    assert power.wrench(make_motion()) == Wrench()


# What was left out: recordings of boats that differ from the catamaran


def recorded(folder: Path, trials: list[int], seconds: float = 12.0, **real: Any) -> list[Path]:
    """Trials of T IV sailed by a real boat; negative ones are their mirror images, 0 is a turn in
    still water."""
    notes, paths = ['vessel = "catamaran"'], []
    for n in trials:
        toward, steady = TRIALS[abs(n)] if n else (0.0, 0.0)
        gust = (steady, 5.0 if n else 0.0, -toward if n < 0 else toward)
        goal = (20.0, 0.0) if n else (0.0, 20.0)
        rows = Real(gust=gust, **real).run(navigation(*goal), seconds, held=0.05)
        name = f"D{n}".replace("-", "m")
        paths.append(folder / f"{name}.csv")
        recordings.write_csv(recording(name, rows, seed=abs(n)), paths[-1])
        notes += [
            f"[runs.{name}.set.gust]",
            f"mean = {gust[0]}",
            f"amplitude = {gust[1]}",
            f"toward = {gust[2]}",
        ]
    (folder / "recording.toml").write_text("\n".join(notes))
    return paths


def answer_to(paths: list[Path]) -> dict[str, Any]:
    return pipeline.diagnose(paths).findings.answer


def named(answer: dict[str, Any]) -> dict[str, dict[str, Any]]:
    return {
        e["name"]: {k: p["value"] for k, p in e["parameters"].items()} for e in answer["effects"]
    }


@pytest.mark.slow
def test_the_boat_of_the_paper_lacks_nothing(tmp_path: Path) -> None:
    answer = answer_to(recorded(tmp_path, [1, 3, 5]))
    assert answer["verdict"] == "nothing_missing" and not answer["effects"]


@pytest.mark.slow
def test_case_1_turned_positions_are_found_before_forces_are_blamed(tmp_path: Path) -> None:
    found = pipeline.diagnose(recorded(tmp_path, [3, 5, -5], replay=True))
    assert (
        found.findings.answer["verdict"] == "nothing_missing"
        and not found.findings.answer["effects"]
    )
    assert len(found.remarks) == 3
    for line in found.remarks:
        assert (
            "contradict each other in proportion to yaw rate and distance from the origin" in line
        )


@pytest.mark.parametrize("trial", TRIALS)
def test_honest_positions_stay(trial: int) -> None:
    toward, steady = TRIALS[trial]
    rows = Real(gust=(steady, 5.0, toward)).run(navigation(20.0, 0.0), 12.0, held=0.05)
    honest = recording("honest", rows, seed=trial)
    assert (
        drop_rotated_positions(honest) is honest
        and abs(position_rotation_fraction(honest)[0]) < 0.05
    )
    # a fast velocity log, an antenna off the mass centre, a turned compass and a current are other
    # errors than this
    x, y, psi, u = (honest[n] for n in ("x_m", "y_m", "psi_rad", "u_mps"))
    wrong = {
        "x_m": x + 0.3 * np.cos(psi) + 0.1 * honest.t,
        "y_m": y + 0.3 * np.sin(psi),
        "u_mps": 1.1 * u,
        "psi_rad": psi + 0.1,
    }
    other = replace(honest, signals=honest.signals | wrong)
    assert drop_rotated_positions(other) is other


@pytest.mark.slow
@pytest.mark.parametrize(
    ("trials", "lever"), [long([3, 5, -5, 7], 0.05), long([3, 5, -5, 7], 0.15), ([1], 0.05)]
)
def test_case_2_a_disturbance_off_the_mass_centre_is_named_with_its_lever(
    tmp_path: Path, trials: list[int], lever: float
) -> None:
    """A single trial is enough where position, heading and all velocities are recorded.

    The real lever is a fifth longer in a gust from ahead or astern; on several headings that shows
    as a force besides.
    """
    answer = answer_to(recorded(tmp_path, trials, lever=lever))
    assert answer["unknown"]["flag"] == (len(trials) > 1)
    assert named(answer) == {"gust_off_centre": {"arm_m": pytest.approx(lever, rel=0.2)}}


@pytest.mark.slow
@pytest.mark.long
def test_case_3_a_heavier_boat_is_named_with_its_deeper_draught(tmp_path: Path) -> None:
    """9 kg instead of 7: D grows from 45 to 52 mm, which raises the added mass in sway and yaw by a
    third."""
    answer = answer_to(recorded(tmp_path, [0, 3, 5], mass=9.0, depth=0.0521))
    found = named(answer)
    assert answer["verdict"] == "named" and found.keys() == {"payload", "added_mass_error"}
    assert found["payload"]["mass_kg"] == pytest.approx(2.0, rel=0.15)
    assert found["payload"]["force_per_mass"] == pytest.approx(7.0 / 9.0, rel=0.05)
    assert found["added_mass_error"]["sway_factor"] == pytest.approx(0.0521**2 / 0.045**2, rel=0.1)


@pytest.mark.slow
@pytest.mark.long
@pytest.mark.parametrize(
    ("trials", "coefficient"), [([1], 80.0), long([3, 5, 6], 80.0), ([3, 5, 6], 400.0)]
)
def test_case_4_quadratic_sway_damping_in_place_of_linear_is_named(
    tmp_path: Path, trials: list[int], coefficient: float
) -> None:
    """Both laws agree at 1 m/s, or at 0.2 m/s, which is less than the sway of trials 3 to 6."""
    answer = answer_to(recorded(tmp_path, trials, sway=(coefficient, 2.0)))
    found = named(answer)
    assert answer["verdict"] == "named" and found.keys() == {"damping_exponent"}
    assert found["damping_exponent"]["sway_exponent"] == pytest.approx(2.0, abs=0.1)
    assert found["damping_exponent"]["sway_equal_mps"] == pytest.approx(80.0 / coefficient, rel=0.1)
