"""The log of a run: its columns, and a row for every time at which one is due."""

from collections.abc import Sequence
from math import nan
from operator import attrgetter

from boatsim.physics.base import Force, WaterFlow, make_motion
from boatsim.physics.debugging import python_function
from boatsim.physics.signals import AXES, COMPONENTS, motion_signals
from boatsim.physics.vessel.wave_field import wave_field
from boatsim.recordings.table import Notes, Recording
from boatsim.simulate.camera import CAMERA_POSE, Frame
from boatsim.simulate.camera_log import mark_columns
from boatsim.simulate.control_loop import TIME_TOLERANCE, ControlLoop
from boatsim.simulate.engine import State
from boatsim.simulate.growing_table import GrowingTable, MakeTable
from boatsim.simulate.tracking_errors import GOAL

SENSED = ("psi_rad", "r_radps", "ax_mps2", "ay_mps2", "u_mps", "x_m", "y_m")
SENSE_VALUES = attrgetter("psi", "r", "ax", "ay", "u", "x", "y")  # of a Sense, in the same order
WAVE_ELEVATION = "wave_elevation_m"
WATER_VELOCITY = ("water_north_mps", "water_east_mps")
REFERENCE = "reference_"  # prefix of estimates that are reference signals of a controller


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

        Raises:
            BadInput: If the controller fails to give its estimates.
        """
        self._loop = loop
        self.scenario = loop.scenario
        vessel = loop.engine.vessel
        with loop.name_controller_in_errors() as controller:
            estimates = list(controller.estimates())
        self._references = [name for name in estimates if name.startswith(REFERENCE)]
        self._estimates = [name for name in estimates if not name.startswith(REFERENCE)]
        self._signals_text = motion_signals(vessel.dof)
        self._motion_of = attrgetter(*(signal.symbol for signal in self._signals_text))
        self._axes = [i for i, axis in enumerate(AXES) if axis in vessel.dof]
        self._readings: dict[str, str] = {}  # reading of a further sensor -> its column
        for sensor in self.scenario.additional_sensors:
            for reading, column in type(sensor).columns.items():
                if column not in SENSED:  # logged already
                    self._readings[reading] = column
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
        columns += map("sensed_{}".format, (*SENSED, *self._readings.values()))
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
        for name in self._estimates:
            columns += [f"estimate_{name}", f"estimate_{name}_low", f"estimate_{name}_high"]
        columns += self._references
        columns += [f"{GOAL}{name}" for name in self._goals]
        return columns

    def is_due(self) -> bool:
        """Return whether the log shall get a row at the present simulated time."""
        return self._loop.state.t >= self.due - TIME_TOLERANCE

    def add_row(self, frames: Sequence[Frame]) -> None:
        """Append a row with the present state of the closed loop to the log.

        Args:
            frames: Camera frames since the last row; the row holds the last of them.

        Raises:
            BadInput: If the controller fails to give its estimates.
            OSError: If the disk is full.
        """
        loop = self._loop
        state, engine, sense = loop.state, loop.engine, loop.sense
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
        row += SENSE_VALUES(sense)
        row += map(sense.more.__getitem__, self._readings)
        if frames:
            row += [*frames[-1].marks, *frames[-1][1:4]]
        else:
            row += [nan] * (2 * len(self.scenario.camera.marks) + len(CAMERA_POSE))
        wrench = engine.wrench()
        row += map(wrench.__getitem__, self._axes)
        if self._winds:
            row += map(self._wind_wrench(state).__getitem__, self._axes)
        if len(self._waves):
            row.append(float(self._waves.elevation(state.x, state.y, state.t)))
        if self._water_moves:
            row += engine.water_velocity()
        row.append(engine.contacts)
        for name in self._estimates:
            row += estimates[name]
        row += [estimates[name].value for name in self._references]
        row += [goal.get(name, nan) for name in self._goals]
        self.table.append_row(row)

    def _wind_wrench(self, state: State) -> list[float]:
        """Force of the air (X, Y, Z, K, M, N) in body axes [N, N m]."""
        total = [0.0] * len(AXES)
        for effect in self._winds:
            # interpreted: a single call is not worth compiling
            law = python_function(type(effect).law)
            values: dict[str, float] = {}
            for role, channel in self.scenario.vessel.specified_inputs(effect).items():
                values[role] = self._measured[channel] if isinstance(channel, str) else channel
            signals = (type(effect).signals(**values),) if type(effect).roles else ()
            wrench = law(make_motion(**state._asdict()), effect.values(), *signals)
            total = [a + b for a, b in zip(total, wrench, strict=True)]
        return total

    def recording(self, notes: Notes, start: int = 0) -> Recording:
        """Return the log from row `start` on as a recording.

        Args:
            notes: Notes of the recording.
            start: First row.
        """
        return self.table.recording(self.scenario.name.replace("/", "_"), notes, start)
