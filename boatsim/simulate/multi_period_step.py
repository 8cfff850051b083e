"""Several control periods in one compiled call, for a compiled controller in open water."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from boatsim.control.base import Controller
from boatsim.control.compiled import CompiledController
from boatsim.simulate.fleet_control import CompiledControl, FleetControl
from boatsim.simulate.open_water import OpenWater
from boatsim.simulate.scenario import Scenario, UntilTable
from boatsim.simulate.stepper import Stepper

FEWEST_PERIODS = 2  # in one call; a call for less costs more time than it saves


@dataclass(frozen=True)
class PeriodsDone:
    """Result of several control periods that were simulated in one call.

    Attributes:
        steps: Number of physics steps.
        seconds: Simulated time [s].
        saturated: Channel -> steps in which a command exceeded its range.
        mean: Channel -> mean of the command in force.
    """

    steps: int
    seconds: float
    saturated: Mapping[str, int]
    mean: Mapping[str, float]


class MultiPeriodStep:
    """Simulates several control periods of controller and vessel in one compiled call.

    The results equal those of `ControlLoop`, which simulates one step after another.

    Attributes:
        period: Control period [s].
    """

    def __init__(
        self,
        scenario: Scenario,
        engine: OpenWater,
        law: CompiledController,
        imu: np.random.Generator,
    ) -> None:
        """Compile the loop; use `create_if_possible` instead, which checks the conditions.

        Args:
            scenario: The scenario.
            engine: The engine of the run.
            law: The scenario's controller.
            imu: Random generator of the inertial unit.
        """
        self.period = law.period
        self._scenario, self._engine = scenario, engine
        self._steps = round(law.period / engine.step)  # of a period
        saturated = np.zeros((1, len(engine.sent)))
        self._aboard = FleetControl(engine.batch, scenario.sensors, self._steps, saturated, [imu])
        self._law = CompiledControl(self._aboard, [law], law.memory)

    @classmethod
    def create_if_possible(
        cls, scenario: Scenario, engine: Stepper, imu: np.random.Generator
    ) -> "MultiPeriodStep | None":
        """Return an object that simulates several control periods of a run in one call, or None.

        It is possible if a compiled controller steers all the time and acts once per period, in
        open water, with the usual sensors, and nothing but time ends the run.

        Args:
            scenario: The scenario.
            engine: The engine of the run.
            imu: Random generator of the inertial unit.
        """
        law = scenario.controller
        if not isinstance(law, CompiledController) or not isinstance(engine, OpenWater):
            return None
        if scenario.additional_sensors or scenario.has_off_goal or not law.only_evaluates_law:
            return None
        kind, steps = type(law), law.period / engine.step
        acts_between = (
            kind.time_to_extra_step is not Controller.time_to_extra_step
            or kind.done is not Controller.done
        )
        if acts_between or scenario.file.until != UntilTable() or abs(steps - round(steps)) > 1e-9:
            return None
        return cls(scenario, engine, law, imu)

    def count_complete_periods(self, t: float, until: float) -> int:
        """Return how many control periods from time t [s] end at least a step before `until` [s].

        Returns:
            The number of whole periods; 0 if there are too few of them to save time.
        """
        found = int(((until - t) / self._engine.step - 1.0 + 1e-6) / self._steps)
        return found if found >= FEWEST_PERIODS else 0

    def advance(
        self, t: float, periods: int, goal_at: Callable[[float], Mapping[str, float]]
    ) -> PeriodsDone:
        """Simulate vessel and controller over control periods; the controller acts at each end.

        Args:
            t: Time now [s]; the commands in force are the controller's last ones.
            periods: Number of periods.
            goal_at: Goals in force at a time [s].

        Returns:
            Numbers of steps and saturated steps, time and mean commands.
        """
        law, aboard, engine = self._law, self._aboard, self._engine
        law.orders[0] = [engine.sent[place] for place in law.places]
        aboard.saturated[:] = 0.0
        aboard.total[:] = 0.0
        goals: list[Mapping[str, float]] = [{}] * periods
        if self._scenario.file.goal:
            goals = [goal_at(t + i * self.period) for i in range(1, periods + 1)]
        law.advance(goals, begins=False)
        for place, order in zip(law.places, law.orders[0].tolist(), strict=True):
            engine.sent[place] = order
        names, seconds = list(self._scenario.vessel.commands), periods * self.period
        saturated: dict[str, int] = {}
        for name, steps in zip(names, aboard.saturated[0].tolist(), strict=False):
            if steps:
                saturated[name] = round(steps)
        mean = dict(zip(names, (aboard.total[0] / seconds).tolist(), strict=False))
        return PeriodsDone(periods * self._steps, seconds, saturated, mean)
