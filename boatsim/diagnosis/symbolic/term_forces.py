"""The force of a term along a recording, row by row, at the smoothed states of a fit."""

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from boatsim.diagnosis.filter import MappedRecording, dof_in_state_order
from boatsim.diagnosis.locate import nominal_forces
from boatsim.diagnosis.problem import Fit, Problem
from boatsim.physics import terms
from boatsim.physics.base import Array, Motion
from boatsim.physics.described_laws import SymbolicTerm
from boatsim.physics.effects.described_force import DescribedForce
from boatsim.physics.effects.described_thrust import DescribedThrust
from boatsim.physics.signals import AXES

# signal and kind of an average over the past, by `terms.history_codes`, and its time constant [s]
Average = tuple[float, float, float]
NO_AVERAGE: Average = (0.0, 0.0, 1.0)
PLACES = dict(zip(AXES, ("x", "y", "z", "phi", "theta", "psi"), strict=True))
RATES = dict(zip(AXES, "uvwpqr", strict=True))


def low_pass_row_means(signals: Array, times: Array, time_constant: float) -> Array:
    """Filter signals by a first-order lag and return the mean over each row.

    Args:
        signals: Signals (K, N), constant from row to row.
        times: Times (N,) [s].
        time_constant: Time constant of the lag [s].

    Returns:
        Means (K, N).
    """
    steps = np.append(np.diff(times), times[-1] - times[-2]) / time_constant
    decays = np.exp(-steps)
    means = np.empty_like(signals)
    y = signals[:, 0]
    for row, (step, decay) in enumerate(zip(steps.tolist(), decays.tolist(), strict=True)):
        x = signals[:, row]
        means[:, row] = x + (y - x) * ((1.0 - decay) / step)
        y = x + (y - x) * decay
    return means


@dataclass(frozen=True)
class FittedRecording:
    """A recording with the states and the unexplained force that a fit's smoother finds in it.

    It evaluates the forces that terms of the symbolic regression would have along the recording.

    Attributes:
        problem: The estimation problem.
        recording: The recording.
        fit: Fit of the vessel model.
        states: Smoothed states (N, 2 NQ).
        residual: Force (N, axes) [N, N m] that the fit does not explain.
        smoother: Covariances (N, n, n) of the smoothed states, and gains (N, n, n) of the smoother.
    """

    problem: Problem
    recording: MappedRecording
    fit: Fit
    states: Array
    residual: Array
    smoother: tuple[Array, Array]

    @cached_property
    def motion(self) -> Motion:
        """Smoothed motion of the hull at all rows; each field has the shape (N,)."""
        program, rows = self.problem.program, len(self.states)
        axes, nq = dof_in_state_order(program.vessel), program.module.NQ
        fields: dict[str, Any] = dict.fromkeys(Motion._fields, np.zeros(rows))
        fields["t"] = self.recording.times
        rates = program.to_body_velocities(self.states)[:, nq:]
        for i, axis in enumerate(axes):
            fields[PLACES[axis]] = self.states[:, i]
            fields[RATES[axis]] = rates[:, i]
        c, s = np.cos(fields["psi"]), np.sin(fields["psi"])
        water, carried = np.zeros((rows, 2)), np.zeros((rows, 2))
        if "surge" in axes:
            code = program.estimation_functions
            given = self.parameter_values, self.effect_switches
            held = np.ascontiguousarray(self.actuator_signals.T)  # (N, K)
            for i, (t, x, y) in enumerate(zip(fields["t"], fields["x"], fields["y"], strict=True)):
                water[i] = code.water_velocity(t, x, y, *given, held[i], np.int64(0))
                carried[i] = code.water_displacement(t, *given)
        north, east = water.T
        fields |= {"cos_psi": c, "sin_psi": s, "wr": fields["w"]}
        fields |= {"water_north": north, "water_east": east}
        fields |= {"carried_north": carried[:, 0], "carried_east": carried[:, 1]}
        fields["ur"] = fields["u"] - c * north - s * east
        fields["vr"] = fields["v"] - c * east + s * north
        return Motion(**fields)

    @cached_property
    def parameter_values(self) -> Array:
        """Parameter values of the fitted vessel model for this recording."""
        return self.problem.parameter_vector(self.recording, self.fit.free, self.fit.theta)

    @cached_property
    def effect_switches(self) -> Array:
        """Array (effects,) with 1 for the effects that act in the fit, else 0."""
        return self.problem.program.effect_switches(self.fit.effects)

    @cached_property
    def actuator_signals(self) -> Array:
        """Actuator signals (K, N) simulated from the recorded commands."""
        return nominal_forces.actuator_states(
            self.recording, self.fit.effects, self.parameter_values
        ).T

    @cached_property
    def _thrusts(self) -> dict[tuple[str, str], Array]:
        return {}

    @cached_property
    def _factors(self) -> dict[tuple[float, terms.Detail, Average], Array]:
        return {}

    @cached_property
    def _lagged(self) -> dict[float, Array]:
        return {}

    def term_force(self, term: SymbolicTerm) -> Array:
        """Return the force along the recording of a term of the symbolic regression.

        The coefficient of the term is taken as 1.

        Args:
            term: A term of the symbolic regression.

        Returns:
            Force (N, axes) [N, N m]; zero for an event of another recording.
        """
        axes = dof_in_state_order(self.problem.program.vessel)
        if term.run not in ("", self.recording.name):
            return np.zeros((len(self.states), len(axes)))
        size = self.term_value(term)
        if isinstance(term, DescribedThrust):
            return self.one_sided_thrust(term.side, term.sense) * size[:, None]
        assert isinstance(term, DescribedForce)
        out, m = np.zeros((len(size), len(axes))), self.motion
        if term.axis in axes:
            out[:, axes.index(term.axis)] = size
            return out
        ahead, abeam = m.sin_psi, m.cos_psi  # towards east
        if term.axis == "north":
            ahead, abeam = m.cos_psi, -m.sin_psi
        out[:, axes.index("surge")] = size * ahead
        out[:, axes.index("sway")] = size * abeam
        return out

    def term_value(self, term: SymbolicTerm) -> Array:
        """Return the value (N,) along the recording of a term of the symbolic regression.

        It is the product of the term's factors and of its course over time, without its
        coefficient.

        Args:
            term: A term of the symbolic regression.
        """
        vessel = self.problem.program.vessel
        acts = float(terms.COURSES.index(term.acts))
        size = np.asarray(
            terms.time_profile.py_func(self.recording.times, acts, term.begin, term.end)
        )
        little = 1.0
        if set(term.of) & set(terms.SENSES):
            little = term.with_all_parameters(vessel).little
        detail = (term.wavelength, term.crest, little, term.beyond)
        average = NO_AVERAGE
        if term.uses_history:
            looks_at, deviation = terms.history_codes(term.name, term.of, vessel.described_signals)
            average = (looks_at, deviation, term.memory)
        codes = terms.factor_codes(term.name, term.of, vessel.described_signals)
        for code in codes[: len(term.of)]:
            size = size * self.factor_value(code, detail, average)
        return size

    def factor_value(
        self, code: float, detail: terms.Detail, average: Average = NO_AVERAGE
    ) -> Array:
        """Return one factor (N,) of a term of the symbolic regression, for example a speed.

        It is evaluated at all rows of the recording.

        Args:
            code: Code of the factor, by `terms.factor_codes`.
            detail: Wavelength, crest, smallest speed and threshold of the term.
            average: Average over the past to which the factor refers.
        """
        key = code, detail, average
        if key not in self._factors:
            held = self.actuator_signals
            if average[0] and terms.RECALLED <= code < terms.FIRST_HELD:
                held = self.average_over_past(*average)[None]
            found = terms.factor_value.py_func(self.motion, held, 0, 0, code, detail)
            self._factors[key] = np.asarray(found, dtype=float)
        return self._factors[key]

    def average_over_past(self, looks_at: float, deviation: float, time_constant: float) -> Array:
        """Return the average over the past of an actuator signal or its size, along the recording.

        The deviation of the signal from that average may be returned instead.

        Args:
            looks_at: Code of the signal, by `terms.history_codes`.
            deviation: Whether the deviation from the average is returned, 1 or 0.
            time_constant: Time constant of the average [s].

        Returns:
            Values (N,).
        """
        signals = np.repeat(self.actuator_signals, 2, axis=0)
        signals[1::2] = np.abs(signals[1::2])
        if time_constant not in self._lagged:
            self._lagged[time_constant] = low_pass_row_means(
                signals, self.recording.times, time_constant
            )
        k = int(looks_at) - terms.FIRST_HELD
        average = self._lagged[time_constant][k]
        if deviation:
            average = signals[k] - average
        return np.asarray(average)

    def one_sided_thrust(self, side: str, sense: str) -> Array:
        """Return the force of the drives on one side of the hull while they push in one direction.

        Args:
            side: "port", "starboard" or "all".
            sense: "ahead", "astern" or "both".

        Returns:
            Force (N, axes) [N, N m].
        """
        if (side, sense) not in self._thrusts:
            program = self.problem.program
            placeholder = next(e.name for e in program.candidates if isinstance(e, DescribedThrust))
            values = self.parameter_values.copy()
            term = DescribedThrust(name=placeholder, side=side, sense=sense).with_all_parameters(
                program.vessel
            )
            for name, x in term.law_parameters().items():
                values[program.parameter_index(placeholder, name)] = x
            values[program.parameter_index(placeholder, "coefficient")] = 1.0
            states, held = (
                np.ascontiguousarray(self.states),
                np.ascontiguousarray(self.actuator_signals.T),
            )
            without = nominal_forces.body_forces(self.recording, states, held, values, ())
            doubled = nominal_forces.body_forces(
                self.recording, states, held, values, (placeholder,)
            )
            self._thrusts[side, sense] = doubled - without
        return self._thrusts[side, sense]


def fitted_recordings(problem: Problem, fit: Fit) -> list[FittedRecording]:
    """Return the recordings of a problem with the states and unexplained forces that a fit finds.

    Args:
        problem: The estimation problem.
        fit: A fit of it.
    """
    on, nq = problem.program.effect_switches(fit.effects), problem.program.module.NQ
    fitted = []
    for recording in problem.recordings:
        values = problem.parameter_vector(recording, fit.free, fit.theta)
        means, covariances, gains = recording.smooth(values, on, fit.levels)
        states, residual = means[:, : 2 * nq].copy(), means[:, 2 * nq : 3 * nq].copy()
        smoother = (covariances, gains)
        fitted.append(FittedRecording(problem, recording, fit, states, residual, smoother))
    return fitted
