"""Recordings mapped to a vessel's compiled Kalman filter: likelihoods, smoothed states, free runs.

The model has one slowly varying latent force per degree of freedom, an Ornstein-Uhlenbeck process
(grey-box modelling, Kristensen et al. 2004). It represents whatever is not modelled, so that the
estimates of parameters are not biased to absorb it.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from boatsim.diagnosis import priors
from boatsim.diagnosis.config import DEFAULT, FilterConfig
from boatsim.diagnosis.filter_arguments import (
    FilterArguments,
    VesselArguments,
    inertia_with_added_mass,
    rigid_body_values,
)
from boatsim.diagnosis.recent_results import RecentResults
from boatsim.diagnosis.work import (
    CORRECTION,
    COVARIANCE,
    DERIVATIVES,
    SMOOTHER,
    RecordingSize,
    WorkCount,
)
from boatsim.physics.base import (
    DriftingMeasurement,
    FilteredSignal,
    MotionMemory,
    RandomForce,
)
from boatsim.physics.kernel.records import (
    FilterHistory,
    InitialState,
    Inputs,
    PassArrays,
    PassOptions,
    VesselNumbers,
)
from boatsim.physics.native.calls import PackedArgument
from boatsim.physics.program import Program
from boatsim.physics.signals import AXES, Array
from boatsim.physics.vessel import Vessel

# Latest results of a recording that are kept, because the stages of a diagnosis ask for them again.
# A pass over 6,000 rows in six degrees of freedom has 30 MB, free runs have 1 MB.
KEPT_PASSES = 2
KEPT_FREE_RUNS = 8
KEPT_SMOOTHED = 4
# numbers in all smoothed states of a recording that are kept, 32 MB
LARGEST_SMOOTHED = 4_000_000
KEPT_LIKELIHOODS = 512
# errors with the gains of a pass: those of a recording whose group an effect does not concern
KEPT_ERRORS = 2
# variance added to the mean square of recorded speeds, so that it is positive [m^2/s^2, rad^2/s^2]
LEAST_RATE_VARIANCE = 1e-8


@dataclass(frozen=True)
class NoiseLevels:
    """Standard deviations of sensor noise, and rms and correlation time of the latent force.

    The latent force is the stochastic, unmodelled force that the Kalman filter estimates on each
    axis. All recordings of a diagnosis share these levels.
    """

    force: Array  # (NQ,) rms of the latent force [N, N m]
    time_constant: float  # [s] correlation time of the latent force
    sensors: Mapping[str, float]  # standard deviation by noise family
    # (NQ,) lower bound of the rms of the latent force when a recording begins
    initial_force: Array = field(default_factory=lambda: np.zeros(1))
    # (NQ,) spectral density of the part of a measured force that does not move the hull, in
    # addition to the noise that its samples show [N^2 s, N^2 m^2 s]; empty: no force is measured
    white: Array = field(default_factory=lambda: np.zeros(0))

    @cached_property
    def key(self) -> bytes:
        """All numbers, as a key for results that depend on them."""
        numbers = repr((self.time_constant, sorted(self.sensors.items()))).encode()
        arrays = (self.force, self.initial_force, self.white)
        return b"".join([numbers, *(array.tobytes() for array in arrays)])

    def with_other_correlation_time(self, seconds: float) -> "NoiseLevels":
        """Return noise levels with another correlation time of the latent (unmodelled) force.

        Its rms is changed so that its effect on slow motion stays the same.

        Args:
            seconds: Correlation time of the latent force [s].
        """
        force = self.force * np.sqrt(self.time_constant / seconds)
        return replace(self, force=force, time_constant=seconds)


class ReusedArrays(NamedTuple):
    """Arrays of a pass of the filter, as arguments of further passes that use them again."""

    for_errors: PackedArgument  # transitions, steps, gains and scale
    for_likelihood: PackedArgument  # transitions and steps


@dataclass(frozen=True, eq=False)
class FilterPass:
    """Result of one pass of the extended Kalman filter over a recording.

    It holds the log likelihood, the whitened prediction errors, the gains and the linearisation.
    The arrays are read-only.
    """

    log_likelihood: float
    whitened: Array  # (N C,) prediction errors in standard deviations, 0 where nothing was recorded
    gains: Array  # (N, C, n)
    # (N, C) inverse sds of the prediction errors, less for outliers, 0 where missing
    scale: Array
    transitions: Array  # (N, 3 NQ, 3 NQ) linearised transitions of motion and latent force
    steps: Array  # (N,) longest integration step before each row [s]; the first is their number
    integrations: float  # number of integration steps between the rows

    @cached_property
    def packed(self) -> dict[FilterArguments, ReusedArrays]:
        """Arrays of this pass as arguments of the compiled filter of a recording."""
        return {}

    @cached_property
    def whitened_errors(self) -> RecentResults[Array]:
        """Latest whitened prediction errors that were computed with the gains of this pass."""
        return RecentResults(KEPT_ERRORS)

    @property
    def log_density_at_predictions(self) -> float:
        """Log density of measurements that would be equal to the filter's predictions.

        It depends on the predicted covariances only, not on the prediction errors, and is known up
        to a constant.
        """
        return float(np.sum(np.log(self.scale[self.scale > 0.0])))

    @property
    def log_density_of_rows(self) -> Array:
        """(N,) log density of the measurements of each row, given the rows before.

        It is known up to a constant. An outlier counts with the inverse standard deviation that the
        filter gave it.
        """
        errors = self.whitened.reshape(self.scale.shape)
        recorded = self.scale > 0.0
        log_scale = np.log(np.where(recorded, self.scale, 1.0))
        found: Array = np.sum(log_scale - 0.5 * errors**2, axis=1)
        return found


class SmoothedStates(NamedTuple):
    """States of a recording estimated by the Rauch-Tung-Striebel smoother, with their covariances.

    The errors of rows i < j have the covariance gains[i] @ ... @ gains[j - 1] @ covariances[j].
    """

    means: Array  # (N, n)
    covariances: Array  # (N, n, n)
    gains: Array  # (N, n, n) of the Rauch-Tung-Striebel smoother


class HullMotion(NamedTuple):
    """Fastest decay rate of the nominal hull about rest, and the integration step it allows."""

    decay_rate: float  # [1/s] of the fastest motion
    largest_step: float  # [s] with which Runge-Kutta follows its oscillations


class Drift(NamedTuple):
    """Drift of an instrument at the starts of free runs, from which it decays exponentially."""

    effect: str  # name of the effect, whose parameter "time" is the decay time [s]
    offsets: Array  # (runs, NQ) added to the recorded coordinates


class FreeRunStarts(NamedTuple):
    """First and last rows of the free runs over a recording, and the states they begin with."""

    starts: NDArray[np.int64]  # (runs,)
    ends: NDArray[np.int64]  # (runs,)
    states: Array  # (runs, 2 NQ) smoothed joint coordinates and their rates
    drifts: tuple[Drift, ...]
    # (N, 2 NQ) those of all rows, where effects remember the motion before a run; else (0, 2 NQ)
    path: Array

    @property
    def key(self) -> bytes:
        """All that the starts consist of, as one key."""
        parts = [self.starts, self.ends, self.states, self.path]
        parts += [drift.offsets for drift in self.drifts]
        return b"".join(part.tobytes() for part in parts)


@dataclass(frozen=True, eq=False)
class MappedRecording:
    """A recording expressed in the signals of a compiled vessel program, ready for the filter.

    It holds measurements, commands and the parameter values of the vessel model for this recording.
    """

    name: str
    program: Program
    times: Array  # (N,) s
    measured: Array  # (N, C), nan where missing
    families: tuple[str, ...]  # noise family of each channel
    signals: tuple[str, ...]  # column of each channel
    codes: Array  # (C,) integers: index of a position, or NQ + index of a body-axes rate
    commands: Array  # (N, K) mean until the next row
    values: Array  # nominal parameters of this run, then the numbers `BODY` of the hull
    noise_scale: Mapping[str, float]  # this recording's sensor noise in shared levels, by family
    facts: Mapping[str, Any] = field(default_factory=dict)
    # (M,) s, times at which commands change; empty: at the rows
    command_times: Array = field(default_factory=lambda: np.zeros(0))
    # (M, K) commands from then on
    command_values: Array = field(default_factory=lambda: np.zeros((0, 0)))
    # initial state, where it is not estimated from the measurements
    specified_initial: InitialState | None = None
    # [s] integration step, where it does not follow from the hull's motion
    specified_step: float | None = None
    # (NQ,) spectral density of the noise of measured forces and moments [N^2 s, N^2 m^2 s]
    input_noise: Array = field(default_factory=lambda: np.zeros(0))
    groups: tuple[str, ...] = ()  # of recordings, to which it belongs
    config: FilterConfig = DEFAULT.filter
    # work that was done; all recordings of a diagnosis share one count
    filtered: WorkCount = field(default_factory=WorkCount)

    def __post_init__(self) -> None:
        if not len(self.command_times):
            times, values = command_changes(self.times, self.commands)
            object.__setattr__(self, "command_times", times)
            object.__setattr__(self, "command_values", values)

    @cached_property
    def initial_state_prior(self) -> InitialState:
        """Prior of the Kalman filter's state at the first row of the recording."""
        return self.specified_initial or _estimated_initial(self)

    @property
    def times_and_commands(self) -> Inputs:
        """Row times and commands of the recording in the form that the compiled functions take."""
        return Inputs(self.times, self.command_times, self.command_values)

    @cached_property
    def _passes(self) -> RecentResults[FilterPass]:
        return RecentResults(KEPT_PASSES)

    @cached_property
    def _likelihoods(self) -> RecentResults[float]:
        return RecentResults(KEPT_LIKELIHOODS)

    @cached_property
    def _smoothed(self) -> RecentResults[SmoothedStates]:
        size = 2 * len(self.times) * self.program.module.NZ**2
        return RecentResults(min(KEPT_SMOOTHED, LARGEST_SMOOTHED // size))

    @cached_property
    def _free_runs(self) -> RecentResults[list[tuple[int, Array]]]:
        return RecentResults(KEPT_FREE_RUNS)

    @cached_property
    def inertia_with_added_mass(self) -> Array:
        """(NQ,) mass or moment of inertia of the nominal hull with added mass [kg, kg m^2]."""
        return inertia_with_added_mass(self.program, self.values, self.program.effect_switches())

    @cached_property
    def largest_step(self) -> float:
        """Largest integration step [s] of the Kalman filter for this recording.

        It is limited by the usual step, by stability and by the oscillations of the hull.
        """
        if self.specified_step is not None:
            return self.specified_step
        config, motion = self.config, self._motion
        usual = config.filter_step * priors.froude_time_scale(self.program.vessel)
        stable = config.decay_step / max(motion.decay_rate, 1e-9)
        return min(usual, stable, motion.largest_step)

    @property
    def fitting_step(self) -> float:
        """Largest integration step [s] of the free runs to which parameters are fitted.

        The step of a free run, which suits a hull of 1.2 m, grows with the time scale of a longer
        hull (Froude's law), up to the step of the filter.
        """
        usual = self.config.free_run_step
        scaled = usual * priors.froude_time_scale(self.program.vessel)
        return max(usual, min(scaled, self.largest_step))

    @cached_property
    def _motion(self) -> HullMotion:
        return hull_time_scales(self.program, self.values, self.commands[0], self.config)

    @property
    def is_stiff(self) -> bool:
        """Whether the fastest motion of the hull decays within one sample of the recording.

        The damping of such a hull influences the gains of the Kalman filter most.
        """
        return self._motion.decay_rate * float(np.median(np.diff(self.times))) > 1.0

    def filter(
        self, values: Array, on: Array, levels: NoiseLevels, about: FilterPass | None = None
    ) -> FilterPass:
        """Run the extended Kalman filter over the recording and return its complete result.

        Args:
            values: Parameter values of the vessel model, as `values` of the recording.
            on: (effects,) 1 for the effects that act, else 0.
            levels: Levels of sensor noise and of the latent (unmodelled) force.
            about: Pass whose linearisation is used again, for other noise levels; None: linearise.
        """
        if about is not None:
            return self._run_filter(values, on, levels, about)
        key = _key_of(values, on, levels)
        found = self._passes.result(key, lambda: self._run_filter(values, on, levels, None))
        self._likelihoods.result(key, lambda: found.log_likelihood)
        return found

    def _run_filter(
        self, values: Array, on: Array, levels: NoiseLevels, about: FilterPass | None
    ) -> FilterPass:
        n, channels = self.measured.shape
        whitened = np.zeros((n, channels))
        gains = np.zeros((n, channels, self.program.module.NZ))
        scale = np.zeros((n, channels))
        if about is None:
            state = len(self.initial_state_prior.mean)
            transitions = np.zeros((n, state, state))
            steps = np.full(n, self.largest_step)
        else:
            transitions = _writable(about.transitions)
            steps = _writable(about.steps)
        arrays = PassArrays(transitions, steps, gains, scale, whitened)
        packed = self._filter_arguments.pack_arrays(arrays)
        found = self._run(values, on, levels, packed, fresh=about is None)
        integrations = float(steps[0]) if about is None else about.integrations
        further = COVARIANCE if about else COVARIANCE + DERIVATIVES
        self._count_pass(integrations, further)
        return FilterPass(
            found,
            _read_only(whitened.ravel()),
            _read_only(gains),
            _read_only(scale),
            _read_only(transitions),
            _read_only(steps),
            integrations,
        )

    def log_likelihood(
        self, values: Array, on: Array, levels: NoiseLevels, about: FilterPass | None = None
    ) -> float:
        """Return only the log likelihood of the recording by the extended Kalman filter.

        It costs less than a complete pass by `filter`, which takes the same arguments.
        """
        if about is not None:
            arrays = self._reused_arrays(about).for_likelihood
            found = self._run(values, on, levels, arrays, fresh=False)
            self._count_pass(about.integrations, COVARIANCE)
            return found
        key = _key_of(values, on, levels)
        return self._likelihoods.result(key, lambda: self.filter(values, on, levels).log_likelihood)

    def whitened_errors(
        self, values: Array, on: Array, levels: NoiseLevels, about: FilterPass
    ) -> Array:
        """Return the filter's whitened prediction errors (N C,) with the gains of another pass.

        Fixed gains make the errors a smooth function of the parameters, as Gauss-Newton steps need.

        Args:
            values: Parameter values of the vessel model for this recording.
            on: (effects,) 1 for the effects that act, else 0.
            levels: Levels of sensor noise and of the latent (unmodelled) force.
            about: Pass whose gains, scale and integration steps are used.
        """
        key = _key_of(values, on, levels)
        return about.whitened_errors.result(
            key, lambda: self._whitened_errors(values, on, levels, about)
        )

    def _whitened_errors(
        self, values: Array, on: Array, levels: NoiseLevels, about: FilterPass
    ) -> Array:
        own = self._filter_arguments
        self._run(values, on, levels, self._reused_arrays(about).for_errors, full=False)
        self._count_pass(about.integrations, 0.0)
        return _read_only(own.whitened.flatten())

    def _reused_arrays(self, about: FilterPass) -> ReusedArrays:
        """Return the arrays of a pass as arguments of passes that use them again."""
        own = self._filter_arguments
        if own not in about.packed:
            transitions, steps = _writable(about.transitions), _writable(about.steps)
            gains, scale = _writable(about.gains), _writable(about.scale)
            held = PassArrays(transitions, steps, gains, scale, own.whitened)
            about.packed[own] = ReusedArrays(
                own.pack_arrays(held), own.pack_arrays_for_likelihood(transitions, steps)
            )
        return about.packed[own]

    def _count_pass(self, integrations: float, further: float) -> None:
        """Count the work of a pass that computes more than corrections in each row."""
        self.filtered.add_pass(integrations, self._size, CORRECTION + further)

    @cached_property
    def _size(self) -> RecordingSize:
        rows, channels = self.measured.shape
        filters = sum(isinstance(effect, FilteredSignal) for effect in self.program.effects)
        dof, actuators = self.program.module.NQ, self.commands.shape[1]
        return RecordingSize(rows, channels, dof, actuators, filters)

    def smooth(self, values: Array, on: Array, levels: NoiseLevels) -> SmoothedStates:
        """Return the smoothed states of the recording (Rauch-Tung-Striebel smoother).

        The model is linearised about the rates that are found for the first row.

        Args:
            values: Parameter values of the vessel model for this recording.
            on: (effects,) 1 for the effects that act, else 0.
            levels: Levels of sensor noise and of the latent (unmodelled) force.
        """
        key = _key_of(values, on, levels)
        return self._smoothed.result(key, lambda: self._smooth(values, on, levels))

    def _smooth(self, values: Array, on: Array, levels: NoiseLevels) -> SmoothedStates:
        n, channels = self.measured.shape
        nq, largest_size = self.program.module.NQ, self.program.module.NZ
        state = len(self.initial_state_prior.mean)
        size = largest_size if self._has_further_states(on) else state
        arrays = PassArrays(
            np.zeros((n, state, state)),
            np.full(n, self.largest_step),
            np.zeros((n, channels, largest_size)),
            np.zeros((n, channels)),
            np.zeros((n, channels)),
        )
        means, covariances = np.zeros((n, size)), np.zeros((n, size, size))
        transitions, predicted = np.zeros((n, size, size)), np.zeros((n, size))
        gains, rates = np.zeros_like(transitions), self.initial_state_prior.rates
        own = self._filter_arguments
        packed = own.pack_arrays(arrays)
        keep = FilterHistory(means, covariances, transitions, predicted)
        history = own.pack_history(keep)
        for _ in range(self.config.smoother_passes):
            start = own.pack_start(rates)
            self._run(values, on, levels, packed, start=start, history=history)
            self._count_pass(float(arrays.steps[0]), COVARIANCE + DERIVATIVES + SMOOTHER)
            self.program.estimation_functions.smooth_states(
                keep, gains, self.times, own.force, values, on
            )
            before, rates = rates, means[0, nq : 2 * nq].copy()
            sd = np.sqrt(np.maximum(np.diag(covariances[0])[nq : 2 * nq], 0.0))
            if (np.abs(rates - before) <= self.config.smoother_tolerance * sd).all():
                break
        return SmoothedStates(_read_only(means), _read_only(covariances), _read_only(gains))

    def free_runs(
        self, values: Array, on: Array, levels: NoiseLevels, horizon: float, skipped: float = 0.0
    ) -> list[tuple[int, Array]]:
        """Simulate free runs: from states of the recording, with the recorded commands alone.

        They start from the smoothed states, one after another; a remainder shorter than the horizon
        is omitted.

        Args:
            values: Parameter values of the vessel model for this recording.
            on: (effects,) 1 for the effects that act, else 0.
            levels: Levels of sensor noise and of the latent (unmodelled) force.
            horizon: Length of each free run [s].
            skipped: Time from the first row before which none starts [s].

        Returns:
            First row and channels (M, 2 NQ), as the recording would show them, of each free run.
        """
        key = _key_of(values, on, levels, horizon, skipped)

        def simulate() -> list[tuple[int, Array]]:
            starts = self.free_run_starts(values, on, levels, horizon, skipped)
            return self.simulate_from(values, on, starts)

        return self._free_runs.result(key, simulate)

    def simulate_from(
        self, values: Array, on: Array, begin: FreeRunStarts, step: float | None = None
    ) -> list[tuple[int, Array]]:
        """Simulate free runs from given states, with the recorded commands alone.

        Args:
            values: Parameter values of the vessel model for this recording.
            on: (effects,) 1 for the effects that act, else 0.
            begin: Where the runs begin and end, and the states they begin with.
            step: Largest integration step [s]; None: that of the configuration.

        Returns:
            First row and channels (M, 2 NQ), as the recording would show them, of each free run.
        """
        if not len(begin.starts):
            return []
        nq = self.program.module.NQ
        step = self.config.free_run_step if step is None else step
        # only the rows of each run are filled and read
        out = np.empty((len(begin.starts), len(self.times), 2 * nq))
        steps = self.program.estimation_functions.simulate_intervals(
            self.times_and_commands,
            step,
            VesselNumbers(rigid_body_values(values), values, on),
            begin.starts,
            begin.ends,
            np.concatenate([begin.states, begin.path]),
            out,
        )
        self.filtered.add_free_runs(steps, self._size)
        runs = []
        for simulated, first, last in zip(out, begin.starts, begin.ends, strict=True):
            runs.append((int(first), simulated[first : last + 1].copy()))
        for drift in begin.drifts:
            decay_time = values[self.program.parameter_index(drift.effect, "time")]
            for (first, channels), offset in zip(runs, drift.offsets, strict=True):
                since = self.times[first : first + len(channels)] - self.times[first]
                channels[:, :nq] += offset * np.exp(-since / decay_time)[:, None]
        return runs

    def free_run_starts(
        self, values: Array, on: Array, levels: NoiseLevels, horizon: float, skipped: float = 0.0
    ) -> FreeRunStarts:
        """Return where free runs begin and end, and the smoothed states that they begin with.

        Args:
            values: Parameter values of the vessel model for this recording.
            on: (effects,) 1 for the effects that act, else 0.
            levels: Levels of sensor noise and of the latent (unmodelled) force.
            horizon: Length of each free run [s].
            skipped: Time from the first row before which none starts [s].
        """
        nq = self.program.module.NQ
        starts, ends = free_run_segments(self.times, horizon, skipped)
        if not starts:
            none = np.zeros(0, dtype=np.int64)
            return FreeRunStarts(none, none, np.zeros((0, 2 * nq)), (), np.zeros((0, 2 * nq)))
        means = self.smooth(values, on, levels).means
        oscillators = 2 if self._oscillates(values, on) else 0
        at = (3 + oscillators) * nq
        drifts = []
        for effect, acts in zip(self.program.effects, on, strict=True):
            if isinstance(effect, DriftingMeasurement) and acts:
                drifts.append(Drift(effect.name, means[starts, at : at + nq].copy()))
        states = np.ascontiguousarray(means[starts, : 2 * nq])
        rows = len(means) if self._remembers_motion(on) else 0
        path = np.ascontiguousarray(means[:rows, : 2 * nq])
        return FreeRunStarts(np.array(starts), np.array(ends), states, tuple(drifts), path)

    def _remembers_motion(self, on: Array) -> bool:
        """Whether an effect acts whose force depends on the past motion of the hull."""
        for effect, acts in zip(self.program.effects, on, strict=True):
            if acts and isinstance(effect, MotionMemory):
                return True
        return False

    def _has_further_states(self, on: Array) -> bool:
        """Whether an effect acts that adds entries to the filter's state."""
        for effect, acts in zip(self.program.effects, on, strict=True):
            if acts and isinstance(effect, RandomForce | DriftingMeasurement):
                return True
        return False

    def _oscillates(self, values: Array, on: Array) -> bool:
        """Whether the filter's state contains an oscillating force."""
        for effect, acts in zip(self.program.effects, on, strict=True):
            if isinstance(effect, RandomForce) and acts:
                places = [
                    self.program.parameter_index(effect.name, n) for n in type(effect).strength
                ]
                if (values[places] > 0.0).any():
                    return True
        return False

    def latent_force_rms(
        self, values: Array, on: Array, levels: NoiseLevels
    ) -> tuple[Array, Array]:
        """Return the rms of the latent (unmodelled) force, scaled to the inertia of a fitted hull.

        The force causes the same accelerations as the given level on the nominal hull. If the force
        itself were kept, added mass would reduce the accelerations and gain evidence for that
        alone.

        Args:
            values: Parameter values of the vessel model for this recording.
            on: (effects,) 1 for the effects that act, else 0.
            levels: Levels of sensor noise and of the latent (unmodelled) force.

        Returns:
            Rms (NQ,) [N, N m], and rms (NQ,) at the first row.
        """
        arguments = self._vessel_arguments
        arguments.write(values, on)
        inertia = arguments.inertia_with_added_mass()
        force = np.asarray(levels.force * inertia / self.inertia_with_added_mass)
        return force, np.maximum(force, levels.initial_force)

    def _run(
        self,
        values: Array,
        on: Array,
        levels: NoiseLevels,
        arrays: PackedArgument,
        *,
        full: bool = True,
        fresh: bool = True,
        start: PackedArgument | None = None,
        history: PackedArgument | None = None,
    ) -> float:
        """Run the compiled filter, which fills or uses `arrays`; return the log likelihood.

        Without new gains (`full`), the levels do not matter except the correlation time.
        """
        own = self._filter_arguments
        if full:
            sds = [levels.sensors[f] * self.noise_scale[f] for f in self.families]
            force, initial_force = self.latent_force_rms(values, on, levels)
            own.write_variances(np.array(sds), initial_force)
            own.write_force(force, levels.time_constant, self._white_noise(levels))
        else:
            self._vessel_arguments.write(values, on)
            own.write_time_constant(levels.time_constant)
        options = PassOptions(self.largest_step, full, fresh, history is not None)
        return own.run(options, arrays, start, history)

    @cached_property
    def _vessel_arguments(self) -> VesselArguments:
        return VesselArguments(self.program)

    @cached_property
    def _filter_arguments(self) -> FilterArguments:
        return FilterArguments(
            self.program,
            self.times_and_commands,
            self.measured,
            self.codes,
            self.initial_state_prior,
            self._vessel_arguments.numbers,
        )

    def _white_noise(self, levels: NoiseLevels) -> Array:
        """Spectral densities (NQ,) of the noise of measured forces."""
        white = np.zeros(self.program.module.NQ)
        if len(self.input_noise):
            white = white + self.input_noise
        if len(levels.white):
            white = white + levels.white
        return white


def _key_of(values: Array, on: Array, levels: NoiseLevels, *times: float) -> bytes:
    """All that a result for a recording depends on, as one key."""
    key = values.tobytes() + on.tobytes() + levels.key
    return key + repr(times).encode() if times else key


def _read_only(array: Array) -> Array:
    """Return a read-only view."""
    view = array.view()
    view.flags.writeable = False
    return view


def _writable(view: Array) -> Array:
    """Return the array under a read-only view.

    Compiled functions accept writable arrays only; those that get it do not change it.
    """
    assert isinstance(view.base, np.ndarray)
    return view.base


def _estimated_initial(mapped: MappedRecording) -> InitialState:
    """Estimate the initial state from measured positions and, where there are none, rates."""
    axes = dof_in_state_order(mapped.program.vessel)
    nq = mapped.program.module.NQ
    mean, covariance, rates = np.zeros(3 * nq), np.zeros((3 * nq, 3 * nq)), np.zeros(nq)
    for c, code in enumerate(mapped.codes):
        recorded = np.isfinite(mapped.measured[:, c])
        if not recorded.any():
            continue
        y, t = mapped.measured[recorded, c], mapped.times[recorded]
        rate = nq + code
        if code < nq:
            mean[code] = y[0]
            speed = rates_of_change(t, y, mapped.config)
            covariance[rate, rate] = mapped.config.usual_rate**2
            if len(speed):
                covariance[rate, rate] = float(np.mean(speed**2)) + LEAST_RATE_VARIANCE
                rates[code] = speed[0]
        elif code - nq not in mapped.codes:
            rates[code - nq] = y[0]
            covariance[code, code] = float(np.mean(y**2)) + LEAST_RATE_VARIANCE
    level = [i for i, axis in enumerate(axes) if axis in ("surge", "sway")]
    by_rates = not set(level) & set(mapped.codes.tolist())
    if len(level) == 2 and "yaw" in axes and by_rates:  # from body axes to earth axes
        (u, v), psi = rates[level], mean[axes.index("yaw")]
        rates[level] = u * np.cos(psi) - v * np.sin(psi), u * np.sin(psi) + v * np.cos(psi)
    # earth-axes velocities share one variance, because the initial heading is arbitrary
    for i in level:
        covariance[nq + i, nq + i] = max(covariance[nq + j, nq + j] for j in level)
    return InitialState(mean, covariance, rates)


def rates_of_change(t: Array, y: Array, config: FilterConfig) -> Array:
    """Return the rates of change of a signal over some rows, but at least some time.

    Args:
        t: Times (N,) [s], increasing.
        y: Values (N,) of the signal.
        config: Settings of the filter: the least number of rows and time.

    Returns:
        Rates of change, in the unit of the signal per second; fewer than N.
    """
    time = max(config.rate_time, config.rate_rows * float(np.median(np.diff(t))))
    gap = np.searchsorted(t, t + time)
    gap = gap.clip(max=len(t) - 1)
    far = gap > np.arange(len(t))
    return np.asarray((y[gap] - y)[far] / (t[gap] - t)[far])


def free_run_segments(
    times: Array, horizon: float, skipped: float = 0.0
) -> tuple[list[int], list[int]]:
    """Return the first and last rows of the free runs into which a recording is divided.

    A free run is a simulation from a recorded state with the recorded commands alone.

    Args:
        times: (N,) times of the rows [s].
        horizon: Length of each free run [s]; a shorter remainder is omitted.
        skipped: Time from the first row before which none starts [s].
    """
    starts, ends = [], []
    begin = float(times[0]) + skipped
    step = float(np.median(np.diff(times)))
    while begin + horizon <= times[-1] + 0.5 * step:
        start = int(np.argmin(abs(times - begin)))
        end = int(np.argmin(abs(times - begin - horizon)))
        if end > start:
            starts.append(start)
            ends.append(end)
        begin += horizon
    return starts, ends


def dof_in_state_order(vessel: Vessel) -> tuple[str, ...]:
    """Return the degrees of freedom of a vessel in the order of the Kalman filter's state."""
    return tuple(axis for axis in AXES if axis in vessel.dof)


def command_changes(times: Array, commands: Array) -> tuple[Array, Array]:
    """Reduce sampled commands to the rows at which they change.

    Returns:
        Times (M,) [s] of the changes, and the commands (M, K) from then on.
    """
    new = np.append(True, (np.diff(commands, axis=0) != 0.0).any(axis=1))
    return np.ascontiguousarray(times[new]), np.ascontiguousarray(commands[new])


def hull_time_scales(
    program: Program, values: Array, command: Array, config: FilterConfig
) -> HullMotion:
    """Return the fastest decay rate and the largest integration step of the nominal hull.

    The model is linearised about rest. The step keeps the phase error of Runge-Kutta, (w h)^5 / 120
    per step, small for all oscillations.

    Args:
        program: Compiled effects of the vessel.
        values: Parameter values of the vessel model for this recording.
        command: (K,) commands in force.
        config: Settings of the filter.
    """
    code, on = program.estimation_functions, program.effect_switches()
    nq = code.NQ
    constants, memory = np.zeros(code.K), np.zeros(program.memory_size)
    actuators = np.zeros(program.actuator_signal_size)
    code.compute_mass_constants(rigid_body_values(values), values, on, constants)
    code.settle_actuators(command, memory, values, on, actuators)
    slopes = np.zeros((nq, 2 * nq))
    rest = np.zeros(2 * nq)
    code.acceleration_jacobian(0.0, rest, actuators, values, on, constants, np.zeros(nq), slopes)
    if not np.isfinite(slopes).all():
        return HullMotion(0.0, np.inf)
    whole = np.block([[np.zeros((nq, nq)), np.eye(nq)], [slopes]])
    largest_step = np.inf
    for x in np.linalg.eigvals(whole):
        if x.imag > 0.0:
            damping = max(-x.real / x.imag, config.least_damping_ratio)
            step = (120.0 * config.phase_error * damping) ** 0.25 / x.imag
            largest_step = min(largest_step, float(step))
    decay_rate = float(np.abs(np.linalg.eigvals(slopes[:, nq:])).max())
    return HullMotion(decay_rate, largest_step)
