"""Accelerations of a recording by smoothed differences, and accelerations predicted by the laws.

A Savitzky-Golay filter blurs the signal that it differentiates. The predicted accelerations are
blurred in the same way, so that a step of the thrust causes no model error.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from math import sqrt

import numpy as np
from scipy.signal import savgol_coeffs

from boatsim.diagnosis.filter import MappedRecording, NoiseLevels, rigid_body_values
from boatsim.diagnosis.locate.nominal_forces import actuator_states
from boatsim.physics.base import Array

ORDER, NARROWEST = 3, 5  # polynomial order, rows of the narrowest window
WIDEST = 1 / 6  # widest window, share of a recording
ALLOWED = 1.02  # largest smoothing error, relative to that of noise alone
LOUDER = 1.0  # largest noise power in accelerations, relative to the ambient force
SHORT = 1e-4  # [s] integration step from which an acceleration is computed


@dataclass(frozen=True)
class Smoother:
    """Windows (rows, odd) for the degrees of freedom of one recording."""

    track: MappedRecording
    windows: tuple[int, ...]  # for accelerations
    narrow: tuple[int, ...]  # for states: blurring twice would look like damping

    @classmethod
    def of(
        cls, track: MappedRecording, ambient: NoiseLevels, noise: Mapping[str, float]
    ) -> "Smoother":
        """Choose windows in which noise moves accelerations less than the ambient force does.

        Windows of x and y are equal. Windows of states are as wide as the noise [m, rad] allows and
        at most half as wide as those of accelerations.
        """
        families, recorded = noise_families(track), recorded_positions(track)
        wide, narrow = dict[str, int](), dict[str, int]()
        for j, family in enumerate(families):
            n = narrowest_quiet_window(
                track,
                ambient.force[j] / track.inertia_with_added_mass[j],
                ambient.time_constant,
                noise[family],
            )
            wide[family] = max(n, wide.get(family, n))
            n = widest_unbiased_window(recorded[:, j], noise[family])
            narrow[family] = min(n, narrow.get(family, n))
        limit = {f: max(NARROWEST, wide[f] // 2 // 2 * 2 + 1) for f in wide}
        return cls(
            track,
            tuple(wide[f] for f in families),
            tuple(min(narrow[f], limit[f]) for f in families),
        )

    @property
    def margin(self) -> int:
        """Rows at either end without a complete window."""
        return max(self.windows) // 2

    def motion(self, recorded: Array) -> tuple[Array, Array]:
        """Return states (N, 2 NQ) and joint accelerations (N, NQ) of positions (N, NQ).

        Rows within the margin are inaccurate.
        """
        h = float(np.median(np.diff(self.track.times)))
        windows = (self.narrow, self.narrow, self.windows)
        parts = []
        for d in range(3):
            parts.append(
                np.column_stack(
                    [
                        smoothed_derivative(y, n, d, h)
                        for y, n in zip(recorded.T, windows[d], strict=True)
                    ]
                )
            )
        return np.ascontiguousarray(np.hstack(parts[:2])), parts[2]

    def smooth_accelerations(self, accelerations: Array) -> Array:
        """Return accelerations (N, NQ) smoothed like the second differences of a window."""
        return np.column_stack(
            [
                np.convolve(a, acceleration_weights(n), "same")
                for a, n in zip(accelerations.T, self.windows, strict=True)
            ]
        )

    def ambient_variance(self, ambient: NoiseLevels, times: float) -> Array:
        """Return the variance (NQ,) of smoothed accelerations under `times` the ambient force.

        Along x and y it is the mean over all headings.
        """
        power = (times * ambient.force / self.track.inertia_with_added_mass) ** 2
        level = [j for j, free in enumerate(self.track.program.module.FREE) if free < 2]
        power[level] = np.mean(power[level]) if level else 0.0
        return power * np.array(
            [
                passed_power_share(n, sampling_interval(self.track), ambient.time_constant)
                for n in self.windows
            ]
        )

    def sample_noise(self, noise: Mapping[str, float], rng: np.random.Generator) -> Array:
        """Return sampled instrument noise (N, NQ) [m, rad]."""
        sd = np.array([noise[f] for f in noise_families(self.track)])
        return sd * rng.standard_normal((len(self.track.times), len(sd)))


def sampling_interval(track: MappedRecording) -> float:
    """Return the sampling interval [s]."""
    return float(np.median(np.diff(track.times)))


def noise_families(track: MappedRecording) -> list[str]:
    """Return the noise family of each recorded position."""
    families = dict(zip(track.codes.tolist(), track.families, strict=True))
    return [families[j] for j in range(track.program.module.NQ)]


def passed_power_share(n: int, h: float, lasts: float) -> float:
    """Return the share of the power of a coloured force that a window of n rows passes."""
    apart = h * np.abs(np.subtract.outer(np.arange(n), np.arange(n)))
    return float(acceleration_weights(n) @ np.exp(-apart / lasts) @ acceleration_weights(n))


def noise_amplification(n: int, h: float) -> float:
    """Return the variance of a window's accelerations per variance of the noise [1/s^4]."""
    return float(np.sum(convolution_weights(n, 2) ** 2)) / h**4


def narrowest_quiet_window(
    track: MappedRecording, ambient: float, lasts: float, noise: float
) -> int:
    """Return the rows of the narrowest window with less noise than ambient acceleration."""
    h, most = sampling_interval(track), int(WIDEST * len(track.times))
    for n in range(NARROWEST, most, 2):
        if noise**2 * noise_amplification(n, h) < LOUDER * ambient**2 * passed_power_share(
            n, h, lasts
        ):
            return n
    return most // 2 * 2 + 1


def recorded_positions(track: MappedRecording) -> Array:
    """Return recorded positions (N, NQ), with gaps interpolated linearly."""
    out = np.zeros((len(track.times), track.program.module.NQ))
    for c, code in enumerate(track.codes):
        if code < out.shape[1]:
            good = np.isfinite(track.measured[:, c])
            out[:, code] = np.interp(track.times, track.times[good], track.measured[good, c])
    return out


def widest_unbiased_window(y: Array, noise: float) -> int:
    """Return the rows of the widest window whose errors do not exceed those of noise alone."""
    best = NARROWEST
    for n in range(NARROWEST, max(int(WIDEST * len(y)), NARROWEST + 1), 2):
        inside = slice(n // 2, len(y) - n // 2)
        left = (y - smoothed_derivative(y, n, 0, 1.0))[inside]
        alone = noise * sqrt(1.0 - float(convolution_weights(n, 0)[n // 2]))
        if float(np.sqrt(np.mean(left**2))) > ALLOWED * alone:
            break
        best = n
    return best


@cache
def convolution_weights(n: int, order: int) -> Array:
    """Return the convolution weights (n,) of a derivative per row."""
    return np.asarray(savgol_coeffs(n, ORDER, order))


def smoothed_derivative(y: Array, n: int, order: int, h: float) -> Array:
    """Return a derivative (N,) of a signal by windows of n rows at intervals of h seconds."""
    padded = np.concatenate([np.full(n // 2, y[0]), y, np.full(n // 2, y[-1])])
    return np.asarray(np.convolve(padded, convolution_weights(n, order), "valid")) / h**order


@cache
def acceleration_weights(n: int) -> Array:
    """Return the weights (n,) of accelerations in second differences; their sum is 1."""
    twice = np.cumsum(np.cumsum(convolution_weights(n, 2)))
    return np.append(0.0, twice[:-1])


def true_positions(track: MappedRecording, recorded: Array, values: Array, on: Array) -> Array:
    """Return positions (N, NQ) of the boat from instrument readings."""
    nq, out = track.program.module.NQ, np.zeros((len(recorded), track.program.module.NZ))
    out[:, :nq] = recorded
    for row, t in zip(out, track.times - track.times[0], strict=True):
        track.program.estimation_functions.remove_position_errors(row, t, values, on)
    return out[:, :nq].copy()


def mean_actuators(track: MappedRecording, effects: tuple[str, ...], values: Array) -> Array:
    """Return the mean actuator states (N, HELD) around each row."""
    after = actuator_states(track, effects, values)
    before = np.vstack([after[:1], after[:-1]])
    return np.asarray(0.5 * (before + after))


def predicted_accelerations(
    track: MappedRecording, states: Array, held: Array, values: Array, on: Array
) -> Array:
    """Return joint accelerations (N, NQ) at states (N, 2 NQ) and actuators (N, HELD)."""
    code = track.program.simulation_functions
    k, nothing, nq = np.zeros(code.K), np.zeros(code.NQ), code.NQ
    code.compute_mass_constants(rigid_body_values(values), values, on, k)
    after, acts = states.copy(), np.hstack([held, held, held])
    for t, y, act in zip(track.times.tolist(), after, acts, strict=True):
        code.step_in_place(t, y, SHORT, act, values, on, k, nothing)
    return np.asarray((after[:, nq:] - states[:, nq:]) / SHORT)
