"""What a term is along a recording: the force that goes with it, row by row, where the boat was."""

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from boatsim.diagnosis.filter import MappedRecording, axes_of
from boatsim.diagnosis.locate import nominal_forces
from boatsim.diagnosis.problem import Fit, Problem
from boatsim.physics import terms
from boatsim.physics.base import Array, Motion
from boatsim.physics.described_laws import Described
from boatsim.physics.effects.described_force import DescribedForce
from boatsim.physics.effects.described_thrust import DescribedThrust
from boatsim.physics.signals import AXES

Late = tuple[float, float, float]  # what is recalled, by `terms.looks`, and its time constant [s]
NEVER: Late = (0.0, 0.0, 1.0)


def lagged(signals: Array, times: Array, time_constant: float) -> Array:
    """(K, N) means, from row to row, of what follows signals (K, N) with a lag; each is held from row to row."""
    steps = np.append(np.diff(times), times[-1] - times[-2]) / time_constant
    decay = np.exp(-steps)
    out, y = np.empty_like(signals), signals[:, 0]
    for row, (step, kept) in enumerate(zip(steps.tolist(), decay.tolist(), strict=True)):
        x = signals[:, row]
        out[:, row] = x + (y - x) * ((1.0 - kept) / step)
        y = x + (y - x) * kept
    return out


@dataclass(frozen=True)
class Way:
    """A recording as a fit sees it: motion and actuators of every row, the force it leaves over."""

    problem: Problem
    track: MappedRecording
    found: Fit
    states: Array  # (N, 2 NQ) smoothed
    left: Array  # (N, axes) force left over [N, N m]
    smoother: tuple[
        Array, Array
    ]  # covariances (N, n, n) of the smoothed states, and the smoother's gains (N, n, n)

    @cached_property
    def motion(self) -> Motion:
        """Of every row, each field (N,)."""
        vessel, rows = self.problem.program.vessel, len(self.states)
        axes, nq = axes_of(vessel), self.problem.program.module.NQ
        given: dict[str, Any] = dict.fromkeys(Motion._fields, np.zeros(rows)) | {
            "t": self.track.times
        }
        rates = self.problem.program.body_rates(self.states)[:, nq:]
        symbols = dict(
            zip(
                AXES,
                zip(("x", "y", "z", "phi", "theta", "psi"), "uvwpqr", strict=True),
                strict=True,
            )
        )
        for i, axis in enumerate(axes):
            place, speed = symbols[axis]
            given |= {place: self.states[:, i], speed: rates[:, i]}
        c, s = np.cos(given["psi"]), np.sin(given["psi"])
        north, east = (
            self.problem.program.module.flow(self.values, self.on)
            if "surge" in axes
            else (0.0, 0.0)
        )
        given |= {"cos_psi": c, "sin_psi": s, "wr": given["w"]}
        given |= {"ur": given["u"] - c * north - s * east, "vr": given["v"] - c * east + s * north}
        return Motion(**given)

    @cached_property
    def values(self) -> Array:
        """Numbers of the fitted boat."""
        return self.problem.values(self.track, self.found.free, self.found.theta)

    @cached_property
    def on(self) -> Array:
        """Which effects act."""
        return self.problem.program.switches(self.found.effects)

    @cached_property
    def held(self) -> Array:
        """(HELD, N) actuators."""
        return nominal_forces.actuator_states(self.track, self.found.effects, self.values).T

    @cached_property
    def _thrusts(self) -> dict[tuple[str, str], Array]:
        return {}

    @cached_property
    def _factors(self) -> dict[tuple[float, terms.Detail, Late], Array]:
        return {}

    @cached_property
    def _lagged(self) -> dict[float, Array]:
        return {}

    def along(self, term: Described) -> Array:
        """(N, axes) force [N, N m] of a term with a coefficient of one; nothing where it is of another recording."""
        axes = axes_of(self.problem.program.vessel)
        if term.run not in ("", self.track.name):
            return np.zeros((len(self.states), len(axes)))
        size = self.size(term)
        if isinstance(term, DescribedThrust):
            return self.thrust(term.side, term.sense) * size[:, None]
        assert isinstance(term, DescribedForce)
        out, m = np.zeros((len(size), len(axes))), self.motion
        if term.axis in axes:
            out[:, axes.index(term.axis)] = size
        else:
            ahead, abeam = (
                (m.cos_psi, -m.sin_psi) if term.axis == "north" else (m.sin_psi, m.cos_psi)
            )
            out[:, axes.index("surge")], out[:, axes.index("sway")] = size * ahead, size * abeam
        return out

    def size(self, term: Described) -> Array:
        """(N,) product of a term's factors and its course."""
        vessel = self.problem.program.vessel
        acts = float(terms.COURSES.index(term.acts))
        size = np.asarray(terms.course.py_func(self.track.times, acts, term.begin, term.end))
        little = term.completed(vessel).little if set(term.of) & set(terms.SENSES) else 1.0
        detail = (term.wavelength, term.crest, little, term.beyond)
        late = (
            (*terms.looks(term.name, term.of, vessel.described_signals), term.memory)
            if term.looks_back
            else NEVER
        )
        for number in terms.codes(term.name, term.of, vessel.described_signals)[: len(term.of)]:
            size = size * self.factor(number, detail, late)
        return size

    def factor(self, number: float, detail: terms.Detail, late: Late = NEVER) -> Array:
        """(N,) one factor."""
        key = number, detail, late
        if key not in self._factors:
            held = self.recalled(*late)[None] if late[0] else self.held
            held = held if terms.RECALLED <= number < terms.FIRST_HELD else self.held
            found = terms.factor.py_func(self.motion, held, 0, 0, number, detail)
            self._factors[key] = np.asarray(found, dtype=float)
        return self._factors[key]

    def recalled(self, looks_at: float, beyond: float, memory: float) -> Array:
        """(N,) an actuator signal, or its size, as it was of late, or by how much it is beyond that; row to row."""
        signals = np.repeat(self.held, 2, axis=0)
        signals[1::2] = np.abs(signals[1::2])
        if memory not in self._lagged:
            self._lagged[memory] = lagged(signals, self.track.times, memory)
        k = int(looks_at) - terms.FIRST_HELD
        late = self._lagged[memory][k]
        return np.asarray(signals[k] - late if beyond else late)

    def thrust(self, side: str, sense: str) -> Array:
        """(N, axes) force of the drives on one side while they push in one sense."""
        if (side, sense) not in self._thrusts:
            slot = next(
                e for e in self.problem.program.candidates if isinstance(e, DescribedThrust)
            )
            whole, own = self.values.copy(), DescribedThrust(name=slot.name, side=side, sense=sense)
            program = self.problem.program
            for name, x in own.completed(program.vessel).by_name().items():
                whole[program.index(slot.name, name)] = x
            whole[program.index(slot.name, "coefficient")] = 1.0
            states, held = np.ascontiguousarray(self.states), np.ascontiguousarray(self.held.T)
            nothing, everything = (
                nominal_forces.body_forces(self.track, states, held, whole, effects)
                for effects in ((), (slot.name,))
            )
            self._thrusts[side, sense] = everything - nothing
        return self._thrusts[side, sense]


def ways(problem: Problem, found: Fit) -> list[Way]:
    """The recordings fitted, as a fit sees them."""
    on, nq = problem.program.switches(found.effects), problem.program.module.NQ
    out = []
    for track in problem.recordings:
        values = problem.values(track, found.free, found.theta)
        means, *smoother = track.smooth(values, on, found.levels)
        states, left = means[:, : 2 * nq].copy(), means[:, 2 * nq : 3 * nq].copy()
        out.append(Way(problem, track, found, states, left, (smoother[0], smoother[1])))
    return out
