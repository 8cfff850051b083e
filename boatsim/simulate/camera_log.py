"""The camera of a run: takes its frames when they are due and logs them."""

import numpy as np

from boatsim.recordings.table import Notes, Recording
from boatsim.simulate.camera import CAMERA_POSE, Camera, Frame
from boatsim.simulate.growing_table import GrowingTable, MakeTable
from boatsim.simulate.scenario import Scenario
from boatsim.simulate.stepper import State


class CameraLog:
    """Takes and logs the camera frames of a run, with the mean commands between two frames.

    Attributes:
        table: The frames.
    """

    def __init__(
        self,
        scenario: Scenario,
        channels: list[str],
        generator: np.random.Generator,
        make_table: MakeTable,
    ) -> None:
        """Create an empty log.

        Args:
            scenario: The scenario, whose camera takes the frames.
            channels: Channels that the controller sets.
            generator: Random generator of the marking noise.
            make_table: Creates a table from names of columns and the expected number of rows.
        """
        self._camera = scenario.camera
        self._generator = generator
        self._number = 0  # of the next frame
        # commands in force since the last frame, and for how long [s]
        self._intervals: list[tuple[list[float], float]] = []
        columns = ["t_s", *CAMERA_POSE, *mark_columns(self._camera), *channels]
        self._first_command = len(columns) - len(channels)
        self.table: GrowingTable = make_table(columns, scenario.file.duration * self._camera.rate)

    @property
    def next_frame_time(self) -> float:
        """Time at which the next camera frame is due [s]."""
        return self._number / self._camera.rate

    def record_command_duration(self, commands: list[float], seconds: float) -> None:
        """Record for how many seconds commands were in force.

        Their mean between two camera frames is logged.

        The commands are in the order of the channels.
        """
        self._intervals.append((commands, seconds))

    def take_frames(self, before: State, after: State, commands: list[float]) -> list[Frame]:
        """Take and log the camera frames that fall into one step of the simulation.

        Args:
            before: State at the begin of the step.
            after: State at its end.
            commands: Commands in force at its end, in the order of the channels.

        Returns:
            The frames.

        Raises:
            OSError: If the disk is full.
        """
        if not self._camera.is_frame_due(self._number, after.t):
            return []
        pose_before = (before.x, before.y, before.psi)
        pose_after = (after.x, after.y, after.psi)
        frames = list(
            self._camera.take_frames_between(
                before.t, pose_before, after.t, pose_after, self._number, self._generator
            )
        )
        for frame in frames:
            self._set_mean_commands()
            self.table.append_row([*frame[:4], *frame.marks, *commands])
        self._number += len(frames)
        return frames

    def _set_mean_commands(self) -> None:
        """Give the last frame the mean of the commands since it was taken."""
        if self.table.count and self._intervals:
            commands, seconds = zip(*self._intervals, strict=True)
            self.table.replace_last_values(self._first_command, np.average(commands, 0, seconds))
        self._intervals.clear()

    def recording(self, notes: Notes, start: int = 0, end: int | None = None) -> Recording:
        """Return camera frames as a recording, from number `start` up to but not including `end`.

        Args:
            notes: Notes of the recording.
            start: Number of the first frame.
            end: Number after the last one; default: all frames.
        """
        return self.table.recording("camera", notes, start, end)


def mark_columns(camera: Camera) -> list[str]:
    """Return the names of the log columns with the measured positions of hull marks of a camera."""
    return [f"camera_{mark}_{axis}_m" for mark in camera.marks for axis in "xy"]
