"""Sway manoeuvre: yaw rate, heading and surge of a boat that moves sideways, from camera frames."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from boatsim.physics.base import Array, param
from boatsim.recordings.table import Recording
from boatsim.simulate.camera import Camera
from boatsim.simulate.camera_metric import (
    CameraFrames,
    CameraMetricSet,
    first_frame_where,
    headings_from_noise,
)
from boatsim.simulate.metric import describe_closest_value

FEWEST_AVERAGES = 3  # moving averages without which no rms is meaningful


@dataclass(frozen=True)
class Sway(CameraMetricSet):
    """Metric set of a boat that shall move sideways without yaw, computed from camera frames.

    Frames from the start to the first one at the distance `distance` to starboard are evaluated.
    """

    words: ClassVar[str] = (
        "yaw rate, heading and surge while a boat moves sideways, from camera frames"
    )
    units: ClassVar = {
        "yaw_rate_inf": "deg/s",
        "yaw_rate_l2": "deg/s",
        "yaw_rate_rms": "deg/s",
        "yaw_rate_l1": "deg/s",
        "heading_at_end": "deg",
        "surge_offset": "m",
        "time_to_end": "s",
    }

    distance: float = param(
        1.0, low=0.0, high=1e5, unit="m", words="distance to starboard at which the evaluation ends"
    )
    averaged: float = param(
        10.0, low=1.0, high=1000.0, unit="", words="yaw rates in the moving average"
    )

    def explain_missing_value(self, metric: str, log: Recording) -> str:
        """Explain in words that a boat never moved the required distance to starboard."""
        psi, dx, dy = log["psi_rad"][0], log["x_m"] - log["x_m"][0], log["y_m"] - log["y_m"][0]
        aside = np.cos(psi) * dy - np.sin(psi) * dx
        return f"{describe_closest_value(aside, self.distance, 'm')} to starboard"

    def values_from_frames(self, frames: CameraFrames) -> dict[str, float]:
        """Return the metrics of a sideways motion: yaw rate, heading change, surge offset and time.

        Yaw rates and heading are measured by the camera; surge offset and time come from the true
        motion.

        Args:
            frames: Frames of the camera with the true motion.
        """
        frame = first_frame_where(
            frames.place[:, 1] >= self.distance, least=round(self.averaged) + FEWEST_AVERAGES
        )
        if frame is None:
            return {}
        part = frames.up_to_frame(frame)
        found = self.yaw_rate_metrics(np.unwrap(part.heading), part.t[1] - part.t[0])
        return {name: float(value) for name, value in found.items()} | {
            "surge_offset": float(part.place[-1, 0] - part.place[0, 0]),  # x_i - x_0
            "time_to_end": float(part.t[-1]),
            "frames": float(len(part.t)),
        }

    def values_from_noise(self, frames: int, camera: Camera) -> dict[str, Array]:
        """Return the yaw-rate metrics that camera noise alone causes at a constant heading.

        Args:
            frames: Number of frames.
            camera: The camera.
        """
        return self.yaw_rate_metrics(headings_from_noise(frames, camera), 1.0 / self.scored)

    def yaw_rate_metrics(self, psi: Array, dt: float) -> dict[str, Array]:
        """Return norms of the yaw rate of a sequence of headings, and the heading change over it.

        The yaw rate e is smoothed by a moving average. The norms are max|e|, sqrt(sum e^2),
        sqrt(mean e^2) and sum|e|.

        Args:
            psi: Headings (..., n) [rad].
            dt: Time between two headings [s].
        """
        rate = np.degrees(np.diff(psi)) / dt
        e = np.lib.stride_tricks.sliding_window_view(rate, round(self.averaged), axis=-1).mean(-1)
        return {
            "yaw_rate_inf": np.abs(e).max(-1),  # max |e|
            "yaw_rate_l2": np.sqrt((e**2).sum(-1)),  # sqrt(sum e^2)
            "yaw_rate_rms": np.sqrt((e**2).mean(-1)),  # sqrt(mean e^2)
            "yaw_rate_l1": np.abs(e).sum(-1),  # sum |e|
            "heading_at_end": np.degrees(psi[..., -1] - psi[..., 0]),  # psi_i - psi_0
        }
