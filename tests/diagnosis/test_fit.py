"""How fits are found: a climb without a gradient, derivatives learnt from steps, a filter that
follows the boat."""

from dataclasses import replace

import numpy as np
import pytest
from jet_craft import Craft, sailed

from boatsim.diagnosis.candidates import program_with_candidates
from boatsim.diagnosis.coordinate_search import maximize
from boatsim.diagnosis.fit import broyden_update
from boatsim.diagnosis.prior_noise import prior_noise_levels
from boatsim.diagnosis.recording_mapping import map_recording
from boatsim.physics import vessel
from boatsim.physics.base import Array

TOP = np.array([2.0, -1.0, 0.3])
BEND = np.array([[40.0, 12.0, 0.0], [12.0, 30.0, -5.0], [0.0, -5.0, 20.0]])


def hill(x: Array) -> float:
    return float(-0.5 * (x - TOP) @ BEND @ (x - TOP))


def test_a_climb_ends_near_the_top_and_says_how_high_it_is() -> None:
    best, x = maximize(hill, np.zeros(3), 0.5, 0.3)
    assert best == pytest.approx(hill(x)) and best > -0.3
    assert x == pytest.approx(TOP, abs=0.15)


def test_at_the_top_each_coordinate_is_looked_at_once() -> None:
    asked = []

    def score(x: Array) -> float:
        asked.append(x.copy())
        return hill(x)

    maximize(score, TOP, 0.5, 0.01)
    # where it begins; then a step on either side, and the parabola's top unless it is the begin
    assert 1 + 2 * len(TOP) <= len(asked) <= 1 + 3 * len(TOP)
    assert len({x.tobytes() for x in asked}) == len(asked)  # no point twice


def test_what_never_rises_is_left_where_it_is() -> None:
    best, x = maximize(lambda x: -np.inf if x.any() else 1.0, np.zeros(2), 0.5, 0.3)
    assert best == 1.0 and not x.any()


def test_derivatives_learnt_from_a_step_agree_with_it_and_stay_across_it() -> None:
    rng = np.random.default_rng(0)
    J, true, step = (
        rng.standard_normal((7, 3)),
        rng.standard_normal((7, 3)),
        np.array([0.2, -0.1, 0.4]),
    )
    found = broyden_update(J, true @ step, step)
    assert found @ step == pytest.approx(true @ step)
    across = np.array([1.0, 2.0, 0.0])  # at right angles to the step
    assert found @ across == pytest.approx(J @ across)
    assert (broyden_update(J, np.zeros(7), np.zeros(3)) == J).all()


@pytest.mark.slow
def test_the_filter_follows_drag_that_dies_out_faster_than_its_steps_and_as_shorter_steps_do() -> (
    None
):
    boat = vessel.load_vessel("jet_ski")
    run = sailed(Craft(cube=0.2), np.repeat([2.0, 6.0, 3.0], 50), np.zeros(150), 5.0)
    program = program_with_candidates(boat, ["cubic_damping"])
    said = []
    for share in (1.0, 0.1):
        laid = map_recording(run, program)
        laid = replace(laid, specified_step=share * laid.largest_step)
        values = laid.values.copy()
        # 15 /s at 5 m/s; at rest the craft has less than 1 /s
        values[program.parameter_index("cubic_damping", "surge")] = 90.0
        levels = prior_noise_levels(boat, [run])
        said.append(
            laid.log_likelihood(values, program.effect_switches(("cubic_damping",)), levels)
        )
    assert np.isfinite(said).all() and said[0] == pytest.approx(said[1], abs=3.0)


def test_a_recording_that_begins_at_full_speed_is_followed_from_its_first_row_on() -> None:
    """The filter knows nothing of the speed it begins at; linearised at rest it went far astray."""
    boat, craft = vessel.load_vessel("jet_ski"), Craft()
    run = sailed(craft, np.full(100, 4.0), np.repeat([0.1, -0.1], 50), 24.0)
    del run.signals["u_mps"]
    program = program_with_candidates(boat, ["cubic_damping"])
    laid = map_recording(run, program)
    means, covariances, _ = laid.smooth(
        laid.values, program.effect_switches(), prior_noise_levels(boat, [run])
    )
    assert laid.initial_state_prior.rates[0] == pytest.approx(
        24.0, abs=1.5
    )  # of noisy fixes a second apart
    speed, sd = (
        means[0, program.module.NQ],
        covariances[0, program.module.NQ, program.module.NQ] ** 0.5,
    )
    assert speed == pytest.approx(24.0, abs=4.0 * sd) and sd < 0.5
    still = laid.initial_state_prior._replace(rates=np.zeros(4))
    laid = replace(laid, specified_initial=still)
    assert laid.smooth(laid.values, program.effect_switches(), prior_noise_levels(boat, [run]))[0][
        0, 4
    ] == pytest.approx(speed, abs=0.1 * sd)  # however wrong the guess


def test_a_recording_without_positions_begins_at_the_speeds_that_it_shows() -> None:
    boat = vessel.load_vessel("jet_ski")
    run = sailed(Craft(), np.full(100, 4.0), np.repeat([0.1, -0.1], 50), 24.0)
    for name in ("x_m", "y_m"):
        del run.signals[name]
    run.signals["psi_rad"] = run.signals["psi_rad"] + 2.0
    program = program_with_candidates(boat, ["cubic_damping"])
    laid = map_recording(run, program)
    assert laid.initial_state_prior.rates[:2] == pytest.approx(
        [24.0 * np.cos(2.0), 24.0 * np.sin(2.0)], abs=0.5
    )
    means = laid.smooth(
        laid.values, program.effect_switches(), prior_noise_levels(boat, [run])
    ).means
    assert np.hypot(*means[0, 4:6]) == pytest.approx(24.0, abs=0.3)


def test_the_order_of_independent_calls_changes_no_number() -> None:
    boat = vessel.load_vessel("jet_ski")
    run = sailed(Craft(), np.full(60, 4.0), np.repeat([0.1, -0.1], 30), 24.0)
    program = program_with_candidates(boat, ["cubic_damping"])
    laid, levels = map_recording(run, program), prior_noise_levels(boat, [run])
    on, more = program.effect_switches(), program.effect_switches(("cubic_damping",))
    rough = replace(levels, force=2.0 * levels.force)

    def everything(first: bool) -> list[Array]:
        about = laid.filter(laid.values, on, levels)
        if first:  # calls in between that once changed what a later one returned
            laid.filter(1.01 * laid.values, more, rough)
            laid.smooth(laid.values, more, rough)
        other = laid.filter(laid.values, on, rough, about)
        if first:
            laid.filter(laid.values, more, levels)
        errors = laid.whitened_errors(1.001 * laid.values, on, levels, about)
        smoothed = laid.smooth(laid.values, on, levels)
        (_, states), *_ = laid.free_runs(laid.values, on, levels, 5.0)
        numbers = np.array(
            [about.log_likelihood, other.log_likelihood, about.log_density_at_predictions]
        )
        return [numbers, about.whitened, other.whitened, errors, *smoothed, states]

    for one, other in zip(everything(first=True), everything(first=False), strict=True):
        np.testing.assert_array_equal(one, other)
    with pytest.raises(ValueError, match="read-only"):
        laid.filter(laid.values, on, levels).whitened[0] = 1.0


def test_kept_results_are_those_of_the_given_noise_levels_and_values() -> None:
    """Results of a recording are kept: other arguments, in any order of calls, give other ones."""
    boat = vessel.load_vessel("jet_ski")
    run = sailed(Craft(), np.full(60, 4.0), np.repeat([0.1, -0.1], 30), 10.0)
    program = program_with_candidates(boat, ["cubic_damping"])
    on, levels = program.effect_switches(), prior_noise_levels(boat, [run])
    sensors = {name: 2.0 * sd for name, sd in levels.sensors.items()}
    changed = [
        levels,
        replace(levels, force=2.0 * levels.force),
        replace(levels, time_constant=2.0 * levels.time_constant),
        replace(levels, sensors=sensors),
        replace(levels, initial_force=np.full(len(levels.force), 1e3)),
    ]
    laid = map_recording(run, program)
    stronger = laid.values.copy()
    stronger[program.parameter_index("surge_drag", "linear")] *= 1.5
    cases = [(laid.values, one) for one in changed] + [(stronger, levels)]
    together = []
    for values, one in cases:
        about = laid.filter(values, on, one)
        errors = laid.whitened_errors(laid.values, on, one, about)
        again = laid.log_likelihood(stronger, on, one, about)
        together.append((about.log_likelihood, errors, again, laid.smooth(values, on, one).means))
    for found, (values, one) in reversed(list(zip(together, cases, strict=True))):
        alone = map_recording(run, program)
        about = alone.filter(values, on, one)
        assert np.array_equal(found[3], alone.smooth(values, on, one).means)
        assert np.array_equal(found[1], alone.whitened_errors(laid.values, on, one, about))
        assert found[0] == about.log_likelihood
        assert found[2] == alone.log_likelihood(stronger, on, one, about)
    assert len({found[0] for found in together}) == len(cases)
