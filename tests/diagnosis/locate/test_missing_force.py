"""Locating: the band against forces that were put there, averages and tests against dense algebra,
regions by cause."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import pytest
from pushed_boat import BOAT, COMMANDS, DAMPING, RATE, ROWS, Missing, laid, push, sail
from scipy.integrate import odeint
from scipy.linalg import expm
from scipy.stats import kstest

from boatsim.diagnosis.candidates import program_with_candidates
from boatsim.diagnosis.config import DEFAULT
from boatsim.diagnosis.locate import missing_force as missing_force_module
from boatsim.diagnosis.locate.missing_force import (
    missing_force,
    residual_force,
    significant_intervals,
)
from boatsim.diagnosis.locate.periodicity import most_significant_peak
from boatsim.diagnosis.locate.region_candidates import tank_walls
from boatsim.diagnosis.locate.region_tests import ScoreStatistics, sum_statistics
from boatsim.diagnosis.locate.regions import Region, find_missing_force_conditions
from boatsim.diagnosis.locate.residual_structure import (
    candidate_regressors,
    find_structure,
    find_structure_held_out,
)
from boatsim.diagnosis.locate.smoothing import (
    LatentForce,
    joint_information,
    running_average,
    variance_of_average,
)
from boatsim.diagnosis.noise_levels import fit_latent_force_spectrum
from boatsim.diagnosis.prior_noise import prior_noise_levels
from boatsim.diagnosis.problem import Problem
from boatsim.diagnosis.recording_mapping import map_recording
from boatsim.diagnosis.search.evidence import unexplained_evidence
from boatsim.diagnosis.search.ranking import fit_baseline
from boatsim.physics import vessel
from boatsim.physics.base import Array
from boatsim.physics.program import Program
from boatsim.recordings.table import Notes, Recording

# ---- a linear Gaussian chain whose posterior is written out densely

DT, TAU, RMS, NOISE, N = 0.2, 1.3, 0.7, 0.05, 40
FIRST = 3.0 * RMS  # a recording may begin rougher than it goes on
LATENT = slice(2, 3)


@dataclass(frozen=True)
class Chain:
    """Mass on a damper under an Ornstein-Uhlenbeck force, its position measured: all that the
    smoother knows of it."""

    times: Array
    covariances: Array
    gains: Array
    finds: Array  # (N, N) smoothed force of the measured positions
    responds: Array  # (N, N) positions of a force
    spread: Array  # (N, N) covariance of the measurements
    posterior: Array  # (N, N) covariance of the smoothed force


def chain() -> Chain:
    A = np.array([[0.0, 1.0, 0.0], [0.0, -0.4, 1.0], [0.0, 0.0, 0.0]])
    F = expm(A * DT)
    moved = F.copy()
    F[2, 2] = decay = np.exp(-DT / TAU)
    Q = np.diag([0.0, 0.0, RMS**2 * (1.0 - decay**2)])
    first = np.diag([0.3**2, 0.5**2, FIRST**2])
    # dense prior over all rows, then the posterior of Gaussian conditioning
    prior = np.zeros((3 * N, 3 * N))
    block = first
    for i in range(N):
        cross = block
        for j in range(i, N):
            prior[3 * i : 3 * i + 3, 3 * j : 3 * j + 3] = cross.copy()
            prior[3 * j : 3 * j + 3, 3 * i : 3 * i + 3] = cross.T
            cross = cross @ F.T
        block = F @ block @ F.T + Q
    H = np.kron(np.eye(N), [[1.0, 0.0, 0.0]])
    spread = H @ prior @ H.T + NOISE**2 * np.eye(N)
    K = prior @ H.T @ np.linalg.inv(spread)
    posterior = prior - K @ H @ prior
    covariances = np.array([posterior[3 * i : 3 * i + 3, 3 * i : 3 * i + 3] for i in range(N)])
    gains = np.zeros((N, 3, 3))
    for i in range(N - 1):  # cov(z_i, z_i+1) = G_i P_i+1
        gains[i] = np.linalg.solve(
            covariances[i + 1].T, posterior[3 * i : 3 * i + 3, 3 * i + 3 : 3 * i + 6].T
        ).T
    responds = np.zeros((N, N))
    for i in range(N - 1):
        z = moved[:, 2].copy()
        z[2] = 0.0
        for j in range(i + 1, N):
            responds[j, i] = z[0]
            z = moved @ z
    return Chain(
        DT * np.arange(N), covariances, gains, K[2::3], responds, spread, posterior[2::3, 2::3]
    )


CHAIN = chain()


@pytest.mark.parametrize("rows", [1, 2, 5, 6])
def test_variance_of_an_average_is_that_of_the_dense_posterior(rows: int) -> None:
    got = variance_of_average(CHAIN.covariances, CHAIN.gains, LATENT, rows)[:, 0]
    mean = running_average(np.eye(N), rows)
    assert got == pytest.approx(np.einsum("ij,jk,ik->i", mean, CHAIN.posterior, mean), rel=1e-6)


def test_running_average_of_a_straight_line_is_the_line_inside() -> None:
    line = np.arange(10.0)[:, None] * [1.0, -2.0]
    assert running_average(line, 5)[2:-2] == pytest.approx(line[2:-2])
    assert running_average(line, 4)[3] == pytest.approx(line[2:6].mean(axis=0))
    assert running_average(line, 5)[0] == pytest.approx(line[:5].mean(axis=0))


def shapes() -> Array:
    t = CHAIN.times
    return np.stack(
        [np.sin(1.1 * t), np.where(np.sin(2.0 * t) > 0, 1.0, 0.0), np.exp(-t)], axis=-1
    )[:, None, :]


def latent(y: Array) -> LatentForce:
    """The smoothed force of measured positions (N,)."""
    means = np.zeros((N, 3))
    means[:, LATENT] = (CHAIN.finds @ y)[:, None]
    rms, first = np.array([RMS]), np.array([FIRST])
    return LatentForce(CHAIN.times, means, CHAIN.covariances, CHAIN.gains, LATENT, rms, first, TAU)


def test_information_on_a_known_force_is_that_of_the_measurements() -> None:
    y = np.random.default_rng(1).multivariate_normal(np.zeros(N), CHAIN.spread)
    S = shapes()
    learnt, score = joint_information(S, latent(y))
    seen = CHAIN.responds @ S[:, 0]  # what each shape does to the positions
    weight = np.linalg.inv(CHAIN.spread)
    assert learnt == pytest.approx(seen.T @ weight @ seen, rel=1e-6, abs=1e-9)
    assert score == pytest.approx(seen.T @ weight @ y, rel=1e-6, abs=1e-9)


def evidence(y: Array) -> ScoreStatistics:
    S = shapes()
    named = {n: (S[..., k],) for k, n in enumerate(("sine", "square", "decay"))}
    return ScoreStatistics.from_latent_force(named, latent(y))


def test_p_values_are_uniform_where_nothing_acts_and_small_where_it_does() -> None:
    rng = np.random.default_rng(4)
    y = rng.multivariate_normal(np.zeros(N), CHAIN.spread, size=400)
    p = [evidence(row).score_test("square", ["sine", "decay"]).p_value for row in y]
    assert kstest(p, "uniform").pvalue > 0.01
    acts = sum_statistics(
        [evidence(row + 3.0 * CHAIN.responds @ shapes()[:, 0, 1]) for row in y[:20]],
        ["square", "sine"],
    )
    result = acts.score_test("square", ["sine"])
    assert result.p_value < 1e-6 and result.factors[0] == pytest.approx(3.0, rel=0.1)
    assert result.rms[0] == pytest.approx(3.0 * np.sqrt(np.mean(shapes()[:, 0, 1] ** 2)), rel=0.1)


def test_an_idea_that_the_others_already_say_is_no_finding() -> None:
    found = evidence(np.random.default_rng(2).multivariate_normal(np.zeros(N), CHAIN.spread))
    assert found.score_test("sine", ["sine", "decay"]).p_value == 1.0


# ---- rhythm


def test_rhythm_has_the_period_that_was_put_in_and_white_or_rough_errors_have_none() -> None:
    rng = np.random.default_rng(3)
    t = np.arange(240) / 6.0

    def runs(add: Callable[[Array], Array]) -> list[tuple[Array, Array]]:
        return [(t, add(rng.standard_normal((240, 3)))) for _ in range(2)]

    swell = 0.6 * np.sin(2 * np.pi * t / 1.9)[:, None]
    found = most_significant_peak(runs(lambda white: white + swell))
    assert (
        found is not None and found.p_value < 1e-6 and found.period == pytest.approx(1.9, rel=0.05)
    )
    p = np.array([most_significant_peak(runs(lambda white: white)).p_value for _ in range(300)])  # type: ignore[union-attr]
    assert np.mean(p < 0.05) < 0.09 and np.mean(p < 0.01) < 0.03
    coloured = [
        most_significant_peak(runs(lambda white: white + 0.3 * np.roll(white, 1, axis=0)))
        for _ in range(100)
    ]
    assert np.mean([r.p_value < 0.01 for r in coloured if r]) < 0.06
    assert most_significant_peak([(t[:6], np.zeros((6, 1)))]) is None


# ---- the trial boat


def nothing(t: float, y: Array, command: Array) -> Array:
    return np.zeros(3)


def found_in(missing: Missing, facts: dict[str, Any] | None = None) -> dict[str, Region]:
    problem, found = laid(*(sail(f"run_{k}", 20 + k, missing, facts)[0] for k in range(2)))
    return {r.variable: r for r in find_missing_force_conditions(problem, found)}


def swelling(t: float, y: Array, command: Array) -> Array:
    """A slow force, a step, and a boat that pushes 6 % more and is damped 5 % less than written."""
    slow = np.array([0.06 * np.sin(0.5 * t), 0.05 if t > 20.0 else 0.0, 0.02 * np.cos(0.4 * t)])
    return slow + 0.06 * push(command[:2], command[2:]) + 0.05 * DAMPING * y[3:]


def test_the_band_holds_a_force_that_was_put_there_and_flags_it_where_it_is() -> None:
    runs = [sail(f"swelling_{k}", 30 + k, swelling) for k in range(2)]
    problem, found = laid(*(r for r, _ in runs))
    forces = missing_force(problem, found, problem.recordings)
    true = np.concatenate([running_average(f, 6) for _, f in runs])
    mean, sd = np.concatenate([f.mean for f in forces]), np.concatenate([f.sd for f in forces])
    inside = np.abs(mean - true) < DEFAULT.locate.band_sds * sd
    assert (inside.mean(axis=0) > 0.9).all()
    flagged, ambient = np.abs(mean) > DEFAULT.locate.band_sds * sd, problem.ambient.force
    assert np.mean(flagged[np.abs(true) > 2 * ambient]) > 0.6
    assert np.mean(np.abs(true)[flagged] < np.broadcast_to(ambient, true.shape)[flagged]) < 0.05
    assert (sd >= ambient / DEFAULT.locate.band_sds).all()
    sway = [
        i for i in significant_intervals(problem, forces) if i.axis == "sway" and i.to_s > 22.0
    ]  # the step is at 20 s
    assert sum(i.to_s - max(i.from_s, 22.0) for i in sway) > 0.8 * len(forces) * (
        ROWS / RATE - 22.0
    )
    # what the recalibrated vessel itself leaves over has no part of the thrust that is 6 % more
    thrust = np.concatenate([push_of(r) for r, _ in runs])
    left = np.concatenate([f.mean for f in residual_force(problem, found, problem.recordings)])
    of_true, of_mean, of_left = (
        np.sum(f[:, 0] * thrust) / np.sum(thrust**2) for f in (true, mean, left)
    )
    assert of_mean == pytest.approx(of_true, abs=0.01) and of_true > 0.06 and abs(of_left) < 0.02


def push_of(recording: Recording) -> Array:
    """(N,) surge force of the thrusters as written, averaged as the missing force is."""
    commands = np.column_stack([recording[c] for c in COMMANDS])
    return running_average(np.array([push(c[:2], c[2:])[0] for c in commands]), 6)


def test_correlation_time_is_that_of_the_force_that_was_put_there() -> None:
    def drawn(tau: float) -> Missing:
        rng, decay = np.random.default_rng(7), np.exp(-1 / RATE / tau)
        course = np.zeros((ROWS + 1, 3))
        for i in range(ROWS):
            course[i + 1] = decay * course[i] + np.sqrt(1 - decay**2) * rng.standard_normal(3) * [
                0.08,
                0.1,
                0.04,
            ]
        return lambda t, y, command: course[min(int(t * RATE + 1e-6), ROWS)]

    times = []
    for tau in (1.0, 5.0):
        problem, found = laid(sail(f"drawn_{tau:g}", 8, drawn(tau))[0])
        times.append(fit_latent_force_spectrum(problem, found).time_constant)
    assert 0.5 < times[0] < 2.0 and 2.5 < times[1] < 10.0


def test_an_ideal_boat_has_no_region() -> None:
    assert found_in(nothing) == {}


def test_thrust_missing_astern_is_found_with_its_share() -> None:
    def weak(t: float, y: Array, command: Array) -> Array:
        return -0.3 * push(np.minimum(command[:2], 0.0), command[2:])

    found = found_in(weak)
    assert list(found) == ["thrust astern"] and found["thrust astern"].p_value < 1e-6
    share = float(found["thrust astern"].statement.split("about ")[1].split(" %")[0])
    assert share == pytest.approx(30.0, abs=4.0)
    assert found["thrust astern"].statement.endswith("is missing; p < 1e-6")


def test_wind_keeps_its_direction_in_the_world() -> None:
    def wind(t: float, y: Array, command: Array) -> Array:
        return np.array([0.1 * np.cos(2.0 - y[2]), 0.1 * np.sin(2.0 - y[2]), 0.0])

    found = found_in(wind)
    assert list(found) == ["heading in the world"]
    toward = float(found["heading in the world"].statement.split("toward ")[1].split(" deg")[0])
    assert toward == pytest.approx(np.degrees(2.0), abs=10.0)


def test_play_in_the_steering_is_found_with_its_width() -> None:
    memory: dict[str, Any] = {}

    def play(t: float, y: Array, command: Array) -> Array:
        if t == 0.0:
            memory["angle"] = command[2:].copy()
        memory["angle"] = np.clip(memory["angle"], command[2:] - 0.1, command[2:] + 0.1)
        return push(command[:2], memory["angle"]) - push(command[:2], command[2:])

    found = found_in(play)
    assert list(found) == ["steering reversals"]
    width = float(found["steering reversals"].statement.split("as with ")[1].split(" rad")[0])
    assert width == pytest.approx(0.2, abs=0.05)


def test_drag_with_the_square_of_the_speed_is_found() -> None:
    found = found_in(lambda t, y, command: np.array([-12.0 * y[3] * abs(y[3]), 0.0, 0.0]))
    assert (
        list(found) == ["surge speed"]
        and "resists with the square of the surge speed" in found["surge speed"].statement
    )


def test_walls_pull_and_drag_where_the_recording_says_they_are() -> None:
    facts = {"walls_m": [-0.6, 1.2, -1.5, 0.9]}  # [m]

    def walls(t: float, y: Array, command: Array) -> Array:
        low, high = np.array(facts["walls_m"][::2]), np.array(facts["walls_m"][1::2])
        near, far = (np.exp(-np.maximum(d, 0.0) / 0.6) for d in (high - y[:2], y[:2] - low))
        c, s = np.cos(y[2]), np.sin(y[2])
        north, east = 0.15 * (near - far)
        drag = 0.8 * (near + far).sum() * DAMPING * y[3:]
        return np.array([c * north + s * east, c * east - s * north, 0.0]) - drag

    found = found_in(walls, facts)
    assert "distance to the walls" in found and found["distance to the walls"].p_value < 1e-6
    assert "more, and the boat is pushed towards it" in found["distance to the walls"].statement
    assert "distance to the walls" not in found_in(nothing, facts)


def test_walls_stated_in_a_recording_are_those_of_the_library_entry_too() -> None:
    still = {n: np.zeros(30) for n in ("x_m", "y_m", "psi_rad", *COMMANDS)}
    stated = Recording(
        "stated", np.arange(30) / RATE, still, Notes(facts={"walls_m": [-1.0, 2.0, -3.0, 5.0]})
    )
    program = program_with_candidates(BOAT, ["wall_effect"])
    own, other = (
        map_recording(replace(stated, notes=Notes()), program),
        map_recording(stated, program),
    )
    at = [program.parameter_index("wall_effect", n) for n in ("x_low", "x_high", "y_low", "y_high")]
    assert other.values[at] == pytest.approx([-1.0, 2.0, -3.0, 5.0]) == tank_walls(other)
    assert own.values[at] == pytest.approx([-4.0, 4.0, -3.0, 3.0]) == tank_walls(own)


# ---- roll alone


@pytest.mark.parametrize(
    ("name", "more"),
    [
        ("roll angle", lambda phi, p: -1800.0 * phi**3),
        ("roll rate", lambda phi, p: -40.0 * p * abs(p)),
        ("", None),
    ],
)
def test_roll_that_stiffens_or_drags_is_told_from_a_linear_one(name: str, more: Any) -> None:
    ship = vessel.load_vessel("kvlcc2_roll")
    inertia, damping, stiffness = 115.6 + 19.8, 6.7, 822.3  # kg m^2, N m s, N m
    rng = np.random.default_rng(11)
    t = np.arange(0.0, 60.0, 0.2)

    def slope(y: Array, _: float) -> list[float]:
        return [y[1], (-damping * y[1] - stiffness * y[0] + (more(*y) if more else 0.0)) / inertia]

    phi = odeint(slope, [0.25, 0.0], t, rtol=1e-9, atol=1e-11)[:, 0] + 1e-3 * rng.standard_normal(
        len(t)
    )
    rec = Recording("decay", t, {"phi_rad": phi})
    program = Program(ship)
    problem = Problem(
        [map_recording(rec, program)],
        prior_noise_levels(ship, [rec]),
        {"damping": 0.05, "restoring": 0.02},
    )
    found = fit_baseline(problem)[1]
    assert [r.variable for r in find_missing_force_conditions(problem, found)][
        : 1 if name else None
    ] == ([name] if name else [])


# ---- structure in what is left over


@pytest.mark.slow
def test_what_is_left_of_a_boat_that_lacks_nothing_goes_with_nothing() -> None:
    p = [
        find_structure(*laid(*(sail(f"run_{k}", seed + k, nothing)[0] for k in range(2))))
        for seed in range(60, 72, 2)
    ]
    assert all(not s.significant and s.tested > 100 for s in p)


@pytest.mark.parametrize(
    ("axis", "goes_with", "weak"),
    [
        ("sway", "the sine of heading", lambda t, y: 0.03 * np.sin(y[2])),
        ("yaw", "twice the heading", lambda t, y: 0.006 * np.cos(2.0 * y[2])),
        ("surge", "it acts in 24.9 to 29.9 s of run_0", lambda t, y: 0.045 * (25.0 < t < 30.0)),
    ],
)
def test_a_force_below_the_tolerated_one_is_seen_by_what_it_goes_with(
    axis: str, goes_with: str, weak: Any
) -> None:
    i = ("surge", "sway", "yaw").index(axis)
    runs = [
        sail(f"run_{k}", 80 + k, lambda t, y, c, k=k: np.eye(3)[i] * weak(t + 100.0 * k, y))[0]
        for k in range(2)
    ]
    problem, found = laid(*runs)
    seen = find_structure(problem, found)
    assert seen.axis == axis and goes_with in seen.goes_with and seen.p_value < 1e-3
    assert (
        unexplained_evidence(problem, found) < DEFAULT.select.unknown_gain
    )  # whose rms alone would pass


@pytest.mark.slow
def test_held_out_runs_of_a_boat_that_lacks_nothing_have_no_structure() -> None:
    """Their parameters differ from the fit by its uncertainty, which is no structure."""
    for seed in range(60, 72, 2):
        problem, found = laid(*(sail(f"run_{k}", seed + k, nothing)[0] for k in range(2)))
        unseen = sail("held_out", seed + 40, nothing)[0]
        held_out = problem.with_recordings([map_recording(unseen, problem.program)])
        assert find_structure_held_out(held_out, found).p_value > 0.01


def test_a_force_that_a_fitted_coefficient_explains_is_no_structure() -> None:
    """The same force is structure beside a damping that may not change."""
    runs = [
        sail(f"run_{k}", 80 + k, lambda t, y, c: -0.3 * DAMPING * y[3:6] * [0, 0, 1])[0]
        for k in range(2)
    ]
    program = Program(BOAT)
    recordings = [map_recording(run, program) for run in runs]
    gains = []
    for uncertainty in (0.3, 1e-6):
        problem = Problem(recordings, prior_noise_levels(BOAT, runs), {"damping": uncertainty})
        gains.append(find_structure(problem, fit_baseline(problem)[1]).gain)
    print(gains)
    assert gains[0] < 8.0 < gains[1]


@pytest.mark.parametrize(
    ("quantity", "more"),
    [
        ("roll rate times", lambda t, phi, p: -30.0 * p * (phi > 0.0)),
        ("the roll angle squared", lambda t, phi, p: 150.0 * phi**2),
    ],
)
def test_damping_on_one_side_is_told_from_a_righting_moment_on_one_side(
    quantity: str, more: Any
) -> None:
    ship = vessel.load_vessel("kvlcc2_roll")
    inertia, damping, stiffness = 115.6 + 19.8, 6.7, 822.3  # kg m^2, N m s, N m
    noise = np.random.default_rng(12)
    t = np.arange(0.0, 60.0, 0.2)

    def slope(y: Array, t: float) -> list[float]:
        return [y[1], (-damping * y[1] - stiffness * y[0] + more(t, *y)) / inertia]

    course = odeint(slope, [0.15, 0.0], t, rtol=1e-9, atol=1e-11)[:, 0]
    recording = Recording("decay", t, {"phi_rad": course + 1e-3 * noise.standard_normal(len(t))})
    problem = Problem(
        [map_recording(recording, Program(ship))],
        prior_noise_levels(ship, [recording]),
        {"damping": 0.5, "restoring": 0.02},
    )
    seen = find_structure(problem, fit_baseline(problem)[1])
    assert seen.significant and quantity in seen.goes_with


def test_stretches_are_told_by_the_clock_of_the_recording() -> None:
    """A later part of a recording does not begin at 0 s."""
    recording, _ = sail("run_0", 80, nothing)
    problem, _ = laid(replace(recording, t=recording.t + 100.0))
    (followed,) = problem.recordings
    told = dict(candidate_regressors(followed, np.ones((ROWS, 6)), 1.0, DEFAULT.locate))
    assert (
        "time: it acts in 100 to 105 s of run_0" in told
        and "time: it acts in 135 to 140 s of run_0" in told
    )


@pytest.mark.parametrize("diverging", ["above", "anywhere"])
def test_a_model_that_diverges_with_a_changed_coefficient_has_a_band(
    diverging: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    problem, retuned = laid(sail("fitted", 1, lambda t, y, command: np.zeros(3))[0])
    [whole] = missing_force(problem, retuned, problem.recordings)
    mean_average = missing_force_module._mean_average

    def diverges(problem: Problem, fit: Any, theta: Any, *rest: Any) -> Any:
        found = mean_average(problem, fit, theta, *rest)
        if diverging == "anywhere" or (theta > fit.theta).any():
            return np.full_like(found, np.nan)
        return found

    monkeypatch.setattr(missing_force_module, "_mean_average", diverges)
    [banded] = missing_force(problem, retuned, problem.recordings)
    assert np.array_equal(banded.mean, whole.mean)
    if diverging == "above":  # the derivative is taken to the other side
        assert banded.sd == pytest.approx(whole.sd, rel=0.02)
    else:
        assert np.isfinite(banded.sd).all() and (banded.sd > 0.0).all()
