"""What a random force does to the hull's energy: waves keep a hull moving, so one that brakes it stands for a law."""

import numpy as np

from boatsim.diagnosis.problem import Fit
from boatsim.diagnosis.search.candidate_sets import Sets

BRAKES = -0.3  # of the power that it could take, from where a force is said to brake


def waves_of(sets: Sets, best: Fit) -> str:
    """The oscillating force of a set; "" where it has none."""
    return next((n for n in best.effects if n in sets.unsteady), "")


def braking(sets: Sets, best: Fit) -> str:
    """The oscillating force of a set that takes energy out of the hull, as friction does; "" where it has none.

    What waves do comes back as damping: on the whole they give the hull energy. Friction of another law than the
    fitted damping oscillates with the hull as waves of its own rhythm would.
    """
    waves = waves_of(sets, best)
    return waves if waves and _share_of_power(sets, best) < BRAKES else ""


def _share_of_power(sets: Sets, best: Fit) -> float:
    """Mean power of the smoothed oscillating force, over what it would be were it in phase with the hull's rates."""
    problem, on = sets.problem, sets.problem.program.switches(best.effects)
    nq, swell = problem.program.module.NQ, problem.program.module.swell
    power, most = 0.0, 0.0
    for track in problem.recordings:
        values = problem.values(track, best.free, best.theta)
        states = track.smooth(values, on, best.levels).means
        force = states[:, 3 * nq + 1 : 5 * nq : 2] / swell(values, on).frequency
        rates = problem.program.body_rates(states[:, : 2 * nq])[:, nq:]
        force, rates = force - force.mean(axis=0), rates - rates.mean(axis=0)
        power += float(np.sum(force * rates))
        most += float(np.sum(np.sqrt(np.sum(force**2, axis=0) * np.sum(rates**2, axis=0))))
    return power / most if most > 0.0 else 0.0
