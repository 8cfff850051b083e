"""Steps one vessel in open water on the compiled engine, as a control loop needs it."""

from collections.abc import Callable
from functools import cached_property

import numpy as np

from boatsim.control.compiled import ONE, SENSE_FIELDS
from boatsim.physics.native.calls import partial_call
from boatsim.physics.signals import Array
from boatsim.physics.vessel import Vessel
from boatsim.simulate import world
from boatsim.simulate.batch import Batch
from boatsim.simulate.step_record import make_step_record
from boatsim.simulate.stepper import Stepper
from boatsim.simulate.tank import Tank
from boatsim.simulate.world import Model


class OpenWater(Stepper):
    """Simulation of one vessel in open water by compiled code, without MuJoCo.

    It is a batch of one vessel with the interface of `Stepper`; its arrays are the batch's.

    Attributes:
        batch: The batch.
    """

    def __init__(self, vessel: Vessel, step: float = 0.02) -> None:
        """Put a vessel at the origin, at rest.

        Args:
            vessel: The vessel.
            step: Integration step [s].
        """
        self.batch = Batch(vessel, 1, step, threads=1)
        super().__init__(self.batch.program, step)
        fleet = self.batch.fleet
        self._commands, self._memory, self._act = fleet.commands[0], fleet.memory[0], fleet.act[0]
        self._y = fleet.y[0]
        self._record = make_step_record(self.program, 1, 1)
        self._record.ends[0] = 1
        self._sensed = np.zeros((1, len(SENSE_FIELDS)))
        self.reset()

    @cached_property
    def tank(self) -> Tank:
        """The water without walls in which the vessel is drawn."""
        return world.open_water(self.vessel)

    @cached_property
    def model(self) -> Model:
        """MuJoCo model of the vessel, used only for drawing it."""
        return world.build_model(self.vessel, self.tank, self.step)

    @property
    def t(self) -> float:
        """Simulated time [s]."""
        return float(self.batch.t[0])

    def _set_joint_state(self, t: float, state: Array) -> None:
        self.batch.t[0] = t
        self._y[:] = state

    def _joint_state(self) -> Array:
        return np.asarray(self._y)

    @cached_property
    def _record_step(self) -> Callable[[float], None]:
        """`record_steps` of this vessel for one step, a function of its length."""
        return partial_call(self.code, "record_steps", self.batch.fleet, ..., self._record)

    @cached_property
    def _read_instruments(self) -> Callable[[], None]:
        """`read_instruments_of_boats` of this vessel."""
        given = ONE, self.batch.fleet, self._sensed
        return partial_call(self.code, "read_instruments_of_boats", *given)

    def _advance(self, length: float) -> None:
        self._record.done[:] = 0
        self._record_step(length)
        self._mean[:] = self._record.mean[0]

    def true_readings(self) -> Array:
        """Return the readings (11,) of error-free instruments, in the order of `SENSE_FIELDS`.

        The array is overwritten by the next call.
        """
        self._read_instruments()
        return np.asarray(self._sensed[0])

    def acceleration(self) -> tuple[float, float]:
        """Return the acceleration over ground of the vessel's origin along body x, y [m/s^2]."""
        self._read_instruments()
        ahead, starboard = self._sensed[0, 3:5].tolist()
        return ahead, starboard
