"""A flexible model of the force that a vessel model lacks, and free runs with it.

It has no form: the missing force of each axis is a Gaussian process of velocities and commands,
fitted to the force that the smoother finds in the fitted recordings. What it cannot predict on
held-out recordings, hardly any law of these inputs can.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from boatsim.diagnosis.filter import MappedRecording, free_run_segments, rigid_body_values
from boatsim.diagnosis.free_runs import FreeRun, free_runs, rms_errors
from boatsim.diagnosis.problem import Fit, Problem
from boatsim.physics.kernel.records import Inputs, LawArguments, VesselState
from validation.real.gaussian_process import GaussianProcess, fit_gaussian_process

Array = NDArray[np.float64]

FLEXIBLE = "flexible"  # name of the model among the free runs
SMOOTHINGS = (1.0, 2.0, 4.0)  # factors of the likely lengths; the best by leaving out runs is used
ROW_SPACING = 1e-9  # [s] tolerance of the times of commands, as in the filter


class FlexibleModel:
    """A vessel model with a Gaussian process for the missing force of each axis.

    Args:
        problem: The estimation problem, whose recordings are fitted.
        fit: Fit of the vessel model that lacks the force.
        recordings: Recordings that the processes are fitted to.
        smoothing: Factor of the most likely lengths of the processes.
    """

    def __init__(
        self,
        problem: Problem,
        fit: Fit,
        recordings: Sequence[MappedRecording],
        smoothing: float = 1.0,
    ) -> None:
        self.problem, self.fit, self.smoothing = problem, fit, smoothing
        inputs, forces = [], []
        for mapped in recordings:
            means = self._means(mapped)
            nq = mapped.program.module.NQ
            inputs.append(_inputs(mapped, means[:, : 2 * nq]))
            forces.append(means[:, 2 * nq : 3 * nq])
        X, F = np.vstack(inputs), np.vstack(forces)
        self.processes: list[GaussianProcess] = []
        for force in F.T:
            self.processes.append(fit_gaussian_process(X, force, smoothing))

    def free_runs(self, mapped: MappedRecording, horizon: float) -> list[Array]:
        """Simulate free runs with the missing force of the processes.

        They begin at the same rows and states as those of `MappedRecording.free_runs`.

        Args:
            mapped: The recording.
            horizon: Length of each free run [s].

        Returns:
            States of each free run, each (M, 2 NQ).
        """
        starts, ends = free_run_segments(mapped.times, horizon)
        means, module = self._means(mapped), mapped.program.module
        values, on = self._values(mapped), self._switches(mapped)
        k = np.zeros(module.K)
        module.compute_mass_constants(rigid_body_values(values), values, on, k)
        laws = LawArguments(values, on, k)
        memory, act = np.zeros(module.MEMORY), np.zeros(3 * module.HELD)
        inputs = mapped.times_and_commands
        module.settle_actuators(inputs.commands[0], memory, values, on, act)
        y = np.zeros(2 * module.NQ)
        plant = VesselState(y, memory, act, np.zeros(module.NQ))
        step, delay = mapped.config.free_run_step, module.motion_latency(values, on)
        memories, rows = [memory.copy()], [0]
        for i in range(1, len(mapped.times)):  # only for the actuators
            y[:] = 0.0
            last, _ = module.predict_motion(inputs, i, delay, rows[-1], step, laws, plant, True)
            rows.append(last)
            memories.append(memory.copy())
        runs = []
        for begin, end in zip(starts, ends, strict=True):
            y[:], memory[:], last = means[begin, : 2 * module.NQ], memories[begin], rows[begin]
            states = [y.copy()]
            for i in range(begin + 1, end + 1):
                plant.force[:] = self._force(module, y, _command_at(inputs, mapped.times[i - 1]))
                last, _ = module.predict_motion(inputs, i, delay, last, step, laws, plant, True)
                states.append(y.copy())
            runs.append(np.array(states))
        return runs

    def _force(self, module: Any, y: Array, command: Array) -> list[float]:
        x = np.append(_velocities(module, y), command)
        return [process.predict(x) for process in self.processes]

    def _means(self, mapped: MappedRecording) -> Array:
        return mapped.smooth(self._values(mapped), self._switches(mapped), self.fit.levels).means

    def _values(self, mapped: MappedRecording) -> Array:
        return self.problem.parameter_vector(mapped, self.fit.free, self.fit.theta)

    def _switches(self, mapped: MappedRecording) -> Array:
        return mapped.program.effect_switches(self.fit.effects)


def compared_free_runs(
    problem: Problem,
    fits: Mapping[str, Fit],
    flexible: FlexibleModel,
    recordings: Sequence[MappedRecording],
    horizon: float,
) -> list[FreeRun]:
    """Return free runs of fitted models, and of the flexible one as a further model.

    Args:
        problem: The estimation problem.
        fits: Fits by the name of the model.
        flexible: The flexible model.
        recordings: The recordings.
        horizon: Length of each free run [s].
    """
    found = []
    for mapped in recordings:
        own = flexible.free_runs(mapped, horizon)
        compared = free_runs(problem, fits, [mapped], horizon)
        for run, states in zip(compared, own, strict=True):
            signals = {}
            for signal, code in zip(mapped.signals, mapped.codes, strict=True):
                if signal in run.channels["recorded"]:
                    signals[signal] = states[:, code]
            found.append(replace(run, channels={**run.channels, FLEXIBLE: signals}))
    return found


def tuned_flexible_model(problem: Problem, fit: Fit, horizon: float) -> FlexibleModel:
    """Return the flexible model whose smoothing predicts each fitted recording best from the rest.

    Args:
        problem: The estimation problem, whose recordings are fitted.
        fit: Fit of the vessel model that lacks the force.
        horizon: Length of the free runs that are compared [s].
    """
    runs = problem.recordings
    if len(runs) == 1:
        return FlexibleModel(problem, fit, runs)
    errors = {}
    for smoothing in SMOOTHINGS:
        found = []
        for out in runs:
            rest = [run for run in runs if run is not out]
            model = FlexibleModel(problem, fit, rest, smoothing)
            found += compared_free_runs(problem, {"retuned": fit}, model, [out], horizon)
        ratio = 1.0
        for by_model in rms_errors(found).values():
            ratio *= by_model[FLEXIBLE] / by_model["retuned"]
        errors[smoothing] = ratio
    best = min(errors, key=errors.__getitem__)
    return FlexibleModel(problem, fit, runs, best)


def _inputs(mapped: MappedRecording, states: Array) -> Array:
    """Velocities and commands (N, D) of each row."""
    module, commands = mapped.program.module, mapped.times_and_commands
    rows = []
    for t, y in zip(mapped.times, states, strict=True):
        rows.append(np.append(_velocities(module, y), _command_at(commands, t)))
    return np.array(rows)


def _velocities(module: Any, y: Array) -> Array:
    motion = module.pose_and_velocities(y)
    return np.array([motion.u, motion.v, motion.r, motion.phi, motion.p])


def _command_at(inputs: Inputs, t: float) -> Array:
    row = np.searchsorted(inputs.change_times, t + ROW_SPACING, side="right") - 1
    return inputs.commands[max(int(row), 0)]
