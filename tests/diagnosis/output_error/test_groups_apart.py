"""Free runs of a recording are not repeated for what concerns other groups of recordings."""

from dataclasses import replace

import numpy as np
import pytest
from pushed_boat import laid, sail

from boatsim.diagnosis.output_error.errors import OutputErrors, output_errors
from boatsim.diagnosis.problem import Fit, Problem
from boatsim.diagnosis.search.screening import add_effect, starting_points
from boatsim.physics.base import Array
from boatsim.recordings.table import Recording

EFFECT = "steady_force"


def undisturbed(t: float, y: Array, command: Array) -> Array:
    return np.zeros(3)


def sailed(name: str, group: str, seed: int) -> Recording:
    run, _ = sail(name, seed, undisturbed)
    return replace(run, notes=replace(run.notes, groups=(group,)))


@pytest.fixture(scope="module")
def two_groups() -> tuple[Problem, Fit, OutputErrors]:
    problem, base = laid(sailed("a red one", "red", 1), sailed("a blue one", "blue", 2))
    return problem, base, output_errors(problem, base, problem.recordings, problem.horizon)


def with_effect(problem: Problem, base: Fit, name: str) -> Fit:
    """The fit with a candidate effect, which changes the motion."""
    point = starting_points(problem, problem.candidates[name])[0]
    start = add_effect(problem, base, name, point)
    own = [i for i, parameter in enumerate(start.free) if parameter.effect == name]
    theta = start.theta.copy()
    theta[own] = [0.3 * start.free[i].sd for i in own]
    return replace(start, theta=theta)


def test_an_effect_of_one_group_changes_and_costs_the_free_runs_of_that_group_alone(
    two_groups: tuple[Problem, Fit, OutputErrors],
) -> None:
    problem, base, errors = two_groups
    assert [mapped.groups for mapped in problem.recordings] == [("red",), ("blue",)]
    starts = errors.starts(base)
    before = errors.residuals(base, starts)

    def with_work(name: str) -> tuple[list[bool], Array]:
        """Whether each recording was simulated with an effect, and the errors."""
        fit = with_effect(problem, base, name)
        work = [mapped.filtered.work for mapped in problem.recordings]
        found = errors.residuals(fit, starts)
        each = zip(problem.recordings, work, strict=True)
        return [mapped.filtered.work > before for mapped, before in each], found

    red, in_red = with_work(f"{EFFECT}@red")
    blue, in_blue = with_work(f"{EFFECT}@blue")
    common, in_both = with_work(EFFECT)
    assert red == [True, False] and blue == [False, True]
    assert common == [False, False]  # both were simulated with the effect before
    of_red = in_red != before
    assert of_red.any() and not of_red.all()
    assert (in_red[of_red] == in_both[of_red]).all()
    assert (in_blue[of_red] == before[of_red]).all()
