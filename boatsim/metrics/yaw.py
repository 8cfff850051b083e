"""Yaw manoeuvre: deviation of a mark from its circle in a turn on the spot, by camera."""

from dataclasses import dataclass
from math import pi
from typing import ClassVar

import numpy as np

from boatsim.errors import BadInput, unknown_name_message
from boatsim.physics.base import Array, param
from boatsim.recordings.table import Recording
from boatsim.simulate.camera import Camera
from boatsim.simulate.camera_metric import (
    CameraFrames,
    CameraMetricSet,
    first_frame_where,
    sample_mark_noise,
)


@dataclass(frozen=True)
class Yaw(CameraMetricSet):
    """Metric set of a full turn on the spot: deviation of a mark on the hull from its ideal circle.

    Camera frames from the start to the first one after a full turn to either side are evaluated.
    """

    words: ClassVar[str] = (
        "deviation of a mark from its circle in a full turn on the spot, from camera frames"
    )
    units: ClassVar = {
        "position_inf": "m",
        "position_rms": "m",
        "position_l1": "m",
        "moved": "m",
        "turn_time": "s",
        "excursion": "m",
    }

    mark: str = "bow"  # of the vessel or of [camera]
    radius: float = param(
        1.0, low=0.0, high=1e4, unit="m", words="radius of the ideal circle of the mark"
    )

    def check_camera(self, camera: Camera) -> None:
        """Check that the camera has the frame rate and the mark that this metric set needs.

        Args:
            camera: The camera.

        Raises:
            BadInput: The frame rate does not fit, or the camera does not follow the mark.
        """
        super().check_camera(camera)
        if self.mark not in camera.marks:
            raise BadInput(unknown_name_message("yaw: mark", self.mark, camera.marks))

    def explain_missing_value(self, metric: str, log: Recording) -> str:
        """Explain in words that a full turn is incomplete, with the largest heading change."""
        turned = np.degrees(np.abs(log["psi_rad"] - log["psi_rad"][0]).max())
        return f"never turned 360 deg: at most {turned:.3g}"

    def values_from_frames(self, frames: CameraFrames) -> dict[str, float]:
        """Return the metrics of a full turn on the spot: deviations of a mark, time, excursion.

        The deviations of the mark from its circle are measured by the camera; turn time and the
        largest excursion of the CG come from the true motion.

        Args:
            frames: Frames of the camera with the true motion.
        """
        if not len(frames.t):
            return {}
        frame = first_frame_where(np.abs(frames.psi - frames.psi[0]) >= 2.0 * pi)
        if frame is None:
            return {}
        part = frames.up_to_frame(frame)
        turn = np.sign(part.psi[-1] - part.psi[0])
        away = np.hypot(*(part.place - part.place[0]).T)
        found = self.deviation_metrics(part.marks[self.mark], float(turn))
        return {name: float(value) for name, value in found.items()} | {
            "turn_time": float(part.t[-1] - part.t[0]),  # T
            "excursion": float(away.max()),  # largest distance of the CG from its start
            "frames": float(len(part.t)),
        }

    def values_from_noise(self, frames: int, camera: Camera) -> dict[str, Array]:
        """Return the deviations of a mark from its circle that camera noise alone causes.

        The noise is that of an ideal turn on the spot.

        Args:
            frames: Number of frames.
            camera: The camera.
        """
        angle, at = np.linspace(0.0, 2.0 * pi, frames), 2 * list(camera.marks).index(self.mark)
        shaken = camera.mark_sd * sample_mark_noise(frames, camera)[..., at : at + 2]
        return self.deviation_metrics(
            self.radius * np.stack([np.cos(angle), np.sin(angle)], axis=-1) + shaken, 1.0
        )

    def deviation_metrics(self, mark: Array, turn: float) -> dict[str, Array]:
        """Return norms of the distance e between a mark on the hull and its ideal circular path.

        The norms are max e, sqrt(mean e^2) and sum e; the distance between first and last position
        is returned too. The first position of the mark lies straight ahead of the centre of the
        circle. The ideal mark moves once around it at a constant rate.

        Args:
            mark: Positions (..., n, 2) of the mark [m].
            turn: Direction, +1 or -1.
        """
        angle = turn * np.linspace(0.0, 2.0 * pi, mark.shape[-2])
        ideal = self.radius * np.stack([np.cos(angle) - 1.0, np.sin(angle)], axis=-1)
        e = np.linalg.norm(mark - mark[..., :1, :] - ideal, axis=-1)
        return {
            "position_inf": e.max(-1),  # max e
            "position_rms": np.sqrt((e**2).mean(-1)),  # sqrt(mean e^2)
            "position_l1": e.sum(-1),  # sum e
            "moved": np.linalg.norm(
                mark[..., -1, :] - mark[..., 0, :], axis=-1
            ),  # |last place - first place|
        }
