"""The diagnosis: its filter against a dense Gaussian, its answers on data whose truth is known, and
on real data."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from alike import slow
from scipy.integrate import solve_ivp
from scipy.linalg import expm
from scipy.stats import multivariate_normal

from boatsim.cli import diagnosis as commands
from boatsim.diagnosis import loading, pipeline
from boatsim.diagnosis.answer.parameters import parameter_key
from boatsim.diagnosis.candidates import program_with_candidates
from boatsim.diagnosis.filter import NoiseLevels, free_run_segments
from boatsim.diagnosis.prior_noise import prior_noise_levels
from boatsim.diagnosis.problem import froude_scale
from boatsim.diagnosis.recording_mapping import map_recording
from boatsim.errors import BadInput
from boatsim.physics import vessel
from boatsim.physics.content import effect_reference, load_class
from boatsim.physics.program import Program
from boatsim.recordings import table as recording
from boatsim.recordings.table import Notes, Recording
from boatsim.simulate import scenario
from boatsim.simulate.engine import Engine
from boatsim.simulate.run_files import run_into_folder
from boatsim.sweeps.diagnoses import DiagnosisOptions

DATA = Path(__file__).parents[1] / "data"
DECAY = DATA / "kvlcc2_roll_decay" / "decay_0kn_run2.csv"


# ---- the filter


def roll_recording(n: int = 40, dt: float = 0.2) -> Recording:
    rng = np.random.default_rng(3)
    t = dt * np.arange(n)
    phi = 0.1 * np.exp(-0.02 * t) * np.cos(2.46 * t) + 1e-3 * rng.standard_normal(n)
    phi[7] = np.nan  # a sample that is missing
    return Recording("roll", t, {"phi_rad": phi})


def test_filter_and_smoother_equal_the_dense_gaussian_of_the_same_linear_model():
    boat = vessel.load_vessel("kvlcc2_roll")
    rec = roll_recording()
    found = map_recording(rec, Program(boat))
    levels = NoiseLevels(np.array([3.0]), 1.5, {"roll_sd_rad": 1e-3})
    on = found.program.effect_switches()
    values = found.values
    # the same model written down here: d/dt (phi, p, K) and its exact discretisation
    inertia, damping, stiffness = 115.6 + 19.8, 6.7, 822.3
    h = rec.t[1] - rec.t[0]
    A = np.array([[0, 1, 0], [-stiffness / inertia, -damping / inertia, 1 / inertia], [0, 0, 0]])
    F = expm(A * h)
    F[2, 2] = np.exp(-h / 1.5)
    Q = np.diag([0.0, 0.0, 9.0 * (1 - F[2, 2] ** 2)])
    P0 = found.initial_state_prior.covariance.copy()
    P0[0, 0], P0[2, 2] = 1e-6, 9.0
    n = len(rec)
    big = np.zeros((3 * n, 3 * n))
    mean = np.zeros(3 * n)
    block, centre = P0, np.array([rec["phi_rad"][0], 0.0, 0.0])
    for i in range(n):
        mean[3 * i : 3 * i + 3] = centre
        big[3 * i : 3 * i + 3, 3 * i : 3 * i + 3] = block
        cross = block
        for j in range(i + 1, n):
            cross = cross @ F.T
            big[3 * i : 3 * i + 3, 3 * j : 3 * j + 3] = cross
            big[3 * j : 3 * j + 3, 3 * i : 3 * i + 3] = cross.T
        block, centre = F @ block @ F.T + Q, F @ centre
    rows = [3 * i for i in range(1, n) if np.isfinite(rec["phi_rad"][i])]
    y = rec["phi_rad"][[r // 3 for r in rows]]
    S = big[np.ix_(rows, rows)] + 1e-6 * np.eye(len(rows))
    dense = multivariate_normal(mean[rows], S).logpdf(y)
    got = found.log_likelihood(values, on, levels) - 0.5 * len(rows) * np.log(2 * np.pi)
    # the filter linearises to third order in h, and holds the force over a sample
    assert got == pytest.approx(dense, abs=0.3)
    gain = np.linalg.solve(S, big[rows]).T
    smoothed = mean + gain @ (y - mean[rows])
    means, covariances, _ = found.smooth(values, on, levels)
    assert means[:, 0] == pytest.approx(smoothed[0::3], abs=2e-4)
    variance = np.diag(big - gain @ big[rows])[2::3]
    assert np.sqrt(covariances[5:-5, 2, 2]) == pytest.approx(np.sqrt(variance)[5:-5], rel=0.05)


def test_one_outlier_moves_neither_states_nor_evidence_much():
    boat = vessel.load_vessel("kvlcc2_roll")
    clean = roll_recording()
    spoilt = replace(clean, signals={"phi_rad": clean["phi_rad"].copy()})
    spoilt["phi_rad"][20] += 0.5
    levels = NoiseLevels(np.array([3.0]), 1.5, {"roll_sd_rad": 1e-3})
    program = Program(boat)
    laid = (map_recording(r, program) for r in (clean, spoilt))
    first, second = (t.smooth(t.values, program.effect_switches(), levels)[0] for t in laid)
    assert np.abs(first[:, 0] - second[:, 0]).max() < 2e-3


def test_evidence_has_no_step_where_a_measurement_becomes_an_outlier():
    boat = vessel.load_vessel("kvlcc2_roll")
    levels = NoiseLevels(np.array([0.2]), 1.5, {"roll_sd_rad": 1e-3})
    program = Program(boat)

    def likelihood(off: float) -> float:
        spoilt = roll_recording()
        spoilt = replace(spoilt, signals={"phi_rad": spoilt["phi_rad"].copy()})
        spoilt["phi_rad"][20] += off
        laid = map_recording(spoilt, program)
        return laid.log_likelihood(laid.values, program.effect_switches(), levels)

    off = np.linspace(0.004, 0.02, 161)  # through the gate, which is at 5 sd
    found = np.array([likelihood(x) for x in off])
    assert found[0] - found[-1] > 5.0
    # half the way, half the difference: over a step it would stay what it is
    assert np.abs(np.diff(found)).max() < 0.6 * np.abs(np.diff(found[::2])).max()


@pytest.fixture(scope="module")
def joystick():
    """Servos lag by 60 ms, motors fed by PWM by 150 ms; a delay is suspected; a rate limit that
    limits nothing."""
    boat = vessel.load_vessel(
        "joystick_boat", extra=[{"use": "rate_limit", "on": ["thrust_port_N"]}]
    )
    return program_with_candidates(boat, ["command_delay"])


def driven(boat: vessel.Vessel) -> Recording:
    """40 s at 6 Hz of random steps every half second, by MuJoCo at 6.7 ms, with the noise of its
    camera."""
    rng, rate, n = np.random.default_rng(1), 6, 240
    raw = {
        c: np.repeat(rng.uniform(-150.0, 150.0, n // 3), 3) for c in ("pwm_port", "pwm_starboard")
    }
    raw |= {
        c: np.repeat(rng.uniform(-0.7, 0.7, n // 3), 3)
        for c in ("steer_port_rad", "steer_starboard_rad")
    }
    engine, poses = Engine(boat, step=1 / rate / 25), []
    engine.reset(commands={c: values[0] for c, values in raw.items()})
    for i in range(n):
        poses.append((engine.state.x, engine.state.y, engine.state.psi))
        engine.command({c: values[i] for c, values in raw.items()})
        engine.advance(25)
    pose = np.array(poses) + rng.standard_normal((n, 3)) * [0.002, 0.002, 0.0094]
    return Recording(
        "driven",
        np.arange(n) / rate,
        dict(zip(("x_m", "y_m", "psi_rad"), pose.T, strict=True)) | raw,
    )


@pytest.mark.slow
def test_likelihood_hangs_neither_on_the_filters_step_nor_on_a_delay_that_merely_splits_it(
    joystick,
):
    recording = driven(joystick.vessel)
    laid, levels = (
        map_recording(recording, joystick),
        prior_noise_levels(joystick.vessel, [recording]),
    )
    nothing, delayed = joystick.effect_switches(), joystick.effect_switches(["command_delay"])
    split = laid.values.copy()
    split[joystick.parameter_index("command_delay", "delay")] = 1e-5
    by_step = []
    for step in (laid.largest_step, laid.largest_step / 2, 1e-3):
        laid = replace(laid, specified_step=step)
        by_step.append(laid.log_likelihood(laid.values, nothing, levels))
        assert laid.log_likelihood(split, delayed, levels) == pytest.approx(by_step[-1], abs=0.02)
    assert by_step == pytest.approx([by_step[-1]] * 3, abs=0.02)  # nats; 240 rows


def test_a_ramp_ends_where_the_signal_that_pwm_is_turned_into_is_reached(joystick):
    code, values, on = (
        joystick.simulation_functions,
        joystick.values(),
        joystick.effect_switches(["command_delay"]),
    )
    values[joystick.parameter_index("command_delay", "delay")] = 1e-5
    (
        values[joystick.parameter_index("thrust_lag", "time_constant")],
        values[joystick.parameter_index("rate_limit", "rate")],
    ) = 0.0, 2.0
    memory, act = np.zeros(joystick.memory_size), np.zeros(joystick.actuator_signal_size)
    full, none = (joystick.command_array({"pwm_port": pwm}) for pwm in (150.0, 0.0))
    code.settle_actuators(full, memory, values, on, act)  # 0.617 N
    assert code.substep_length(full, memory, 1.0, code.SHORTEST, values, on) == pytest.approx(
        0.06
    )  # of the servos
    code.advance_actuators(none, memory, 0.2, values, on, act)  # 0.4 N at 2 N/s
    assert code.substep_length(none, memory, 1.0, code.SHORTEST, values, on) == pytest.approx(0.06)
    code.advance_actuators(none, memory, 0.1, values, on, act)  # 0.017 N are left
    assert code.substep_length(none, memory, 1.0, code.SHORTEST, values, on) == pytest.approx(
        0.017 / 2.0, abs=1e-5
    )


def test_free_runs_start_every_horizon_and_leave_a_shorter_rest_out():
    starts, ends = free_run_segments(np.arange(0, 20.01, 0.5), 6.0)
    assert [(0.5 * a, 0.5 * b) for a, b in zip(starts, ends, strict=True)] == [
        (0, 6),
        (6, 12),
        (12, 18),
    ]


# ---- answers on data from an integrator that shares no code with the tool

M, IZ, A11, A22, A66 = 4.6, 0.6, 0.3, 9.0, 0.7  # the trial boat: kg, kg m^2
XU, YV, NR, X_MOTOR, Y_MOTOR = 3.0, 10.0, 1.0, -0.6, 0.19


def truth(t, y, thrust, steer, astern, toward):
    """Surge, sway, yaw of the trial boat with its rigid-body Coriolis force only, written out for
    this test.

    Astern the propellers lose the more the harder they turn; the air's force has a bluff body's
    curve over its angle.
    """
    _, _, psi, u, v, r = y
    push = np.where(thrust < 0, 1.0 - (1.0 - astern) * (0.8 + 0.3 * abs(thrust)), 1.0) * thrust
    off = toward[1] - psi
    X = (push * np.cos(steer)).sum() + toward[0] * np.cos(off) * (0.45 + 0.1 * np.cos(off) ** 2)
    Y = (push * np.sin(steer)).sum() + toward[0] * np.sin(off) * (1.0 - 0.1 * np.cos(off) ** 2)
    N = X_MOTOR * (push * np.sin(steer)).sum() + Y_MOTOR * (
        push[0] * np.cos(steer[0]) - push[1] * np.cos(steer[1])
    )
    du = (X - XU * u + M * v * r) / (M + A11)
    dv = (Y - YV * v - M * u * r) / (M + A22)
    c, s = np.cos(psi), np.sin(psi)
    return [u * c - v * s, u * s + v * c, r, du, dv, (N - NR * r) / (IZ + A66)]


def recorded(
    name: str, seed: int, astern: float = 1.0, wind: tuple[float, float] = (0.0, 0.0)
) -> Recording:
    rng = np.random.default_rng(seed)
    dt, n = 1 / 6, 240
    commands = np.repeat(
        np.column_stack([rng.uniform(-0.9, 0.9, (30, 2)), rng.uniform(-0.6, 0.6, (30, 2))]),
        8,
        axis=0,
    )
    y, rows = np.zeros(6), []
    for k in range(n):
        rows.append(y[:3])
        args = (commands[k, :2], commands[k, 2:], astern, wind)
        y = solve_ivp(truth, (0, dt), y, args=args, rtol=1e-8, atol=1e-10).y[:, -1]
    pose = np.array(rows) + rng.standard_normal((n, 3)) * [0.003, 0.003, 0.012]
    names = ("thrust_port_N", "thrust_starboard_N", "steer_port_rad", "steer_starboard_rad")
    signals = dict(zip(("x_m", "y_m", "psi_rad"), pose.T, strict=True)) | dict(
        zip(names, commands.T, strict=True)
    )
    return Recording(name, dt * np.arange(n), signals, Notes(vessel="trial_boat"))


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("runs")


def written(folder: Path, *recordings: Recording) -> list[Path]:
    for r in recordings:
        recording.write_csv(r, folder / f"{r.name}.csv")
    return [folder / f"{r.name}.csv" for r in recordings]


def test_ideal_boat_has_nothing_missing(folder):
    runs = written(folder, recorded("ideal_1", 1), recorded("ideal_2", 2))
    answer = pipeline.diagnose(runs, vessel="trial_boat").findings.answer
    assert answer["verdict"] == "nothing_missing" and answer["effects"] == []
    limits = answer["upper_limits"]["weak_reverse"]["astern_factor"]
    assert 0.0 < limits < 0.1  # so small a weakness would have gone unseen
    # a slower steering would have been seen: the larger its rate, the weaker that effect
    assert "rate_radps" not in answer["upper_limits"]["steering_rate_limit"]
    assert answer["lower_limits"]["steering_rate_limit"]["rate_radps"] > 0.1
    assert answer["where"]["region"] == []


@pytest.mark.slow
def test_two_effects_are_named_with_their_values_and_the_patched_boat_follows_unseen_data(folder):
    wind = (0.12, 0.8)
    runs = written(
        folder, *(recorded(f"both_{i}", 10 + i, astern=0.7, wind=wind) for i in range(3))
    )
    found = pipeline.diagnose(runs, vessel="trial_boat")
    answer = found.findings.answer
    assert {e["name"] for e in answer["effects"]} == {"weak_reverse", "wind"} and answer[
        "verdict"
    ] == "named"
    values = {k: p for e in answer["effects"] for k, p in e["parameters"].items()}
    for key, true in (("astern_factor", 0.7), ("force_N", 0.12), ("toward_rad", 0.8)):
        assert (
            abs(values[key]["value"] - true) < 4 * values[key]["sd"] and values[key]["sd"] < 0.1
        ), key
    regions = {r["variable"]: r for r in answer["where"]["region"]}
    share = float(regions["thrust astern"]["statement"].split("about ")[1].split(" %")[0])
    # 30 % of it is missing; the smoothed force blurs thrust that changes every 1.3 s
    assert 20.0 < share < 40.0 and regions["thrust astern"]["p_value"] < 1e-6
    toward = float(
        regions["heading in the world"]["statement"].split("toward ")[1].split(" deg")[0]
    )
    assert abs(toward - np.degrees(0.8)) < 15.0
    rms = answer["fit"]["position_rms_m"]
    assert answer["fit"]["held_out"] == ["both_2"]
    assert (
        rms["patched"] < 0.006 < 0.2 * rms["recalibrated"]
    )  # 3 mm camera noise and that of the smoothed start


@pytest.mark.slow
def test_patched_file_gives_the_fitted_motion_back(folder):
    runs = written(
        folder, *(recorded(f"both_{i}", 10 + i, astern=0.7, wind=(0.12, 0.8)) for i in range(2))
    )
    found = pipeline.diagnose(runs[:1], runs[1:], "trial_boat")
    commands.write_diagnosis(found, folder)
    again = vessel.load_vessel(str(folder / "patched.toml"))
    assert {e.name for e in again.effects} >= {"weak_reverse", "wind"}
    assert "# [kg]" in (folder / "patched.toml").read_text()  # comments are kept
    rec = recording.read(runs[1], again.limits())
    fitted, own = map_recording(rec, found.problem.program), map_recording(rec, Program(again))
    best = found.ranking.best
    first = fitted.free_runs(
        found.problem.parameter_vector(fitted, best.free, best.theta),
        fitted.program.effect_switches(best.effects),
        best.levels,
        6.0,
    )
    second = own.free_runs(own.values, own.program.effect_switches(), best.levels, 6.0)
    for (_, a), (_, b) in zip(first, second, strict=True):
        assert np.abs(a - b).max() < 1e-6


@pytest.mark.parametrize("name", [slow("T002"), "T003", slow("T019")])
def test_practice_trials_are_named_exactly(name):
    trial = DATA / "trials" / name
    truth_is = json.loads((trial / "answer.json").read_text())
    answer = pipeline.diagnose(
        [trial / "run_1.csv", trial / "run_2.csv"], [trial / "run_3.csv"]
    ).findings.answer
    assert {e["name"] for e in answer["effects"]} == {e["name"] for e in truth_is["effects"]}
    reference = truth_is["reference_position_rms_m"]
    best = reference.get("true_structure", reference["recalibrated"])
    assert answer["fit"]["position_rms_m"]["patched"] < 1.1 * best


def test_a_single_run_keeps_its_middle_third_unseen():
    rec = recorded("single", 5)
    fitted, held_out, note = loading.split_recordings([rec], [])
    assert [len(r) for r in (*fitted, *held_out)] == pytest.approx([80, 80, 80], abs=2)
    assert held_out[0].t[0] > fitted[0].t[-1] - 0.2 and fitted[1].t[0] > held_out[0].t[-1]
    assert "middle third" in note


def test_load_and_settings_of_the_notes_belong_to_their_own_vessel(tmp_path):
    run = written(tmp_path, recorded("alone", 1))[0]
    (tmp_path / "recording.toml").write_text(
        'vessel = "joystick_boat"\nload = ["light", "narrow"]\n[set.pwm_thrust]\nat_span = 0.3\n'
    )
    own, same = (
        loading.vessel_of_recording_file(run, None, ()),
        loading.vessel_of_recording_file(run, "joystick_boat", ()),
    )
    other = loading.vessel_of_recording_file(run, "otter", ())
    assert own.load == same.load == ("light", "narrow")
    assert other.name == "otter" and other.load == ()
    with pytest.raises(BadInput, match="load 'light' does not exist"):
        loading.vessel_of_recording_file(run, "otter", ["light"])


def test_the_folder_of_a_run_is_its_recording(tmp_path):
    run = written(tmp_path, recorded("alone", 1))[0]
    run.rename(tmp_path / "recording.csv")
    (tmp_path / "recording.toml").write_text('vessel = "trial_boat"\n')
    assert len(recording.read(tmp_path)) == len(recording.read(tmp_path / "recording.csv"))
    loaded = loading.load_recordings(loading.Request([tmp_path]))
    assert loaded.vessel.name == "trial_boat"


def test_bad_requests_get_one_line(folder):
    runs = written(folder, recorded("alone", 1))
    with pytest.raises(BadInput, match="no vessel given"):
        pipeline.diagnose(runs)
    with pytest.raises(BadInput, match="did you mean 'weak_reverse'"):
        pipeline.diagnose(runs, vessel="trial_boat", without=["weak_revers"])
    with pytest.raises(BadInput, match="phi_rad"):
        pipeline.diagnose(runs, vessel="kvlcc2_roll")


@pytest.mark.parametrize(
    ("name", "unit", "key"),
    [
        ("force", "N", "force_N"),
        ("north", "m/s", "north_mps"),
        ("factor", "", "factor"),
        ("time_constant", "s", "time_constant_s"),
        ("surge_quadratic", "N s^2/m^2", "surge_quadratic_Ns2pm2"),
    ],
)
def test_parameter_keys_carry_their_unit(name, unit, key):
    assert parameter_key(name, unit) == key


# ---- the thesis' own boat


@pytest.fixture(scope="module")
def thesis(tmp_path_factory):
    folder = tmp_path_factory.mktemp("thesis")
    for name in ("sway_1", "yaw_1", "sway_3", "yaw_3"):
        run_into_folder(folder / name, scenario.load(f"joystick_boat/{name}_as_published"))
    return folder


@pytest.mark.slow
def test_reverse_thrust_taken_for_ideal_is_found_in_the_thesis_own_tests(thesis):
    runs = [thesis / n / "camera.csv" for n in ("sway_1", "yaw_1")]
    held_out = [thesis / n / "camera.csv" for n in ("sway_3", "yaw_3")]
    answer = pipeline.diagnose(runs, held_out).findings.answer
    assert [e["name"] for e in answer["effects"]] == ["weak_reverse"]
    assert answer["effects"][0]["parameters"]["astern_factor"]["value"] == pytest.approx(
        0.694, rel=0.05
    )
    rms = answer["fit"]["position_rms_m"]
    assert rms["patched"] < rms["nominal"] / 5 and rms["patched"] < rms["recalibrated"] / 5


# ---- a real roll decay


@pytest.mark.slow
def test_real_roll_decay_shows_nonlinear_damping_and_stiffening_on_unseen_data():
    found = pipeline.diagnose([DECAY]).findings
    answer = found.answer
    names = {e["name"] for e in answer["effects"]}
    assert "righting_arm_stiffening" in names and names & {"quadratic_damping", "cubic_damping"}
    rms = answer["fit"]["roll_rms_rad"]
    assert rms["patched"] < 0.5 * rms["recalibrated"]
    assert any(
        "last third" in r for r in found.remarks
    )  # there the linear model is already right, and it says so


# ---- what a user may do


def test_a_recording_without_commands_is_refused_not_explained(folder):
    full = recorded("steered", 1)
    for gone in ("thrust_port_N", "steer_starboard_rad"):
        part = replace(full, signals={k: v for k, v in full.signals.items() if k != gone})
        with pytest.raises(BadInput, match=f"column {gone} is missing"):
            pipeline.diagnose(written(folder, part), vessel="trial_boat")


def test_positions_in_millimetres_are_asked_about(folder):
    full = recorded("millimetres", 1)
    large = {k: v * 1000.0 if k in ("x_m", "y_m") else v for k, v in full.signals.items()}
    with pytest.raises(BadInput, match="are they in m"):
        pipeline.diagnose(written(folder, replace(full, signals=large)), vessel="trial_boat")


def test_what_is_fitted_can_not_be_held_out(folder):
    runs = written(folder, recorded("twice", 1))
    with pytest.raises(BadInput, match="given twice"):
        pipeline.diagnose(runs, runs, "trial_boat")


def test_horizon_shrinks_to_what_was_kept_unseen():
    answer = pipeline.diagnose([DECAY.with_name("decay_15p5kn.csv")]).findings.answer
    assert 10.0 < answer["fit"]["horizon_s"] < 60.0 and answer["fit"]["roll_rms_rad"]["nominal"] > 0


WEED = """
from dataclasses import dataclass
from numba import njit
from boatsim.physics.base import Force, param, wrench

@njit(inline="always")
def law(m, q):
    return wrench(K=-q.roll * m.p**3)

@dataclass(frozen=True)
class RollWeed(Force):
    words = "weed on the bilge resists rolling"
    shown_by = "a decay"
    law = law
    roll: float = param(0.0, low=0.0, high=1e13, unit="N m s^3", words="roll", fit=True, spread=0.003)
"""


def test_own_preset_of_a_shipped_law_is_found_by_its_own_file(tmp_path):
    file = tmp_path / "weed.py"
    file.write_text(
        "from boatsim.physics.base import preset_effect\n"
        "from boatsim.physics.effects.damping import LinearDamping\n"
        'Weed = preset_effect(LinearDamping, "Weed", words="weed", fixed={"roll_exponent": 3.0})\n'
    )
    assert effect_reference(load_class("effect", str(file), named=True)) == str(file.resolve())


@pytest.mark.slow
def test_own_vessel_and_own_library_file_give_a_patched_boat_that_replays(folder, tmp_path, capsys):
    text = (vessel.load_vessel("kvlcc2_roll").file).read_text()
    mine = tmp_path / "mine"
    mine.mkdir()
    (mine / "vessel.toml").write_text(text)
    for file in ("hull.xml",):
        (mine / file).write_text((vessel.load_vessel("kvlcc2_roll").path / file).read_text())
    own = tmp_path / "roll_weed.py"
    own.write_text(WEED)
    without = ["cubic_damping", "quadratic_damping"]
    code = commands.diagnose(
        [DECAY],
        DiagnosisOptions(
            vessel=str(mine / "vessel.toml"), library=(str(own),), without=tuple(without)
        ),
        tmp_path / "out",
    )
    assert code == 0 and "roll_weed" in capsys.readouterr().out
    (tmp_path / "elsewhere").mkdir()
    fit = json.loads((tmp_path / "out" / "diagnosis.json").read_text())["fit"]
    patched = str(tmp_path / "out" / "patched.toml")
    code = commands.replay(DECAY, patched, [], fit["horizon_s"], tmp_path / "elsewhere")
    rms = float(capsys.readouterr().out.split("roll_rms_rad:")[1].split()[0])
    assert code == 0 and rms < 0.5 * fit["roll_rms_rad"]["recalibrated"]


def test_froude_scaled_priors_are_those_of_the_small_boat():
    small, large = vessel.load_vessel("trial_boat"), vessel.load_vessel("kvlcc2_roll")
    length = large.length / small.length
    assert all(
        froude_scale(unit, small) == pytest.approx(1.0)
        for unit in ("N", "N s^2/m^2", "N m", "m/s", "s", "")
    )
    assert froude_scale("m/s", large) == pytest.approx(length**0.5)
    assert froude_scale("N", large) == pytest.approx(
        large.body.mass / small.body.mass
    )  # weight has no other scale
    assert froude_scale("N s^2/m^2", large) == pytest.approx(
        large.body.mass / small.body.mass / length
    )
