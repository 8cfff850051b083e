"""The search: a look's promise against dense least squares, looks the filter does not bear out,
runs side by side."""

from dataclasses import replace

import numpy as np
import pytest
from pushed_boat import laid, push, sail

from boatsim.diagnosis.filter import FilterPass
from boatsim.diagnosis.fit import fit
from boatsim.diagnosis.problem import FilterPasses, Fit, Problem
from boatsim.diagnosis.search.candidate_sets import CandidateSets
from boatsim.diagnosis.search.evidence import quadratic_evidence_gain
from boatsim.diagnosis.search.pruning import differs_from_zero
from boatsim.diagnosis.search.screening import Linearisation, confirm_screening, screen
from boatsim.physics.base import Array


def a_third_more_astern(t: float, y: Array, command: Array) -> Array:
    return np.asarray(-0.33 * push(np.minimum(command[:2], 0.0), command[2:]))


@pytest.fixture(scope="module")
def weak() -> tuple[Problem, Fit]:
    return laid(*(sail(f"run_{k}", 40 + k, a_third_more_astern)[0] for k in range(2)))


def test_a_start_promises_what_least_squares_gains_by_a_multiple_of_it_beside_all_that_is_free() -> (
    None
):
    rng = np.random.default_rng(3)
    known, white, mark = (
        rng.standard_normal((50, 4)),
        rng.standard_normal(50),
        rng.standard_normal(50),
    )
    nothing = np.zeros((1, 1))
    passes = FilterPasses((FilterPass(0.0, white, nothing, nothing, nothing, nothing, 0.0),))
    inverse = np.linalg.inv(np.eye(4) + known.T @ known)
    begin = Linearisation(known, np.zeros(4), 0.0, passes, inverse)

    def cost(A: Array) -> float:
        """Of the best fit, with the priors of what was free before."""
        prior = np.zeros((4, A.shape[1]))
        prior[:, :4] = np.eye(4)
        b = np.concatenate([-white, np.zeros(4)])
        rows = np.vstack([A, prior])
        return 0.5 * float(np.sum((rows @ np.linalg.lstsq(rows, b, rcond=None)[0] - b) ** 2))

    gain = cost(known) - cost(np.column_stack([known, mark]))
    assert begin.predicted_gain(white + mark) == pytest.approx(gain, rel=1e-9)
    assert begin.predicted_gain(white - 7.0 * mark) == pytest.approx(
        gain, rel=1e-9
    )  # whatever its size


def test_a_look_that_the_filter_bears_out_stays_and_from_one_that_it_does_not_it_steps_on(
    weak: tuple[Problem, Fit],
) -> None:
    problem, base = weak
    look = screen(problem, base, ["weak_reverse"])["weak_reverse"]
    assert look.evidence > base.evidence + 10.0
    assert confirm_screening(problem, base, look) is look
    own = np.array([f.effect == "weak_reverse" for f in look.free])
    mean = np.array([f.mean for f in look.free])
    wild = replace(
        look, theta=np.where(own, mean - 2.5 * (look.theta - mean), look.theta)
    )  # strong, the wrong way
    honest = confirm_screening(problem, base, wild)
    assert honest is not wild and honest.theta[own] == pytest.approx(
        look.theta[own], abs=0.2
    )  # from the wrong side
    assert honest.evidence - base.evidence == pytest.approx(look.evidence - base.evidence, rel=0.2)


def test_a_member_is_worth_less_than_its_curvature_says_and_what_does_nothing_little(
    weak: tuple[Problem, Fit],
) -> None:
    problem, base = weak
    looks = screen(problem, base, ["weak_reverse", "steady_force"])
    found = fit(problem, looks["weak_reverse"])
    assert (
        quadratic_evidence_gain(found, "weak_reverse") > found.evidence - base.evidence > 100.0
    )  # the latent force takes its place
    both = fit(problem, screen(problem, found, ["steady_force"])["steady_force"])
    assert (
        quadratic_evidence_gain(both, "steady_force") < 10.0
        and quadratic_evidence_gain(both, "nothing of the kind") == 0.0
    )


@pytest.mark.parametrize("least_sd, expected", [(0.001, True), (0.25, False)])
def test_an_effect_acts_where_recordings_tell_a_number_of_it_whatever_they_leave_of_its_strength(
    weak: tuple[Problem, Fit], least_sd: float, expected: bool
) -> None:
    """A craft that never comes near the speed from which it planes: how far it is held back is
    seen, the speed not."""
    problem, base = weak
    free = problem.free_parameters(("planing_lag",))
    at = {f.name: i for i, f in enumerate(free) if f.effect == "planing_lag"}
    theta, sd = np.array([f.mean for f in free]), np.array([f.sd for f in free])
    theta[at["full_speed"]], theta[at["least"]], sd[at["least"]] = (
        sd[at["full_speed"]],
        0.5,
        least_sd,
    )
    found = replace(
        base, effects=("planing_lag",), free=free, theta=theta, covariance=np.diag(sd**2)
    )
    assert (
        differs_from_zero(CandidateSets(problem, ("planing_lag",), base), found, "planing_lag")
        is expected
    )
