"""Trajectories of a recording simulated in windows, each with a fitted start.

Over a run of 40 s the ambient force alone moves the model by decimetres, more than any effect does.
In windows as long as the free runs that evaluate patched boats it does not. This is multiple
shooting without continuity constraints.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from boatsim.diagnosis.filter import MappedRecording, free_run_segments, rigid_body_values
from boatsim.physics.base import Array
from boatsim.physics.kernel.records import Inputs, VesselNumbers

FIRST = 1.0  # [s] duration from which a window's start is estimated
STEP = 1e-4  # [m, rad and per s] step of finite differences of starts


@dataclass(frozen=True)
class Windows:
    """One recording cut into windows."""

    track: MappedRecording
    begins: Array  # (W,) row numbers
    ends: Array

    @classmethod
    def of(cls, track: MappedRecording, horizon: float) -> "Windows":
        """Cut a recording into windows of `horizon` seconds."""
        begins, ends = free_run_segments(track.times, horizon)
        return cls(track, np.array(begins), np.array(ends))

    def guess(self) -> Array:
        """Fit positions and earth-axes rates (W, 2 NQ) linearly to each window's first second."""
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
        """Return recorded minus simulated, (M, C) for each window, nan for missing values."""
        track, program = self.track, self.track.program
        out = np.full((len(starts), len(track.times), starts.shape[1]), np.nan)
        program.estimation_functions.simulate_intervals(
            Inputs(track.times, track.command_times, track.command_values),
            track.largest_step,
            VesselNumbers(rigid_body_values(values), values, on),
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
        """Return derivatives (M, C, 2 NQ) of the errors of each window by its start."""
        slopes = [np.zeros((*e.shape, starts.shape[1])) for e in errors]
        for j in range(starts.shape[1]):
            shifted = starts.copy()
            shifted[:, j] += STEP
            for slope, there, here in zip(
                slopes, self.errors(values, on, shifted), errors, strict=True
            ):
                slope[:, :, j] = (there - here) / STEP
        return slopes
