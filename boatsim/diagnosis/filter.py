"""Recordings on a vessel's compiled filter: likelihood of parameters, smoothed states, missing force, free runs.

The model has one slowly varying latent force per freedom (Ornstein-Uhlenbeck, after Kristensen et al. 2004, grey-box
modelling). It stands for whatever is not modelled, so that parameter estimates are not bent to absorb it.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from boatsim.diagnosis import priors
from boatsim.errors import BadInput
from boatsim.physics.base import Unsteady, Wandering
from boatsim.physics.commands import taken_rows
from boatsim.physics.program import Program
from boatsim.physics.signals import AXES, NOISE, Array, signals_of
from boatsim.physics.vessel import Vessel
from boatsim.recordings.table import FEWEST_ROWS, HUGE, Recording

FEWEST_IN_PART = FEWEST_ROWS // 3  # rows: the shortest recording is split into thirds
# [s] largest integration step of a free run: that of the engine, so that lags are averaged alike
MAX_STEP = 0.02
FIT_STEP = 0.17  # [s] the same in the filter of a boat of 1.2 m, which is corrected at every sample
# tolerated forces by which actuators on their way, or a hand's push, may act when a recording
# begins
START = 3.0
# [rad] of phase by which Runge-Kutta is off when an oscillation of the hull has died out
LATE = 0.007
# of critical damping: an oscillation that dies out more slowly is corrected before it has
RINGING = 0.01
ROUNDS, NEAR = (
    4,
    0.1,
)  # times that a recording is smoothed, until the rates it begins with move by less of their sd
# a step of the filter in time constants of the hull's quickest motion there: less than
# Runge-Kutta's 2.8
AT_REST = 0.7
GRAVITY = 9.81  # [m/s^2]
FASTEST = 10.0  # Froude number that no boat reaches: positions are in another unit
# [kg], [m], [kg m^2] numbers of the body at the end of a track's values, as in `Program.body`
BODY = ("mass", "centre_ahead", "centre_below", "roll_inertia", "pitch_inertia", "yaw_inertia")
# times as noisy: recordings are of instruments unlike each other, not of one by chance
UNLIKE = 3.0
# of `Mass`, the last of a pass' constants: its diagonal, axis by axis, comes first
MASS_ENTRIES = 12
NOTHING = (
    np.zeros((1, 1)),
    np.zeros((1, 1, 1)),
    np.zeros((1, 1, 1)),
    np.zeros((1, 1)),
)  # where no pass is kept


@dataclass(frozen=True)
class NoiseLevels:
    """How noisy sensors and water are: one set for all recordings of a diagnosis."""

    force: Array  # (NQ,) rms of the latent force [N, N m]
    time_constant: float  # [s] of the latent force
    sensors: Mapping[str, float]  # standard deviation by noise family
    # (NQ,) least rms of the force when a recording begins
    begins: Array = field(default_factory=lambda: np.zeros(1))

    def lasting(self, seconds: float) -> "NoiseLevels":
        """The same slow force with another correlation time: what it does to the motion over long times stays."""
        return replace(
            self, force=self.force * np.sqrt(self.time_constant / seconds), time_constant=seconds
        )


@dataclass
class MappedRecording:
    """One recording laid on a program: what was measured and commanded, and this run's own parameter values."""

    name: str
    program: Program
    times: Array  # (N,) s
    measured: Array  # (N, C), nan where missing
    families: tuple[str, ...]  # noise family of each channel
    signals: tuple[str, ...]
    codes: Array  # (C,) integers
    commands: Array  # (N, K) mean until the next row
    values: Array  # nominal parameters of this run, then the body's `BODY`
    noise_scale: Mapping[str, float]  # this recording's sensor noise per common one, by family
    # what the recording's notes state besides
    facts: Mapping[str, Any] = field(default_factory=dict)
    # (M,) s, when commands change; empty: at its rows
    given: Array = field(default_factory=lambda: np.zeros(0))
    # (M, K) what they are from then on
    orders: Array = field(default_factory=lambda: np.zeros((0, 0)))
    # (NQ,) of the hull as written, with its water, axis by axis [kg, kg m^2]
    inertia: Array = field(init=False)
    start: Array = field(init=False)  # (n,) first state
    spread: Array = field(init=False)  # (n, n) its covariance without sensor noise
    # (NQ,) it begins at, of earth axes: the filter is linearised about them first
    rates: Array = field(init=False)

    def __post_init__(self) -> None:
        if not len(self.given):
            self.given, self.orders = changes(self.times, self.commands)
        self.rate, smooth = quickest(self.program, self.values, self.commands[0])
        usual = FIT_STEP * priors.froude_time(self.program.vessel)
        self.step = min(usual, AT_REST / max(self.rate, 1e-9), smooth)
        self.inertia = inertia_of(self.program, self.values, self.program.switches())
        nq = self.program.module.NQ
        self.start, self.spread, self.rates = (
            np.zeros(3 * nq),
            np.zeros((3 * nq, 3 * nq)),
            np.zeros(nq),
        )
        self._gains = np.zeros((*self.measured.shape, self.program.module.NZ))
        self._linear = np.zeros((len(self.times), 3 * nq, 3 * nq))
        self._steps = np.full(len(self.times), self.step)
        self._scale, self._white = np.zeros(self.measured.shape), np.zeros(self.measured.shape)
        self._begin(nq)

    def _begin(self, nq: int) -> None:
        """Where the recording begins, and how fast, by the positions that it shows and, of others, by their rates."""
        axes = axes_of(self.program.vessel)
        for c, code in enumerate(self.codes):
            good = np.isfinite(self.measured[:, c])
            if code < nq and good.any():
                y, t = self.measured[good, c], self.times[good]
                self.start[code] = y[0]
                gap = np.searchsorted(t, t + max(1.0, 4 * float(np.median(np.diff(t))))).clip(
                    max=len(t) - 1
                )
                far = gap > np.arange(len(t))
                speed = (y[gap] - y)[far] / (t[gap] - t)[far]
                self.spread[nq + code, nq + code] = (
                    float(np.mean(speed**2)) + 1e-8 if far.any() else 1.0
                )
                self.rates[code] = speed[0] if far.any() else 0.0
            elif code >= nq and code - nq not in self.codes and good.any():
                y, i = self.measured[good, c], code - nq
                self.rates[i], self.spread[code, code] = y[0], float(np.mean(y**2)) + 1e-8
        level = [i for i, axis in enumerate(axes) if axis in ("surge", "sway")]
        if (
            len(level) == 2 and "yaw" in axes and not set(level) & set(self.codes.tolist())
        ):  # from the hull's axes
            (u, v), psi = self.rates[level], self.start[axes.index("yaw")]
            self.rates[level] = u * np.cos(psi) - v * np.sin(psi), u * np.sin(psi) + v * np.cos(psi)
        for i in (
            level
        ):  # earth-axes velocities share one spread: the heading at the start is anybody's guess
            self.spread[nq + i, nq + i] = max(self.spread[nq + j, nq + j] for j in level)

    @property
    def stiff(self) -> bool:
        """Whether a motion of the hull dies out within a sample: its damping then moves the filter's gains most."""
        return self.rate * float(np.median(np.diff(self.times))) > 1.0

    def likelihood(
        self, values: Array, on: Array, levels: NoiseLevels, fresh: bool = True
    ) -> float:
        """Log likelihood of parameters; not `fresh`: linearised where the last fresh one was, for other levels."""
        return self._pass(values, on, levels, True, None, fresh)

    def whitened(self, values: Array, on: Array, levels: NoiseLevels) -> Array:
        """Whitened prediction errors (N * C,) with gains, outliers and scale of the last `likelihood`."""
        self._pass(values, on, levels, False, None)
        return self._white.ravel().copy()

    @property
    def tightness(self) -> float:
        """How little the last full pass allowed its measurements: log of the density that it expected at the best."""
        return float(np.sum(np.log(self._scale[self._scale > 0.0])))

    @property
    def white(self) -> Array:
        """Whitened prediction errors (N * C,) of the last pass."""
        return self._white.ravel().copy()

    def smoothed(self, values: Array, on: Array, levels: NoiseLevels) -> tuple[Array, Array]:
        """Smoothed states (N, n) and their covariances (N, n, n)."""
        means, covariances, _ = self.smoothed_with_gains(values, on, levels)
        return means, covariances

    def smoothed_with_gains(
        self, values: Array, on: Array, levels: NoiseLevels
    ) -> tuple[Array, Array, Array]:
        """`smoothed` with the smoother's gains G (N, n, n): the errors of rows i < j covary by G_i ... G_j-1 P_j.

        Linearised about the rates it finds for the first row, where the filter has but a guess of them.
        """
        n, dim, nq = len(self.times), self.program.module.NZ, self.program.module.NQ
        keep = (
            np.zeros((n, dim)),
            np.zeros((n, dim, dim)),
            np.zeros((n, dim, dim)),
            np.zeros((n, dim)),
        )
        means, covariances, transitions, predicted = keep
        gains, rates = np.zeros_like(transitions), self.rates
        for _ in range(ROUNDS):
            self._pass(values, on, levels, True, keep, rates=rates)
            self.program.module.smooth(
                means,
                covariances,
                transitions,
                predicted,
                gains,
                self.jolts(values, on, levels)[0] ** 2,
                self.times,
                levels.time_constant,
                values,
                on,
            )
            before, rates = rates, means[0, nq : 2 * nq].copy()
            sd = np.sqrt(np.maximum(np.diag(covariances[0])[nq : 2 * nq], 0.0))
            if (np.abs(rates - before) <= NEAR * sd).all():
                break
        return means, covariances, gains

    def free_runs(
        self, values: Array, on: Array, levels: NoiseLevels, horizon: float
    ) -> list[tuple[int, Array]]:
        """Free runs of `horizon` s, each started at its smoothed state: (first row, channels (M, 2 NQ) as recorded).

        Starts lie every horizon from the first row; a rest shorter than the horizon is left out.
        """
        means, _ = self.smoothed(values, on, levels)
        starts, ends = segments(self.times, horizon)
        if not starts:
            return []
        nq = self.program.module.NQ
        out = np.full((len(starts), len(self.times), 2 * nq), np.nan)
        states = np.ascontiguousarray(means[starts, : 2 * nq])
        self.program.module.free_runs(
            self.times,
            self.given,
            self.orders,
            MAX_STEP,
            body_of(values),
            values,
            on,
            np.array(starts),
            np.array(ends),
            states,
            out,
        )
        found = [
            (a, out[i, a : b + 1].copy()) for i, (a, b) in enumerate(zip(starts, ends, strict=True))
        ]
        for effect in self.program.effects:
            if isinstance(effect, Wandering) and on[self.program.effects.index(effect)]:
                lasts = values[self.program.index(effect.name, "time")]
                self._add_wander(found, means, lasts, 2 if self._swells(values, on) else 0)
        return found

    def _add_wander(
        self, runs: list[tuple[int, Array]], means: Array, lasts: float, swells: int
    ) -> None:
        """What is expected of an instrument's error after the start of each run: it dies out."""
        nq = self.program.module.NQ
        first = (3 + swells) * nq
        for a, shown in runs:
            since = self.times[a : a + len(shown)] - self.times[a]
            shown[:, :nq] += means[a, first : first + nq] * np.exp(-since / lasts)[:, None]

    def _swells(self, values: Array, on: Array) -> bool:
        """Whether the filter follows an oscillating force."""
        acting = (
            e for i, e in enumerate(self.program.effects) if isinstance(e, Unsteady) and on[i]
        )
        return any(
            values[self.program.index(e.name, n)] > 0.0 for e in acting for n in type(e).strength
        )

    def jolts(self, values: Array, on: Array, levels: NoiseLevels) -> tuple[Array, Array]:
        """Rms of the latent force on a hull of these values (NQ,), and that of the first row.

        It is what would shake the hull as written as much: were it the force itself, any mass added would calm the
        water, and be believed for that alone.
        """
        force = np.asarray(levels.force * inertia_of(self.program, values, on) / self.inertia)
        return force, np.maximum(force, levels.begins)

    def _pass(
        self,
        values: Array,
        on: Array,
        levels: NoiseLevels,
        full: bool,
        keep: tuple[Array, ...] | None,
        fresh: bool = True,
        rates: Array | None = None,
    ) -> float:
        nq = self.program.module.NQ
        noise = np.array([(levels.sensors[f] * self.noise_scale[f]) ** 2 for f in self.families])
        covariance = self.spread.copy()
        for c, code in enumerate(self.codes):
            if code < nq:
                covariance[code, code] = noise[c]
        force, begins = self.jolts(values, on, levels)
        for i in range(nq):
            covariance[2 * nq + i, 2 * nq + i] = begins[i] ** 2
            if covariance[nq + i, nq + i] == 0.0:
                covariance[nq + i, nq + i] = 1.0
        means, covariances, transitions, predicted = keep or NOTHING
        rates = self.rates if rates is None else rates
        found = self.program.module.kalman(
            self.times,
            self.measured,
            self.codes,
            self.given,
            self.orders,
            self.step,
            body_of(values),
            values,
            on,
            force**2,
            levels.time_constant,
            noise,
            self.start,
            covariance,
            rates,
            full,
            fresh,
            self._linear,
            self._steps,
            self._gains,
            self._scale,
            self._white,
            keep is not None,
            means,
            covariances,
            transitions,
            predicted,
        )
        return float(found)


def body_of(values: Array) -> Array:
    """Mass and inertias of a boat, the last of a track's values."""
    return values[-len(BODY) :]


def segments(times: Array, horizon: float) -> tuple[list[int], list[int]]:
    """Rows at which free runs start and end: every horizon from the first row, shorter rests left out."""
    starts, ends = [], []
    begin = float(times[0])
    step = float(np.median(np.diff(times)))
    while begin + horizon <= times[-1] + 0.5 * step:
        a, b = int(np.argmin(abs(times - begin))), int(np.argmin(abs(times - begin - horizon)))
        if b > a:
            starts.append(a)
            ends.append(b)
        begin += horizon
    return starts, ends


def axes_of(vessel: Vessel) -> tuple[str, ...]:
    """Names of the freedoms in the filter's order."""
    return tuple(a for a in AXES if a in vessel.dof)


def map_recording(
    recording: Recording,
    program: Program,
    stated: Mapping[str, float] | None = None,
    beside: Mapping[str, float] | None = None,
) -> MappedRecording:
    """Lay a recording on a program; `stated` is the sensor noise all recordings share, where its own differs.

    `beside` is how many times noisier than theirs its own instruments are, by family, where nobody states it. Raises
    BadInput if a column is missing that the vessel moves or is steered by, or if too few rows are left.
    """
    vessel = program.vessel
    axes = axes_of(vessel)
    where = _called(recording)
    found = [s for s in signals_of(vessel.dof) if s.column in recording.signals]
    needed = ["psi_rad"] if "yaw" in axes else []
    missing = [n for n in needed if n not in recording.signals] or _unfed(recording, vessel)
    if missing or all(s.rate for s in found):
        column = (missing or [signals_of(vessel.dof)[0].column])[0]
        raise BadInput(
            f"{where}: column {column} is missing, without which {vessel.name} can not be followed"
        )
    if len(recording) < FEWEST_IN_PART:
        raise BadInput(
            f"{where}: {recording.name} has {len(recording)} rows to use; at least {FEWEST_IN_PART} are needed"
        )
    codes = np.array([axes.index(s.axis) + s.rate * len(axes) for s in found])
    measured = np.column_stack([recording.signals[s.column] for s in found])
    own = checked_noise(recording)
    scale = {
        f: own.get(f, common) / common for f, common in (stated or NOISE | own).items()
    } | dict(beside or {})
    commands = (
        taken_rows(vessel, recording.signals, len(recording))
        if vessel.inputs
        else np.zeros((len(recording), 1))
    )
    facts = facts_of(vessel, recording)
    laid = MappedRecording(
        recording.name,
        program,
        np.ascontiguousarray(recording.t),
        np.ascontiguousarray(measured),
        tuple(s.noise for s in found),
        tuple(s.column for s in found),
        codes,
        np.ascontiguousarray(commands),
        stated_values(program, facts),
        scale,
        facts,
        *_orders_of(recording, vessel),
    )
    nq = len(axes)
    if "surge" in axes and (speed := float(np.sqrt(laid.spread[nq, nq]))) > FASTEST * np.sqrt(
        GRAVITY * vessel.length
    ):
        raise BadInput(
            f"{where}: x_m, y_m move at {speed:.3g} m/s, far beyond a hull of {vessel.length:g} m; are they in m?"
        )
    return laid


def changes(times: Array, commands: Array) -> tuple[Array, Array]:
    """Commands (M, K) with the times (M,) from which each is in force, those left out that repeat the one before."""
    new = np.append(True, (np.diff(commands, axis=0) != 0.0).any(axis=1))
    return np.ascontiguousarray(times[new]), np.ascontiguousarray(commands[new])


def _orders_of(recording: Recording, vessel: Vessel) -> tuple[Array, Array]:
    """Commands at their own times where a recording has them more often than in its rows, else empty."""
    if recording.orders is None or not vessel.inputs:
        return np.zeros(0), np.zeros((0, 0))
    t, signals = recording.orders.t, recording.orders.signals
    return changes(t, taken_rows(vessel, signals, len(t)))


def quickest(program: Program, values: Array, command: Array) -> tuple[float, float]:
    """Of the nominal hull at rest: rate at which its quickest motion dies out [1/s], step that follows its swings [s].

    Runge-Kutta's phase is off by (w h)^5 / 120 a step.
    """
    code, on = program.module, program.switches()
    nq = code.NQ
    k, act, memory = np.zeros(code.K), np.zeros(program.held_size), np.zeros(program.memory_size)
    code.constants(body_of(values), values, on, k)
    code.settle(command, memory, values, on, act)
    slopes = np.zeros((nq, 2 * nq))
    code.slopes(0.0, np.zeros(2 * nq), act, values, on, k, np.zeros(nq), slopes)
    if not np.isfinite(slopes).all():
        return 0.0, np.inf
    whole = np.block([[np.zeros((nq, nq)), np.eye(nq)], [slopes]])
    swings = [x for x in np.linalg.eigvals(whole) if x.imag > 0.0]
    smooth = [(120.0 * LATE * max(-x.real / x.imag, RINGING)) ** 0.25 / x.imag for x in swings]
    return float(np.abs(np.linalg.eigvals(slopes[:, nq:])).max()), float(
        min(smooth, default=np.inf)
    )


def inertia_of(program: Program, values: Array, on: Array) -> Array:
    """Mass or moment of inertia with which each freedom answers to a force of its own (NQ,) [kg, kg m^2]."""
    code = program.module
    k = np.zeros(code.K)
    code.constants(body_of(values), values, on, k)
    whole = k[-MASS_ENTRIES:][[AXES.index(axis) for axis in axes_of(program.vessel)]]
    return np.asarray(1.0 / whole if code.CLOSED else whole)


def stated_values(program: Program, facts: Mapping[str, Any]) -> Array:
    """Parameters of a program, those that a recording's facts state (`Effect.facts`) put in, then its body's numbers.

    Every random force is silenced: the filter finds its course, a free run knows none.
    """
    values = np.append(program.values(), program.body)
    for effect in program.effects:
        if isinstance(effect, Unsteady):
            values[program.index(effect.name, "realisation")] = 0.0
        for fact, names in type(effect).facts.items():
            for name, x in zip(names, facts.get(fact, ()), strict=False):
                values[program.index(effect.name, name)] = x
    return values


def _unfed(recording: Recording, vessel: Vessel) -> list[str]:
    """What laws take and the recording has not got: readings, and actuators without a command (PWM feeds thrust)."""
    there = recording.signals
    idle = [
        n
        for n in vessel.actuators
        if n not in there and not any(_feeds(vessel, n, m) for m in there)
    ]
    return idle + [n for n in vessel.readings if n not in there]


def _feeds(vessel: Vessel, actuator: str, command: str) -> bool:
    """Whether a channel effect of the vessel turns this command into that actuator."""
    return any(vessel.feeding_command(e, actuator) == command for e in vessel.effects)


def noise_of(vessel: Vessel, recordings: Sequence[Recording]) -> dict[str, float]:
    """Sensor noise by family that recordings share: what the first states, else the vessel, else what is in the data.

    Raises BadInput.
    """
    told = {str(family): sd for family, sd in vessel.diagnosis.noise.items()} | checked_noise(
        recordings[0]
    )
    return NOISE | {f: x for f in NOISE if (x := priors.sensed_noise(vessel, recordings, f))} | told


def noise_beside(
    vessel: Vessel, recordings: Sequence[Recording], recording: Recording
) -> dict[str, float]:
    """How many times noisier than in others a recording's instruments are, by family, where it is many times or few.

    An exact log and one by a camera must not be taken for equally good: a free run starts where its recording says.
    """
    families = [
        f for f in NOISE if f not in recording.notes.noise and f not in vessel.diagnosis.noise
    ]
    pairs = {
        f: [priors.sensed_noise(vessel, rs, f) for rs in ([recording], recordings)]
        for f in families
    }
    ratios = {f: own / common for f, (own, common) in pairs.items() if own and common}
    return {f: r for f, r in ratios.items() if not 1.0 / UNLIKE < r < UNLIKE}


def checked_noise(recording: Recording) -> dict[str, float]:
    """What a recording's notes state of its instruments. Raises BadInput."""
    told = recording.notes.noise
    if wrong := [n for n, sd in told.items() if not 0 < sd < HUGE]:
        raise BadInput(
            f"{_called(recording)}: noise {wrong[0]} = {told[wrong[0]]:g}; allowed is more than 0, at most {HUGE:g}"
        )
    return told


def facts_of(vessel: Vessel, recording: Recording) -> dict[str, Any]:
    """What is known of a run besides its columns: the vessel's word, unless the recording's notes say otherwise."""
    return {**vessel.diagnosis.facts, **recording.notes.facts}


def _called(recording: Recording) -> str:
    """The file of a recording, or its name."""
    return str(recording.path or recording.name)


def nominal_levels(vessel: Vessel, recordings: Sequence[Recording]) -> NoiseLevels:
    """What is known before any fit: ambient force as the first recording states it or by rule, noise.

    Raises BadInput.
    """
    axes, recording = axes_of(vessel), recordings[0]
    given = recording.notes.ambient.get("force_rms", {})
    if not isinstance(given, Mapping):
        named = recording.notes.ambient.get("axes", axes)
        if len(named) != len(given):
            raise BadInput(
                f"{_called(recording)}: ambient.force_rms = {given}; allowed are {len(named)} numbers, of "
                f"{', '.join(named)} in turn"
            )
        given = dict(zip(named, given, strict=True))
    ambient = priors.tolerated_force(vessel)
    force = np.array([float(given.get(a, ambient[a])) for a in axes])
    time_constant = float(
        recording.notes.ambient.get("time_constant_s", priors.time_constant(vessel))
    )
    for axis, rms in zip(axes, force.tolist(), strict=True):
        if not 0 < rms < HUGE:
            raise BadInput(
                f"{_called(recording)} on {vessel.name}: ambient force in {axis} = {rms:g}, what is tolerated; allowed "
                f"is more than 0, at most {HUGE:g}"
            )
    if not 0 < time_constant < HUGE:
        raise BadInput(
            f"{_called(recording)}: ambient time_constant_s = {time_constant:g}; allowed is more than 0, "
            f"at most {HUGE:g}"
        )
    return NoiseLevels(force, time_constant, noise_of(vessel, recordings), START * force)
