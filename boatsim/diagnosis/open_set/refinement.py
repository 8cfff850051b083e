"""Identified effects that are no missing physics: better values of numbers that are estimates."""

from math import hypot

from boatsim.diagnosis.problem import Fit, Problem
from boatsim.physics.base import Effect
from boatsim.physics.vessel import estimated_number_sd, sd_of_corrected_estimates


def refines_estimated_number(problem: Problem, best: Fit, name: str) -> bool:
    """Return whether an identified effect only refines a number that the file calls estimated.

    An effect that adds to such a number, as a load does to the mass, refines it as long as it is
    not clearly larger than the uncertainty of the number.

    Args:
        problem: The estimation problem: recordings, vessel model, candidate effects and priors.
        best: Fit of the vessel model with the effect.
        name: Name of the effect among the candidates.
    """
    vessel, effect = problem.program.vessel, problem.candidates[name]
    sd = sd_of_corrected_estimates(effect, vessel, vessel.estimated)
    return sd is not None and not _exceeds_uncertainty(problem, best, effect, sd)


def number_without_addition(problem: Problem, effect: Effect, parameter: str) -> float | None:
    """Return the number of the vessel file to which a parameter of an effect adds.

    Args:
        problem: The estimation problem: recordings, vessel model, candidate effects and priors.
        effect: The effect.
        parameter: Name of the parameter.

    Returns:
        Value of the number before the diagnosis; None if the parameter adds to none.
    """
    number = type(effect).adds_to.get(parameter)
    if number is None:
        return None
    owner, key = number.split(".")
    return float(problem.recordings[0].values[problem.index_of_parameter(owner, key)])


def _exceeds_uncertainty(problem: Problem, best: Fit, effect: Effect, sd: float) -> bool:
    """Whether an effect adds more to a number than the uncertainties of number and fit explain."""
    vessel = problem.program.vessel
    for parameter, number in type(effect).adds_to.items():
        before = number_without_addition(problem, effect, parameter)
        if before is None:
            continue
        owner, key = number.split(".")
        own = estimated_number_sd(owner, key, vessel, vessel.estimated) or sd
        added, fitted_sd = best.value(effect.name, parameter)
        if abs(added) > problem.config.decide.refined_spreads * hypot(own * before, fitted_sd):
            return True
    return False
