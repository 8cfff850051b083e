"""Simulations of a trial with their own parameters, starts, ambient force and noise.

Each window of a recording starts at the recorded state, as in the other methods, with the error of
that estimate. boatsim's compiled model simulates the deterministic motion; the ambient force enters
through the linearised response of the nominal motion, because a compiled window has no random
force. The summary of a simulation is its deviation from the recording, averaged over parts of each
window. The summary of the recording itself is therefore zero.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from boatsim.diagnosis.filter import MappedRecording, rigid_body_values
from boatsim.physics.base import Array
from boatsim.physics.kernel.records import Inputs, VesselNumbers
from validation.rivals.question import Question, free_parameters
from validation.rivals.windows import FIRST, Windows

PARTS = 6  # averages of each channel in a window
KNEE = 3.0  # [noise sds] deviation above which a summary grows with its logarithm
# of the sd of a start: thrust jumps within the second to which a parabola is fitted
INFLATION = 1.5
LARGE = 1e3  # [m, rad] deviation of a simulation that has diverged


@dataclass(frozen=True)
class Hypothesis:
    """Effects that act and the free parameters (F,) of that structure."""

    effects: tuple[str, ...]
    theta: Array


@dataclass(frozen=True)
class Recorded:
    """One recording with what is the same in all its simulations."""

    run: Windows
    starts: Array  # (W, 2 NQ) estimated
    start_sd: Array  # (W, 2 NQ)
    averaging: Array  # (C, P, R) weights of the rows of all windows in the averages
    noise_sd: Array  # (S,) of the averages [m, rad]
    knees: Array  # (S,) noise of a single value [m, rad]
    response: Array  # (S, N NQ) of the averages to unit ambient forces in each row


class Simulator:
    """Simulations of the recordings of a trial."""

    def __init__(self, question: Question) -> None:
        self.question, self.problem = question, question.problem
        self.recorded = [self._prepare(track) for track in self.problem.recordings]

    def summaries(self, hypotheses: Sequence[Hypothesis], rng: np.random.Generator) -> Array:
        """Return the summaries (n, S) of one simulation of each hypothesis.

        Args:
            hypotheses: The hypotheses (n,).
            rng: Generator of starts, ambient forces and noise.
        """
        return np.array([self._summary(hypothesis, rng) for hypothesis in hypotheses])

    def _summary(self, hypothesis: Hypothesis, rng: np.random.Generator) -> Array:
        """Return the summary (S,) of one simulation."""
        free = free_parameters(self.question, hypothesis.effects)
        on = self.problem.program.effect_switches(hypothesis.effects)
        found = []
        for one in self.recorded:
            track = one.run.track
            values = self.problem.parameter_vector(track, free, hypothesis.theta)
            starts = one.starts + one.start_sd * rng.standard_normal(one.starts.shape)
            deviations = -np.vstack(one.run.errors(values, on, starts))
            averages = average_parts(one.averaging, deviations)
            averages += one.response @ self._ambient(track, rng)
            averages += one.noise_sd * rng.standard_normal(len(averages))
            found.append(np.arcsinh(averages / (KNEE * one.knees)))
        return np.concatenate(found)

    def _ambient(self, track: MappedRecording, rng: np.random.Generator) -> Array:
        """Return a sample (N NQ,) of a first-order Gauss-Markov process of unit variance."""
        h = float(np.median(np.diff(track.times)))
        keep = float(np.exp(-h / self.problem.ambient.time_constant))
        out = rng.standard_normal((len(track.times), track.program.module.NQ))
        for i in range(1, len(out)):
            out[i] = keep * out[i - 1] + np.sqrt(1.0 - keep**2) * out[i]
        return out.ravel()

    def _prepare(self, track: MappedRecording) -> Recorded:
        """Return what is the same in all simulations of a recording."""
        run = Windows.of(track, self.problem.horizon)
        noise = np.array([self.question.noise[f] for f in track.families])
        starts, start_sd = estimated_starts(run, noise)
        averaging = averaging_weights(run)
        # the variance of a mean of n values is 1/n of theirs, the sum of the squared weights
        noise_sd = noise[:, None] * np.sqrt((averaging**2).sum(axis=2))
        return Recorded(
            run,
            starts,
            start_sd,
            averaging,
            noise_sd.T.ravel(),
            np.tile(noise, averaging.shape[1]),
            self._response(run, starts, averaging),
        )

    def _response(self, run: Windows, starts: Array, averaging: Array) -> Array:
        """Return the response (S, N NQ) of the averages to ambient forces of one sd in a row."""
        track, nq = run.track, run.track.program.module.NQ
        h = float(np.median(np.diff(track.times)))
        kicks = self.problem.ambient.force * h / track.inertia_with_added_mass  # (NQ,) body rates
        begins = np.concatenate(
            [np.arange(a, b) for a, b in zip(run.begins, run.ends, strict=True)]
        )
        ends = np.repeat(run.ends, run.ends - run.begins)
        nominal = simulate(run, run.begins, run.ends, starts)
        window = np.repeat(np.arange(len(run.begins)), run.ends - run.begins)
        states = nominal[window, begins]  # (R, 2 NQ) positions and body rates
        base = simulate(run, begins, ends, track.program.to_joint_rates(states))
        channels, parts, rows = averaging.shape
        first = np.concatenate([[0], np.cumsum(run.ends + 1 - run.begins)])  # row of each window
        out = np.zeros((parts * channels, len(track.times), nq))
        for axis in range(nq):
            kicked = states.copy()
            kicked[:, nq + axis] += kicks[axis]
            moved = simulate(run, begins, ends, track.program.to_joint_rates(kicked)) - base
            for r, row in enumerate(begins.tolist()):
                w = int(window[r])
                deviations = np.zeros((rows, channels))
                own = moved[r, run.begins[w] : run.ends[w] + 1][:, track.codes]
                deviations[first[w] : first[w + 1]] = np.nan_to_num(own)
                out[:, row, axis] = average_parts(averaging, deviations)
        return out.reshape(len(out), -1)


def simulate(run: Windows, begins: Array, ends: Array, states: Array) -> Array:
    """Return nominal positions and body rates (R, N, 2 NQ) from states (R, 2 NQ), else nan."""
    track, program = run.track, run.track.program
    out = np.full((len(begins), len(track.times), states.shape[1]), np.nan)
    values = track.values.copy()
    program.estimation_functions.simulate_intervals(
        Inputs(track.times, track.command_times, track.command_values),
        track.largest_step,
        VesselNumbers(rigid_body_values(values), values, program.effect_switches(())),
        np.ascontiguousarray(begins),
        np.ascontiguousarray(ends),
        np.ascontiguousarray(states),
        out,
    )
    return out


def estimated_starts(run: Windows, noise: Array) -> tuple[Array, Array]:
    """Return the state (W, 2 NQ) at each window's first row by local parabolas, and its sd.

    Args:
        run: The windows.
        noise: Noise (C,) of the channels [m, rad].
    """
    track, nq = run.track, run.track.program.module.NQ
    starts, sd = np.zeros((len(run.begins), 2 * nq)), np.zeros((len(run.begins), 2 * nq))
    for w, row in enumerate(run.begins.tolist()):
        reach = FIRST if row == 0 else 0.5 * FIRST
        near = np.abs(track.times - track.times[row]) <= reach
        for c, code in enumerate(track.codes.tolist()):
            good = near & np.isfinite(track.measured[:, c])
            if code >= nq or good.sum() < 4:
                continue
            since = track.times[good] - track.times[row]
            powers = np.column_stack([np.ones(len(since)), since, since**2])
            found = np.linalg.lstsq(powers, track.measured[good, c], rcond=None)[0]
            spread = noise[c] * np.sqrt(np.diag(np.linalg.inv(powers.T @ powers)))
            starts[w, [code, nq + code]] = found[:2]
            sd[w, [code, nq + code]] = INFLATION * spread[:2]
    return starts, sd


def averaging_weights(run: Windows) -> Array:
    """Return the weights (C, P, R) with which rows of all windows enter each average.

    A window has PARTS averages of each channel, without its first row. Missing values have no
    weight; a part without a value in some channel is left out.
    """
    measured = [run.track.measured[a : b + 1] for a, b in zip(run.begins, run.ends, strict=True)]
    recorded = np.isfinite(np.vstack(measured))  # (R, C)
    found, first = [], 0
    for rows in measured:
        edges = first + np.linspace(1, len(rows), PARTS + 1).astype(int)
        for begin, end in zip(edges[:-1], edges[1:], strict=True):
            counts = recorded[begin:end].sum(axis=0)
            if counts.all():
                weights = np.zeros(recorded.shape)
                weights[begin:end] = recorded[begin:end] / counts
                found.append(weights.T)
        first += len(rows)
    return np.stack(found, axis=1)


def average_parts(averaging: Array, deviations: Array) -> Array:
    """Return the averages (S,) of deviations (R, C) of all windows, channels innermost."""
    values = np.nan_to_num(deviations, posinf=LARGE, neginf=-LARGE).clip(-LARGE, LARGE)
    parts = [weights @ column for weights, column in zip(averaging, values.T, strict=True)]
    return np.column_stack(parts).ravel()
