"""Energy balance of a stochastic force: one that brakes the hull stands for a missing law.

Waves excite a hull, and what they do comes back as damping: on the whole they give energy to it.
Friction of another law than the fitted damping oscillates like waves at the
frequency of the hull, but takes energy from it.
"""

import numpy as np

from boatsim.diagnosis.problem import Fit
from boatsim.diagnosis.search.candidate_sets import CandidateSets


def oscillating_force_name(sets: CandidateSets, best: Fit) -> str:
    """Return the name of the oscillating stochastic force of a fit, such as waves; "" without one.

    Args:
        sets: Cache of the fits of candidate sets, with the estimation problem.
        best: Fit of the vessel model with some candidate effects.
    """
    return next((name for name in best.effects if name in sets.unsteady), "")


def dissipative_force_name(sets: CandidateSets, best: Fit) -> str:
    """Return the name of a fit's oscillating force if that force takes energy from the hull, or "".

    Waves give energy to a hull. A force that brakes it only imitates a missing damping law.

    Args:
        sets: Cache of the fits of candidate sets, with the estimation problem.
        best: Fit of the vessel model with some candidate effects.
    """
    name = oscillating_force_name(sets, best)
    if name and _share_of_power(sets, best) < sets.config.select.braking_share:
        return name
    return ""


def _share_of_power(sets: CandidateSets, best: Fit) -> float:
    """Mean power of the smoothed oscillating force, relative to one in phase with the rates."""
    problem, on = sets.problem, sets.problem.program.effect_switches(best.effects)
    nq, swell = problem.program.module.NQ, problem.program.estimation_functions.oscillating_force
    power, largest = 0.0, 0.0
    for mapped in problem.recordings:
        values = problem.parameter_vector(mapped, best.free, best.theta)
        states = mapped.smooth(values, on, best.levels).means
        force = states[:, 3 * nq + 1 : 5 * nq : 2] / swell(values, on).frequency
        rates = problem.program.to_body_velocities(states[:, : 2 * nq])[:, nq:]
        force = force - force.mean(axis=0)
        rates = rates - rates.mean(axis=0)
        power += float(np.sum(force * rates))
        squares = np.sum(force**2, axis=0) * np.sum(rates**2, axis=0)
        largest += float(np.sum(np.sqrt(squares)))
    return power / largest if largest > 0.0 else 0.0
