"""Stretches of a run in one compiled call: a compiled law and a boat in open water, left alone until a row is due."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from boatsim.control.base import Controller
from boatsim.control.compiled import CompiledController
from boatsim.simulate.fleet_control import Aboard, ByLaw
from boatsim.simulate.open_water import OpenWater
from boatsim.simulate.scenario import Scenario, UntilTable
from boatsim.simulate.stepper import Stepper

WORTH_IT = 2  # [periods] of a leap; a shorter one costs more than it saves


@dataclass(frozen=True)
class Leapt:
    """What a leap leaves to be counted."""

    steps: int
    seconds: float
    saturated: Mapping[str, int]  # channel -> steps in which more was sent than it takes
    mean: Mapping[str, float]  # commands in force


class Leap:
    """Steps law and boat together, period by period, as `Runner` would."""

    def __init__(
        self,
        scenario: Scenario,
        engine: OpenWater,
        law: CompiledController,
        imu: np.random.Generator,
    ) -> None:
        self.scenario, self.engine, self.period = scenario, engine, law.period
        self.steps = round(law.period / engine.step)  # of a period
        self._aboard = Aboard(
            engine.batch, scenario.sensors, self.steps, np.zeros((1, len(engine.sent))), [imu]
        )
        self._law = ByLaw(self._aboard, [law], law.memory)

    @classmethod
    def possible(
        cls, scenario: Scenario, engine: Stepper, imu: np.random.Generator
    ) -> "Leap | None":
        """For a compiled law at work all along, in open water which nothing but time ends, with the usual sensors."""
        law = scenario.controller
        if not isinstance(law, CompiledController) or not isinstance(engine, OpenWater):
            return None
        if scenario.aboard or scenario.lets_go or not law.only_evaluates_law:
            return None
        kind, each = type(law), law.period / engine.step
        acts_between = kind.early is not Controller.early or kind.done is not Controller.done
        if acts_between or scenario.file.until != UntilTable() or abs(each - round(each)) > 1e-9:
            return None
        return cls(scenario, engine, law, imu)

    def periods(self, t: float, until: float) -> int:
        """Whole periods from now that end at least a step before a time; 0 where a leap is not worth it."""
        found = int(((until - t) / self.engine.step - 1.0 + 1e-6) / self.steps)
        return found if found >= WORTH_IT else 0

    def leap(
        self, t: float, periods: int, goal_at: Callable[[float], Mapping[str, float]]
    ) -> Leapt:
        """So many periods, each with the law at its end; the commands in force now were the law's last."""
        law, aboard, engine = self._law, self._aboard, self.engine
        law.orders[0] = [engine.sent[c] for c in law.places]
        aboard.saturated[:] = aboard.total[:] = 0.0
        times = (
            [t + i * self.period for i in range(1, periods + 1)] if self.scenario.file.goal else []
        )
        law.sail([goal_at(at) for at in times] or [{}] * periods, begins=False)
        for c, order in zip(law.places, law.orders[0].tolist(), strict=True):
            engine.sent[c] = order
        names, seconds = list(self.scenario.vessel.commands), periods * self.period
        counted = zip(names, aboard.saturated[0].tolist(), strict=False)
        mean = dict(zip(names, (aboard.total[0] / seconds).tolist(), strict=False))
        return Leapt(
            periods * self.steps, seconds, {name: round(n) for name, n in counted if n}, mean
        )
