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
from boatsim.physics.base import Array

MODEL = "model"  # the only one whose free runs are simulated
STEP = 1e-3  # of finite differences, in prior sds
FAMILY_OF = {name: family for family, signals in FAMILIES.items() for name in signals}


class RecordedSignal(NamedTuple):
    """A signal of a free run as it was recorded.

    Attributes:
        code: Index of the coordinate that it shows.
        measured: (M,) its values, nan where nothing was recorded.
        known: (M,) whether a value was recorded.
        unit: Error that counts as one, for a single row.
    """

    code: int
    measured: Array
    known: NDArray[np.bool_]
    unit: float


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
            begun.append(mapped.free_run_starts(values, on, found.levels, self.horizon))
        return begun

    def residuals(self, found: Fit, starts: Sequence[FreeRunStarts] | None = None) -> Array:
        """Return the weighted errors (R,) of all free runs of a model; nan where it diverges.

        Args:
            found: The model with its parameters.
            starts: States from which the runs begin; None: those that the model's own smoother
                estimates, which takes most of the time.
        """
        on = self.problem.program.effect_switches(found.effects)
        parts, weights = list[Array](), iter(np.sqrt(self.weights))
        each = zip(self.recordings, starts or self.starts(found), strict=True)
        for number, (mapped, begin) in enumerate(each):
            values = self.problem.parameter_vector(mapped, found.free, found.theta)
            for first, simulated in mapped.simulate_from(values, on, begin, mapped.fitting_step):
                weight = next(weights)
                for code, measured, known, unit in self._signals(number, first, len(simulated)):
                    error = np.where(known, simulated[:, code] - measured, 0.0)
                    parts.append(weight * (error / unit))
        return np.concatenate(parts) if parts else np.zeros(0)

    def _signals(self, number: int, first: int, rows: int) -> list[RecordedSignal]:
        """The recorded signals of a free run: recording, first row and number of its rows."""
        key = number, first, rows
        if key in self._known_signals:
            return self._known_signals[key]
        mapped, found = self.recordings[number], list[RecordedSignal]()
        for c, (code, signal) in enumerate(zip(mapped.codes, mapped.signals, strict=True)):
            scale = self.scale.get(FAMILY_OF.get(signal, ""))
            if code < mapped.program.module.NQ and scale:
                measured = mapped.measured[first : first + rows, c]
                known = np.isfinite(measured)
                unit = float(scale * np.sqrt(max(int(known.sum()), 1)))
                found.append(RecordedSignal(int(code), measured, known, unit))
        self._known_signals[key] = found
        return found

    @cached_property
    def _known_signals(self) -> dict[tuple[int, int, int], list[RecordedSignal]]:
        return {}

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
