"""Metric sets that are computed from the frames of the camera instead of the log."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from boatsim.errors import BadInput
from boatsim.physics.base import Array, param
from boatsim.recordings.table import Recording
from boatsim.simulate.camera import Camera, Pose
from boatsim.simulate.metric import MetricSet

NOISE_SAMPLES = 200  # of the camera's noise; they give the noise floor to about 2 %


@dataclass(frozen=True)
class CameraFrames:
    """Measured hull marks and headings and true poses at the times of camera frames.

    The axes have origin and heading of the start.

    Attributes:
        t: Times (n,) [s].
        heading: Measured heading (n,) [rad].
        marks: Measured position of each mark (n, 2) [m].
        place: True position of the CG (n, 2) [m].
        psi: True heading (n,) [rad].
    """

    t: Array
    heading: Array
    marks: Mapping[str, Array]
    place: Array
    psi: Array

    def up_to_frame(self, frame: int) -> "CameraFrames":
        """Return the measured camera frames up to and including the given frame number."""
        n = frame + 1
        marks = {name: positions[:n] for name, positions in self.marks.items()}
        return CameraFrames(self.t[:n], self.heading[:n], marks, self.place[:n], self.psi[:n])


@dataclass(frozen=True)
class CameraMetricSet(MetricSet):
    """Base class of metric sets that are computed from camera frames instead of the log of a run.

    Metrics are computed at a scored frame rate and at a second, reported one. Times and positions
    count from `begin`; earlier frames, as of preparations, are ignored.
    """

    scored: float = param(
        5.0, low=0.1, high=240.0, unit="Hz", words="frame rate at which the norms are judged"
    )
    reported: float = param(
        10.0, low=0.1, high=240.0, unit="Hz", words="frame rate whose norms stand beside them"
    )
    begin: float = param(0.0, low=0.0, high=1e6, unit="s", words="when what is measured begins")

    def check_camera(self, camera: Camera) -> None:
        """Check that a camera can deliver the frames that this metric set needs.

        Args:
            camera: The scenario's camera.

        Raises:
            BadInput: If its rate is not a multiple of both rates, or a mark is missing.
        """
        for rate in (self.reported, self.scored):
            times = camera.rate / rate
            if abs(times - max(round(times), 1)) > 1e-9:
                raise BadInput(
                    f"[camera] rate = {camera.rate:g} Hz; "
                    f"allowed with this measure is a multiple of {rate:g} Hz"
                )

    def values_from_frames(self, frames: CameraFrames) -> dict[str, float]:
        """Compute the metrics of a run from its camera frames.

        Args:
            frames: The frames.

        Returns:
            Value by metric, and the number of `frames` used; empty if the run did not reach the
            condition of the metrics.
        """
        raise NotImplementedError

    def values_from_noise(self, frames: int, camera: Camera) -> dict[str, Array]:
        """Compute the metrics that camera noise alone causes for an ideal motion.

        Args:
            frames: Number of frames.
            camera: The camera.

        Returns:
            Samples (NOISE_SAMPLES,) of each metric.
        """
        raise NotImplementedError

    def kind(self, metric: str) -> str:
        """Return how a metric on camera frames summarises its signal, such as "rms" or "largest".

        A sum adds the values of the frames and is not multiplied by their interval.

        Args:
            metric: Name of one of the metrics.
        """
        sums = {"l1": "sum over frames", "l2": "root of summed squares"}
        return sums.get(metric.rpartition("_")[2]) or super().kind(metric)

    def noise_floor(self, frames: int, camera: Camera) -> dict[str, float]:
        """Return the mean value that camera noise alone gives to each metric of ideal motion.

        Args:
            frames: Number of frames.
            camera: The camera.
        """
        found: dict[str, float] = {}
        for name, samples in self.values_from_noise(frames, camera).items():
            found[name] = float(np.abs(samples).mean())
        return found


def select_camera_frames(
    camera: Recording, truth: Recording, start: Pose, every: int, begin: float = 0.0
) -> CameraFrames:
    """Select camera frames of a run and the true pose at their times, relative to the start.

    Args:
        camera: Recording of the camera.
        truth: Log of the run.
        start: Pose of the start.
        every: Use every n-th frame.
        begin: Time of the first frame [s]; if above 0, poses are relative to the pose at that time
            instead of `start`.

    Returns:
        The frames.
    """
    if begin > 0.0:
        camera = camera.between(begin, np.inf)
        x = float(np.interp(begin, truth.t, truth["x_m"]))
        y = float(np.interp(begin, truth.t, truth["y_m"]))
        psi = float(np.interp(begin, truth.t, truth["psi_rad"]))
        start = (x, y, psi)
    t = camera.t[::every]
    c, s = np.cos(start[2]), np.sin(start[2])

    def in_start_axes(x: Array, y: Array) -> Array:
        dx, dy = x - start[0], y - start[1]
        return np.stack([c * dx + s * dy, c * dy - s * dx], axis=-1)

    marks: dict[str, Array] = {}
    for column in camera.signals:
        if column.startswith("camera_") and not column.endswith("_y_m"):
            name = column.removeprefix("camera_").removesuffix("_x_m")
            north, east = camera[f"camera_{name}_x_m"], camera[f"camera_{name}_y_m"]
            marks[name] = in_start_axes(north[::every], east[::every])
    north = np.interp(t, truth.t, truth["x_m"])
    east = np.interp(t, truth.t, truth["y_m"])
    heading = np.interp(t, truth.t, truth["psi_rad"])
    return CameraFrames(
        t - begin,
        camera["psi_rad"][::every] - start[2],
        marks,
        in_start_axes(north, east),
        heading - start[2],
    )


def sample_mark_noise(frames: int, camera: Camera) -> Array:
    """Return standard normal samples for the noise of all hull marks in all camera frames.

    Args:
        frames: Number of frames.
        camera: The camera with M marks.

    Returns:
        Samples (NOISE_SAMPLES, frames, 2 M).
    """
    shape = (NOISE_SAMPLES, frames, 2 * len(camera.marks))
    return np.random.default_rng(0).standard_normal(shape)


@lru_cache(maxsize=100)
def headings_from_noise(frames: int, camera: Camera) -> Array:
    """Return headings that a camera measures of a vessel at rest with a heading of 0.

    They are computed once for a sweep of runs with as many frames.

    Args:
        frames: Number of frames.
        camera: The camera.

    Returns:
        Headings (NOISE_SAMPLES, frames) [rad], which must not be changed.
    """
    still = np.zeros(frames)
    marks = camera.measured_mark_positions(still, still, sample_mark_noise(frames, camera))
    return camera.fit_heading(marks)


def first_frame_where(reached: NDArray[np.bool_], least: int = 0) -> int | None:
    """Return the number of the first camera frame at which a condition holds.

    Args:
        reached: Whether the condition holds, (n,).
        least: Smallest number to return.

    Returns:
        The number, at least `least`; None if the condition never holds or there are too few frames.
    """
    if not reached.any() or len(reached) <= least:
        return None
    return max(int(np.argmax(reached)), least)
