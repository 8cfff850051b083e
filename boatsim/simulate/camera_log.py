"""The camera of a run: takes its frames when they are due and logs them."""

import numpy as np
from numpy.typing import NDArray

from boatsim.physics.signals import Array
from boatsim.recordings.table import Notes, Recording
from boatsim.simulate.camera import CAMERA_POSE, Camera
from boatsim.simulate.growing_table import GrowingTable, MakeTable
from boatsim.simulate.scenario import Scenario
from boatsim.simulate.step_block import StepBlock
from boatsim.simulate.stepper import State

TIMED_POSE = [State._fields.index(name) for name in ("t", "x", "y", "psi")]


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
        self._commands: list[list[float]] = []
        self._seconds: list[float] = []
        columns = ["t_s", *CAMERA_POSE, *mark_columns(self._camera), *channels]
        self._first_command = len(columns) - len(channels)
        self._no_frames = np.zeros((0, self._first_command))
        self.table: GrowingTable = make_table(columns, scenario.file.duration * self._camera.rate)

    def record_command_duration(self, commands: list[float], seconds: float) -> None:
        """Record for how many seconds commands were in force.

        Their mean between two camera frames is logged.

        The commands are in the order of the channels.
        """
        self._commands.append(commands)
        self._seconds.append(seconds)

    def take_frames(self, before: State, after: State, commands: list[float]) -> Array:
        """Take and log the camera frames that fall into one step of the simulation.

        Args:
            before: State at the begin of the step.
            after: State at its end.
            commands: Commands in force at its end, in the order of the channels.

        Returns:
            The frames (k, 4 + 2 M) as rows of `Camera.take_frames`.

        Raises:
            OSError: If the disk is full.
        """
        if not self._camera.is_frame_due(self._number, after.t):
            return self._no_frames
        end = self._number + 1
        while self._camera.is_frame_due(end, after.t):
            end += 1
        numbers = np.arange(self._number, end)
        begin = np.array([[before.t, before.x, before.y, before.psi]] * len(numbers))
        end_of_step = np.array([[after.t, after.x, after.y, after.psi]] * len(numbers))
        frames = self._camera.take_frames_between(numbers, begin, end_of_step, self._generator)
        held, seconds = np.array(self._commands), np.array(self._seconds)
        ends = np.full(len(numbers), len(seconds))
        self._log_frames(frames, np.array([commands] * len(numbers)), held, seconds, ends)
        self._commands.clear()
        self._seconds.clear()
        return frames

    def take_frames_of_block(
        self, before: State, block: StepBlock
    ) -> tuple[Array, NDArray[np.int64]]:
        """Take and log the camera frames that fall into many steps of the simulation.

        Args:
            before: State at the begin of the first step.
            block: The steps.

        Returns:
            The frames (k, 4 + 2 M) as rows of `Camera.take_frames`, and the number (k,) of the step
            into which each falls.

        Raises:
            OSError: If the disk is full.
        """
        states, commands = block.states, block.commands
        numbers, steps = self._camera.due_frames(self._number, states[:, 0])
        held, seconds = commands, np.full(len(commands), block.step)
        waiting = len(self._seconds)
        if waiting:
            held = np.concatenate([self._commands, commands])
            seconds = np.concatenate([self._seconds, seconds])
        rest, frames = 0, self._no_frames
        if len(numbers):
            poses = np.concatenate([[before], states])[:, TIMED_POSE]
            frames = self._camera.take_frames_between(
                numbers, poses[steps], poses[steps + 1], self._generator
            )
            ends = waiting + steps + 1
            rest = int(ends[-1])
            self._log_frames(frames, commands[steps], held[:rest], seconds[:rest], ends)
        self._commands, self._seconds = held[rest:].tolist(), seconds[rest:].tolist()
        return frames, steps

    def _log_frames(
        self,
        frames: Array,
        commands: Array,
        held: Array,
        seconds: Array,
        ends: NDArray[np.int64],
    ) -> None:
        """Log new frames, and the mean of the commands between two frames.

        Args:
            frames: The frames (k, 4 + 2 M).
            commands: Commands (k, C) in force at each frame, which the last one keeps for now.
            held: Commands (n, C) that were in force one after another since the last logged frame.
            seconds: How long (n,) each was in force [s].
            ends: Number (k,) of those in force before each of the new frames.
        """
        begins = np.concatenate([[0], ends[:-1]])
        between = np.flatnonzero(ends > begins)  # those with commands since the frame before
        means = np.concatenate([commands[:1], commands])  # of the last logged frame, then the new
        if len(between):
            at = begins[between]
            weighted = np.add.reduceat(held * seconds[:, None], at, axis=0)
            means[between] = weighted / np.add.reduceat(seconds, at)[:, None]
            if self.table.count and between[0] == 0:
                self.table.replace_last_values(self._first_command, means[0])
        self.table.append_rows([frames, means[1:]])
        self._number += len(frames)

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
