"""A scenario with many vessels at once, each with its controller, sensors, goals and seed.

The vessels run on the compiled engine: there are no walls and no camera, and `[until]` does not end
the run. The sensor noise of a vessel is that of `boatsim run` with its seed.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import inf

import numpy as np
from numpy.typing import ArrayLike

from boatsim.arguments import (
    check_instance,
    checked_integer,
    checked_number,
    integer_array,
    type_error,
)
from boatsim.control.base import Controller
from boatsim.control.compiled import CompiledController
from boatsim.errors import BadInput
from boatsim.physics.commands import input_vector
from boatsim.physics.signals import Array, motion_signals
from boatsim.physics.vessel import Vessel
from boatsim.simulate.batch import MOST_BOATS, Batch, checked_vessels
from boatsim.simulate.fleet_control import (
    CompiledControl,
    FleetControl,
    FunctionControl,
    GoalsAsCommands,
    Vectorised,
)
from boatsim.simulate.scenario import Scenario

LONGEST_RUN = 1e8  # [s], three years
MOST_LOGGED = 10**8  # states of a log
AHEAD = 64  # [periods] for which noise is sampled at a time


@dataclass(frozen=True)
class FleetLog:
    """Log of a fleet simulation: states and commands of all n vessels at N times.

    Attributes:
        t: Times (N,) [s].
        columns: Names of the states, as in a recording.
        states: States (N, n, 2 NQ).
        inputs: Names of the commands and measured inputs.
        commands: Commands (N, n, C) in force before each time.
    """

    t: Array
    columns: tuple[str, ...]
    states: Array
    inputs: tuple[str, ...]
    commands: Array

    def __getitem__(self, column: str) -> Array:
        """Return a state or an input (N, n) by its name."""
        if column in self.columns:
            return np.asarray(self.states[:, :, self.columns.index(column)])
        return np.asarray(self.commands[:, :, self.inputs.index(column)])


class Fleet:
    """Closed-loop simulation of many vessels in one scenario, without interaction between them.

    The motion of each depends on its vessel, start and seed only.

    Attributes:
        scenario: The scenario.
        seeds: Seeds (n,).
        batch: The vessels.
    """

    def __init__(
        self,
        scenario: Scenario,
        n: int | None = None,
        *,
        vessels: Vessel | Sequence[Vessel] | None = None,
        seeds: Sequence[int] | None = None,
        controller: Controller | Sequence[Controller] | Vectorised | None = None,
        threads: int | None = None,
    ) -> None:
        """Put the vessels at the scenario's start.

        Args:
            scenario: The scenario.
            n: Number of vessels; default: one of each.
            vessels: Vessels, used in turn; default: the scenario's.
            seeds: Seeds (n,); default: those from the scenario's on.
            controller: Controllers, used in turn; default: the scenario's. A controller must be
                compiled or pass its goals on as commands. It can also be a function of the records
                (n,) of all sensors and of the goals, which returns commands (n,) by channel.
            threads: Number of threads; default: one per core.

        Raises:
            BadInput: If a controller is of another kind, or scenario and numbers do not fit.
        """
        check_instance("scenario", scenario, Scenario, "a Scenario of boatsim.load_scenario")
        file = scenario.file
        if vessels is None:
            vessels = scenario.vessel
        kinds = checked_vessels(vessels)
        count = len(kinds) if n is None else checked_integer("n", n, 1, MOST_BOATS)
        if seeds is None:
            seeds = range(file.seed, file.seed + count)
        self.seeds = integer_array("seeds", list(seeds) if isinstance(seeds, range) else seeds)
        if self.seeds.shape != (count,):
            raise BadInput(f"{self.seeds.size} seeds for {count} boats; allowed is one for each")
        if scenario.has_off_goal:
            raise BadInput(
                f"{scenario.name}: a goal has off = true; a fleet is steered all the time"
            )
        self.scenario = scenario
        self.batch = Batch(kinds, count, file.step, threads=threads, seeds=self.seeds.tolist())
        given = scenario.controller if controller is None else controller
        self._each = list(given) if isinstance(given, Sequence) else [given]
        self._check_controllers()
        first = self._each[0]
        self._period = scenario.controller.period
        if isinstance(first, Controller):
            self._period = first.period
        self._steps = round(self._period / file.step)
        if abs(self._steps * file.step - self._period) > 1e-9:
            raise BadInput(
                f"{scenario.name}: period {self._period:g} s; "
                f"allowed are whole numbers of steps of {file.step:g} s"
            )
        saturated = np.zeros((count, len(self.batch.vessels[0].inputs)))
        self._aboard = FleetControl(self.batch, scenario.sensors, self._steps, saturated)
        self._controlled = self._make_control()
        self.reset()

    def _check_controllers(self) -> None:
        """Raise TypeError or BadInput unless there are controllers, or one function."""
        if not self._each:
            raise BadInput("controller is empty; allowed is at least one")
        several: list[object] = list(self._each)
        for one in several:
            is_function = callable(one) and len(several) == 1
            if not isinstance(one, Controller) and not is_function:
                raise type_error("controller", one, "controllers or one function")

    def reset(self, starts: ArrayLike | None = None) -> None:
        """Put all vessels of the fleet at a start and restart their noise.

        Args:
            starts: State (2 NQ,) or states (n, 2 NQ); default: the scenario's start.
        """
        start, vessel = self.scenario.file.start, self.batch.vessels[0]
        commands: dict[str, float] = {}
        if isinstance(self._each[0], Controller):
            commands.update(self._each[0].initial_commands())
        commands.update(start.commands)
        if starts is None:
            motion = start.initial_state_values()
            starts = [motion[signal.symbol] for signal in motion_signals(vessel.dof)]
        self.batch.reset(starts, input_vector(vessel, commands))
        self._aboard.reseed(list(map(_sensor_generator, self.seeds.tolist())))
        self._periods = 0
        self._controlled.reset()

    @property
    def saturated(self) -> Array:
        """Number of steps (n, inputs) in which a command of a vessel exceeded its range."""
        return self._aboard.saturated.copy()

    def run(self, seconds: float | None = None, log: float = inf) -> FleetLog:
        """Continue the simulation of all vessels and log their states and commands.

        Args:
            seconds: Simulated time [s]; default: the scenario's duration.
            log: Time between two logged rows [s], rounded to control periods.

        Returns:
            The log, with the first and the last state.

        Raises:
            BadInput: If a number is out of range, the log would be too long, or a control function
                returns a channel that does not exist.
        """
        if seconds is None:
            seconds = self.scenario.file.duration
        seconds = checked_number("seconds", seconds, 0.0, LONGEST_RUN, "s")
        log = _checked_interval(log)
        last = round(seconds / self._period)
        every = max(1, round(min(log, last * self._period) / self._period))
        if last // every * len(self.batch) > MOST_LOGGED:
            raise BadInput(
                f"log = {log:g} s; {last // every} rows of {len(self.batch)} boats are more than "
                f"{MOST_LOGGED:g}"
            )
        at = [*range(0, last, every), last]
        vessel, shape = self.batch.vessels[0], (len(at), len(self.batch))
        t = np.empty(len(at))
        states = np.empty((*shape, self.batch.fleet.y.shape[1]))
        commands = np.empty((*shape, len(vessel.inputs)))
        for i, periods in enumerate(at):
            if i:
                self._advance(periods - at[i - 1])
            t[i] = self._periods * self._period
            states[i] = self.batch.states
            commands[i] = self.batch.commands
        columns = tuple(signal.column for signal in motion_signals(vessel.dof))
        return FleetLog(t, columns, states, vessel.inputs, commands)

    def _advance(self, periods: int) -> None:
        """Advance by control periods, some at a time."""
        while periods > 0:
            part = min(periods, AHEAD)
            goals: list[Mapping[str, float]] = []
            for number in range(self._periods, self._periods + part):
                goals.append(self.scenario.goal_at(number * self._period))
            self._controlled.advance(goals)
            self._periods += part
            periods -= part

    def _make_control(self) -> GoalsAsCommands | FunctionControl | CompiledControl:
        """How the vessels are controlled. Raises BadInput."""
        first = self._each[0]
        if not isinstance(first, Controller):
            return FunctionControl(self._aboard, first)
        laws = [c for c in self._each if isinstance(c, CompiledController) and c.only_evaluates_law]
        if len(laws) == len(self._each):
            return CompiledControl(self._aboard, laws)
        if len(self._each) > 1 or not type(first).passes_on:
            raise BadInput(
                f"controller {type(first).__name__} is not compiled; allowed are compiled ones, "
                "one that passes its goals on, and functions over all boats"
            )
        return GoalsAsCommands(self._aboard)


def _checked_interval(log: object) -> float:
    """Time between two logged rows [s], which may be infinite."""
    if isinstance(log, float) and log == inf:
        return inf
    return checked_number("log", log, 0.0, LONGEST_RUN, "s")


def _sensor_generator(seed: int) -> np.random.Generator:
    """Generator of the inertial unit, as in a run with this seed."""
    return np.random.default_rng(np.random.SeedSequence(seed).spawn(1)[0])
