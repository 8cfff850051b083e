"""Accelerations of a recording by smoothed differences, and those that a boat's laws give at the same motion.

Savitzky and Golay's filter blurs what it differentiates. The laws' accelerations are blurred alike, so that a step of
the thrust is no error of the model.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from math import sqrt

import numpy as np
from scipy.signal import savgol_coeffs

from boatsim.diagnosis.filter import MappedRecording, NoiseLevels, body_of
from boatsim.diagnosis.locate.nominal_forces import actuator_states
from boatsim.physics.base import Array

ORDER, NARROWEST = 3, 5  # of the polynomials, and rows of the narrowest window
WIDEST = 1 / 6  # of a recording
ALLOWED = 1.02  # errors of smoothed positions in those that noise alone leaves
LOUDER = 1.0  # times the power of the ambient force that noise may have in accelerations
SHORT = 1e-4  # [s] of a step whose change of speed is an acceleration


@dataclass(frozen=True)
class Smoother:
    """Windows (rows, odd) of one recording's freedoms."""

    track: MappedRecording
    windows: tuple[int, ...]  # in which accelerations are told
    narrow: tuple[int, ...]  # in which states are: what is blurred twice would seem damped

    @classmethod
    def of(
        cls, track: MappedRecording, ambient: NoiseLevels, noise: Mapping[str, float]
    ) -> "Smoother":
        """Windows in which noise [m, rad] moves accelerations less than the ambient force; x and y have the same.

        Those of states are as wide as leaves the errors of smoothed positions to noise, and at most half as wide.
        """
        families, recorded = of_freedoms(track), positions(track)
        wide, narrow = dict[str, int](), dict[str, int]()
        for j, family in enumerate(families):
            n = calm(
                track, ambient.force[j] / track.inertia[j], ambient.time_constant, noise[family]
            )
            wide[family] = max(n, wide.get(family, n))
            n = widest(recorded[:, j], noise[family])
            narrow[family] = min(n, narrow.get(family, n))
        limit = {f: max(NARROWEST, wide[f] // 2 // 2 * 2 + 1) for f in wide}
        return cls(
            track,
            tuple(wide[f] for f in families),
            tuple(min(narrow[f], limit[f]) for f in families),
        )

    @property
    def margin(self) -> int:
        """Rows at either end that no window reaches whole."""
        return max(self.windows) // 2

    def motion(self, recorded: Array) -> tuple[Array, Array]:
        """States (N, 2 NQ) and joint accelerations (N, NQ) of positions (N, NQ); those at the ends are poor."""
        h = float(np.median(np.diff(self.track.times)))
        windows = (self.narrow, self.narrow, self.windows)
        parts = [
            np.column_stack(
                [derived(y, n, d, h) for y, n in zip(recorded.T, windows[d], strict=True)]
            )
            for d in range(3)
        ]
        return np.ascontiguousarray(np.hstack(parts[:2])), parts[2]

    def blurred(self, accelerations: Array) -> Array:
        """(N, NQ) as the second differences of a window see them."""
        return np.column_stack(
            [
                np.convolve(a, kernel(n), "same")
                for a, n in zip(accelerations.T, self.windows, strict=True)
            ]
        )

    def pushed(self, ambient: NoiseLevels, times: float) -> Array:
        """(NQ,) variance of accelerations in water that pushes `times` as hard as is tolerated, as the windows see it.

        Along x and y it is the mean of all headings.
        """
        power = (times * ambient.force / self.track.inertia) ** 2
        level = [j for j, free in enumerate(self.track.program.module.FREE) if free < 2]
        power[level] = np.mean(power[level]) if level else 0.0
        return power * np.array(
            [kept(n, step(self.track), ambient.time_constant) for n in self.windows]
        )

    def noisy(self, noise: Mapping[str, float], rng: np.random.Generator) -> Array:
        """(N, NQ) noise as the instruments have it [m, rad]."""
        sd = np.array([noise[f] for f in of_freedoms(self.track)])
        return sd * rng.standard_normal((len(self.track.times), len(sd)))


def step(track: MappedRecording) -> float:
    """Seconds from row to row."""
    return float(np.median(np.diff(track.times)))


def of_freedoms(track: MappedRecording) -> list[str]:
    """Noise family of each recorded position."""
    families = dict(zip(track.codes.tolist(), track.families, strict=True))
    return [families[j] for j in range(track.program.module.NQ)]


def kept(n: int, h: float, lasts: float) -> float:
    """Share of the power of a force that lasts so long [s] which a window of n rows sees."""
    apart = h * np.abs(np.subtract.outer(np.arange(n), np.arange(n)))
    return float(kernel(n) @ np.exp(-apart / lasts) @ kernel(n))


def loud(n: int, h: float) -> float:
    """Variance of a window's accelerations per variance of the noise [1/s^4]."""
    return float(np.sum(coefficients(n, 2) ** 2)) / h**4


def calm(track: MappedRecording, ambient: float, lasts: float, noise: float) -> int:
    """Rows of the narrowest window in which noise moves accelerations less than the ambient one [m/s^2] does."""
    h, most = step(track), int(WIDEST * len(track.times))
    for n in range(NARROWEST, most, 2):
        if noise**2 * loud(n, h) < LOUDER * ambient**2 * kept(n, h, lasts):
            return n
    return most // 2 * 2 + 1


def positions(track: MappedRecording) -> Array:
    """(N, NQ) recorded positions, gaps bridged by straight lines."""
    out = np.zeros((len(track.times), track.program.module.NQ))
    for c, code in enumerate(track.codes):
        if code < out.shape[1]:
            good = np.isfinite(track.measured[:, c])
            out[:, code] = np.interp(track.times, track.times[good], track.measured[good, c])
    return out


def widest(y: Array, noise: float) -> int:
    """Rows of the widest window whose errors are no larger than those of noise alone."""
    best = NARROWEST
    for n in range(NARROWEST, max(int(WIDEST * len(y)), NARROWEST + 1), 2):
        inside = slice(n // 2, len(y) - n // 2)
        left = (y - derived(y, n, 0, 1.0))[inside]
        alone = noise * sqrt(1.0 - float(coefficients(n, 0)[n // 2]))
        if float(np.sqrt(np.mean(left**2))) > ALLOWED * alone:
            break
        best = n
    return best


@cache
def coefficients(n: int, order: int) -> Array:
    """(n,) of a derivative per row, for a convolution."""
    return np.asarray(savgol_coeffs(n, ORDER, order))


def derived(y: Array, n: int, order: int, h: float) -> Array:
    """A derivative (N,) of a signal by windows of n rows, h s apart."""
    padded = np.concatenate([np.full(n // 2, y[0]), y, np.full(n // 2, y[-1])])
    return np.asarray(np.convolve(padded, coefficients(n, order), "valid")) / h**order


@cache
def kernel(n: int) -> Array:
    """(n,) weights with which the second differences of a window of n rows see accelerations; their sum is 1."""
    twice = np.cumsum(np.cumsum(coefficients(n, 2)))
    return np.append(0.0, twice[:-1])


def shown_by(track: MappedRecording, recorded: Array, values: Array, on: Array) -> Array:
    """Positions (N, NQ) of the boat behind what instruments showed."""
    nq, out = track.program.module.NQ, np.zeros((len(recorded), track.program.module.NZ))
    out[:, :nq] = recorded
    for row in out:
        track.program.module.undistorted(row, values, on)
    return out[:, :nq].copy()


def held_by(track: MappedRecording, effects: tuple[str, ...], values: Array) -> Array:
    """(N, HELD) mean actuators around each row."""
    after = actuator_states(track, effects, values)
    before = np.vstack([after[:1], after[:-1]])
    return np.asarray(0.5 * (before + after))


def predicted(
    track: MappedRecording, states: Array, held: Array, values: Array, on: Array
) -> Array:
    """(N, NQ) joint accelerations by the laws at states (N, 2 NQ) under actuators (N, HELD)."""
    code = track.program.module
    k, nothing, nq = np.zeros(code.K), np.zeros(code.NQ), code.NQ
    code.constants(body_of(values), values, on, k)
    after, acts = states.copy(), np.hstack([held, held, held])
    for t, y, act in zip(track.times.tolist(), after, acts, strict=True):
        code.step_in_place(t, y, SHORT, act, values, on, k, nothing)
    return np.asarray((after[:, nq:] - states[:, nq:]) / SHORT)
