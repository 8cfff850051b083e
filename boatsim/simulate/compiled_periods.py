"""Several control periods of a vessel with a compiled controller, recorded in one call."""

import numpy as np

from boatsim.control.base import Controller
from boatsim.control.compiled import (
    ONE,
    SENSE,
    SENSE_FIELDS,
    CompiledController,
    indices_of_names,
    view_as_array,
)
from boatsim.physics.kernel.records import StepRecord
from boatsim.physics.signals import Array
from boatsim.simulate import compiled_loop
from boatsim.simulate.compiled_loop import History
from boatsim.simulate.open_water import OpenWater
from boatsim.simulate.scenario import Scenario
from boatsim.simulate.sensing import NOISES

WORD = 8  # [bytes] of a number in the memory of a controller


class CompiledPeriods:
    """Simulates several control periods of controller and vessel in one compiled call.

    The results equal those of `ControlLoop`, which calls the controller after each period.
    """

    def __init__(
        self,
        scenario: Scenario,
        engine: OpenWater,
        law: CompiledController,
        imu: np.random.Generator,
        record: StepRecord,
    ) -> None:
        """Compile the loop; use `create_if_possible` instead, which checks the conditions.

        Args:
            scenario: The scenario.
            engine: The engine of the run.
            law: The scenario's controller.
            imu: Random generator of the inertial unit.
            record: Record of the steps.
        """
        self._law, self._sensors, self._imu = law, scenario.sensors, imu
        fleet, code, vessel = engine.batch.fleet, engine.code, scenario.vessel
        self._commands = fleet.commands
        self._places = indices_of_names(law.channels(), vessel.inputs)
        low, high = np.array(list(vessel.limits().values()), dtype=float).reshape(-1, 2).T
        self._low, self._high = np.ascontiguousarray(low), np.ascontiguousarray(high)
        self._settings = law.settings_array()
        self._sense = np.zeros(1, SENSE)
        self._goal, self._sent = (np.zeros(1, t) for t in type(law).record_types())
        self._saturated = np.zeros((1, len(vessel.inputs)))
        self._memory = view_as_array(law.memory)
        feel = compiled_loop.ProgramFunction(code.read_instruments_of_boats, compiled_loop.FEEL)
        self._feel = feel.bind_arguments(ONE, fleet, view_as_array(self._sense))
        steps = compiled_loop.ProgramFunction(code.record_steps, compiled_loop.RECORD_STEPS)
        self._advance = steps.bind_arguments(fleet, engine.step, record)
        loop = self._loop(np.zeros((1, len(law.goals))), np.zeros((1, 1, NOISES)))
        self._pointer, self._run = compiled_loop.recorded_loop(
            type(law).law, self._feel, self._advance, loop
        )

    @classmethod
    def create_if_possible(
        cls,
        scenario: Scenario,
        engine: OpenWater,
        imu: np.random.Generator,
        record: StepRecord,
    ) -> "CompiledPeriods | None":
        """Return an object that simulates several control periods of a run in one call, or None.

        It is possible if a compiled controller steers all the time with the usual sensors and does
        not end the run.

        Args:
            scenario: The scenario.
            engine: The engine of the run.
            imu: Random generator of the inertial unit.
            record: Record of the steps.
        """
        law = scenario.controller
        if not isinstance(law, CompiledController) or not law.only_evaluates_law:
            return None
        if scenario.additional_sensors or scenario.has_off_goal:
            return None
        if type(law).done is not Controller.done or law.memory.dtype.itemsize % WORD:
            return None
        if type(law).estimates is not CompiledController.estimates:  # may depend on other things
            return None
        return cls(scenario, engine, law, imu, record)

    def advance(self, goals: Array) -> History:
        """Simulate vessel and controller over control periods; the controller acts at each end.

        Args:
            goals: Goals (periods, G) at the end of each period.

        Returns:
            What the controller received, sent and remembers after each period.
        """
        count = len(goals)
        history = History(
            felt=np.zeros((count, len(SENSE_FIELDS))),
            orders=np.zeros((count, len(self._places))),
            commands=np.zeros((count, self._commands.shape[1])),
            memory=np.zeros((count, self._memory.shape[1])),
        )
        noise = np.zeros((1, count, NOISES))
        if not self._sensors.ideal:
            self._imu.standard_normal(out=noise[0])
        loop = self._loop(goals, noise)
        self._run(
            self._pointer,
            self._feel,
            self._advance,
            ONE,
            self._commands,
            loop,
            self._memory,
            history,
        )
        return history

    def _loop(self, goals: Array, noise: Array) -> compiled_loop.Loop:
        """Records and arrays of the controller for the compiled loop."""
        return compiled_loop.Loop(
            compiled_loop.Control(
                self._settings, self._law.memory, self._sense, self._goal, self._sent
            ),
            compiled_loop.Sensing(
                view_as_array(self._sense), self._sensors.error_parameters, noise
            ),
            compiled_loop.Goals(view_as_array(self._goal), goals),
            compiled_loop.Orders(
                view_as_array(self._sent), self._places, self._low, self._high, self._saturated
            ),
        )
