"""A scenario with many boats at once: its controller, sensors, goals and seeds for each, on all cores.

As `boatsim run` without MuJoCo: nothing touches a wall, no camera films, and what ends a run early (`[until]`) ends no
fleet. The noise of a boat's sensors is that of `boatsim run` with its seed.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from math import inf

import numpy as np
from numpy.typing import ArrayLike

from boatsim.control.base import Controller
from boatsim.control.compiled import CompiledController
from boatsim.errors import BadInput
from boatsim.physics.commands import command_row
from boatsim.physics.signals import Array, signals_of
from boatsim.physics.vessel import Vessel
from boatsim.simulate.batch import Batch
from boatsim.simulate.fleet_control import Aboard, ByFunction, ByLaw, PassedOn, Vectorised
from boatsim.simulate.scenario import Scenario

AHEAD = 64  # periods for which noise is drawn at a time


@dataclass(frozen=True)
class Voyages:
    """Where all boats were, and under which commands, at some times."""

    t: Array  # (N,) [s]
    columns: tuple[str, ...]  # names of the states, as in a recording
    states: Array  # (N, n, 2 NQ)
    inputs: tuple[str, ...]
    commands: Array  # (N, n, C) in force until then

    def __getitem__(self, column: str) -> Array:
        """(N, n) of a state or an input by its name."""
        if column in self.columns:
            return np.asarray(self.states[:, :, self.columns.index(column)])
        return np.asarray(self.commands[:, :, self.inputs.index(column)])


class Fleet:
    """N boats of a scenario; `run` sails them. What a boat does depends on its vessel, its start and its seed alone."""

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
        """Boat i has the vessel and the controller i modulo their numbers, and seed i; default: the scenario's.

        Without `seeds` they count on from the scenario's. A controller is compiled, or passes its goals on as the
        commands of their channels, or is a function of the records of what all sense and of the goal in force, which
        gives the commands of all by name. Raises BadInput for one that is neither.
        """
        file = scenario.file
        boats = scenario.vessel if vessels is None else vessels
        count = n if n is not None else 1 if isinstance(boats, Vessel) else len(boats)
        self.seeds = (
            np.arange(file.seed, file.seed + count)
            if seeds is None
            else np.asarray(seeds, dtype=int)
        )
        if len(self.seeds) != count:
            raise BadInput(f"{len(self.seeds)} seeds for {count} boats; allowed is one for each")
        if scenario.has_off_goal:
            raise BadInput(
                f"{scenario.name}: a goal says off; boats of a fleet are steered all the time"
            )
        self.scenario = scenario
        self.batch = Batch(boats, count, file.step, threads=threads, seeds=self.seeds.tolist())
        given = scenario.controller if controller is None else controller
        self._each = list(given) if isinstance(given, Sequence) else [given]
        self._period = next(
            (c.period for c in self._each if isinstance(c, Controller)), scenario.controller.period
        )
        self._steps = round(self._period / file.step)
        if abs(self._steps * file.step - self._period) > 1e-9:
            raise BadInput(
                f"{scenario.name}: period {self._period:g} s; allowed are whole numbers of steps of {file.step:g} s"
            )
        saturated = np.zeros((count, len(self.batch.vessels[0].inputs)))
        self._aboard = Aboard(self.batch, scenario.sensors, self._steps, saturated)
        self._controlled = self._way()
        self.reset()

    def reset(self, starts: ArrayLike | None = None) -> None:
        """Back to the scenario's start, or to states (2 NQ,) or (n, 2 NQ), all noise from its beginning."""
        start, symbols = (
            self.scenario.file.start,
            [s.symbol for s in signals_of(self.batch.vessels[0].dof)],
        )
        moving = start.motion()
        first = self._each[0].initial_commands() if isinstance(self._each[0], Controller) else {}
        commands = command_row(self.batch.vessels[0], {**first, **start.commands})
        self.batch.reset([moving[s] for s in symbols] if starts is None else starts, commands)
        self._aboard.saturated[:] = 0.0
        self._aboard.random = [
            np.random.default_rng(np.random.SeedSequence(int(s)).spawn(1)[0]) for s in self.seeds
        ]
        self._periods = 0
        self._controlled.reset()

    @property
    def saturated(self) -> Array:
        """(n, inputs) steps in which a boat was sent more than a channel takes."""
        return self._aboard.saturated.copy()

    def run(self, seconds: float | None = None, log: float = inf) -> Voyages:
        """Sail on for so many seconds (the scenario's duration), noting every `log` s, rounded to control periods."""
        last = round((self.scenario.file.duration if seconds is None else seconds) / self._period)
        every = max(1, round(min(log, last * self._period) / self._period))
        at = [*range(0, last, every), last]
        boat = self.batch.vessels[0]
        t, states = np.empty(len(at)), np.empty((len(at), len(self.batch), self.batch._y.shape[1]))
        commands = np.empty((len(at), len(self.batch), len(boat.inputs)))
        for i, periods in enumerate(at):
            if i:
                self._sail(periods - at[i - 1])
            t[i], states[i], commands[i] = (
                self._periods * self._period,
                self.batch.states,
                self.batch._commands,
            )
        named = tuple(s.column for s in signals_of(boat.dof))
        return Voyages(t, named, states, boat.inputs, commands)

    def _sail(self, periods: int) -> None:
        """So many control periods, some at a time."""
        while periods > 0:
            part = min(periods, AHEAD)
            times = [(self._periods + k) * self._period for k in range(part)]
            self._controlled.sail([self.scenario.goal_at(t) for t in times])
            self._periods, periods = self._periods + part, periods - part

    def _way(self) -> PassedOn | ByFunction | ByLaw:
        """How the boats are steered. Raises BadInput."""
        first = self._each[0]
        if not isinstance(first, Controller):
            return ByFunction(self._aboard, first)
        laws = [c for c in self._each if isinstance(c, CompiledController) and c.only_evaluates_law]
        if len(laws) == len(self._each):
            return ByLaw(self._aboard, laws)
        if len(self._each) > 1 or not type(first).passes_on:
            raise BadInput(
                f"controller {type(first).__name__} is not compiled; allowed are compiled ones, one that passes its "
                f"goals on, and functions over all boats"
            )
        return PassedOn(self._aboard)
