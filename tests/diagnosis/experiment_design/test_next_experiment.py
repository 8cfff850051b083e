"""The next experiment: what it must do for causes that are confusable by nature, and that its file
runs."""

from dataclasses import replace
from functools import cache
from pathlib import Path
from types import SimpleNamespace
from typing import cast

import numpy as np
import pytest
from alike import few
from boats import PLANAR, ROLL, box_in_measured_wave, written
from scipy.linalg import expm

from boatsim.cli import diagnosis as commands
from boatsim.diagnosis.candidates import candidate_library, instantiate_neutral_effect
from boatsim.diagnosis.command_range import manoeuvre_commands
from boatsim.diagnosis.config import DEFAULT
from boatsim.diagnosis.experiment_design import manoeuvres, next_experiment
from boatsim.diagnosis.experiment_design.manoeuvres import Manoeuvre, available_manoeuvres
from boatsim.diagnosis.experiment_design.simulated_manoeuvre import simulate_manoeuvre
from boatsim.diagnosis.filter import NoiseLevels
from boatsim.diagnosis.fit import converge, fit, gauss_newton
from boatsim.diagnosis.prior_noise import prior_noise_levels
from boatsim.diagnosis.problem import Fit, Problem
from boatsim.diagnosis.recording_mapping import map_recording
from boatsim.diagnosis.search.pruning import IdentifiedEffect
from boatsim.diagnosis.search.ranking import Ranking
from boatsim.diagnosis.search.screening import screen
from boatsim.physics import vessel
from boatsim.physics.base import Array
from boatsim.physics.content import load_class
from boatsim.physics.kernel.records import VesselNumbers
from boatsim.physics.program import Program
from boatsim.recordings.table import Recording, write_csv
from boatsim.simulate import scenario
from boatsim.simulate.run import run

RATE = 6.0  # [1/s] rows of a recording
STRAIGHT = ((10.0, 0.5, 0.5, 0.0, 0.0), (10.0, -0.5, -0.5, 0.0, 0.0)) * 2
ONE_LEVEL = ((20.0, 0.5, 0.5, 0.6, 0.6), (20.0, 0.5, 0.5, -0.6, -0.6))
CRAB = ((10.0, 0.5, -0.5, 0.5, -0.5), (10.0, -0.5, 0.5, 0.5, -0.5)) * 2
TURNS = ((1, 0.4), (-1, -0.4), (1, -0.4), (-1, 0.4))
LIVELY = tuple((2.0, 0.5 * s, 0.5 * s, angle, angle) for s, angle in TURNS) * 4
CONFUSABLE = {  # truth with its values, rival, first recording in which the two look alike
    "wind at constant heading": ("wind", {"force": 0.06, "toward": 0.6}, "current", STRAIGHT),
    "deadband at one thrust level": (
        "thrust_deadband",
        {"width": 0.06},
        "thrust_gain_error",
        ONE_LEVEL,
    ),
    "steering offset in crab": (
        "steering_offset",
        {"port": 0.03, "starboard": 0.03},
        "thrust_imbalance",
        CRAB,
    ),
}


@cache
def program() -> Program:
    boat = vessel.load_vessel("trial_boat")
    return Program(boat, candidate_library(boat).compiled_effects)


def recorded(
    name: str, settings: dict[str, float], script: tuple[manoeuvres.Step, ...]
) -> Recording:
    """The boat with one entry acting, driven through a script of (seconds, commands), seen by a
    noisy camera."""
    rng = np.random.default_rng(4)
    code, values, on = (
        program().simulation_functions,
        program().values(),
        program().effect_switches([name]),
    )
    for key, value in settings.items():
        values[program().parameter_index(name, key)] = value
    rows = np.concatenate([np.tile(step[1:], (round(step[0] * RATE), 1)) for step in script])
    memory, act = np.zeros(program().memory_size), np.zeros(program().actuator_signal_size)
    code.settle_actuators(rows[0], memory, values, on, act)
    out = np.zeros((len(rows) + 1, 6))
    code.rollout(
        VesselNumbers(program().body, values, on),
        program().vessel_state(np.zeros(6), memory),
        rows,
        0.0,
        1 / RATE / 8,
        8,
        out,
    )
    pose = out[:-1, :3] + rng.standard_normal((len(rows), 3)) * [0.003, 0.003, 0.012]
    signals = dict(zip(("x_m", "y_m", "psi_rad"), pose.T, strict=True))
    signals |= dict(zip(program().vessel.commands, rows.T, strict=True))
    return Recording("first", np.arange(len(rows)) / RATE, signals)


@cache
def tie(case: str) -> tuple[Problem, Fit, Fit]:
    """A first recording, the truth fitted to it, and its rival."""
    name, settings, rival, script = CONFUSABLE[case]
    first = recorded(name, settings, script)
    boat = program().vessel
    problem = Problem(
        [map_recording(first, program())],
        prior_noise_levels(boat, [first]),
        {"damping": 0.05, "thrust": 0.05},
    )
    nominal = gauss_newton(problem, problem.nominal_hypothesis(), 4, 0.1)
    winner, other = (converge(problem, f) for f in screen(problem, nominal, [name, rival]).values())
    return problem, winner, other


def suggested(case: str) -> next_experiment.Plan:
    problem, winner, rival = tie(case)
    plan = next_experiment.best_plan(problem, winner, {CONFUSABLE[case][2]: rival})
    assert plan is not None
    return plan


def course(problem: Problem, winner: Fit, plan: next_experiment.Plan) -> Array:
    """What a camera would see of a plan (N, 3)."""
    found = simulate_manoeuvre(
        problem, winner, Manoeuvre("", plan.times, plan.levels, plan.duration)
    )
    assert found is not None
    return np.asarray(found.recording.measured)


@pytest.mark.parametrize("case", few(CONFUSABLE, 0))
def test_suggestion_tells_more_than_the_first_manoeuvre_once_more(case):
    problem, winner, rival = tie(case)
    name, _, other, script = CONFUSABLE[case]
    times = np.cumsum([0.0, *(step[0] for step in script)])
    levels = tuple(dict(zip(program().vessel.commands, step[1:], strict=True)) for step in script)
    found = simulate_manoeuvre(
        problem, winner, Manoeuvre("again", tuple(times[:-1]), levels, times[-1])
    )
    again = next_experiment.expected_log_bayes_factors(
        problem, found.recording, winner, {other: rival}
    )[other]
    plan = suggested(case)
    assert plan.separates == (name, other)
    assert plan.expected_log_bayes_factor > max(3.0, 2.0 * again)  # 3 nats: no longer look-alikes


def test_wind_is_told_from_current_by_turning():
    problem, winner, _ = tie("wind at constant heading")
    psi = course(problem, winner, suggested("wind at constant heading"))[:, 2]
    assert (
        np.ptp(problem.recordings[0].measured[:, 2]) < 0.6
    )  # the first recording held its heading
    assert np.ptp(psi) > np.pi


def test_deadband_is_told_from_gain_by_more_than_one_thrust_level():
    plan = suggested("deadband at one thrust level")
    assert len({abs(level["thrust_port_N"]) for level in plan.levels} - {0.0}) > 2


def test_the_worst_rival_counts():
    case = "wind at constant heading"
    problem, winner, rival = tie(case)
    both = {"current": rival, "twin": winner}  # no manoeuvre tells a hypothesis from itself
    for plan in next_experiment.all_plans(problem, winner, both):
        assert (
            plan.expected_log_bayes_factor
            == min(plan.log_bayes_factors.values())
            == pytest.approx(0.0, abs=1e-6)
        )
    assert next_experiment.best_plan(problem, winner, both) is None
    assert next_experiment.best_plan(problem, winner, {}) is None


def test_expected_gain_is_the_divergence_of_the_dense_predictions_of_a_linear_model():
    """Both models written out: mean and covariance of all samples, parameters' spread included."""
    boat = vessel.load_vessel("kvlcc2_roll")
    t = 0.2 * np.arange(150)
    first = Recording("first", t, {"phi_rad": 0.1 * np.cos(2.46 * t)})
    levels = NoiseLevels(np.array([2.0]), 0.5, {"roll_sd_rad": 1e-3})
    problem = Problem(
        [map_recording(first, Program(boat))], levels, {"damping": 0.3, "restoring": 0.01}
    )
    free = problem.free_parameters(())
    assert [f.name for f in free] == ["roll", "stiffness"]
    winner, rival = (
        Fit((), free, np.array(theta), np.diag(np.square(sd)), levels, 0.0)
        for theta, sd in (([1.6, 1.0], [0.2, 0.002]), ([1.0, 1.004], [0.15, 0.002]))
    )
    found = simulate_manoeuvre(problem, winner, Manoeuvre("", duration=24.0, release_angle=0.15))
    assert found is not None
    n, h, P0 = (
        len(found.recording.times),
        0.2,
        found.recording.initial_state_prior.covariance + np.diag([1e-6, 0.0, 4.0]),
    )

    def dense(theta: Array) -> tuple[Array, Array]:
        """Mean and covariance of all samples after the first at given parameters."""
        inertia, damping, stiffness = 115.6 + 19.8, 6.7 * theta[0], 822.3 * theta[1]
        F = expm(
            h
            * np.array(
                [[0, 1, 0], [-stiffness / inertia, -damping / inertia, 1 / inertia], [0, 0, 0]]
            )
        )
        F[2, 2] = np.exp(-h / 0.5)
        block, centre, mean, big = P0, np.array([0.15, 0.0, 0.0]), np.zeros(n), np.zeros((n, n))
        for i in range(n):
            mean[i], cross = centre[0], block
            for j in range(i, n):
                big[i, j] = big[j, i] = cross[0, 0]
                cross = cross @ F.T
            block, centre = F @ block @ F.T + np.diag([0, 0, 4.0 * (1 - F[2, 2] ** 2)]), F @ centre
        return mean[1:], big[1:, 1:] + 1e-6 * np.eye(n - 1)

    def prediction(model: Fit) -> tuple[Array, Array]:
        mean, S = dense(model.theta)
        steps = np.diag([1e-4, 1e-6])
        J = np.column_stack([(dense(model.theta + d)[0] - mean) / d.max() for d in steps])
        return mean, S + J @ model.covariance @ J.T

    (m1, S1), (m2, S2) = prediction(winner), prediction(rival)
    logs = np.linalg.slogdet(S2)[1] - np.linalg.slogdet(S1)[1]
    divergence = 0.5 * (
        np.trace(np.linalg.solve(S2, S1))
        + (m1 - m2) @ np.linalg.solve(S2, m1 - m2)
        - len(m1)
        + logs
    )
    stretches = 1.0 + 24.0 / (2 * 0.5)
    wanted = (
        0.5 * stretches * np.log1p(2.0 * divergence / stretches)
    )  # ambient force of the rival refitted
    got = next_experiment.expected_log_bayes_factors(
        problem, found.recording, winner, {"rival": rival}
    )["rival"]
    assert wanted > 1.0
    assert got == pytest.approx(wanted, rel=0.05)


def test_the_question_is_about_an_effect_that_is_only_possible() -> None:
    """A report that names a suspect suggests the manoeuvre that tests this suspect."""
    _, winner, other = tie("deadband at one thrust level")
    certain = IdentifiedEffect("wind", 40.0, 40.0, 0.97, (), {"current": other})
    suspect = IdentifiedEffect("thrust_deadband", 9.0, 9.0, 0.3, (), {"thrust_gain_error": other})
    unlike = IdentifiedEffect("surge_drag", 6.0, 6.0, 0.1, (), {})
    ranking = SimpleNamespace(
        named=(certain,),
        doubtful=(unlike, suspect),
        best=winner,
        without={"surge_drag": other, "thrust_deadband": other},
    )
    assert question_of(ranking) == (winner, {"thrust_gain_error": other})
    ranking.doubtful = (unlike,)  # without a rival of its own
    assert question_of(ranking) == (winner, {next_experiment.NOTHING: other})
    ranking.doubtful = ()
    assert question_of(ranking) == (winner, {"current": other})
    ranking.named = (replace(certain, tied_with=("current",)),)
    ranking.doubtful = (suspect,)  # what the tool states is settled first
    assert question_of(ranking) == (winner, {"current": other})


def question_of(ranking: SimpleNamespace) -> tuple[Fit, dict[str, Fit]]:
    """The question of a selection that has only the parts it needs."""
    return next_experiment.undecided_hypotheses(cast(Ranking, ranking), DEFAULT)


def test_a_manoeuvre_in_which_a_rival_diverges_is_no_plan(monkeypatch):
    """Its evidence is not a number, which would void the whole answer."""
    problem, winner, rival = tie("wind at constant heading")
    compute, calls = next_experiment.expected_log_bayes_factors, []

    def first_diverges(*given):
        calls.append(given)
        return {"rival": float("nan")} if len(calls) == 1 else compute(*given)

    monkeypatch.setattr(next_experiment, "expected_log_bayes_factors", first_diverges)
    plans = next_experiment.all_plans(problem, winner, {"rival": rival})
    assert len(plans) == len(calls) - 1
    assert all(np.isfinite(plan.expected_log_bayes_factor) for plan in plans)


@pytest.mark.parametrize("case", CONFUSABLE)
def test_no_manoeuvre_is_expected_to_speak_against_the_truth(case):
    """A Kullback-Leibler divergence is never negative."""
    problem, winner, rival = tie(case)
    for plan in next_experiment.all_plans(problem, winner, {"rival": rival}):
        assert plan.expected_log_bayes_factor > -0.05, (
            plan.manoeuvre
        )  # noise and force levels of the two are taken for the same


def test_suggestion_is_the_same_every_time_and_stays_inside_walls_and_limits():
    for case in CONFUSABLE:
        problem, winner, _ = tie(case)
        plan = suggested(case)
        assert plan == suggested(case)
        for level in plan.levels:
            for name, value in level.items():
                assert (
                    program().vessel.commands[name].low
                    <= value
                    <= program().vessel.commands[name].high
                )
        reach = (
            np.abs(course(problem, winner, plan)[:, :2]).max(axis=0) + 0.5 * program().vessel.length
        )
        assert (reach <= [4.0, 3.0]).all()  # [m] walls of the trials' tank


@pytest.mark.slow
def test_scenario_plays_the_plan_on_the_nominal_and_on_the_patched_vessel(tmp_path):
    text = next_experiment.scenario_text(suggested("wind at constant heading"), program().vessel)
    address = 'vessel = "trial_boat"'
    source = program().vessel.file.read_text()
    (tmp_path / "patched.toml").write_text('based_on = "trial_boat"\n' + source)
    for name, used in (("next", address), ("on_patched", 'vessel = "patched.toml"')):
        assert address in text
        file = tmp_path / f"{name}.toml"
        file.write_text(text.replace(address, used))
        done = run(scenario.load(str(file))).recording
        plan = suggested("wind at constant heading")
        for time, level in zip(plan.times, plan.levels, strict=True):
            row = int(np.searchsorted(done.t, time + 0.05))
            for command, value in level.items():
                assert done[command][row] == pytest.approx(value)
        assert done.t[-1] == pytest.approx(plan.duration, abs=0.02)


def test_diagnose_leaves_the_scenario_beside_its_answer_and_takes_an_old_one_away(tmp_path):
    csv = tmp_path / "first.csv"
    write_csv(recorded("weak_reverse", {"astern_factor": 0.7}, LIVELY), csv)
    found = commands.analyse([csv], [], "trial_boat")
    commands.write_diagnosis(found, tmp_path / "out")
    wanted = found.findings.answer["next_experiment"]
    assert wanted["scenario"] == "next.toml" and wanted["expected_gain_nats"] > 0.0
    assert set(wanted["separates"]) <= {"nothing", *(e.name for e in program().candidates)}
    assert scenario.load(str(tmp_path / "out" / "next.toml")).vessel.name == "trial_boat"
    assert "What to record next" in (tmp_path / "out" / "report.html").read_text()
    commands.write_diagnosis(replace(found, plan=None), tmp_path / "out")
    assert not (tmp_path / "out" / "next.toml").exists()


# ---- other vessels


def test_manoeuvres_keep_commands_inside_limits_and_times_to_froude_scale():
    for name in ("trial_boat", "joystick_boat"):
        boat = vessel.load_vessel(name)
        large = replace(boat, length=4.0 * boat.length)
        for small, big in zip(
            available_manoeuvres(boat, {}, 0.0, True),
            available_manoeuvres(large, {}, 0.0, True),
            strict=True,
        ):
            assert (
                big.duration == pytest.approx(2.0 * small.duration) and big.levels == small.levels
            )
            for level in small.levels:
                for command, value in level.items():
                    assert boat.commands[command].low <= value <= boat.commands[command].high
    assert available_manoeuvres(boat, {}, 0.0, True) == available_manoeuvres(boat, {}, 0.0, True)


def test_pwm_takes_the_place_of_the_thrust_it_feeds():
    boat = vessel.load_vessel("joystick_boat")
    assert set(manoeuvre_commands(boat)) == {
        "pwm_port",
        "pwm_starboard",
        "steer_port_rad",
        "steer_starboard_rad",
    }


@pytest.mark.slow
def test_hull_without_commands_is_released_at_another_angle(tmp_path):
    boat = vessel.load_vessel(str(written(tmp_path, "test_roller", ROLL)))
    suspects = tuple(
        instantiate_neutral_effect(k).with_all_parameters(boat)
        for k in kinds("righting_arm_stiffening", "cubic_damping")
    )
    t = 0.2 * np.arange(150)
    first = Recording(
        "first", t, {"phi_rad": 0.1 * np.cos(2.0 * t)}
    )  # sqrt(stiffness 2 / inertia 0.5) = 2 rad/s
    levels = NoiseLevels(np.array([1e-3]), 1.0, {"roll_sd_rad": 1e-3})
    problem = Problem([map_recording(first, Program(boat, suspects))], levels, {})
    nominal = problem.nominal_hypothesis()
    winner, rival = (
        fit(problem, f) for f in screen(problem, nominal, [e.name for e in suspects]).values()
    )
    plan = next_experiment.best_plan(problem, winner, {"cubic_damping": rival})
    assert plan is not None and plan.start == {
        "phi": pytest.approx(0.15)
    }  # the larger angle tells more
    file = tmp_path / "next.toml"
    file.write_text(next_experiment.scenario_text(plan, boat))
    done = run(scenario.load(str(file))).recording
    assert done["phi_rad"][0] == pytest.approx(0.15) and done["phi_rad"].min() < -0.14


def test_without_commands_only_a_hull_that_rolls_has_manoeuvres(tmp_path):
    rolls = vessel.load_vessel(str(written(tmp_path, "test_roller", ROLL)))
    assert len(available_manoeuvres(rolls, {}, 0.1, False)) == len(DEFAULT.plan.release_shares)
    sways = replace(rolls, dof=("sway", "heave"))
    assert available_manoeuvres(sways, {}, 0.0, False) == ()


def test_a_plan_starts_each_degree_of_freedom_at_its_own_place(tmp_path):
    """A section that sways, heaves and rolls has as many states as a boat in the plane."""
    section = box_in_measured_wave(tmp_path)
    recording = SimpleNamespace(program=SimpleNamespace(vessel=section))
    release = Manoeuvre("a release", duration=24.0, release_angle=0.15)
    start = np.array([0.0, 0.0, 0.15, 0.0, 0.0, 0.0])
    simulated = SimpleNamespace(manoeuvre=release, recording=recording, start=start)
    plan = next_experiment._plan(simulated, (), {})
    assert plan.start == {"y": 0.0, "z": 0.0, "phi": 0.15}
    assert "\nphi = 0.15\n" in next_experiment.scenario_text(plan, section)


def kinds(*names: str) -> list:
    return [load_class("effect", n) for n in names]


@pytest.mark.slow
def test_zig_zag_of_a_ship_changes_over_where_its_heading_is_expected_to_be(tmp_path):
    text = PLANAR.replace("low = -100.0", "low = 0.0").replace("x = 0.0\nhalf", "x = -0.5\nhalf")
    boat = vessel.load_vessel(str(written(tmp_path, "test_ship", text)))
    code = Program(boat)
    steady = {"thrust_port_N": 5.0, "thrust_starboard_N": 5.0}
    rows = np.tile(code.command_array(steady), (240, 1))
    t = np.arange(240) / RATE
    signals = {
        "x_m": 0.5 * t,
        "y_m": 0.0 * t,
        "psi_rad": 0.0 * t,
        **dict(zip(boat.commands, rows.T, strict=True)),
    }
    problem = Problem(
        [map_recording(Recording("first", t, signals), code)],
        NoiseLevels(np.full(3, 0.1), 1.0, NOISE),
        {},
    )
    zigzag = next(
        m for m in available_manoeuvres(boat, steady, 0.0, False) if m.name == "20/20 zig-zag"
    )
    found = simulate_manoeuvre(problem, problem.nominal_hypothesis(), zigzag)
    assert found is not None
    seen, plan = found.recording, found.manoeuvre
    assert found.start[3] > 0.3 and len(plan.times) > 2
    for time, before in zip(plan.times[1:], plan.levels, strict=False):
        side = np.sign(before["steer_port_rad"])
        psi = side * seen.measured[np.searchsorted(seen.times, time - 1e-3), 2]
        assert abs(abs(psi) - np.radians(20.0)) < np.radians(8.0)  # a row is 1/6 s
        assert abs(before["steer_port_rad"]) == pytest.approx(np.radians(20.0))
        assert before["thrust_port_N"] == 5.0


NOISE = {"position_sd_m": 0.003, "heading_sd_rad": 0.01}


@pytest.fixture(autouse=True)
def in_its_own_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
