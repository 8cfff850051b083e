"""Slow drives that make one recording look as if its commands had another clock.

Another lag of all drives, or another delay or lag of a single drive, may delay the motion of one
recording as well. Their log likelihoods are compared with that of another clock.
"""

from collections.abc import Callable, Mapping

import numpy as np

from boatsim.diagnosis.checks.command_delays import (
    Delay,
    DelayEstimator,
    Parts,
    Response,
    moving_commands,
)


def common_lag(
    estimator: DelayEstimator, files: Mapping[str, Parts], delays: Mapping[str, Delay]
) -> float:
    """Return the likeliest lag [s] of the drives of all files, each with a delay of its own.

    Args:
        estimator: Estimator of delays.
        files: Mapped parts of each file.
        delays: Delays of the files without a lag.
    """

    def total(lag: float) -> float:
        found = 0.0
        for name, delay in delays.items():
            low, high = delay.seconds - lag - estimator.stride, delay.seconds + estimator.stride
            found += estimator.likeliest(files[name], Response(lag=lag), low, high)[1]
        return found

    lags = [factor * estimator.time_scale for factor in estimator.config.command_clock_lags]
    totals = list[float]()
    for lag in lags:
        totals.append(_if_finite(total(lag)))
        if totals[-1] < max(totals):
            break
    best = int(np.argmax(totals))
    low, high = lags[max(best - 1, 0)], lags[min(best + 1, len(lags) - 1)]
    refined, value = estimator.maximum(total, low, high, estimator.config.command_clock_lag_steps)
    if value > totals[best]:
        return refined
    return lags[best]


def best_drive_rival(estimator: DelayEstimator, parts: Parts, usual: Response) -> float:
    """Return the largest log likelihood [nats] of a file by drives that differ in it.

    All drives may have another lag, or one command may have another delay or another lag.

    Args:
        estimator: Estimator of delays.
        parts: The mapped parts of the file.
        usual: How the commands of the other files act.
    """
    longest_lag = usual.lag + estimator.longest
    found = [_best_time(estimator, parts, lambda lag: usual._replace(lag=lag), 0.0, longest_lag)]
    for column in moving_commands(parts):
        one = usual._replace(only=column, only_lag=usual.lag)
        found.append(_best_delay_of_one(estimator, parts, one))
        found.append(_best_lag_of_one(estimator, parts, one, longest_lag))
    return max(found)


def _best_delay_of_one(estimator: DelayEstimator, parts: Parts, one: Response) -> float:
    """Largest log likelihood [nats] of a file by the delay of one command."""
    longest = estimator.longest
    return _best_time(
        estimator, parts, lambda delay: one._replace(only_delay=delay), -longest, longest
    )


def _best_lag_of_one(
    estimator: DelayEstimator, parts: Parts, one: Response, longest: float
) -> float:
    """Largest log likelihood [nats] of a file by the lag of one command."""
    return _best_time(estimator, parts, lambda lag: one._replace(only_lag=lag), 0.0, longest)


def _best_time(
    estimator: DelayEstimator,
    parts: Parts,
    response_of: Callable[[float], Response],
    low: float,
    high: float,
) -> float:
    """Largest log likelihood [nats] of a file by a time [s] of the response of its commands.

    Times of a grid are compared first, because there may be several maxima.
    """

    def value(seconds: float) -> float:
        return estimator.log_likelihood(parts, response_of(seconds))

    times = np.linspace(low, high, max(1, round((high - low) / estimator.stride)) + 1)
    values = [_if_finite(value(seconds)) for seconds in times.tolist()]
    best = int(np.argmax(values))
    before, after = times[max(best - 1, 0)], times[min(best + 1, len(times) - 1)]
    refined = estimator.maximum(value, float(before), float(after))[1]
    return max(values[best], _if_finite(refined))


def _if_finite(log_likelihood: float) -> float:
    """A log likelihood [nats]; -inf where the filter diverges."""
    if np.isfinite(log_likelihood):
        return log_likelihood
    return -np.inf
