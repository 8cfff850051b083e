"""The closed loop of a run: sensors, controller, commands and physics."""

import traceback
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from inspect import getsourcefile
from math import inf

import numpy as np

from boatsim.control.base import Controller, Sense
from boatsim.errors import BadInput, BoatsimError
from boatsim.physics.signals import Array
from boatsim.simulate.control_columns import ControlColumns
from boatsim.simulate.engine import Engine, State
from boatsim.simulate.open_water import OpenWater
from boatsim.simulate.run_end import TIME_TOLERANCE
from boatsim.simulate.run_options import GoalSource
from boatsim.simulate.scenario import OFF, Scenario
from boatsim.simulate.sensing import add_further_readings

SHORTEST_PART = 1e-6  # [s] of a step that the controller cuts


class ControlLoop:
    """Closed loop of one run: sensors and controller act once per period, the physics in between.

    Attributes:
        scenario: The scenario.
        engine: What steps the vessel.
        goal_at: Goals in force at a time [s].
        state: State of the vessel at the end of the last step.
        sense: The latest sample of the sensors.
        sent: Commands sent by the controller, before ranges limit them.
        columns: Columns of the log with sensor readings and estimates.
        due: Time at which the next control period begins [s].
        imu: Random generator of the inertial unit.
        steps: Number of physics steps.
        saturated: Channel -> steps in which a command exceeded its range.
    """

    def __init__(
        self,
        scenario: Scenario,
        engine: Engine | OpenWater,
        goal_at: GoalSource,
        generators: Sequence[np.random.Generator],
        on_interval: Callable[[list[float], float], None],
    ) -> None:
        """Put the vessel at its start and let the controller act once.

        Args:
            scenario: The scenario.
            engine: What steps the vessel.
            goal_at: Goals in force at a time [s].
            generators: Random generators of the inertial unit and of each further sensor.
            on_interval: Receives the commands in force and the length [s] of each interval.

        Raises:
            BadInput: If the controller fails.
        """
        self.scenario = scenario
        self.engine = engine
        self.goal_at = goal_at
        self.imu, *others = generators
        self._instruments = [
            sensor.start(rng)
            for sensor, rng in zip(scenario.additional_sensors, others, strict=True)
        ]
        self._on_interval = on_interval
        vessel = scenario.vessel
        #: channels that the controller sets, and their places among the vessel's commands
        self.channels = list(scenario.controller.channels() or vessel.commands)
        self._places = [list(vessel.commands).index(name) for name in self.channels]
        self.sent: dict[str, float] = {}
        self._beyond: list[str] = []
        self.saturated: Counter[str] = Counter()
        self.steps = 0
        self.due = 0.0
        self._early = inf  # [s] when the controller acts within its period
        start = scenario.file.start
        self.state = State(**start.initial_state_values())
        with self.name_controller_in_errors() as controller:
            controller.reset()
            engine.reset(self.state, {**controller.initial_commands(), **start.commands})
            self._store_sent_commands()
        self.control()
        with self.name_controller_in_errors() as controller:
            self.columns = ControlColumns(scenario, controller.estimates())

    @contextmanager
    def name_controller_in_errors(self) -> Iterator[Controller]:
        """Yield the controller to a block; an error there is raised with its name and time.

        Raises:
            BadInput: If anything in the block fails.
        """
        controller = self.scenario.controller
        try:
            yield controller
        except Exception as error:
            use = self.scenario.file.controller["use"]
            where = f"controller {use} at t = {self.state.t:g} s"
            raise BadInput(f"{where}: {controller_error(error, controller)}") from error

    def advance(self, on_early_command: Callable[[], None]) -> None:
        """Advance the run by one step of physics with constant commands.

        The step is cut where the controller acts within its period.

        Args:
            on_early_command: Called when the controller changed the commands within the step.

        Raises:
            BadInput: If the controller fails.
            BadPhysics: If the motion diverges.
        """
        begin = self.state.t
        end = begin + self.engine.step
        self.steps += 1
        self.saturated.update(self._beyond)
        while self._early < end - SHORTEST_PART:
            self._advance_physics(max(self._early - self.state.t, SHORTEST_PART))
            held = self.sent
            self._sense_and_control()
            if self.sent != held:
                on_early_command()
        if self.state.t > begin:
            self._advance_physics(end - self.state.t)
        else:
            self._advance_physics(self.engine.step)

    def control_if_due(self) -> None:
        """Read the sensors and run the controller if a control period begins now.

        Raises:
            BadInput: If the controller fails.
        """
        if self.state.t >= self.due - TIME_TOLERANCE:
            self.control()

    def control(self) -> None:
        """Read the sensors and run the controller for the period that begins now.

        Raises:
            BadInput: If the controller fails.
        """
        self.due += self.scenario.controller.period
        self._sense_and_control()

    def goal_spans(self, times: Array) -> Iterator[tuple[slice, Mapping[str, float]]]:
        """Yield the goals over ascending times (N,) [s]: ranges of equal goals, and the goals."""
        if self.goal_at == self.scenario.goal_at:
            yield from self.scenario.goal_spans(times)
            return
        for number, t in enumerate(times.tolist()):
            yield slice(number, number + 1), self.goal_at(t)

    def follow_engine(self, state: State, sense: Sense, orders: Mapping[str, float]) -> None:
        """Take over what compiled code has done: the state, and the controller's last step.

        Args:
            state: State of the vessel.
            sense: What the controller received.
            orders: What it sent, by channel.
        """
        self.state = state
        self.sense: Sense = sense
        self.engine.note_sent(orders)
        self._store_sent_commands()

    def commands_in_force(self) -> list[float]:
        """Return the commands that act on the vessel, in the order of `channels`."""
        commands = self.engine.commands_in_force()
        return [commands[place] for place in self._places]

    def _advance_physics(self, seconds: float) -> None:
        self._on_interval(self.commands_in_force(), seconds)
        self.engine.advance(length=seconds)
        self.state = self.engine.state

    def _sense_and_control(self) -> None:
        state = self.state
        usual = self.scenario.sensors.sample(
            state.t,
            (state.x, state.y, state.psi),
            (state.u, state.v, state.r),
            self.engine.acceleration(),
            self.imu,
            (state.phi, state.p),
        )
        self.sense = add_further_readings(usual, self._instruments, self.engine)
        goal = self.goal_at(state.t)
        with self.name_controller_in_errors() as controller:
            if goal.get(OFF):
                controller.reset()
                self.send_commands({})
                self._early = inf
                return
            self.send_commands(controller.step(self.sense, goal))
            self._early = state.t + controller.time_to_extra_step(self.sense)

    def send_commands(self, commands: dict[str, float]) -> None:
        """Send commands of the controller to the vessel, and note what was sent.

        Args:
            commands: Commands by channel; the others are neutral.

        Raises:
            BadInput: If a channel does not exist or a value is not finite.
        """
        self.engine.command(commands)
        self._store_sent_commands()

    def _store_sent_commands(self) -> None:
        self.sent = dict(zip(self.scenario.vessel.commands, self.engine.sent, strict=False))
        self._beyond = self.engine.channels_beyond_range


def controller_error(error: Exception, controller: Controller) -> str:
    """Describe an exception that a controller raised in one line.

    Args:
        error: The exception.
        controller: The controller.

    Returns:
        The text of an error of this package; for another one its kind and the controller's line.
    """
    if isinstance(error, BoatsimError):
        return str(error)
    goals = type(controller).goals
    if isinstance(error, KeyError) and error.args[0] in goals:
        return f"no [[goal]] in force gives {error.args[0]}; it takes {', '.join(goals)}"
    file = getsourcefile(type(controller))
    frames = traceback.extract_tb(error.__traceback__)
    lines = [frame.lineno for frame in frames if frame.filename == file]
    text = f"{type(error).__name__}: {error}"
    return f"{text} ({file}, line {lines[-1]})" if lines else text
