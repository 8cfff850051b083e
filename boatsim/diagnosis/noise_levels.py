"""Fits how noisy sensors and water are: sensor noise, level and correlation time of the latent force."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from boatsim.diagnosis.coordinate_search import climbed
from boatsim.diagnosis.filter import NoiseLevels
from boatsim.diagnosis.problem import Fit, Problem
from boatsim.physics.base import Array, Wandering

FORCE_PRIOR = (0.3, 1.5)  # sd of log rms of the latent force below and above the ambient level
SENSOR_PRIOR = 0.4  # sd of log noise about the stated one
ROUGH, FINE = (
    2.0,
    0.3,
)  # [nats] that levels are near enough their best, once more and for a first fit
LEAST = 1 / 10  # of the tolerated force, which a level is at least: no law is better than that
QUIETEST = (
    1 / 10
)  # of the stated or sensed noise, which a sensor is off by at least: no log is better than that
LOOSER = 10  # times that the force is raised e-fold until the filter follows a recording
TIME_PRIOR = 0.7  # sd of log time constant


def force_prior(problem: Problem, levels: NoiseLevels) -> float:
    """Log prior of the latent force: near the ambient level, more is likelier than less."""
    over = np.log(levels.force / problem.ambient.force)
    return float(
        np.sum(-0.5 * np.where(over > 0, over / FORCE_PRIOR[1], over / FORCE_PRIOR[0]) ** 2)
    )


def _forces(problem: Problem, logs: Array) -> Array:
    """Levels of the latent force from their logarithms: however calm the water, a model is no better than so much."""
    return np.maximum(np.exp(logs), LEAST * problem.ambient.force)


def _sensors(families: Sequence[str], logs: Array, stated: Array) -> dict[str, float]:
    """Noise of each family from its logarithm: however exact a log seems, so much of the stated one is left."""
    return dict(
        zip(families, np.maximum(np.exp(logs), QUIETEST * np.exp(stated)).tolist(), strict=True)
    )


def fit_force(problem: Problem, found: Fit, enough: float = ROUGH) -> Fit:
    """A hypothesis with the latent-force level of each axis refitted, and with it the spectra it has (`searched`).

    Where the error of an instrument wanders, the noise of the instruments with them: it was fitted without that error.
    """
    on = problem.program.switches(found.effects)
    searched = [j for j, f in enumerate(found.free) if f.searched]
    low = np.array([found.free[j].low for j in searched])
    high = np.array([found.free[j].high for j in searched])
    mean = np.array([found.free[j].mean for j in searched])
    sd = np.array([found.free[j].sd for j in searched])
    wanders = any(
        isinstance(e, Wandering) and e.name in found.effects for e in problem.program.candidates
    )
    families = sorted({f for t in problem.recordings for f in t.families}) if wanders else []
    stated = np.log([problem.ambient.sensors[f] for f in families])
    k, n = len(searched), len(searched) + len(families)

    def placed(x: Array) -> tuple[NoiseLevels, Array]:
        theta = found.theta.copy()
        theta[searched] = np.clip(x[:k] * sd, low, high)
        sensors = _sensors(families, x[k:n], stated)
        force = _forces(problem, x[n:])
        return replace(
            found.levels, force=force, sensors={**found.levels.sensors, **sensors}
        ), theta

    def score(x: Array) -> float:
        levels, theta = placed(x)
        prior = -0.5 * float(
            np.sum(((theta[searched] - mean) / sd) ** 2)
            + np.sum(((x[k:n] - stated) / SENSOR_PRIOR) ** 2)
        )
        return (
            problem.likelihood(found.free, theta, on, levels, fresh=False)
            + force_prior(problem, levels)
            + prior
        )

    problem.likelihood(found.free, found.theta, on, found.levels)
    noise = np.log([found.levels.sensors[f] for f in families])
    begin = np.concatenate([found.theta[searched] / sd, noise, np.log(found.levels.force)])
    levels, theta = placed(climbed(score, begin, 0.5, enough)[1])
    return replace(found, levels=levels, theta=theta)


def fit_noise(problem: Problem, found: Fit) -> Fit:
    """A hypothesis with sensor noise and latent-force levels fitted, parameters as they are."""
    families = sorted({f for t in problem.recordings for f in t.families})
    n = len(problem.ambient.force)
    on = problem.program.switches(found.effects)
    stated = np.log([problem.ambient.sensors[f] for f in families])
    rough = np.log([_roughness(problem, f) or problem.ambient.sensors[f] for f in families])

    def levels(x: Array) -> NoiseLevels:
        sensors = {**problem.ambient.sensors, **_sensors(families, x[n:], stated)}
        return replace(problem.ambient, force=_forces(problem, x[:n]), sensors=sensors)

    def score(x: Array, fresh: bool = False) -> float:
        prior = -0.5 * float(np.sum(((x[n:] - stated) / SENSOR_PRIOR) ** 2))
        likelihood = problem.likelihood(found.free, found.theta, on, levels(x), fresh)
        return likelihood + force_prior(problem, levels(x)) + prior

    x = np.concatenate(
        [np.log(problem.ambient.force) + 0.7, np.clip(rough, stated - 1.2, stated + 1.2)]
    )
    for _ in range(LOOSER):  # where the boat as written runs away from what was recorded
        if np.isfinite(score(x, fresh=True)):
            break
        x[:n] += 1.0
    _, x = climbed(score, x, 0.6, ROUGH)
    score(x, fresh=True)
    return replace(found, levels=levels(climbed(score, x, 0.4, FINE)[1]))


def fit_time_constant(problem: Problem, found: Fit) -> NoiseLevels:
    """Latent-force levels with their correlation time, for the band that locates a mismatch in time."""
    on = problem.program.switches(found.effects)

    def levels(x: Array) -> NoiseLevels:
        lasting = found.levels.lasting(float(np.exp(x[1])))
        return replace(lasting, force=lasting.force * np.exp(x[0]))

    def score(x: Array) -> float:
        prior = -0.5 * ((x[1] - np.log(problem.ambient.time_constant)) / TIME_PRIOR) ** 2
        likelihood = problem.likelihood(found.free, found.theta, on, levels(x), fresh=False)
        return likelihood + force_prior(problem, levels(x)) + float(prior)

    problem.likelihood(found.free, found.theta, on, found.levels)
    begin = np.array([0.0, np.log(found.levels.time_constant)])
    return levels(climbed(score, begin, 0.7, FINE)[1])


def _roughness(problem: Problem, family: str) -> float:
    """Noise sd of a sensor from third differences of its signal, robust to outliers; 0 if it never varies."""
    found = []
    for t in problem.recordings:
        for c, f in enumerate(t.families):
            y = t.measured[np.isfinite(t.measured[:, c]), c]
            if f == family and len(y) > 8:
                found.append(np.diff(y, 3) ** 2 / 20.0)
    return float(np.sqrt(np.median(np.concatenate(found)) / 0.455)) if found else 0.0
