"""Delay of the motion of recordings behind their commands, each estimated with the same model.

The commands of a recording are moved in time, and the Kalman filter states how likely the recorded
motion is then. All recordings share the vessel model, so that what it lacks shifts all of them
alike: only differences between their delays concern the clocks. The standard deviation follows
from the scatter of the scores of parts of a recording (P. J. Huber, Proc. 5th Berkeley Symposium 1,
221, 1967), because a vessel model that is wrong makes the curvature of the likelihood too sharp.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from scipy.linalg import solve_banded
from scipy.optimize import minimize_scalar

from boatsim.diagnosis.config import ChecksConfig
from boatsim.diagnosis.filter import FilterPass, MappedRecording, NoiseLevels
from boatsim.diagnosis.priors import froude_time_scale
from boatsim.diagnosis.problem import Fit, Problem
from boatsim.physics.base import Array

Parts = Sequence[MappedRecording]  # of one file, with one clock
ALL = -1  # number of the commands in place of that of one command
EDGE = 0.98  # share of an interval beyond which a maximum lies at its end


class Delay(NamedTuple):
    """Delay of the motion of a file behind its commands.

    Attributes:
        seconds: The delay, beyond that of the vessel model [s].
        sd: Its standard deviation [s].
        log_likelihood: Log likelihood of the file with it [nats].
    """

    seconds: float
    sd: float
    log_likelihood: float


class Response(NamedTuple):
    """How the commands of a file act.

    Attributes:
        delay: Time by which all commands act later [s]; negative: earlier.
        lag: Time constant of a first-order lag of all commands [s].
        only: Number of one command with a further delay or another lag, or `ALL`.
        only_delay: Further delay of this command [s].
        only_lag: Its lag instead of `lag` [s].
    """

    delay: float = 0.0
    lag: float = 0.0
    only: int = ALL
    only_delay: float = 0.0
    only_lag: float = 0.0


@dataclass(frozen=True)
class DelayEstimator:
    """Estimates the delay of files with a fitted vessel model that all of them share.

    Attributes:
        problem: The estimation problem.
        fit: Fit of the vessel model without candidate effects.
    """

    problem: Problem
    fit: Fit

    @property
    def config(self) -> ChecksConfig:
        """Thresholds of the quality checks."""
        return self.problem.config.checks

    @property
    def time_scale(self) -> float:
        """Factor by which times are longer than on a hull of 1.2 m."""
        return froude_time_scale(self.problem.program.vessel)

    @property
    def stride(self) -> float:
        """Distance of the delays that are compared first [s]."""
        return self.config.command_clock_step * self.time_scale

    @property
    def longest(self) -> float:
        """Largest delay that is sought [s]."""
        return self.config.command_clock_max_delay * self.time_scale

    def log_likelihood(self, parts: Parts, response: Response) -> float:
        """Return the log likelihood [nats] of a file whose commands act as a response states.

        The gains of the Kalman filter are those of the recorded commands: the response changes the
        motion that they cause, and hardly the linearisation.

        Args:
            parts: The mapped parts of the file.
            response: Delays and lags of its commands.
        """
        found = 0.0
        for mapped in parts:
            recorded = self._pass(mapped)
            moved = with_response(mapped, response)
            arguments = self._arguments(moved)
            # a copy of the pass knows no errors of other commands
            errors = moved.whitened_errors(*arguments, about=replace(recorded))
            change = float(errors @ errors - recorded.whitened @ recorded.whitened)
            found += recorded.log_likelihood - 0.5 * change
        return found

    def delay(self, parts: Parts) -> Delay | None:
        """Return the likeliest delay of a file; None if the log likelihood has no clear maximum.

        Args:
            parts: The mapped parts of the file.
        """
        steps = round(self.config.command_clock_max_delay / self.config.command_clock_step)
        delays = self.stride * np.arange(-steps, steps + 1)
        values = np.array([self.log_likelihood(parts, Response(d)) for d in delays.tolist()])
        best = int(np.argmax(np.where(np.isfinite(values), values, -np.inf)))
        if not 0 < best < len(delays) - 1:
            return None
        return self.refined(parts, float(delays[best]))

    def refined(self, parts: Parts, near: float, lag: float = 0.0) -> Delay | None:
        """Return the likeliest delay of a file near a delay; None if there is no maximum.

        A lag takes the place of some of the delay, at most of as much as its time constant.

        Args:
            parts: The mapped parts of the file.
            near: The delay without a lag [s].
            lag: Time constant of a first-order lag of all drives [s].
        """
        low, high = near - lag - self.stride, near + self.stride
        seconds, best = self.likeliest(parts, Response(lag=lag), low, high)
        edge = EDGE * 0.5 * (high - low)
        if not np.isfinite(best) or abs(seconds - 0.5 * (low + high)) > edge:
            return None
        sd = self._sd(parts, seconds, lag)
        if sd is None:
            return None
        return Delay(seconds, sd, best)

    def likeliest(
        self, parts: Parts, response: Response, low: float, high: float
    ) -> tuple[float, float]:
        """Return the likeliest delay [s] of a response, and the log likelihood [nats].

        Args:
            parts: The mapped parts of the file.
            response: Its other numbers are kept.
            low: Smallest delay [s].
            high: Largest delay [s].
        """
        return self.maximum(
            lambda seconds: self.log_likelihood(parts, response._replace(delay=seconds)), low, high
        )

    def maximum(
        self, value: Callable[[float], float], low: float, high: float, most: int = 100
    ) -> tuple[float, float]:
        """Return the time [s] between two others at which a value is largest, and the value.

        Args:
            value: Function of a time [s].
            low: Smallest time [s].
            high: Largest time [s].
            most: Largest number of steps of the search.
        """
        tolerance = self.config.command_clock_tolerance * self.stride
        found = minimize_scalar(
            lambda seconds: -value(float(seconds)),
            bounds=(low, high),
            method="bounded",
            options={"xatol": tolerance, "maxiter": most},
        )
        return float(found.x), -float(found.fun)

    def _passes(self, parts: Parts, response: Response) -> list[FilterPass]:
        return [self._pass(with_response(mapped, response)) for mapped in parts]

    def _pass(self, mapped: MappedRecording) -> FilterPass:
        return mapped.filter(*self._arguments(mapped))

    def _arguments(self, mapped: MappedRecording) -> tuple[Array, Array, NoiseLevels]:
        """Values of the parameters, switches of the effects and noise levels of the fit."""
        on = self.problem.program.effect_switches(self.fit.effects)
        values = self.problem.parameter_vector(mapped, self.fit.free, self.fit.theta)
        return values, on, self.fit.levels

    def _sd(self, parts: Parts, delay: float, lag: float) -> float | None:
        """Standard deviation [s] from the scores of intervals; None without a maximum."""
        step = self.config.command_clock_derivative * self.stride
        rows = sum(len(one.times) for one in parts)
        curvature, scores = 0.0, list[float]()
        nearby = [self._passes(parts, Response(delay + d, lag)) for d in (-step, 0.0, step)]
        for before, at, after in zip(*nearby, strict=True):
            low, middle, high = (p.log_density_of_rows for p in (before, at, after))
            curvature += float(np.sum(2.0 * middle - low - high)) / step**2
            share = len(middle) / rows
            blocks = max(1, round(share * self.config.command_clock_intervals))
            for block in np.array_split((high - low) / (2.0 * step), blocks):
                scores.append(float(block.sum()))
        if not curvature > 0.0 or len(scores) < 2:
            return None
        variance = len(scores) * float(np.var(scores, ddof=1))
        return float(np.sqrt(max(variance, curvature))) / curvature


def moving_commands(parts: Parts) -> list[int]:
    """Return the numbers of the commands that change in at least one part of a file.

    Args:
        parts: The mapped parts of the file.
    """
    moving = set[int]()
    for mapped in parts:
        moving.update(np.flatnonzero(np.ptp(mapped.command_values, axis=0) > 0.0).tolist())
    return sorted(moving)


def with_response(mapped: MappedRecording, response: Response) -> MappedRecording:
    """Return a recording whose commands act later, and through first-order lags.

    Args:
        mapped: The mapped recording.
        response: Delays and lags of its commands.
    """
    times, values = mapped.command_times, mapped.command_values
    lags = np.full(values.shape[1], response.lag)
    if response.only != ALL:
        lags[response.only] = response.only_lag
    if lags.any():
        times, values = _lagged(times, values, np.union1d(times, mapped.times), lags)
    if response.only != ALL and response.only_delay:
        times, values = _one_later(times, values, response.only, response.only_delay)
    return replace(mapped, command_times=times + response.delay, command_values=values)


def _lagged(times: Array, values: Array, fine: Array, lags: Array) -> tuple[Array, Array]:
    """Commands (N, K) at finer times (N,) [s] through lags (K,) [s], held until the next."""
    orders = values[np.maximum(np.searchsorted(times, fine, side="right") - 1, 0)]
    found = orders.copy()
    for lag in np.unique(lags[lags > 0.0]):
        own = lags == lag
        # x[k + 1] - kept[k] x[k] = (1 - kept[k]) orders[k], as bands of a matrix
        kept = np.exp(-np.diff(fine) / lag)
        bands = np.vstack([np.ones(len(fine)), np.append(-kept, 0.0)])
        right = np.vstack([orders[:1, own], (1.0 - kept)[:, None] * orders[:-1, own]])
        states = solve_banded((1, 0), bands, right)
        found[:-1, own] = 0.5 * (states[1:] + states[:-1])
        found[-1, own] = states[-1]
    return fine, np.ascontiguousarray(found)


def _one_later(times: Array, values: Array, column: int, delay: float) -> tuple[Array, Array]:
    """Commands (N, K) of which one column acts later, at all times (N,) [s] of changes."""
    both = np.union1d(times, times + delay)
    rows = np.maximum(np.searchsorted(times, both, side="right") - 1, 0)
    own = np.maximum(np.searchsorted(times + delay, both, side="right") - 1, 0)
    moved = values[rows]
    moved[:, column] = values[own, column]
    return both, np.ascontiguousarray(moved)
