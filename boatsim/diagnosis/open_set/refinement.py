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


def vessel_number(problem: Problem, number: str) -> float:
    """Return a number of the vessel file as it was before the diagnosis.

    Args:
        problem: The estimation problem: recordings, vessel model, candidate effects and priors.
        number: Its owner, an effect or "body", and its name, such as "body.mass".
    """
    owner, key = number.split(".")
    return float(problem.recordings[0].values[problem.index_of_parameter(owner, key)])


def _exceeds_uncertainty(problem: Problem, best: Fit, effect: Effect, sd: float) -> bool:
    """Whether an effect adds more to a number than the uncertainties of number and fit explain."""
    vessel, most = problem.program.vessel, problem.config.decide.largest_refined_addition
    for parameter, number in type(effect).adds_to.items():
        owner, key = number.split(".")
        own = estimated_number_sd(owner, key, vessel, vessel.estimated) or sd
        added, fitted_sd = best.value(effect.name, parameter)
        if abs(added) > most * hypot(own * vessel_number(problem, number), fitted_sd):
            return True
    return False
