"""Errors of free runs over recordings, as residuals of a least-squares problem.

A free run is a simulation from a recorded state with the recorded commands alone. Where the model
lacks a force, a Kalman filter ascribes the effect of that force to a disturbance, and a wrong
coefficient costs it little. A simulation has no disturbance: it shows the wrong coefficient
(output-error method; L. Ljung, System Identification, 2nd ed. 1999, section 3.2; R. V. Jategaonkar,
Flight Vehicle System Identification, 2nd ed. 2015, chapter 4).
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from boatsim.diagnosis.filter import FreeRunStarts, MappedRecording
from boatsim.diagnosis.fit import ParameterSpace, log_prior
from boatsim.diagnosis.free_runs import FAMILIES, free_runs
from boatsim.diagnosis.output_error.weights import run_errors
from boatsim.diagnosis.problem import Fit, Problem
from boatsim.diagnosis.recent_results import RecentResults
from boatsim.physics.base import Array

MODEL = "model"  # the only one whose free runs are simulated
STEP = 1e-3  # of finite differences, in prior sds
KEPT = 8  # recent errors of a recording; those of 6,000 rows with six signals have 0.3 MB
FAMILY_OF = {name: family for family, signals in FAMILIES.items() for name in signals}


class RecordedSignal(NamedTuple):
    """A signal in the free runs over a recording, one after another, as it was recorded.

    Attributes:
        code: Index of the coordinate that it shows.
        measured: (M,) its values, nan where nothing was recorded.
        known: (M,) whether a value was recorded.
        unit: (M,) error that counts as one, for a single row.
    """

    code: int
    measured: Array
    known: NDArray[np.bool_]
    unit: Array


@dataclass(frozen=True)
class OutputErrors:
    """Errors of free runs over some recordings, in units of those of a reference model.

    Each recorded signal of a run counts as a single observation, because its errors follow one
    another smoothly. A run in which the errors of the reference model are unusually large has less
    weight.

    Attributes:
        problem: The estimation problem: vessel model, candidate effects and priors.
        recordings: Recordings over which the free runs lead.
        horizon: Length of each free run [s].
        scale: Error of the reference model by family of signals (position, heading, ...).
        weights: (R,) weights of the runs, in the order of the recordings.
    """

    problem: Problem
    recordings: Sequence[MappedRecording]
    horizon: float
    scale: Mapping[str, float]
    weights: Array

    def starts(self, found: Fit) -> list[FreeRunStarts]:
        """Return the states from which the free runs of a model begin, for each recording."""
        on = self.problem.program.effect_switches(found.effects)
        begun = []
        for mapped in self.recordings:
            values = self.problem.parameter_vector(mapped, found.free, found.theta)
            acting = self.problem.switches_in(mapped, found.free, on)
            begun.append(mapped.free_run_starts(values, acting, found.levels, self.horizon))
        return begun

    def residuals(self, found: Fit, starts: Sequence[FreeRunStarts] | None = None) -> Array:
        """Return the weighted errors (R,) of all free runs of a model; nan where it diverges.

        Args:
            found: The model with its parameters.
            starts: States from which the runs begin; None: those that the model's own smoother
                estimates, which takes most of the time.
        """
        on = self.problem.program.effect_switches(found.effects)
        parts, runs = list[Array](), 0
        for number, (mapped, begin) in enumerate(
            zip(self.recordings, starts or self.starts(found), strict=True)
        ):
            values = self.problem.parameter_vector(mapped, found.free, found.theta)
            acting = self.problem.switches_in(mapped, found.free, on)
            weights = self.weights[runs : runs + len(begin.starts)]
            runs += len(begin.starts)
            parts.append(self._residuals_over(number, values, acting, begin, weights))
        return np.concatenate(parts)

    def _residuals_over(
        self, number: int, values: Array, acting: Array, begin: FreeRunStarts, weights: Array
    ) -> Array:
        """The weighted errors of the free runs over a recording; recent ones are kept.

        Effects and parameters that concern other groups of recordings do not change them.
        """
        mapped = self.recordings[number]

        def simulate() -> Array:
            runs = mapped.simulate_from(values, acting, begin, mapped.fitting_step)
            if not runs:
                return np.zeros(0)
            simulated = np.concatenate([channels for _, channels in runs])
            parts = [np.zeros(0)]
            for code, measured, known, unit in self._signals(number, begin, weights):
                error = np.where(known, simulated[:, code] - measured, 0.0)
                parts.append(error / unit)
            return np.concatenate(parts)

        key = values.tobytes() + acting.tobytes() + begin.key
        return self._recent[number].result(key, simulate)

    def _signals(self, number: int, begin: FreeRunStarts, weights: Array) -> list[RecordedSignal]:
        """The recorded signals of the free runs over a recording."""
        if number in self._known_signals:
            return self._known_signals[number]
        mapped, found = self.recordings[number], list[RecordedSignal]()
        rows = [np.arange(i, j + 1) for i, j in zip(begin.starts, begin.ends, strict=True)]
        for c, (code, signal) in enumerate(zip(mapped.codes, mapped.signals, strict=True)):
            scale = self.scale.get(FAMILY_OF.get(signal, ""))
            if code < mapped.program.module.NQ and scale:
                measured = mapped.measured[np.concatenate(rows), c]
                units = []
                for own, weight in zip(rows, weights, strict=True):
                    count = max(int(np.isfinite(mapped.measured[own, c]).sum()), 1)
                    with np.errstate(divide="ignore"):  # weight zero: an infinite unit
                        units.append(np.full(len(own), scale * np.sqrt(count / weight)))
                known = np.isfinite(measured)
                found.append(RecordedSignal(int(code), measured, known, np.concatenate(units)))
        self._known_signals[number] = found
        return found

    @cached_property
    def _known_signals(self) -> dict[int, list[RecordedSignal]]:
        return {}

    @cached_property
    def _recent(self) -> list[RecentResults[Array]]:
        """Recent errors of each recording."""
        return [RecentResults(KEPT) for _ in self.recordings]

    def derivatives(
        self,
        found: Fit,
        starts: Sequence[FreeRunStarts],
        at: Array,
        moved: Iterable[int],
    ) -> Array:
        """Return the derivatives (R, F) of the residuals by the parameters, in prior sds.

        The runs begin from the same states with all parameters, except with those of an error of
        the measurement, which changes what a recorded position says about the state.

        Args:
            found: The model with its parameters.
            starts: States from which its runs begin.
            at: (R,) its residuals.
            moved: Indices of the parameters; the derivatives by others are 0.
        """
        space = ParameterSpace(found.free)
        J = np.zeros((len(at), len(found.free)))
        for j in moved:
            step = STEP if found.theta[j] + STEP * space.sd[j] <= space.high[j] else -STEP
            theta = found.theta.copy()
            theta[j] += step * space.sd[j]
            own = None if self.is_measurement(found, j) else starts
            J[:, j] = (self.residuals(replace(found, theta=theta), own) - at) / step
        return np.nan_to_num(J, posinf=0.0, neginf=0.0)

    def is_measurement(self, found: Fit, j: int) -> bool:
        """Whether a parameter belongs to an error of the measurement.

        Args:
            found: The model.
            j: Index of the parameter.
        """
        parameter = found.free[j]
        if parameter.relative:
            return False
        return type(self.problem.candidates[parameter.effect]).kind == "measurement"

    def score(self, found: Fit, residuals: Array, fixed: Sequence[int] = ()) -> float:
        """Return the log posterior density of a model's parameters, -inf if the model diverges.

        Args:
            found: The model with its parameters.
            residuals: (R,) weighted errors of its free runs.
            fixed: Indices of parameters that are given, so that their prior does not count.
        """
        free = [j for j in range(len(found.free)) if j not in fixed]
        with np.errstate(over="ignore", invalid="ignore"):
            score = log_prior([found.free[j] for j in free], found.theta[free])
            score -= 0.5 * float(residuals @ residuals)
        return score if np.isfinite(score) else -np.inf


def output_errors(
    problem: Problem, reference: Fit, recordings: Sequence[MappedRecording], horizon: float
) -> OutputErrors:
    """Return the errors of free runs in units of those of a reference model.

    Args:
        problem: The estimation problem: vessel model, candidate effects and priors.
        reference: Model whose errors are the units.
        recordings: Recordings over which the free runs lead.
        horizon: Length of each free run [s].
    """
    runs = free_runs(problem, {MODEL: reference}, recordings, horizon)
    if not runs:
        return OutputErrors(problem, recordings, horizon, {}, np.zeros(0))
    found = run_errors(runs, MODEL)
    scale = found.scale()
    return OutputErrors(problem, recordings, horizon, scale, found.weights(scale))
