"""Priors of the estimation problem on hulls of any size, and coefficients that are refitted."""

from dataclasses import replace

import numpy as np
import pytest
from unmeasured import unmeasured

from boatsim.diagnosis.filter import NoiseLevels
from boatsim.diagnosis.problem import Problem
from boatsim.physics import vessel
from boatsim.physics.effects.damping import QuadraticDamping
from boatsim.physics.effects.rate_limit import SteeringRateLimit
from boatsim.physics.effects.wave_forcing import WaveForcing
from boatsim.physics.effects.wind import Wind
from boatsim.physics.program import Program
from boatsim.physics.vessel import Vessel

REFERENCE_LENGTH = 1.2  # [m] of the hull for which effects state their priors


def problem_of(boat: Vessel, *candidates: object, uncertain: str = "damping") -> Problem:
    """An estimation problem with one recording in which nothing was measured."""
    program = Program(boat, candidates)
    mapped = unmeasured(program)
    levels = NoiseLevels(np.ones(3), 1.0, {"heading_sd_rad": 0.01})
    return Problem([mapped], levels, {uncertain: 0.1})


@pytest.mark.parametrize("name", ["joystick_boat", "catamaran", "mariner"])
def test_frequencies_and_rates_scale_with_the_root_of_the_length(name: str) -> None:
    """Mean and sd of a prior follow the same law: waves of a longer ship are slower (Froude)."""
    boat = vessel.load_vessel(name)
    waves, limit = WaveForcing(name="wave_forcing"), SteeringRateLimit(name="steering_rate_limit")
    problem = problem_of(boat, waves, limit)
    slower = (boat.length / REFERENCE_LENGTH) ** -0.5
    free = {
        f.name: f for f in problem.free_parameters(("wave_forcing",)) if f.effect == "wave_forcing"
    }
    assert free["frequency"].mean == pytest.approx(3.0 * slower)
    assert free["frequency"].sd == pytest.approx(1.5 * slower)
    assert free["damping"].mean == pytest.approx(0.08)  # a ratio has the same value on any hull


@pytest.mark.parametrize("name", ["joystick_boat", "catamaran", "mariner"])
def test_the_expected_force_of_a_wind_is_that_of_one_wind_speed_on_every_hull(name: str) -> None:
    """A breeze of 5 m/s on the side, of 0.3 L B; drag coefficient 0.9, air of 1.2 kg/m^3."""
    boat = vessel.load_vessel(name)
    free = problem_of(boat, Wind(name="wind")).free_parameters(("wind",))
    [force] = [f for f in free if (f.effect, f.name) == ("wind", "force")]
    breeze = 0.5 * 1.2 * 0.9 * 5.0**2 * 0.3 * boat.length * boat.beam
    assert force.sd == pytest.approx(breeze, rel=0.03)


def test_a_problem_with_another_prior_leaves_the_first_one_and_its_copies_as_they_are() -> None:
    waves = WaveForcing(name="wave_forcing")
    problem = problem_of(vessel.load_vessel("joystick_boat"), waves)
    other = problem.with_recordings(problem.recordings).with_spread("wave_forcing", 123.0)

    def spreads(of: Problem) -> set[float]:
        free = of.free_parameters(("wave_forcing",))
        return {f.sd for f in free if f.effect == "wave_forcing"}

    assert spreads(other) == {123.0} and not problem.spreads
    assert 123.0 not in spreads(problem)


def test_all_damping_coefficients_of_a_vessel_are_refitted() -> None:
    boat = vessel.load_vessel("catamaran")
    quadratic = QuadraticDamping(name="quadratic_damping", sway=20.0, yaw=1.0)
    heavier = replace(boat, effects=(*boat.effects, quadratic))
    found = {(f.effect, f.name) for f in problem_of(heavier).nominal_coefficients}
    assert {("quadratic_damping", "sway"), ("quadratic_damping", "yaw")} <= found
    assert ("quadratic_damping", "surge") not in found  # zero in the file
    assert ("linear_damping", "yaw") in found


def test_a_refitted_coefficient_stays_within_what_a_vessel_file_allows() -> None:
    """A log that fits no thrust, as a mirrored one, else ends in a vessel that is refused."""
    boat = vessel.load_vessel("catamaran")
    effects = {effect.name: effect for effect in boat.effects}
    found = problem_of(boat, uncertain="thrust").nominal_coefficients
    gains = [free for free in found if free.name == "gain"]
    assert gains
    for free in gains:
        drive = effects.get(free.effect) or next(
            one for one in boat.effects if type(one).type_name() == free.effect
        )
        param = type(drive).params()["gain"]
        assert free.low * drive.gain >= param.low and free.high * drive.gain <= param.high
