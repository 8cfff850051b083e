"""What a camera saw of a run, and what a measure is that looks at its frames and not at the log."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from boatsim.errors import BadInput
from boatsim.physics.base import Array, param
from boatsim.recordings.table import Recording
from boatsim.simulate.camera import Camera, Pose
from boatsim.simulate.metric import Measure

DRAWS = 200  # of the camera's noise, for its floor: known to about 2 %


@dataclass(frozen=True)
class Film:
    """What the camera saw and what was true at its frames, in start axes (origin and heading of the start)."""

    t: Array  # (n,) s
    heading: Array  # (n,) rad, measured
    marks: Mapping[str, Array]  # each (n, 2) m, measured
    place: Array  # (n, 2) m, true CG
    psi: Array  # (n,) rad, true

    def until(self, frame: int) -> "Film":
        """The frames up to and with this one."""
        n = frame + 1
        marks = {name: seen[:n] for name, seen in self.marks.items()}
        return Film(self.t[:n], self.heading[:n], marks, self.place[:n], self.psi[:n])


@dataclass(frozen=True)
class FilmMeasure(Measure):
    """Base of measures on camera frames, at the rate that is scored and at another that is reported beside it.

    What goes before `begin`, preparations say, is left out: times and places count from there.
    """

    scored: float = param(
        5.0, low=0.1, high=240.0, unit="Hz", words="frame rate at which the norms are judged"
    )
    reported: float = param(
        10.0, low=0.1, high=240.0, unit="Hz", words="frame rate whose norms stand beside them"
    )
    begin: float = param(0.0, low=0.0, high=1e6, unit="s", words="when what is measured begins")

    def check(self, camera: Camera) -> None:
        """Raises BadInput for a camera that does not take the frames, or does not see what they are measured by."""
        for rate in (self.reported, self.scored):
            times = camera.rate / rate
            if abs(times - max(round(times), 1)) > 1e-9:
                raise BadInput(
                    f"[camera] rate = {camera.rate:g} Hz; allowed with this measure is a multiple of {rate:g} Hz"
                )

    def of_film(self, film: Film) -> dict[str, float]:
        """Norms, and how many `frames` they come from; empty where the run never got as far as they ask."""
        raise NotImplementedError

    def of_noise(self, frames: int, camera: Camera) -> dict[str, Array]:
        """Norms (DRAWS,) of so many frames of a boat that moves without error under a camera whose marks are noisy."""
        raise NotImplementedError

    def kind(self, norm: str) -> str:
        """Sums of a film are over its frames, whatever their rate."""
        sums = {"l1": "sum over frames", "l2": "root of summed squares"}
        return sums.get(norm.rpartition("_")[2]) or super().kind(norm)

    def noise_floor(self, frames: int, camera: Camera) -> dict[str, float]:
        """Mean of each norm that the marks' noise alone would give."""
        return {
            name: float(np.abs(value).mean())
            for name, value in self.of_noise(frames, camera).items()
        }


def film(camera: Recording, truth: Recording, start: Pose, every: int, begin: float = 0.0) -> Film:
    """Every so many frames of what a camera recorded from `begin` [s] on, beside the log of the run."""
    if begin > 0.0:
        camera = camera.between(begin, np.inf)
        x, y, psi = (
            float(np.interp(begin, truth.t, truth[name])) for name in ("x_m", "y_m", "psi_rad")
        )
        start = (x, y, psi)
    t = camera.t[::every]
    c, s = np.cos(start[2]), np.sin(start[2])

    def ahead(x: Array, y: Array) -> Array:
        dx, dy = x - start[0], y - start[1]
        return np.stack([c * dx + s * dy, c * dy - s * dx], axis=-1)

    names = [
        n.removeprefix("camera_").removesuffix("_x_m")
        for n in camera.signals
        if n.startswith("camera_")
    ]
    marks = {
        n: ahead(camera[f"camera_{n}_x_m"][::every], camera[f"camera_{n}_y_m"][::every])
        for n in names
        if not n.endswith("_y_m")
    }
    north, east, heading = (
        np.interp(t, truth.t, truth[name]) for name in ("x_m", "y_m", "psi_rad")
    )
    return Film(
        t - begin,
        camera["psi_rad"][::every] - start[2],
        marks,
        ahead(north, east),
        heading - start[2],
    )


def noise(frames: int, camera: Camera) -> Array:
    """(DRAWS, frames, 2 M) standard normal; the same whatever the seed, so that a floor depends on the frames alone."""
    return np.random.default_rng(0).standard_normal((DRAWS, frames, 2 * len(camera.marks)))


def first(reached: NDArray[np.bool_], least: int = 0) -> int | None:
    """Number of the first frame at which it is so, at least `least`; None if there is none."""
    if not reached.any() or len(reached) <= least:
        return None
    return max(int(np.argmax(reached)), least)
