"""Accelerations of a recording by smoothed differences, and those that a boat's laws give at the same motion.

Savitzky and Golay's filter blurs what it differentiates. The laws' accelerations are blurred alike, so that a step of
the thrust is no error of the model.
"""

from dataclasses import dataclass
from math import sqrt

import numpy as np
from scipy.signal import savgol_coeffs

from boatsim.diagnose.filter import Levels, Track, body_of
from boatsim.diagnose.locate.hull_forces import actuators
from boatsim.physics.base import Array

ORDER, NARROWEST = 3, 7  # of the polynomials, and rows of the narrowest window
WIDEST = 1 / 6  # of a recording
ALLOWED = 1.1  # errors of smoothing in those that noise alone leaves
SHORT = 1e-4  # [s] of a step whose change of speed is an acceleration
NEVER = 1e-12  # of the noise, below which a channel never varies


@dataclass(frozen=True)
class Smoother:
    """Windows (rows, odd) of one recording's freedoms."""

    track: Track
    windows: tuple[int, ...]

    @classmethod
    def of(cls, track: Track, noise: dict[str, float]) -> "Smoother":
        """The widest windows whose smoothed positions keep within the noise `noise` [m, rad]; x and y have the same."""
        nq, found = track.program.module.NQ, {}
        recorded = positions(track)
        for c, code in enumerate(track.codes):
            if code < nq:
                family = track.families[c]
                found[code] = (family, widest(recorded[:, code], noise[family]))
        least = {family: min(n for f, n in found.values() if f == family) for family, _ in found.values()}
        return cls(track, tuple(least[found[j][0]] for j in range(nq)))

    @property
    def margin(self) -> int:
        """Rows at either end that no window reaches whole."""
        return max(self.windows) // 2

    def motion(self, recorded: Array) -> tuple[Array, Array]:
        """States (N, 2 NQ) and joint accelerations (N, NQ) of positions (N, NQ); those at the ends are poor."""
        h = float(np.median(np.diff(self.track.times)))
        parts = [np.column_stack([derived(y, n, d, h) for y, n in zip(recorded.T, self.windows, strict=True)])
                 for d in range(3)]  # fmt: skip
        return np.ascontiguousarray(np.hstack(parts[:2])), parts[2]

    def blurred(self, accelerations: Array) -> Array:
        """(N, NQ) as the second differences of a window see them."""
        return np.column_stack(
            [np.convolve(a, kernel(n), "same") for a, n in zip(accelerations.T, self.windows, strict=True)]
        )

    def spread(self, ambient: Levels, noise: dict[str, float], times: float) -> Array:
        """(NQ,) variance of the accelerations of a perfect model in water that pushes `times` as hard as is tolerated.

        The recording's noise twice differentiated, and the ambient force as the windows see it; along x and y as the
        mean over all headings.
        """
        h, out = float(np.median(np.diff(self.track.times))), np.zeros(len(self.windows))
        pushed = (times * ambient.force / self.track.inertia) ** 2
        level = [j for j, free in enumerate(self.track.program.module.FREE) if free < 2]
        pushed[level] = np.mean(pushed[level]) if level else 0.0
        families = dict(zip(self.track.codes.tolist(), self.track.families, strict=True))
        for j, n in enumerate(self.windows):
            seen, apart = kernel(n), h * np.abs(np.subtract.outer(np.arange(n), np.arange(n)))
            kept = float(seen @ np.exp(-apart / ambient.time_constant) @ seen)
            out[j] = pushed[j] * kept + (noise[families[j]] * float(np.linalg.norm(savgol_coeffs(n, ORDER, 2, h)))) ** 2
        return out


def positions(track: Track) -> Array:
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
        alone = noise * sqrt(1.0 - float(savgol_coeffs(n, ORDER)[n // 2]))
        if float(np.sqrt(np.mean(left**2))) > ALLOWED * alone:
            break
        best = n
    return best


def derived(y: Array, n: int, order: int, h: float) -> Array:
    """A derivative (N,) of a signal by windows of n rows, h s apart."""
    padded = np.pad(y, n // 2, mode="reflect", reflect_type="odd")
    return np.asarray(np.convolve(padded, savgol_coeffs(n, ORDER, order, h), "valid"))


def kernel(n: int) -> Array:
    """(n,) weights with which the second differences of a window of n rows see accelerations; their sum is 1."""
    twice = np.cumsum(np.cumsum(savgol_coeffs(n, ORDER, 2)))
    return np.append(0.0, twice[:-1])


def shown_by(track: Track, recorded: Array, values: Array, on: Array) -> Array:
    """Positions (N, NQ) of the boat behind what instruments showed."""
    nq, out = track.program.module.NQ, np.zeros((len(recorded), track.program.module.NZ))
    out[:, :nq] = recorded
    for row in out:
        track.program.module.undistorted(row, values, on)
    return out[:, :nq].copy()


def held_by(track: Track, suspects: tuple[str, ...], values: Array) -> Array:
    """(N, HELD) mean actuators around each row."""
    after = actuators(track, suspects, values)
    before = np.vstack([after[:1], after[:-1]])
    return np.asarray(0.5 * (before + after))


def predicted(track: Track, states: Array, held: Array, values: Array, on: Array) -> Array:
    """(N, NQ) joint accelerations by the laws at states (N, 2 NQ) under actuators (N, HELD)."""
    code = track.program.module
    k, nothing, nq = np.zeros(code.K), np.zeros(code.NQ), code.NQ
    code.constants(body_of(values), values, on, k)
    out, acts = np.zeros((len(states), nq)), np.hstack([held, held, held])
    for row, (state, act, t) in enumerate(zip(states, acts, track.times.tolist(), strict=True)):
        y = state.copy()
        code.step_in_place(t, y, SHORT, act, values, on, k, nothing)
        out[row] = (y[nq:] - state[nq:]) / SHORT
    return out
