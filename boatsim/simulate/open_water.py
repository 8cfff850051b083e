"""Steps a vessel in open water in compiled code alone: as the engine does to rounding, several times as fast."""

from functools import cached_property

import numpy as np

from boatsim.control.compiled import ONE, SENSE_FIELDS
from boatsim.physics.signals import Array
from boatsim.physics.vessel import Vessel
from boatsim.simulate import world
from boatsim.simulate.batch import Batch
from boatsim.simulate.stepper import Stepper
from boatsim.simulate.world import Model, Tank


class OpenWater(Stepper):
    """One vessel that nothing touches: a batch of one, whose rows it works on."""

    def __init__(self, vessel: Vessel, step: float = 0.02) -> None:
        """`step` is the integration step in s."""
        super().__init__(vessel, step)
        self.batch = Batch(vessel, 1, step, threads=1)
        self._commands, self._memory, self._act = (
            self.batch._commands[0],
            self.batch._memory[0],
            self.batch._act[0],
        )
        self._y, self._k, self._none = self.batch._y[0], self.batch._k[0], np.zeros(self.code.NQ)
        self._felt = np.zeros((1, len(SENSE_FIELDS)))
        self.reset()

    @cached_property
    def tank(self) -> Tank:
        """The water, to be drawn."""
        return world.open_water(self.vessel)

    @cached_property
    def model(self) -> Model:
        """The vessel, to be drawn."""
        return world.build(self.vessel, self.tank, self.step)

    @property
    def t(self) -> float:
        """Time [s]."""
        return float(self.batch.t[0])

    def _put(self, t: float, state: Array) -> None:
        self.batch.t[0], self._y[:] = t, state

    def _joint_state(self) -> Array:
        return np.asarray(self._y)

    def _step(self, dt: float) -> None:
        self.code.step_in_place(
            self.t, self._y, dt, self._act, self._values, self._on, self._k, self._none
        )
        self.batch.t[0] += dt

    def acceleration(self) -> tuple[float, float]:
        """Acceleration of the origin over ground along body x and y [m/s^2], as an accelerometer there feels it."""
        self.code.feel_boats(ONE, self.batch.fleet, self._felt)
        ahead, aside = self._felt[0, 3:5].tolist()
        return ahead, aside
