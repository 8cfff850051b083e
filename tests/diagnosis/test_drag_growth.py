"""Growing resistance is named with its rate, not where the resistance stays, and between days it is
found as damping of one day."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from alike import long
from answers import diagnosed, named, nothing_missing
from pushed_boat import BOAT, push, sail
from simulated_runs import simulated

from boatsim.diagnosis.candidates import candidate_library
from boatsim.diagnosis.prior_noise import prior_noise_levels
from boatsim.diagnosis.problem import Problem
from boatsim.diagnosis.recording_mapping import map_recording
from boatsim.diagnosis.search.ranking import Ranking, select_and_rank_candidates
from boatsim.physics.base import Array
from boatsim.physics.groups import group_of
from boatsim.physics.program import Program

RATE = 0.1  # [N s/m^2] in 40 s as much as the boat's own drag at 0.7 m/s
LATE = 1000.0  # [s] by which the clock of a log may be ahead
OWN, FOULED = 3.0, 1.5  # [N s/m] surge damping, and its factor on the second day
DAMPED = ("damping_error", "drag_growth", "towed_drag", "thrust_gain_error", "payload")
KNOWN, ROUGH = 0.05, 0.3  # relative uncertainty of the damping in the vessel file
PUSHED = {"thrust_N": (0.0, 20.0), "azimuth_rad": (-1.2, 1.2)}


def weed(t: float, y: Array, _: Array) -> Array:
    return np.array([-RATE * t * abs(y[3]) * y[3], 0.0, 0.0])


def emptier_battery(t: float, _: Array, commands: Array) -> Array:
    return -0.008 * t * push(commands[:2], commands[2:])


def clean(_: float, __: Array, ___: Array) -> Array:
    return np.zeros(3)


def fouled(_: float, y: Array, __: Array) -> Array:
    return np.array([-(FOULED - 1.0) * OWN * y[3], 0.0, 0.0])


@pytest.mark.slow
@pytest.mark.parametrize("ahead", [0.0, LATE])
def test_growing_drag_is_named_with_its_rate_on_any_clock(tmp_path: Path, ahead: float) -> None:
    runs = [sail(f"run_{seed}", seed, weed)[0] for seed in (1, 2, 3)]
    runs = [replace(run, t=run.t + ahead) for run in runs]
    named(diagnosed(runs, tmp_path, "trial_boat"), "drag_growth", {"rate_Nspm2": RATE})


@pytest.mark.slow
def test_nothing_is_named_where_the_drag_stays(tmp_path: Path) -> None:
    nothing_missing(
        diagnosed([sail(f"run_{k}", k, clean)[0] for k in (1, 2, 3)], tmp_path, "trial_boat")
    )


@pytest.mark.slow
def test_thrust_that_falls_with_time_is_not_taken_for_growing_drag(tmp_path: Path) -> None:
    runs = [sail(f"run_{seed}", seed, emptier_battery)[0] for seed in (1, 2, 3)]
    answer = diagnosed(runs, tmp_path, "trial_boat")
    assert "drag_growth" in answer["tried"]
    assert "drag_growth" not in [one["name"] for one in answer["effects"]]


@pytest.mark.parametrize("rate", [long(0.3), long(0.0)])
def test_on_another_vessel_it_is_named_only_where_it_acts(tmp_path: Path, rate: float) -> None:
    more = [{"use": "drag_growth", "rate": rate}] if rate else []
    runs = [simulated("catamaran", PUSHED, seed, more) for seed in (1, 2, 3)]
    answer = diagnosed(runs, tmp_path, "catamaran")
    entries = {one["name"]: one["parameters"] for one in answer["effects"]}
    assert ("drag_growth" in entries) == (rate > 0.0)
    if rate:
        found = entries["drag_growth"]["rate_Nspm2"]
        assert abs(found["value"] - rate) < 3.5 * found["sd"] < 0.3 * rate


def ranked_days(damping: float) -> Ranking:
    """The selection from two days, with a relative uncertainty of the damping in the file."""
    runs = []
    for seed, day in enumerate(("april", "april", "june", "june")):
        run, _ = sail(f"{day}_{seed}", seed, fouled if day == "june" else clean)
        runs.append(replace(run, notes=replace(run.notes, groups=(day,))))
    program = Program(BOAT, candidate_library(BOAT, facts={"begin_s": 0.0}).compiled_effects)
    mapped = [map_recording(run, program) for run in runs]
    levels = prior_noise_levels(BOAT, runs)
    problem = Problem(mapped, levels, {"damping": damping, "thrust": 0.05})
    tested = (*DAMPED, *problem.candidates_in_single_groups(DAMPED))
    return select_and_rank_candidates(problem, tested)


@pytest.mark.slow
def test_drag_that_grew_between_two_days_is_named_on_the_day_that_differs_from_the_file() -> None:
    ranking = ranked_days(KNOWN)
    [one] = ranking.named
    assert one.name == "damping_error@june" and not one.tied_groups
    factor, sd = ranking.best.value(one.name, "surge_factor")
    assert abs(factor - FOULED) < max(3.5 * sd, 0.1)


@pytest.mark.slow
def test_where_the_damping_in_the_file_is_rough_either_day_may_be_the_odd_one() -> None:
    ranking = ranked_days(ROUGH)
    [one] = ranking.named
    days = {group_of(one.name), *one.tied_groups}
    assert days == {"april", "june"} and not one.tied_with
    factor, sd = ranking.best.value(one.name, "surge_factor")
    true = FOULED if group_of(one.name) == "june" else 1.0 / FOULED
    assert abs(factor - true) < max(3.5 * sd, 0.1)
