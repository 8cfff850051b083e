"""A craft with three azimuth drives, of which one does not turn as commanded: it is found.

Its direction turns slowly, lags, is late, or has play. If all of them are alike, that is one fault.

The recordings come from an integrator that shares no code with the tool."""

import numpy as np
import pytest
from driven_boats import platform_of_turning_drives
from scipy.integrate import odeint

from boatsim.diagnosis.candidates import candidate_library
from boatsim.diagnosis.fit import unfitted_hypothesis
from boatsim.diagnosis.prior_noise import prior_noise_levels
from boatsim.diagnosis.problem import Problem, free_parameter_values
from boatsim.diagnosis.recording_mapping import map_recording
from boatsim.diagnosis.search.candidate_sets import CandidateSets
from boatsim.diagnosis.search.equal_errors import merge_equal_errors
from boatsim.diagnosis.search.ranking import (
    Ranking,
    fit_baseline,
    select_and_rank_candidates,
)
from boatsim.physics.base import Array
from boatsim.physics.program import Program
from boatsim.recordings.table import Notes, Recording

MASS, INERTIA = 30.0, 4.0  # kg, kg m^2
DAMPING = np.array([6.0, 15.0, 6.0])  # N s/m, N s/m, N m s
PLACES = {"bow": (0.6, 0.0), "port": (-0.6, -0.3), "starboard": (-0.6, 0.3)}  # ahead, to starboard
RATE, ROWS, HOLD = 10.0, 900, 30  # Hz, rows of a recording, rows between two orders
AZIMUTH = ("azimuth_rate_limit", "azimuth_lag", "azimuth_delay", "azimuth_backlash")
TESTED = (
    "thrust_lag",
    "command_delay",
    "steering_rate_limit",
    "steering_backlash",
    *(f"{effect}_{drive}_rad" for effect in AZIMUTH for drive in PLACES),
    *(f"drive_rate_limit_{drive}_N" for drive in PLACES),
    "steering_lag",
    "steering_delay",
)


CRAFT = platform_of_turning_drives()


AT_ONCE = np.full(3, np.inf)  # rate of drives that turn without a limit
NONE = np.zeros(3)


def sailed(
    seed: int,
    fastest: Array = AT_ONCE,
    lag: Array = NONE,
    late: Array = NONE,
    play: Array = NONE,
) -> Recording:
    """A recording of random steps of all drives, whose directions are not those commanded.

    `fastest` are the largest rates of the directions [rad/s], `lag` their time constants [s],
    `late` their dead times in rows, and `play` the total play of their steering [rad].
    """
    rng = np.random.default_rng(seed)
    steps = ROWS // HOLD
    thrusts = np.repeat(rng.uniform(1.0, 8.0, (steps, 3)), HOLD, axis=0)
    directions = np.repeat(rng.uniform(-1.5, 1.5, (steps, 3)), HOLD, axis=0)
    followed = directions.copy()
    for i, rows in enumerate(late.astype(int)):
        followed[rows:, i] = directions[: ROWS - rows, i]
        followed[:rows, i] = directions[0, i]
    for row in range(1, ROWS):
        low, high = followed[row] - 0.5 * play, followed[row] + 0.5 * play
        followed[row] = np.clip(followed[row - 1], low, high)
    x, y = np.array(list(PLACES.values())).T

    def turned(time: float, order: Array, begin: Array) -> Array:
        most = fastest * max(time, 1e-12)
        slow = (order - begin) * -np.expm1(-time / np.maximum(lag, 1e-9))
        return begin + np.clip(slow, -most, most)

    def derivatives(
        s: Array, time: float, thrust: Array, order: Array, begin: Array
    ) -> list[float]:
        angle = turned(time, order, begin)
        ahead, right = thrust * np.cos(angle), thrust * np.sin(angle)
        u, v, r = s[3:]
        forces = np.array([ahead.sum(), right.sum(), x @ right - y @ ahead]) - DAMPING * s[3:]
        c, k = np.cos(s[2]), np.sin(s[2])
        rates = [u * c - v * k, u * k + v * c, r]
        return [*rates, forces[0] / MASS + r * v, forces[1] / MASS - r * u, forces[2] / INERTIA]

    s, poses, angle = np.zeros(6), [], followed[0]
    for thrust, order in zip(thrusts, followed, strict=True):
        poses.append(s[:3])
        s = odeint(derivatives, s, [0.0, 1.0 / RATE], args=(thrust, order, angle), rtol=1e-8)[-1]
        angle = turned(1.0 / RATE, order, angle)
    seen = np.array(poses) + rng.standard_normal((ROWS, 3)) * [0.005, 0.005, 0.003]
    signals = dict(zip(("x_m", "y_m", "psi_rad"), seen.T, strict=True))
    for i, drive in enumerate(PLACES):
        signals |= {f"{drive}_N": thrusts[:, i], f"{drive}_rad": directions[:, i]}
    return Recording(f"run_{seed}", np.arange(ROWS) / RATE, signals, Notes())


def problem_of(*recordings: Recording) -> Problem:
    effects = [e for e in candidate_library(CRAFT).compiled_effects if e.name in TESTED]
    program = Program(CRAFT, effects)
    mapped = [map_recording(recording, program) for recording in recordings]
    return Problem(mapped, prior_noise_levels(CRAFT, recordings), {"thrust": 0.05})


def ranked(*recordings: Recording) -> Ranking:
    return select_and_rank_candidates(problem_of(*recordings), TESTED)


PORT = np.arange(3) == 1


@pytest.mark.parametrize(
    ("fault", "effect", "parameter", "true"),
    [
        ({"fastest": np.where(PORT, 0.4, np.inf)}, "azimuth_rate_limit", "rate", 0.4),
        ({"lag": 0.8 * PORT}, "azimuth_lag", "time_constant", 0.8),
        ({"late": 6.0 * PORT}, "azimuth_delay", "delay", 0.6),
        ({"play": 0.3 * PORT}, "azimuth_backlash", "width", 0.3),
    ],
)
@pytest.mark.slow
def test_the_drive_that_does_not_turn_as_commanded_is_found_with_the_size_of_its_fault(
    fault: dict[str, Array], effect: str, parameter: str, true: float
) -> None:
    ranking = ranked(sailed(1, **fault), sailed(2, **fault))
    assert [one.name for one in ranking.named] == [f"{effect}_port_rad"]
    value, sd = ranking.best.value(f"{effect}_port_rad", parameter)
    assert abs(value - true) < max(4.0 * sd, 0.05 * true)
    assert sd < 0.2 * true


@pytest.mark.parametrize(
    ("fault", "effect", "parameter", "true"),
    [
        ({"lag": np.full(3, 0.8)}, "steering_lag", "time_constant", 0.8),
        ({"late": np.full(3, 6.0)}, "steering_delay", "delay", 0.6),
    ],
)
@pytest.mark.slow
def test_equal_faults_of_all_directions_are_one_fault(
    fault: dict[str, Array], effect: str, parameter: str, true: float
) -> None:
    ranking = ranked(sailed(1, **fault), sailed(2, **fault))
    assert [one.name for one in ranking.named] == [effect]
    value, sd = ranking.best.value(effect, parameter)
    assert abs(value - true) < max(4.0 * sd, 0.05 * true)
    assert sd < 0.2 * true


SINGLE_DELAYS = tuple(f"azimuth_delay_{drive}_rad" for drive in PLACES)


@pytest.mark.parametrize(
    ("rows", "wanted"),
    [
        ((6.0, 6.0, 6.0), {"steering_delay"}),
        ((2.0, 6.0, 6.0), set(SINGLE_DELAYS)),
    ],
)
@pytest.mark.slow
def test_single_delays_are_merged_if_they_are_equal_only(
    rows: tuple[float, ...], wanted: set[str]
) -> None:
    problem = problem_of(sailed(1, late=np.array(rows)))
    sets = CandidateSets(problem, TESTED, fit_baseline(problem).recalibrated)
    free = problem.free_parameters(SINGLE_DELAYS)
    begin = dict(
        zip(((name, "delay") for name in SINGLE_DELAYS), 0.1 * np.array(rows), strict=True)
    )
    theta = free_parameter_values(free, {**sets.base.values(), **begin})
    singles = sets.converged_fit(unfitted_hypothesis(SINGLE_DELAYS, free, theta, sets.base.levels))
    merged = merge_equal_errors(sets, singles)
    assert set(merged.effects) == wanted
    if wanted == {"steering_delay"}:
        assert merged.value("steering_delay", "delay")[0] == pytest.approx(0.6, abs=0.02)


@pytest.mark.slow
def test_no_fault_is_found_where_all_directions_turn_at_once() -> None:
    assert ranked(sailed(3), sailed(4)).named == ()
