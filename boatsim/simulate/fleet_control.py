"""How the vessels of a fleet are controlled: goals passed on, compiled controllers, a function."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from itertools import groupby
from typing import TypeAlias

import numba
import numpy as np
from numpy.typing import ArrayLike

from boatsim.control.compiled import (
    SENSE,
    CompiledController,
    Records,
    indices_of_names,
    view_as_array,
)
from boatsim.errors import BadInput
from boatsim.physics.commands import SLACK, input_vector
from boatsim.physics.debugging import DEBUG
from boatsim.physics.signals import Array
from boatsim.simulate import compiled_loop
from boatsim.simulate.batch import Batch, Boats
from boatsim.simulate.sensing import NOISES, Sensors

Vectorised: TypeAlias = Callable[[Records, Mapping[str, float]], Mapping[str, ArrayLike]]


@dataclass
class FleetControl:
    """Base class of the ways to control a fleet: goals, a function, or compiled controllers.

    Attributes:
        batch: The vessels.
        sensors: Their sensors.
        steps: Steps of a control period.
        saturated: Steps (n, inputs) in which a command exceeded its range.
        random: Random generators of the sensors of each vessel.
    """

    batch: Batch
    sensors: Sensors
    steps: int
    saturated: Array
    random: Sequence[np.random.Generator] = ()

    @property
    def limits(self) -> tuple[Array, Array]:
        """Smallest and largest value of each input of a vessel, two arrays (inputs,)."""
        low, high = (
            np.array(list(self.batch.vessels[0].limits().values()), dtype=float).reshape(-1, 2).T
        )
        return np.ascontiguousarray(low), np.ascontiguousarray(high)

    def reseed(self, random: Sequence[np.random.Generator]) -> None:
        """Begin with other random numbers, and with no saturated steps.

        Args:
            random: Random generators of the sensors of each vessel.
        """
        self.random = random
        self.saturated[:] = 0.0

    def next_sensor_noise(self, boats: Boats, periods: int) -> Array:
        """Return the next random numbers (boats, periods, 7) of the sensor noise of each vessel."""
        samples = np.zeros((len(boats), periods, NOISES))
        if not self.sensors.ideal:
            for row, b in zip(samples, boats, strict=True):
                self.random[b].standard_normal(out=row)
        return samples

    def send_commands(self, orders: Array, steps: int) -> None:
        """Integrate the motion of all vessels under commands and count saturated steps.

        A step is saturated if a command exceeds its range.

        Args:
            orders: Commands (n, inputs) or (inputs,).
            steps: Number of steps.
        """
        low, high = self.limits
        self.batch.advance(orders, steps)
        self.saturated += steps * (np.abs(orders - self.batch.commands) > SLACK * (high - low))


class GoalsAsCommands:
    """Controls a fleet by sending the goals of its scenario directly as commands."""

    def __init__(self, aboard: FleetControl) -> None:
        self.aboard = aboard

    def reset(self) -> None:
        """Do nothing, since goals that are sent as commands need no memory."""

    def advance(self, goals: Sequence[Mapping[str, float]]) -> None:
        """Advance the fleet by one control period per goal, with the goals as commands."""
        for goal, same in groupby(goals):
            steps = len(list(same)) * self.aboard.steps
            self.aboard.send_commands(input_vector(self.aboard.batch.vessels[0], goal), steps)


class FunctionControl:
    """Controls a fleet by a function that computes commands from all sensors and the goals."""

    def __init__(self, aboard: FleetControl, function: Vectorised) -> None:
        self.aboard, self.function = aboard, function
        self._sense = np.zeros(len(aboard.batch), SENSE)

    def reset(self) -> None:
        """Do nothing, since a function that controls a fleet has its own memory."""

    def advance(self, goals: Sequence[Mapping[str, float]]) -> None:
        """Advance the fleet by one control period per goal, with the commands of the function.

        Raises:
            BadInput: If the function returns a channel that does not exist.
        """
        batch, numbers = self.aboard.batch, self.aboard.sensors.error_parameters
        everyone, boat = np.arange(len(batch)), batch.vessels[0]
        noise = self.aboard.next_sensor_noise(everyone, len(goals))
        for i, goal in enumerate(goals):
            batch.sense(view_as_array(self._sense))
            compiled_loop.add_sensor_errors_to_boats(
                everyone, view_as_array(self._sense), numbers, noise, i
            )
            orders = np.tile(input_vector(boat, {}), (len(batch), 1))
            for name, values in self.function(self._sense, goal).items():
                if name not in boat.commands:
                    raise BadInput(boat.unknown_command_message(name))
                orders[:, boat.inputs.index(name)] = values
            self.aboard.send_commands(orders, self.aboard.steps)


class CompiledControl:
    """Controls a fleet by compiled controllers of one kind, one for each vessel.

    Each vessel's controller has its own settings and memory.
    """

    def __init__(self, aboard: FleetControl, controllers: Sequence[CompiledController]) -> None:
        """Compile the loop of controller and vessels.

        Args:
            aboard: Vessels and sensors.
            controllers: Controllers, used in turn.

        Raises:
            BadInput: If they are not of one kind.
        """
        kind = type(controllers[0])
        if any(type(c) is not kind or c.period != controllers[0].period for c in controllers):
            raise BadInput(
                "controllers of a fleet of several kinds or periods; allowed are other settings"
            )
        self.aboard, self.kind = aboard, kind
        n, boat = len(aboard.batch), aboard.batch.vessels[0]
        rows = np.concatenate([c.settings_array() for c in controllers])
        self._settings = rows[np.arange(n) % len(rows)]
        self._memory = np.zeros(n, kind.memory_type)
        self._sense = np.zeros(n, SENSE)
        self._goal, self._sent = (np.zeros(n, t) for t in kind.record_types())
        self._felt, self._wanted, self.orders = (
            view_as_array(r) for r in (self._sense, self._goal, self._sent)
        )
        self.places = indices_of_names(controllers[0].channels(), boat.inputs)
        self._low, self._high = aboard.limits
        self._compile()

    def reset(self) -> None:
        """Clear the memory of the controllers of all vessels of a fleet."""
        self._memory[:] = np.zeros(1, self.kind.memory_type)

    def advance(self, goals: Sequence[Mapping[str, float]]) -> None:
        """Advance the fleet by one control period per goal, under its compiled controllers.

        Args:
            goals: Goals of each period.
        """
        table = np.array([self.kind.goal_values(goal) for goal in goals], dtype=float)
        self.aboard.batch.run_on_threads(lambda boats: self._advance(boats, table))

    def _advance(self, boats: Boats, goals: Array) -> None:
        aboard, batch, count = self.aboard, self.aboard.batch, len(goals)
        periods = compiled_loop.Periods(count, aboard.steps)
        loop = self._make_loop(goals, aboard.next_sensor_noise(boats, count))
        feel = self._feel.bind_arguments(boats, batch.fleet, self._felt)
        advance = self._step.bind_arguments(boats, batch.fleet, batch.step, aboard.steps)
        self._run(self._law, feel, advance, boats, periods, batch.fleet.commands, loop)

    def _make_loop(self, goals: Array, noise: Array) -> compiled_loop.Loop:
        """Records and arrays of the controllers for the compiled loop."""
        aboard = self.aboard
        return compiled_loop.Loop(
            compiled_loop.Control(
                self._settings, self._memory, self._sense, self._goal, self._sent
            ),
            compiled_loop.Sensing(self._felt, aboard.sensors.error_parameters, noise),
            compiled_loop.Goals(self._wanted, goals),
            compiled_loop.Orders(self.orders, self.places, self._low, self._high, aboard.saturated),
        )

    _run: Callable[..., None]

    def _compile(self) -> None:
        """Compile the loop; it takes pointers to functions, so that one serves all vessels."""
        batch = self.aboard.batch
        loop = self._make_loop(np.zeros((1, len(self.kind.goals))), np.zeros((1, 1, NOISES)))
        records = tuple(map(numba.typeof, loop.control))
        self._law = compiled_loop.law_pointer(self.kind.law, records)
        self._feel = compiled_loop.ProgramFunction(
            batch.code.read_instruments_of_boats, compiled_loop.FEEL
        )
        self._step = compiled_loop.ProgramFunction(batch.code.advance_boats, compiled_loop.ADVANCE)
        if DEBUG:
            self._run = compiled_loop.run_periods
        else:
            boats = np.arange(1)
            feel = self._feel.bind_arguments(boats, batch.fleet, self._felt)
            advance = self._step.bind_arguments(boats, batch.fleet, batch.step, 1)
            kinds = self._law.kind, numba.typeof(feel), numba.typeof(advance)
            self._run = compiled_loop.compile_loop(kinds, numba.typeof(loop))
