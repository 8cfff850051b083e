"""Slow drives that make one recording look as if its commands had another clock.

Another lag of all drives, or another delay or lag of a single drive, may delay the motion of one
recording as well. Their log likelihoods are compared with that of another clock.
"""

from collections.abc import Mapping

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
        totals.append(total(lag))
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
    longest = usual.lag + estimator.longest

    def with_lag(lag: float) -> float:
        return estimator.log_likelihood(parts, usual._replace(lag=lag))

    found = [estimator.maximum(with_lag, 0.0, longest)[1]]
    for column in moving_commands(parts):
        one = usual._replace(only=column, only_lag=usual.lag)
        found.append(_best_delay_of_one(estimator, parts, one))
        found.append(_best_lag_of_one(estimator, parts, one, longest))
    return max(found)


def _best_delay_of_one(estimator: DelayEstimator, parts: Parts, one: Response) -> float:
    """Largest log likelihood [nats] of a file by the delay of one command."""

    def value(seconds: float) -> float:
        return estimator.log_likelihood(parts, one._replace(only_delay=seconds))

    steps = round(estimator.longest / estimator.stride)
    delays = estimator.stride * np.arange(-steps, steps + 1)
    near = float(delays[int(np.argmax([value(d) for d in delays.tolist()]))])
    return estimator.maximum(value, near - estimator.stride, near + estimator.stride)[1]


def _best_lag_of_one(
    estimator: DelayEstimator, parts: Parts, one: Response, longest: float
) -> float:
    """Largest log likelihood [nats] of a file by the lag of one command."""
    return estimator.maximum(
        lambda lag: estimator.log_likelihood(parts, one._replace(only_lag=lag)), 0.0, longest
    )[1]
