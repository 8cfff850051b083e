"""Evidence of a cause given its true force, and errors of free runs of the true model.

The force that a model without the cause lacks along the true motion is a known signal in coloured
noise: the ambient force plus the apparent force of the instrument noise. Gain = 1/2 sum |F|^2 / S
over all frequencies that the rows resolve, after projecting out the influence of the model's
coefficients and of a stronger ambient force (a matched filter: H. L. Van Trees, Detection,
Estimation, and Modulation Theory, part I, 1968, section 4.3).
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from validation.practice.cause import (
    Cause,
    apply_number_changes,
    instrument_pose,
    predictable_parts,
    sum_of_forces,
    water_velocity,
)
from validation.practice.motion import (
    RUNS,
    Array,
    Boat,
    generalised_force,
    motion_relative_to_water,
    runge_kutta_step,
)
from validation.practice.sail import ActuatorHistory, Voyage

FITTED = (0, 1)  # runs to diagnose from
HELD_OUT = 2
# prior sd of another force, as the length of its whitened vector: far above the strongest cause,
# whose length is about 100, so that forces of any size are projected out
ANY_SIZE = 1000.0


@dataclass(frozen=True)
class FineGridMotion:
    """A motion on the fine grid from the first row on, (K, 6, RUNS) each."""

    q: Array
    nu: Array
    nudot: Array


def flatten_runs(x: Array) -> Array:
    """Reshape (K, n, RUNS) to (n, K RUNS)."""
    return np.ascontiguousarray(np.moveaxis(x, 1, 0).reshape(x.shape[1], x.shape[0] * x.shape[2]))


class Oracle:
    """Evidence and reference errors of one trial."""

    def __init__(
        self, nominal: Boat, real: Boat, causes: Sequence[Cause], voyage: Voyage, noise: Array
    ) -> None:
        """Simulate the trial.

        `real` has perturbed coefficients and no cause yet; `noise` (6,) is that of the instruments.
        """
        self.nominal = nominal
        self.real = real
        self.causes = tuple(causes)
        self.voyage = voyage
        self.noise = noise
        grid = voyage.grid
        self.inside = slice(grid.lead, grid.lead + grid.steps + 1)
        count = grid.steps + 1
        self.t = np.repeat(np.arange(count) * grid.dt, RUNS)
        self.run = np.tile(np.arange(RUNS), count)
        self.own = voyage.actuators(nominal, ())
        q, nu = (x[self.inside] for x in (voyage.q, voyage.nu))
        still = self.needed(
            real, self.causes, self.actuators(self.causes), FineGridMotion(q, nu, np.zeros_like(nu))
        )
        nudot = np.einsum(
            "ij,kjb->kib",
            apply_number_changes(real, self.causes).inverse(),
            voyage.push[self.inside] - still,
        )
        self.true = FineGridMotion(q, nu, nudot)
        self.seen = self.recorded(self.causes)
        self.spectra = self._spectra()

    def actuators(self, causes: Sequence[Cause]) -> ActuatorHistory:
        """Return the actuators of the real boat with some of the causes."""
        return self.voyage.actuators(self.real, causes)

    def needed(
        self, boat: Boat, causes: Sequence[Cause], acts: ActuatorHistory, course: FineGridMotion
    ) -> Array:
        """Return the force (K, 6, RUNS) that a model lacks on this motion."""
        model = apply_number_changes(boat, causes)
        q, nu, act = (
            flatten_runs(course.q),
            flatten_runs(course.nu),
            flatten_runs(acts.begin[self.inside]),
        )
        m, _, carried = motion_relative_to_water(
            model, self.t, self.run, q, nu, act, water_velocity(causes)
        )
        found = (model.hull + model.water) @ flatten_runs(course.nudot) - generalised_force(
            model, m, carried, sum_of_forces(model, causes)
        )
        return np.moveaxis(found.reshape(6, -1, RUNS), 0, 1)

    def recorded(self, causes: Sequence[Cause]) -> FineGridMotion:
        """Return the true motion with these instrument errors, without noise."""
        measured = [c for c in causes if c.measured]
        if not measured:
            return self.true
        dt, late = self.voyage.grid.dt, round(sum(c.late for c in measured) / self.voyage.grid.dt)
        late_q = self.voyage.q[self.inside.start - late :][: len(self.true.q)]
        if late < 0:
            late_q = np.concatenate(
                [late_q, np.repeat(late_q[-1:], len(self.true.q) - len(late_q), axis=0)]
            )
        q = instrument_pose(measured, flatten_runs(late_q)).reshape(6, -1, RUNS)
        q = np.moveaxis(q, 0, 1)
        off = level_rates(q, dt) - level_rates(self.true.q, dt)
        return FineGridMotion(q, self.true.nu + off, self.true.nudot + np.gradient(off, dt, axis=0))

    def force_of(self, cause: Cause) -> Array:
        """Return the force (K, 6, RUNS) that a model without this cause lacks.

        Ambient forces are excluded.
        """
        if cause.measured:
            acts = self.actuators(self.causes)
            return self.needed(self.real, self.causes, acts, self.recorded([cause])) - self.needed(
                self.real, self.causes, acts, self.true
            )
        rest = [c for c in self.causes if c is not cause]
        return (
            self.needed(self.real, rest, self.actuators(rest), self.true)
            - self.voyage.push[self.inside]
        )

    def _spectra(self) -> Array:
        """Return two-sided spectra (6, F) [N^2 s] of ambient force and instrument noise.

        The noise is converted to force by the hull's impedance.
        """
        grid, b = self.voyage.grid, self.nominal
        w = 2 * np.pi * np.fft.rfftfreq(grid.steps + 1, grid.dt)
        tau = b.scale
        self.ambient = 2 * b.ambient()[:, None] ** 2 * tau / (1 + (w * tau) ** 2)
        mass = np.diag(b.hull + b.water)[:, None]
        stiff, damping = self._slopes()
        impedance = (stiff[:, None] - mass * w**2) ** 2 + (damping[:, None] * w) ** 2
        return np.asarray(self.ambient + impedance * self.noise[:, None] ** 2 * grid.row)

    def _slopes(self) -> tuple[Array, Array]:
        """Return stiffness and damping (6,) of the nominal hull at its usual speed, by axis."""
        b, none = self.nominal, np.zeros(13)
        q, nu = np.zeros((6, 13)), np.zeros((6, 13))
        nu[0] = b.cruise or 0.3 * b.scale
        q[range(6), range(1, 7)] = nu[range(6), range(7, 13)] = 1e-3
        nu[0, 1:7], nu[0, 8:] = nu[0, 0], nu[0, 0]
        nu[0, 7] = nu[0, 0] + 1e-3
        act = np.zeros((len(b.drive.lag), 13))
        m, _, _ = motion_relative_to_water(
            b, none, none.astype(np.int64), q, nu, act, lambda t, q, run: None
        )
        off = -(b.law(b.c, m) - b.law(b.c, m)[:, :1]) / 1e-3
        return np.diag(off[:, 1:7]), np.diag(off[:, 7:])

    def white(self, force: Array, runs: Sequence[int] = FITTED) -> Array:
        """Return a force as one vector scaled so that half its square is its gain [nats]."""
        grid = self.voyage.grid
        heard = np.fft.rfftfreq(grid.steps + 1, grid.dt) < 0.5 / grid.row
        axes = list(self.nominal.free)
        spectrum = (
            np.moveaxis(np.fft.rfft(force[:, axes][:, :, list(runs)], axis=0)[heard], 1, 0)
            * grid.dt
        )
        weight = np.where(np.arange(heard.sum()) == 0, 1.0, 2.0) / ((grid.steps + 1) * grid.dt)
        scaled = spectrum * np.sqrt(weight / self.spectra[axes][:, heard])[:, :, None]
        return np.stack([scaled.real, scaled.imag], 1).ravel()

    def coefficients(self) -> dict[str, Array]:
        """Return the force change (K, 6, RUNS) per specified sd of each nominal coefficient."""
        base = self.needed(self.nominal, (), self.own, self.seen)
        found = {}
        for name, kind in self.nominal.kinds.items():
            sd = self.nominal.uncertainty.get(kind, 0.05)
            other = replace(
                self.nominal, c={**self.nominal.c, name: self.nominal.c[name] * (1 + 0.01 * sd)}
            )
            found[name] = (self.needed(other, (), self.own, self.seen) - base) / 0.01
        return found

    def gain(self, force: Array, others: Sequence[Array]) -> float:
        """Return the evidence [nats] of a force after projecting out alternatives.

        The alternatives are the coefficients, other forces of any size, an ambient force of any
        size at the start of a recording, and a stronger ambient force in each axis.
        """
        y = self.white(force)
        columns = [self.white(f) for f in self.coefficients().values()]
        free = [
            ANY_SIZE * v / np.linalg.norm(v)
            for f in (*others, *self.initial_forces())
            if np.linalg.norm(v := self.white(f)) > 1e-9
        ]
        A = np.array([*columns, *free]).T
        theta = np.linalg.solve(A.T @ A + np.eye(A.shape[1]), A.T @ y)  # in prior sd
        left = y - A @ theta
        grid, axes = self.voyage.grid, list(self.nominal.free)
        heard = np.fft.rfftfreq(grid.steps + 1, grid.dt) < 0.5 / grid.row
        share = (self.ambient[axes] / self.spectra[axes])[:, heard]
        square = (left**2).reshape(len(axes), 2, heard.sum(), -1).sum(axis=(1, 3))
        count = np.full(heard.sum(), 2.0 * len(FITTED)) - (np.arange(heard.sum()) == 0) * len(
            FITTED
        )
        more = (
            1.0 + (np.geomspace(1.0, 30.0, 80)[:, None, None] ** 2 - 1.0) * share
        )  # spectrum per true one
        nats = 0.5 * (count * (np.log(more) + 1.0 / more - 1.0) + square / more).sum(axis=2)
        return float(nats.min(axis=0).sum() + 0.5 * theta @ theta)

    def initial_forces(self) -> list[Array]:
        """Return forces (K, 6, RUNS) that act at the start of one run and decay.

        An ambient force that is large when the recording begins decays with its correlation time.
        """
        time = np.arange(len(self.seen.q)) * self.voyage.grid.dt
        found = []
        for axis in self.nominal.free:
            for run in FITTED:
                force = np.zeros_like(self.seen.q)
                force[:, axis, run] = np.exp(-time / self.nominal.scale)
                found.append(force)
        return found

    def marginal(self, cause: Cause) -> float:
        """Return the evidence gain of a true cause given the trial's others."""
        return self.gain(
            self.force_of(cause), [self.force_of(c) for c in self.causes if c is not cause]
        )

    def beyond_library(self, cause: Cause) -> float:
        """Return the evidence gain of a cause over simple forces like those of the library."""
        return self.gain(self.force_of(cause), self.simple())

    def simple(self) -> list[Array]:
        """Return simple forces.

        They are steady forces in earth and hull axes, inertia, squares and products of rates, and
        gains and delays of actuators.
        """
        c, found = self.seen, []
        psi, zero = c.q[:, 5], np.zeros_like(c.q)

        def on(axis: int, value: Array) -> None:
            if axis in self.nominal.free:
                f = zero.copy()
                f[:, axis] = value
                found.append(f)

        if 0 in self.nominal.free:
            found += [
                force_in_plane(zero, np.cos(psi), -np.sin(psi)),
                force_in_plane(zero, np.sin(psi), np.cos(psi)),
            ]
        for axis in self.nominal.free:
            rate = c.nu[:, axis]
            for value in (np.ones_like(rate), c.nudot[:, axis], rate, np.abs(rate) * rate, rate**3):
                on(axis, value)
            if axis in (3, 4):
                on(axis, c.q[:, axis] ** 3)
        for axis in (1, 5):
            for value in (c.nu[:, 1], c.nu[:, 5], c.nu[:, 0] * c.nu[:, 1], c.nu[:, 0] * c.nu[:, 5]):
                on(axis, value)
        base = self.needed(self.nominal, (), self.own, c)
        for i in range(len(self.nominal.drive.lag)):
            size = np.abs(self.own.begin[:, i]).max() + 1e-9
            lag = (
                np.gradient(self.own.begin[:, i], self.voyage.grid.dt, axis=0) * self.nominal.scale
            )
            for change in (0.01 * size, 0.01 * self.own.begin[:, i], 0.01 * lag):
                begin = self.own.begin.copy()
                begin[:, i] += change
                found.append(
                    self.needed(self.nominal, (), ActuatorHistory(begin, begin, begin), c) - base
                )
        return found

    def recalibrated(self) -> Boat:
        """Return the nominal with coefficients fitted to the force it lacks.

        The fit uses the runs to diagnose from. Each axis is weighted by the residual, as if the
        ambient force were that strong.
        """
        names, axes = list(self.nominal.kinds), len(self.nominal.free)
        sd = np.array([self.nominal.uncertainty.get(self.nominal.kinds[n], 0.05) for n in names])
        y = self.white(self.needed(self.nominal, (), self.own, self.seen)).reshape(axes, -1)
        A = np.array([self.white(f).reshape(axes, -1) for f in self.coefficients().values()])
        theta, heard = np.zeros(len(names)), max(int((y[0] != 0.0).sum()), 1)
        for _ in range(4):
            rms = np.sqrt(
                np.maximum(((y + np.tensordot(theta, A, 1)) ** 2).sum(axis=1) / heard, 1.0)
            )[:, None]
            B, z = (A / rms).reshape(len(names), -1), (y / rms).ravel()
            theta = -np.linalg.solve(B @ B.T + np.eye(len(names)), B @ z)
        fitted = {}
        for n, s, x in zip(names, sd, theta, strict=True):
            fitted[n] = self.nominal.c[n] * max(1 + s * x, 0.05)
        return replace(self.nominal, c={**self.nominal.c, **fitted})

    def free_runs(self, horizon: float, rng: np.random.Generator) -> dict[str, float]:
        """Return the position rms [m] over free runs of the held-out run.

        The models are nominal, recalibrated and true structure. All start from the truth with the
        errors that a smoother leaves.
        """
        off = self.left_by_smoother()[:, :, None] * rng.standard_normal((2, 6, 64))
        causes, real = predictable_parts(self.causes), apply_number_changes(self.real, self.causes)
        late = round(sum(c.late for c in self.causes) / self.voyage.grid.dt)
        acts = self.actuators(self.causes)
        fitted = self.recalibrated()
        return {
            "nominal": self._runs(self.nominal, (), self.own, horizon, off, self.seen, 0),
            "recalibrated": self._runs(
                fitted, (), self.voyage.actuators(fitted, ()), horizon, off, self.seen, 0
            ),
            "true_structure": self._runs(real, causes, acts, horizon, off, None, late),
        }

    def left_by_smoother(self) -> Array:
        """Return the sd (2, 6) of smoothed pose and rates.

        White acceleration q and white noise r leave r w / sqrt(8), times w^2 for rates, with w^4 =
        q / r, of a double integrator (B. D. O. Anderson, J. B. Moore, Optimal Filtering, 1979,
        chapter 7).
        """
        r = self.noise**2 * self.voyage.grid.row + 1e-18
        mass = np.maximum(np.diag(self.nominal.hull + self.nominal.water), 1e-9)
        w = np.minimum(
            (2 * self.nominal.ambient() ** 2 * self.nominal.scale / mass**2 / r) ** 0.25, 10.0
        )
        pose = np.sqrt(r * w / np.sqrt(8.0))
        return np.array([pose, pose * w]) * np.isin(np.arange(6), self.nominal.free)

    def _runs(
        self,
        boat: Boat,
        causes: Sequence[Cause],
        acts: ActuatorHistory,
        horizon: float,
        off: Array,
        start: FineGridMotion | None,
        late: int,
    ) -> float:
        """Return the rms over all free runs, which are simulated as columns.

        With `start` None they begin at the true state and are compared as recorded.
        """
        grid, v = self.voyage.grid, self.voyage
        rows = round(horizon / grid.row)
        first = np.arange(0, grid.rows - rows, rows) * grid.every
        run, at = np.full(len(first), HELD_OUT), grid.lead + first - late
        q, nu = (v.q[at, :, HELD_OUT].T, v.nu[at, :, HELD_OUT].T)
        if start is not None:
            q, nu = start.q[first, :, HELD_OUT].T, start.nu[first, :, HELD_OUT].T
        q, nu = q + off[0, :, : len(first)], nu + off[1, :, : len(first)]
        force = sum_of_forces(boat, causes)
        flow = water_velocity(causes)
        inverse = boat.inverse()
        none = np.zeros_like(q)
        squares = []
        for i in range(rows * grid.every + 1):
            if i % grid.every == 0:
                row = first // grid.every + i // grid.every
                squares.append(
                    (instrument_pose(causes, q)[:2] - v.recorded[row, :2, HELD_OUT].T) ** 2
                )
            now = np.minimum(at + i, len(v.q) - 1)
            three = tuple(part[now, :, HELD_OUT].T for part in acts)
            t = (now - grid.lead) * grid.dt
            q, nu = runge_kutta_step(
                boat,
                t,
                run,
                q,
                nu,
                (three[0], three[1], three[2]),
                grid.dt,
                none,
                force,
                flow,
                inverse,
            )
        return float(np.sqrt(np.mean(squares)))


def level_rates(q: Array, dt: float) -> Array:
    """Return surge, sway and yaw rates (K, 6, RUNS) of recorded positions and headings."""
    found, moved = np.zeros_like(q), np.gradient(q, dt, axis=0)
    c, s = np.cos(q[:, 5]), np.sin(q[:, 5])
    found[:, 0], found[:, 1] = c * moved[:, 0] + s * moved[:, 1], c * moved[:, 1] - s * moved[:, 0]
    found[:, 5] = moved[:, 5]
    return found


def force_in_plane(like: Array, surge: Array, sway: Array) -> Array:
    """Return a force with these two components."""
    f = like.copy()
    f[:, 0], f[:, 1] = surge, sway
    return f
