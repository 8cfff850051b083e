"""The log of a run: its columns, and a row for every time at which one is due."""

from math import nan
from operator import attrgetter

import numpy as np
from numpy.typing import NDArray

from boatsim.physics.base import Force, WaterFlow
from boatsim.physics.signals import AXES, COMPONENTS, Array, motion_signals
from boatsim.physics.vessel.wave_field import wave_field
from boatsim.recordings.table import Notes, Recording
from boatsim.simulate.camera import CAMERA_POSE
from boatsim.simulate.camera_log import mark_columns
from boatsim.simulate.control_loop import ControlLoop
from boatsim.simulate.growing_table import GrowingTable, MakeTable
from boatsim.simulate.run_end import TIME_TOLERANCE
from boatsim.simulate.step_block import StepBlock
from boatsim.simulate.stepper import State
from boatsim.simulate.tracking_errors import GOAL

WAVE_ELEVATION = "wave_elevation_m"
WATER_VELOCITY = ("water_north_mps", "water_east_mps")
PLACE = (State._fields.index("x"), State._fields.index("y"))


class RunLog:
    """Log of a run: writes the state of the closed loop into a table at regular times.

    The columns are the motion, the commands in force and groups with a prefix. `sent_` is a command
    as the controller sent it, before its range limits it; `goal_` is a goal, nan where none is in
    force; `actual_` is an actuator; `sensed_` and `camera_` are measurements. `force_` is the sum
    of all effects and `wind_` that of the effects of air. `wave_elevation_m` is the elevation of
    the sea at the vessel's origin, upward, where the waves of an effect have one.
    `water_north_mps` and `water_east_mps` are the velocity of the water there over the ground,
    where an effect moves it. `estimate_` is an estimate of the controller.

    Attributes:
        scenario: The scenario.
        table: The rows.
        due: Time of the next row [s].
    """

    def __init__(self, loop: ControlLoop, make_table: MakeTable) -> None:
        """Create an empty log for a control loop whose controller has acted once.

        Args:
            loop: The control loop.
            make_table: Creates a table from names of columns and the expected number of rows.
        """
        self._loop = loop
        self.scenario = loop.scenario
        vessel = loop.engine.vessel
        self._signals_text = motion_signals(vessel.dof)
        self._motion_of = attrgetter(*(signal.symbol for signal in self._signals_text))
        self._motion_places = [State._fields.index(s.symbol) for s in self._signals_text]
        self._axes = [i for i, axis in enumerate(AXES) if axis in vessel.dof]
        self._camera_columns = 2 * len(self.scenario.camera.marks) + len(CAMERA_POSE)
        self._measured = {name: channel.neutral for name, channel in vessel.measured.items()}
        # goals that are commands are already in the columns `sent_`
        self._goals = [key for key in self.scenario.goal_keys if key not in vessel.commands]
        self._winds = [e for e in vessel.effects if isinstance(e, Force) and type(e).of_air]
        self._waves = wave_field(vessel.effects)
        self._water_moves = any(isinstance(effect, WaterFlow) for effect in vessel.effects)
        self.due = 0.0
        file = self.scenario.file
        rows = file.duration / max(file.log, file.step)
        self.table: GrowingTable = make_table(self._column_names(), rows)

    def _column_names(self) -> list[str]:
        components = [COMPONENTS[AXES[i]] for i in self._axes]
        columns = ["t_s", *(signal.column for signal in self._signals_text), *self._loop.channels]
        columns += self._measured
        columns += map("sent_{}".format, self._loop.channels)
        columns += map("actual_{}".format, self._loop.engine.vessel.actuators)
        columns += self._loop.columns.sensed
        columns += mark_columns(self.scenario.camera)
        columns += map("camera_{}".format, CAMERA_POSE)
        columns += map("force_{}".format, components)
        if self._winds:
            columns += map("wind_{}".format, components)
        if len(self._waves):
            columns.append(WAVE_ELEVATION)
        if self._water_moves:
            columns += WATER_VELOCITY
        columns.append("contacts")
        columns += self._loop.columns.estimated
        columns += [f"{GOAL}{name}" for name in self._goals]
        return columns

    def is_due(self) -> bool:
        """Return whether the log shall get a row at the present simulated time."""
        return self._loop.state.t >= self.due - TIME_TOLERANCE

    def rows_due(self, times: Array) -> NDArray[np.bool_]:
        """Return at which of several consecutive times [s] the log shall get a row.

        The rows count as written.
        """
        interval = self.scenario.file.log
        if interval == 0.0:
            return np.ones(len(times), dtype=bool)
        found: list[bool] = []
        for t in times.tolist():
            found.append(t >= self.due - TIME_TOLERANCE)
            if found[-1]:
                self.due += interval
        return np.array(found)

    def add_row(self, frame: Array | None) -> None:
        """Append a row with the present state of the closed loop to the log.

        Args:
            frame: The last camera frame since the last row, a row of `Camera.take_frames`; None if
                there was none.

        Raises:
            BadInput: If the controller fails to give its estimates.
            OSError: If the disk is full.
        """
        loop, columns = self._loop, self._loop.columns
        state, engine = loop.state, loop.engine
        if self.is_due():
            self.due += self.scenario.file.log
        with loop.name_controller_in_errors() as controller:
            estimates = controller.estimates()
        goal = loop.goal_at(state.t)
        row = [
            state.t,
            *self._motion_of(state),
            *loop.commands_in_force(),
            *self._measured.values(),
        ]
        row += map(loop.sent.__getitem__, loop.channels)
        row += engine.actuators.values()
        row += columns.sensed_values(loop.sense)
        if frame is None:
            row += [nan] * self._camera_columns
        else:
            row += [*frame[4:].tolist(), *frame[1:4].tolist()]
        row += engine.body_force()
        if self._winds:
            row += engine.air_force()
        if len(self._waves):
            row.append(float(self._waves.elevation(state.x, state.y, state.t)))
        if self._water_moves:
            row += engine.water_velocity()
        row.append(engine.contacts)
        row += columns.estimated_values(estimates)
        row += [goal.get(name, nan) for name in self._goals]
        self.table.append_row(row)

    def add_rows(self, block: StepBlock, frames: Array, steps: NDArray[np.int64]) -> None:
        """Append the rows of many steps to the log.

        Args:
            block: The steps.
            frames: Camera frames (k, 4 + 2 M) since the last row, rows of `Camera.take_frames`.
            steps: Number (k,) of the step into which each falls; -1 before the first.

        Raises:
            OSError: If the disk is full.
        """
        record, control = block.record, block.control
        at = np.flatnonzero(block.logged)
        if not len(at):
            return
        rows: slice | NDArray[np.int64] = at
        if len(at) == block.count:
            rows = slice(block.count)  # a view costs nothing
        states, after = block.states[rows], block.control_after[rows]
        t, x, y = states[:, 0], states[:, PLACE[0]], states[:, PLACE[1]]
        camera = np.full((len(at), self._camera_columns), nan)
        first = np.searchsorted(at, steps)  # the first row from each frame on
        shown = first < len(at)
        camera[first[shown]] = np.roll(frames[shown, 1:], -len(CAMERA_POSE), axis=1)
        parts = [
            states[:, :1],
            states[:, self._motion_places],
            control.commands[after],
            np.tile(np.array(list(self._measured.values())), (len(at), 1)),
            control.sent[after],
            record.mean[rows],
            control.sensed[after],
            camera,
            record.force[rows],
        ]
        if self._winds:
            parts.append(record.air[rows])
        if len(self._waves):
            parts.append(np.asarray(self._waves.elevation(x, y, t))[:, None])
        if self._water_moves:
            parts.append(record.water[rows])
        parts += [np.zeros((len(at), 1)), control.estimated[after], self._goals_at(t)]
        self.table.append_rows(parts)

    def _goals_at(self, times: Array) -> Array:
        """Goals (N, G) at several times [s]."""
        rows = np.full((len(times), len(self._goals)), nan)
        for span, goal in self._loop.goal_spans(times):
            for column, name in enumerate(self._goals):
                if name in goal:
                    rows[span, column] = goal[name]
        return rows

    def recording(self, notes: Notes, start: int = 0) -> Recording:
        """Return the log from row `start` on as a recording.

        Args:
            notes: Notes of the recording.
            start: First row.
        """
        return self.table.recording(self.scenario.name.replace("/", "_"), notes, start)
