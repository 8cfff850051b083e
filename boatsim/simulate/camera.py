"""A camera above the water: it sees marks on the hull and gives the pose that fits them best."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from boatsim.errors import BadInput
from boatsim.physics.base import Array, CheckedParameters, param
from boatsim.physics.vessel import Vessel

Pose = tuple[float, float, float]  # x, y [m] of the CG, psi [rad]
DUE = 1e-9  # [s] by which rounding may shift the time of a frame
CAMERA_POSE = ("x_m", "y_m", "psi_rad")  # columns of the pose that a frame gives


class Frame(NamedTuple):
    """One frame of the overhead camera: measured positions of hull marks, and the fitted pose."""

    t: float  # [s]
    x: float  # [m] CG
    y: float  # [m]
    psi: float  # [rad] in [-pi, pi]
    marks: tuple[float, ...]  # [m] x and y of each, in the order of the camera's


@dataclass(frozen=True)
class Camera(CheckedParameters):
    """Overhead camera that measures the pose of a vessel by marks on its hull, with marking noise.

    Its pictures are evaluated by hand: the user marks points of the hull. Positions in the plane of
    the water are complex numbers, north + i east, on the hull ahead + i starboard. Heading and CG
    are those of the least-squares fit of the marks' pattern to the marked points; the scale of the
    pattern is free, as that of a picture is.
    """

    rate: float = param(6.0, low=0.1, high=240.0, unit="Hz", words="frames evaluated per second")
    mark_sd: float = param(
        0.002, low=0.0, high=0.1, unit="m", words="marking noise per coordinate and mark"
    )
    # [m] ahead and to starboard of the CG
    marks: Mapping[str, tuple[float, float]] = field(default_factory=dict)

    def __post_init__(self) -> None:
        super().__post_init__()
        for name, place in self.marks.items():
            if not _is_position(place):
                raise BadInput(
                    f"Camera.marks.{name} = {place!r}; "
                    "allowed are two numbers, m ahead and to starboard"
                )
        if len(set(map(tuple, self.marks.values()))) < 2:
            raise BadInput(
                f"Camera.marks = {dict(self.marks)}; a heading needs two marks in different places"
            )

    def __hash__(self) -> int:
        return hash((self.rate, self.mark_sd, *self.marks, *map(tuple, self.marks.values())))

    @cached_property
    def mark_positions(self) -> Array:
        """Positions (M,) of the camera's marks in hull axes, ahead + i starboard [m]."""
        return np.array([complex(*place) for place in self.marks.values()])

    @cached_property
    def _weights(self) -> Array:
        """Weights (2, M) of the marks in the position of the CG and the direction of the bow."""
        off = self.mark_positions - self.mark_positions.mean()
        turn = off.conj() / (np.abs(off) ** 2).sum()
        return np.array([1.0 / len(off) - self.mark_positions.mean() * turn, turn])

    # Products of complex numbers are computed by their parts: numpy multiplies complex arrays of
    # some shapes with fused operations and of others without, and a frame must not depend on the
    # number of frames.
    def measured_mark_positions(self, place: Array, psi: Array, noise: Array) -> Array:
        """Return the positions of the hull marks that the camera measures, with noise.

        Args:
            place: Complex position (...) of the CG [m].
            psi: Heading (...) [rad].
            noise: Standard normal numbers (..., 2 M).

        Returns:
            Complex positions (..., M) [m].
        """
        places = np.asarray(place)
        ahead, starboard = self._measured_marks(places.real, places.imag, psi, noise)
        return np.asarray(ahead + 1j * starboard)

    def _measured_marks(self, x: Array, y: Array, psi: Array, noise: Array) -> tuple[Array, Array]:
        """Coordinates (..., M) of the marks that the camera measures [m]."""
        bow = np.exp(1j * np.asarray(psi))[..., None]
        c, s, marks = bow.real, bow.imag, self.mark_positions
        turned = c * marks.real - s * marks.imag, c * marks.imag + s * marks.real
        return (
            x[..., None] + turned[0] + self.mark_sd * noise[..., 0::2],
            y[..., None] + turned[1] + self.mark_sd * noise[..., 1::2],
        )

    def fit_pose(self, seen: Array) -> tuple[Array, Array]:
        """Return the pose of the vessel that fits measured positions of its hull marks best.

        Args:
            seen: Complex positions (..., M) of the marks [m].

        Returns:
            Complex position (...) of the CG [m] and heading (...) [rad].
        """
        x, y, psi = self._fit(seen.real, seen.imag)
        return np.asarray(x + 1j * y), psi

    def fit_heading(self, seen: Array) -> Array:
        """Return the heading of the pose that fits measured positions of hull marks best.

        Args:
            seen: Complex positions (..., M) of the marks [m].

        Returns:
            Heading (...) [rad].
        """
        return self._fit(seen.real, seen.imag)[2]

    def _fit(self, x: Array, y: Array) -> tuple[Array, Array, Array]:
        """Position (...) of the CG [m] and heading (...) [rad] that fit marks (..., M) best."""
        weights = self._weights.reshape(2, *(1,) * (x.ndim - 1), -1)
        along = (x * weights.real - y * weights.imag).sum(axis=-1)
        across = (x * weights.imag + y * weights.real).sum(axis=-1)
        return along[0], across[0], np.arctan2(across[1], along[1])

    def pose_noise(self) -> dict[str, float]:
        """Return the standard deviations of a pose measured by the camera.

        They are keyed as in the noise table of a recording's notes.
        """
        centre, turn = (float(np.sqrt((np.abs(w) ** 2).sum())) for w in self._weights)
        return {"position_sd_m": self.mark_sd * centre, "heading_sd_rad": self.mark_sd * turn}

    def take_frame(self, t: float, pose: Pose, noise: Array) -> Frame:
        """Take one camera frame of a vessel: noisy positions of the marks and the fitted pose.

        Args:
            t: Time [s].
            pose: True pose.
            noise: Standard normal numbers (2 M,).
        """
        _, x, y, psi, *marks = self.take_frames(
            np.array([t]), np.array([pose]), np.asarray(noise)[None]
        )[0].tolist()
        return Frame(t, x, y, psi, tuple(marks))

    def take_frames(self, t: Array, poses: Array, noise: Array) -> Array:
        """Take camera frames of a vessel: noisy positions of the marks and the fitted poses.

        A frame does not depend on the others, to the last bit.

        Args:
            t: Times (k,) [s].
            poses: True poses (k, 3).
            noise: Standard normal numbers (k, 2 M).

        Returns:
            Rows (k, 4 + 2 M): time, x, y [m], psi [rad], then x and y of each mark [m].
        """
        rows = np.empty((len(t), 4 + noise.shape[1]))
        rows[:, 0] = t
        marks = self._measured_marks(poses[:, 0], poses[:, 1], poses[:, 2].copy(), noise)
        rows[:, 1], rows[:, 2], rows[:, 3] = self._fit(*marks)
        rows[:, 4::2], rows[:, 5::2] = marks
        return rows

    def is_frame_due(self, number: int, t: float) -> bool:
        """Return whether the camera frame with this number is due by the time t [s]."""
        return number / self.rate <= t + DUE

    def due_frames(self, first: int, t: Array) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """Return the camera frames that fall into consecutive steps of a simulation.

        Args:
            first: Number of the first frame that was not taken yet.
            t: Times (N,) at the ends of the steps [s].

        Returns:
            Numbers (k,) of the frames, and for each the number of the step into which it falls.
        """
        end = max(first, int((t[-1] + DUE) * self.rate) + 2)
        numbers = np.arange(first, end)
        numbers = numbers[numbers / self.rate <= t[-1] + DUE]
        return numbers, np.searchsorted(t + DUE, numbers / self.rate)

    def take_frames_between(
        self,
        numbers: NDArray[np.int64],
        before: Array,
        after: Array,
        rng: np.random.Generator,
    ) -> Array:
        """Take camera frames within steps of a simulation, each at its own time.

        The true pose is interpolated between the ends of the step.

        Args:
            numbers: Numbers (k,) of the frames.
            before: Time [s] and true pose (k, 4) at the begin of each frame's step.
            after: The same at its end.
            rng: Random generator of the marking noise.

        Returns:
            Rows (k, 4 + 2 M) as those of `take_frames`.
        """
        t, t0, t1 = numbers / self.rate, before[:, 0], after[:, 0]
        lengths = np.where(t1 > t0, t1 - t0, 1.0)
        w = np.where(t1 > t0, np.clip((t - t0) / lengths, 0.0, 1.0), 1.0)[:, None]
        poses = before[:, 1:] + w * (after[:, 1:] - before[:, 1:])
        return self.take_frames(t, poses, rng.standard_normal((len(t), 2 * len(self.marks))))


def make_camera(vessel: Vessel, settings: Mapping[str, object]) -> Camera:
    """Return the overhead camera of a scenario, which measures a vessel by marks on its hull.

    Args:
        vessel: The vessel; its marks are used unless the settings replace them. Without any mark
            there are two, half a length ahead and astern of the CG.
        settings: The table [camera].

    Raises:
        BadInput: If a setting is not valid.
    """
    given = settings.get("marks", {})
    if not isinstance(given, Mapping):
        raise BadInput(
            f"Camera.marks = {given!r}; allowed is a table: name = [m ahead, m to starboard]"
        )
    ends = {"bow": (0.5 * vessel.length, 0.0), "stern": (-0.5 * vessel.length, 0.0)}
    return Camera.from_settings({**settings, "marks": {**vessel.marks, **given} or ends})


def _is_position(given: object) -> bool:
    """Whether a value is a list of two finite numbers."""
    if not isinstance(given, list | tuple) or len(given) != 2:
        return False
    return all(type(x) in (int, float) and np.isfinite(x) for x in given)
