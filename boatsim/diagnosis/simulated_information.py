"""Information of free runs over the recordings about the parameters of a fit.

The Kalman filter learns a parameter also from motions that nothing known causes: a boat that never
turns still sways a little, and the filter reads mass and damping in sway from that. Such values
follow the assumed disturbance and do not carry over to a boat that turns. A free run has only the
recorded commands, so that it depends on a parameter only as far as these excite it.
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from boatsim.diagnosis.free_runs import (
    FAMILIES,
    FreeRun,
    free_run_horizon,
    free_runs,
    mean_square,
)
from boatsim.diagnosis.problem import Fit, Problem, prior_arrays
from boatsim.physics.base import Array

FITTED, CHANGED = "fitted", "changed"  # the vessels that are compared


def covariance_by_simulations(problem: Problem, found: Fit) -> Array:
    """Return the covariance of the parameters of a fit, given only free runs over its recordings.

    The prior is combined with the sensitivity of the free runs to each parameter. Each recorded
    signal of a run counts as a single observation, with the mean square error of the fit as its
    variance: the disturbance of a boat under way also changes the state in which a run starts, so
    that more rows give no more information on the response to commands. A body without commands is
    excited by its first state alone, and a signal counts as many times as it has independent
    errors.

    Args:
        problem: The estimation problem: recordings, vessel model, candidate effects and priors.
        found: Converged fit of the vessel model with some candidate effects.

    Returns:
        Covariance (F, F) of the free parameters; that of the prior where no run depends on them.
    """
    prior = prior_arrays(found.free)
    horizon = free_run_horizon(problem, problem.recordings)
    runs = free_runs(problem, {FITTED: found}, problem.recordings, horizon)
    changed, steps = list[list[FreeRun]](), list[float]()
    for j, sd in enumerate(prior.sd):
        step = min(problem.config.fit.simulated_step * sd, np.sqrt(found.covariance[j, j]))
        if found.theta[j] + step > prior.high[j]:
            step = -step
        theta = found.theta.copy()
        theta[j] += step
        model = replace(found, theta=theta)
        changed.append(free_runs(problem, {CHANGED: model}, problem.recordings, horizon))
        steps.append(step)
    information = np.diag(1.0 / prior.sd**2)
    commanded = bool(problem.program.vessel.commands)
    for signals in FAMILIES.values():
        errors = [error for run in runs for error in run.deviations(FITTED, signals)]
        variance = mean_square(errors) if errors else np.nan
        if not 0.0 < variance < np.inf:  # nothing was recorded, or a simulated boat diverges
            continue
        for i, run in enumerate(runs):
            others = [each[i] for each in changed]
            for signal in signals:
                if signal in run.channels["recorded"]:
                    slopes = _slopes(run, others, steps, signal)
                    [error] = run.deviations(FITTED, [signal])
                    count = 1.0 if commanded else independent_count(error)
                    rows = max(slopes.shape[1], 1)
                    information += count / rows * slopes @ slopes.T / variance
    return np.asarray(np.linalg.inv(information))


def independent_count(errors: Array) -> float:
    """Return the number of independent values among errors, between 1 and their number.

    It is their number over the integrated autocorrelation time, whose sum ends at the first
    correlation that is not positive (C. J. Geyer, Practical Markov chain Monte Carlo, Statistical
    Science 1992). The mean is not removed, because an error of one sign is a single value.

    Args:
        errors: Errors (M,) in the order of time; nan are left out.
    """
    known = errors[np.isfinite(errors)]
    if len(known) < 2 or not known.any():
        return 1.0
    correlation = np.correlate(known, known, "full")[len(known) - 1 :]
    correlation = correlation / correlation[0]
    positive = int(np.argmax(np.append(correlation, 0.0) <= 0.0))
    return max(1.0, len(known) / (2.0 * float(correlation[:positive].sum()) - 1.0))


def _slopes(run: FreeRun, others: Sequence[FreeRun], steps: Sequence[float], signal: str) -> Array:
    """Derivatives (F, M) of a simulated signal by the parameters, in the rows where all exist."""
    simulated = run.channels[FITTED][signal]
    slopes = []
    for other, step in zip(others, steps, strict=True):
        slopes.append((other.channels[CHANGED][signal] - simulated) / step)
    found = np.array(slopes).reshape(len(slopes), len(simulated))
    return np.asarray(found[:, np.isfinite(found).all(axis=0)])
