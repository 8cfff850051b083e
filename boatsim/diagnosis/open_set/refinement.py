"""Identified effects that are no missing physics: better values of numbers that are estimates."""

from boatsim.diagnosis.problem import Problem
from boatsim.physics.vessel import sd_of_corrected_estimates


def refines_estimated_number(problem: Problem, name: str) -> bool:
    """Return whether a candidate effect only refines a number that the vessel file calls estimated.

    Args:
        problem: The estimation problem: recordings, vessel model, candidate effects and priors.
        name: Name of the candidate.
    """
    vessel = problem.program.vessel
    return sd_of_corrected_estimates(problem.candidates[name], vessel, vessel.estimated) is not None
