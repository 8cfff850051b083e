"""Fits the levels of sensor noise, and the level and correlation time of the latent force."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from boatsim.diagnosis.coordinate_search import maximize
from boatsim.diagnosis.filter import NoiseLevels
from boatsim.diagnosis.priors import CHI_SQUARE_MEDIAN
from boatsim.diagnosis.problem import FilterPasses, Fit, Problem, prior_arrays
from boatsim.physics.base import Array, DriftingMeasurement

THIRD_DIFFERENCE = 20.0  # sum of the squared binomial coefficients of a third difference


def log_latent_force_prior(problem: Problem, levels: NoiseLevels) -> float:
    """Return the log prior density of the levels of the latent (unmodelled) force.

    It is highest at the assumed disturbance level, and decreases faster below it than above.

    Args:
        problem: Problem with the assumed levels.
        levels: Noise levels of a hypothesis.
    """
    config = problem.config.fit
    over = np.log(levels.force / problem.ambient.force)
    deviation = np.where(over > 0, over / config.force_sd_above, over / config.force_sd_below)
    return float(np.sum(-0.5 * deviation**2))


def log_noise_level_prior(problem: Problem, levels: NoiseLevels) -> float:
    """Return the log prior density of the latent force and of the noise of measured forces.

    Args:
        problem: Problem with the assumed levels.
        levels: Noise levels of a hypothesis.
    """
    over = _log_input_noise(levels) - _log_input_noise(problem.ambient)
    noise = -0.5 * float(np.sum((over / problem.config.fit.input_noise_sd) ** 2))
    return log_latent_force_prior(problem, levels) + noise


def _log_input_noise(levels: NoiseLevels) -> Array:
    """Logarithms of the noise of measured forces, along the axes on which they act."""
    return np.asarray(np.log(levels.white[levels.white > 0.0]), dtype=float)


def _with_input_noise(levels: NoiseLevels, logs: Array) -> NoiseLevels:
    """Return levels with another noise of measured forces, given by its logarithms."""
    if not len(logs):
        return levels
    white = levels.white.copy()
    white[white > 0.0] = np.exp(logs)
    return replace(levels, white=white)


def _force_levels(problem: Problem, logs: Array) -> Array:
    """Levels of the latent force from their logarithms, with the lower bound."""
    return np.maximum(np.exp(logs), problem.config.fit.least_force * problem.ambient.force)


def _sensor_noise(
    problem: Problem, families: Sequence[str], logs: Array, specified: Array
) -> dict[str, float]:
    """Noise of each family from its logarithm, with the lower bound."""
    least = problem.config.fit.least_noise * np.exp(specified)
    return dict(zip(families, np.maximum(np.exp(logs), least).tolist(), strict=True))


def _families(problem: Problem) -> list[str]:
    """Noise families of all recorded channels."""
    return sorted({family for mapped in problem.recordings for family in mapped.families})


def _log_noise(levels: NoiseLevels, families: Sequence[str]) -> Array:
    """Logarithms of the noise of some families."""
    noise = np.array([levels.sensors[family] for family in families], dtype=float)
    return np.asarray(np.log(noise), dtype=float)


def _noise_prior(problem: Problem, logs: Array, specified: Array) -> float:
    """Sum of the squared deviations of the log noise in prior sds."""
    return float(np.sum(((logs - specified) / problem.config.fit.noise_sd) ** 2))


def fit_latent_force_level(problem: Problem, found: Fit, enough: float | None = None) -> Fit:
    """Refit the level of the latent (unmodelled) force on each axis; keep the other parameters.

    The spectra of the fit's stochastic forces are fitted together with it. If the fit contains the
    drift of an instrument, the sensor noise is refitted too, because it was fitted without that
    drift.

    Args:
        problem: The estimation problem: recordings, vessel model, candidate effects and priors.
        found: Fit from which the search starts.
        enough: Accuracy [nats]; None: the rough one of levels that are fitted again later.
    """
    config = problem.config.fit
    if enough is None:
        enough = config.rough_gain
    on = problem.program.effect_switches(found.effects)
    searched = [j for j, f in enumerate(found.free) if f.searched]
    free = [found.free[j] for j in searched]
    mean, sd, low, high = prior_arrays(free)
    families: list[str] = []
    if any(isinstance(problem.candidates[name], DriftingMeasurement) for name in found.effects):
        families = _families(problem)
    specified = _log_noise(problem.ambient, families)
    k, n = len(searched), len(searched) + len(families)
    last = n + len(found.levels.force)

    def noise_levels_and_parameters(x: Array) -> tuple[NoiseLevels, Array]:
        theta = found.theta.copy()
        theta[searched] = np.clip(x[:k] * sd, low, high)
        sensors = dict(found.levels.sensors) | _sensor_noise(problem, families, x[k:n], specified)
        force = _force_levels(problem, x[n:last])
        levels = replace(found.levels, force=force, sensors=sensors)
        return _with_input_noise(levels, x[last:]), theta

    about = problem.filter(found.free, found.theta, on, found.levels)

    def log_posterior(x: Array) -> float:
        levels, theta = noise_levels_and_parameters(x)
        deviation = float(np.sum(((theta[searched] - mean) / sd) ** 2))
        prior = -0.5 * (deviation + _noise_prior(problem, x[k:n], specified))
        likelihood = problem.log_likelihood(found.free, theta, on, levels, about)
        return likelihood + log_noise_level_prior(problem, levels) + prior

    noise = _log_noise(found.levels, families)
    logs = [np.log(found.levels.force), _log_input_noise(found.levels)]
    begin = np.concatenate([found.theta[searched] / sd, noise, *logs])
    _, x = maximize(log_posterior, begin, config.force_search_step, enough, config)
    levels, theta = noise_levels_and_parameters(x)
    return replace(found, levels=levels, theta=theta)


def fit_noise(problem: Problem, found: Fit) -> Fit:
    """Fit the sensor noise and the level of the latent (unmodelled) force; keep all parameters.

    Args:
        problem: The estimation problem: recordings, vessel model, candidate effects and priors.
        found: Fit of the vessel model whose parameters are kept.
    """
    config, prior_levels = problem.config.fit, problem.ambient
    families = _families(problem)
    n = len(prior_levels.force)
    last = n + len(families)
    on = problem.program.effect_switches(found.effects)
    specified = _log_noise(prior_levels, families)
    sensed = []
    for family in families:
        sensed.append(_roughness(problem, family) or prior_levels.sensors[family])
    rough = np.log(np.array(sensed))

    def noise_levels(x: Array) -> NoiseLevels:
        logs = x[n:last]
        sensors = dict(prior_levels.sensors) | _sensor_noise(problem, families, logs, specified)
        found = replace(prior_levels, force=_force_levels(problem, x[:n]), sensors=sensors)
        return _with_input_noise(found, x[last:])

    def log_sensor_noise_prior(x: Array) -> float:
        return -0.5 * _noise_prior(problem, x[n:last], specified)

    def maximize_noise(x: Array, about: FilterPasses, step: float, enough: float) -> Array:
        def log_posterior(x: Array) -> float:
            likelihood = problem.log_likelihood(found.free, found.theta, on, noise_levels(x), about)
            return (
                likelihood
                + log_noise_level_prior(problem, noise_levels(x))
                + log_sensor_noise_prior(x)
            )

        return maximize(log_posterior, x, step, enough, config)[1]

    low, high = specified - config.noise_start_range, specified + config.noise_start_range
    start = np.log(prior_levels.force) + config.force_start
    x = np.concatenate([start, np.clip(rough, low, high), _log_input_noise(prior_levels)])
    about = problem.filter(found.free, found.theta, on, noise_levels(x))
    for _ in range(config.force_raises):  # where the simulated boat diverges from the recording
        begin = (
            about.log_likelihood
            + log_noise_level_prior(problem, noise_levels(x))
            + log_sensor_noise_prior(x)
        )
        if np.isfinite(begin):
            break
        x[:n] += 1.0
        about = problem.filter(found.free, found.theta, on, noise_levels(x))
    x = maximize_noise(x, about, config.noise_search_step, config.rough_gain)
    about = problem.filter(found.free, found.theta, on, noise_levels(x))
    x = maximize_noise(x, about, config.noise_fine_search_step, config.fine_gain)
    return replace(found, levels=noise_levels(x))


def fit_latent_force_spectrum(problem: Problem, found: Fit) -> NoiseLevels:
    """Fit level and correlation time of the latent (unmodelled) force; keep all parameters.

    They are used to locate a missing force in time.

    Args:
        problem: The estimation problem: recordings, vessel model, candidate effects and priors.
        found: Fit of the vessel model whose parameters are kept.

    Returns:
        The noise levels with the fitted level and correlation time.
    """
    config = problem.config.fit
    on = problem.program.effect_switches(found.effects)
    usual = np.log(problem.ambient.time_constant)
    about = problem.filter(found.free, found.theta, on, found.levels)

    def noise_levels(x: Array) -> NoiseLevels:
        other = found.levels.with_other_correlation_time(float(np.exp(x[1])))
        return replace(other, force=other.force * np.exp(x[0]))

    def log_posterior(x: Array) -> float:
        prior = -0.5 * ((x[1] - usual) / config.correlation_time_sd) ** 2
        likelihood = problem.log_likelihood(found.free, found.theta, on, noise_levels(x), about)
        return likelihood + log_latent_force_prior(problem, noise_levels(x)) + float(prior)

    begin = np.array([0.0, np.log(found.levels.time_constant)])
    step = config.spectrum_search_step
    return noise_levels(maximize(log_posterior, begin, step, config.fine_gain, config)[1])


def _roughness(problem: Problem, family: str) -> float:
    """Noise sd of a sensor from third differences of its signal, robust to outliers, or 0."""
    found = []
    for mapped in problem.recordings:
        for c, own in enumerate(mapped.families):
            y = mapped.measured[np.isfinite(mapped.measured[:, c]), c]
            if own == family and len(y) > problem.config.fit.noise_min_rows:
                found.append(np.diff(y, 3) ** 2 / THIRD_DIFFERENCE)
    if not found:
        return 0.0
    return float(np.sqrt(np.median(np.concatenate(found)) / CHI_SQUARE_MEDIAN))
