"""Velocities that the nominal laws do not explain, and the contribution of each candidate to them.

The residual velocity of a recording is its velocity minus the integral of the accelerations that
the nominal laws predict along the recorded motion. Its rate of change is what a missing effect
adds. A parameter in which that addition is linear has a column of its own; the other parameters of
a candidate keep the values of a starting point.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.integrate import cumulative_trapezoid

from boatsim.diagnosis.candidates import name_without_prefixes
from boatsim.diagnosis.problem import FreeParameter
from boatsim.diagnosis.search.screening import starting_points
from boatsim.physics.base import Array, Measurement
from validation.rivals.accelerations import (
    Smoother,
    mean_actuators,
    predicted_accelerations,
    recorded_positions,
    true_positions,
)
from validation.rivals.question import Question, free_parameters

LINEAR = 0.1  # largest relative deviation from proportionality of a parameter called linear
SMALL = 1e-9  # a column below this share of the largest one is zero
STEP = 0.05  # relative step of the derivative by a coefficient of the vessel


@dataclass(frozen=True)
class Column:
    """Rate of change of the residual velocity per unit of one or more parameters."""

    entry: str  # candidate effect; empty for a coefficient of the vessel
    parameters: tuple[int, ...]  # indices in the free parameters of the entry
    per_unit: tuple[float, ...]  # change of each of these parameters per unit of the coefficient
    start: Array  # (F,) free parameters of the entry at which the column was evaluated
    rates: tuple[Array, ...]  # (N, NQ) of each recording [m/s^2, rad/s^2 per unit]


@dataclass(frozen=True)
class Motion:
    """Recorded velocities and predicted accelerations of one recording under a hypothesis."""

    velocities: Array  # (N, NQ) [m/s, rad/s]
    accelerations: Array  # (N, NQ) [m/s^2, rad/s^2]


class ResidualColumns:
    """Residual velocities of a trial and the columns of its candidates."""

    def __init__(self, question: Question) -> None:
        self.question, self.problem = question, question.problem
        self.smoothers = [
            Smoother.of(t, self.problem.ambient, question.noise) for t in self.problem.recordings
        ]
        self.recorded = [recorded_positions(t) for t in self.problem.recordings]
        self.nominal = self.motions((), question.start())

    def entries(self) -> list[str]:
        """Return the candidates that can have a column: one of each law, none of the clock."""
        found: dict[str, str] = {}
        for name, effect in self.question.entries.items():
            late = isinstance(effect, Measurement) and type(effect).motion_latency is not None
            if not late:
                found.setdefault(name_without_prefixes(name), name)
        return list(found.values())

    def motions(self, effects: tuple[str, ...], theta: Array) -> list[Motion]:
        """Return the motion of each recording under a hypothesis."""
        free = free_parameters(self.question, effects)
        on = self.problem.program.effect_switches(effects)
        found = []
        for smoother, recorded in zip(self.smoothers, self.recorded, strict=True):
            track = smoother.track
            values = self.problem.parameter_vector(track, free, theta)
            states, _ = smoother.motion(true_positions(track, recorded, values, on))
            held = mean_actuators(track, effects, values)
            predicted = predicted_accelerations(track, states, held, values, on)
            found.append(Motion(states[:, recorded.shape[1] :], predicted))
        return found

    def residual_velocities(self) -> list[Array]:
        """Return the residual velocities (N, NQ) of each recording [m/s, rad/s]."""
        found = []
        for track, motion in zip(self.problem.recordings, self.nominal, strict=True):
            explained = cumulative_trapezoid(motion.accelerations, track.times, axis=0, initial=0.0)
            found.append(motion.velocities - explained)
        return found

    def additions(self, effects: tuple[str, ...], theta: Array) -> list[Array]:
        """Return what a hypothesis adds (N, NQ) to the nominal rate of the residual velocity."""
        found = []
        motions = self.motions(effects, theta)
        for track, after, before in zip(
            self.problem.recordings, motions, self.nominal, strict=True
        ):
            shift = after.velocities - before.velocities
            added = after.accelerations - before.accelerations
            found.append(added - np.gradient(shift, track.times, axis=0))
        return found

    def vessel_columns(self) -> list[Column]:
        """Return the columns of the vessel's uncertain coefficients, per prior sd."""
        columns = []
        theta = self.question.start()
        for j, f in enumerate(free_parameters(self.question, ())):
            moved = theta.copy()
            moved[j] += STEP
            rates = [x * f.sd / STEP for x in self.additions((), moved)]
            columns.append(Column("", (j,), (f.sd,), theta, tuple(rates)))
        return columns

    def entry_columns(self, entry: str) -> list[list[Column]]:
        """Return the columns of a candidate, one list for each of its starting points."""
        free = free_parameters(self.question, (entry,))
        own = [j for j, f in enumerate(free) if f.effect == entry and not f.relative]
        inactive = np.array([f.mean for f in free])
        found = []
        for start in starting_points(self.problem, self.question.entries[entry]):
            theta = inactive.copy()
            for j in own:
                if free[j].name in start:
                    theta[j] = start[free[j].name]
            theta = np.clip(theta, [f.low for f in free], [f.high for f in free])
            columns = self._columns_at(entry, free, own, theta)
            if columns:
                found.append(columns)
        return found

    def _columns_at(
        self, entry: str, free: Sequence[FreeParameter], own: list[int], theta: Array
    ) -> list[Column]:
        """Return one column for each linear parameter, or one for all if there is none."""
        whole = self.additions((entry,), theta)
        size = _size(whole)
        if not np.isfinite(size) or size == 0.0:
            return []
        columns = []
        for j in own:
            change = theta[j] - free[j].mean
            rates = self._linear_rates(entry, theta, j, free[j].mean, whole)
            if change != 0.0 and rates is not None and _size(rates) > SMALL * size:
                columns.append(Column(entry, (j,), (change,), theta, tuple(rates)))
        if columns:
            return columns
        changes = [theta[j] - free[j].mean for j in own]
        return [Column(entry, tuple(own), tuple(changes), theta, tuple(whole))]

    def _linear_rates(
        self, entry: str, theta: Array, j: int, inactive: float, whole: list[Array]
    ) -> list[Array] | None:
        """Return the contribution of one parameter at a start; None if it is not linear."""
        without, half = theta.copy(), theta.copy()
        without[j] = inactive
        half[j] = 0.5 * (inactive + theta[j])
        base = self.additions((entry,), without)
        rates = [a - b for a, b in zip(whole, base, strict=True)]
        halves = [a - b for a, b in zip(self.additions((entry,), half), base, strict=True)]
        off = [2.0 * h - r for h, r in zip(halves, rates, strict=True)]
        if _size(off) <= LINEAR * _size(rates):
            return rates
        return None


def _size(rates: Sequence[Array]) -> float:
    """Return the root of the sum of squares of all recordings."""
    return float(np.sqrt(sum(float(np.sum(x**2)) for x in rates)))
