"""Trajectories of a recording simulated in windows, each from a start of its own that is fitted too.

Over a whole run of 40 s the water's unsteady push alone carries a model decimetres away, more than any effect does. In
windows as long as the free runs by which patched boats are judged it does not: multiple shooting without ties.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from boatsim.diagnosis.filter import MappedRecording, body_of, segments
from boatsim.physics.base import Array
from boatsim.physics.kernel.records import Inputs, Model

FIRST = 1.0  # [s] from which a window's start is guessed
STEP = 1e-4  # [m, rad and per s] by which starts are moved for derivatives


@dataclass(frozen=True)
class Windows:
    """One recording cut into windows."""

    track: MappedRecording
    begins: Array  # (W,) rows, integers
    ends: Array

    @classmethod
    def of(cls, track: MappedRecording, horizon: float) -> "Windows":
        """Windows of `horizon` s from the first row on."""
        begins, ends = segments(track.times, horizon)
        return cls(track, np.array(begins), np.array(ends))

    def guess(self) -> Array:
        """(W, 2 NQ) positions and earth-axes rates by straight lines through the first second of each window."""
        t, nq = self.track.times, self.track.program.module.NQ
        out = np.zeros((len(self.begins), 2 * nq))
        for w, begin in enumerate(self.begins):
            end = max(int(np.searchsorted(t, t[begin] + FIRST)), int(begin) + 5)
            for c, code in enumerate(self.track.codes):
                y, s = self.track.measured[begin:end, c], t[begin:end] - t[begin]
                good = np.isfinite(y)
                if code < nq and good.sum() > 1:
                    slope, out[w, code] = np.polyfit(s[good], y[good], 1)
                    out[w, nq + code] = slope
        return out

    def errors(self, values: Array, on: Array, starts: Array) -> list[Array]:
        """Recorded less simulated, (M, C) for each window, nan where nothing was recorded."""
        track, program = self.track, self.track.program
        out = np.full((len(starts), len(track.times), starts.shape[1]), np.nan)
        program.module.free_runs(
            Inputs(track.times, track.command_times, track.command_values),
            track.step,
            Model(body_of(values), values, on),
            self.begins,
            self.ends,
            np.ascontiguousarray(starts),
            out,
        )
        cut = [slice(a, b + 1) for a, b in zip(self.begins, self.ends, strict=True)]
        return [track.measured[s] - out[w, s][:, track.codes] for w, s in enumerate(cut)]

    def by_starts(
        self, values: Array, on: Array, starts: Array, errors: Sequence[Array]
    ) -> list[Array]:
        """Derivatives (M, C, 2 NQ) of the errors of each window by its start."""
        slopes = [np.zeros((*e.shape, starts.shape[1])) for e in errors]
        for j in range(starts.shape[1]):
            beside = starts.copy()
            beside[:, j] += STEP
            for slope, there, here in zip(
                slopes, self.errors(values, on, beside), errors, strict=True
            ):
                slope[:, :, j] = (there - here) / STEP
        return slopes
