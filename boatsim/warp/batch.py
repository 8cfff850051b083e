"""A batch of boats on a device of Warp, with the interface of `boatsim.simulate.batch.Batch`."""

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from boatsim.errors import BadInput
from boatsim.physics.signals import Array
from boatsim.physics.vessel import Vessel
from boatsim.simulate import batch
from boatsim.warp.device_state import DeviceBoats
from boatsim.warp.on_mujoco import MujocoMotion
from boatsim.warp.standalone import StandaloneMotion

MOST_EXACT = 2**24  # integers up to this one are exact in single precision


class Batch(batch.Batch):
    """Many vessels in open water, simulated on a GPU or on Warp's CPU device.

    Arrays are copied to and from the device when they are needed.

    A boat whose motion diverges is `lost`; other boats are unaffected.
    """

    def __init__(
        self,
        vessels: Vessel | Sequence[Vessel],
        n: int | None = None,
        step: float = 0.02,
        device: str = "cpu",
        *,
        mujoco: bool = True,
        double: bool = False,
        seeds: Sequence[int] | None = None,
    ) -> None:
        """Put boats at rest at the origin.

        Args:
            vessels: Boat i is the vessel i modulo their number.
            n: Number of boats; that of the vessels if None.
            step: Integration step [s].
            device: Name of a device of Warp, "cpu" or "cuda:0".
            mujoco: Integrate with mujoco_warp, which has single precision only; else in one kernel.
            double: Double precision.
            seeds: Seed of each boat's random effects.

        Raises:
            BadInput: Vessels differ in more than numbers, the law of an effect cannot be
                translated, or an argument is not allowed.
        """
        if mujoco and double:
            raise BadInput(
                "double = true; mujoco_warp has single precision only (allowed with mujoco = false)"
            )
        self._ahead = False  # whether the device has stepped since its states were read
        self._changed = True  # whether arrays here have changed since they were sent
        self._double = double
        self._numbers = np.zeros(0, dtype=np.int64)  # (n,) number of each boat's vessel
        super().__init__(vessels, n, step, seeds=seeds)
        self._there = DeviceBoats(
            self.program, self.n, step, device, "float64" if double else "float32"
        )
        self.motion: MujocoMotion | StandaloneMotion = (
            MujocoMotion(self._there, self.vessels) if mujoco else StandaloneMotion(self._there)
        )
        self.copy_inputs_to_device()

    def reset(
        self,
        states: ArrayLike | None = None,
        commands: ArrayLike | Mapping[str, float] | None = None,
        boats: ArrayLike | None = None,
    ) -> None:
        """Set the state of some or all vessels, see `boatsim.simulate.batch.Batch.reset`."""
        self._read_from_device()
        super().reset(states, commands, boats)
        self._changed = True

    def advance(
        self, commands: ArrayLike | Mapping[str, float] | None = None, steps: int = 1
    ) -> None:
        """Integrate the motion of all vessels, see `boatsim.simulate.batch.Batch.advance`."""
        if commands is not None:
            self._commands[:] = self._clip(commands, np.arange(self.n))
        self.copy_inputs_to_device()
        self.motion.advance(steps)
        self.t += steps * self.step
        self._ahead = True

    def set(self, parameter: str, values: ArrayLike, boats: ArrayLike | None = None) -> None:
        """Change a model parameter of vessels, see `boatsim.simulate.batch.Batch.set`."""
        self._read_from_device()
        super().set(parameter, values, boats)
        self._check_courses()
        self._changed = True

    def assign(self, vessel: ArrayLike, boats: ArrayLike | None = None) -> None:
        """Give vessels the parameters of another, see `boatsim.simulate.batch.Batch.assign`."""
        self._read_from_device()
        super().assign(vessel, boats)
        if boats is None:
            self._numbers = np.zeros(self.n, dtype=np.int64)
        self._numbers[self._boat_numbers(boats)] = vessel
        self._check_courses()
        self._changed = True

    @property
    def states(self) -> Array:
        """Present states of all vessels (n, 2 NQ), with body rates over ground."""
        self._read_from_device()
        return super().states

    @property
    def actuators(self) -> Array:
        """Present actuator positions of all vessels (n, A), in the order of `vessel.actuators`."""
        self._read_from_device()
        return super().actuators

    @property
    def lost(self) -> NDArray[np.bool_]:
        """Whether the motion of each vessel (n,) has diverged; other vessels are unaffected."""
        self._read_from_device()
        return super().lost

    def sense(self, felt: Array) -> None:
        """Compute error-free instrument readings, see `boatsim.simulate.batch.Batch.sense`."""
        self._read_from_device()
        super().sense(felt)

    def copy_inputs_to_device(self) -> None:
        """Copy commands and times to the Warp device, and all other arrays if they changed."""
        self._there.commands.assign(self._commands)
        self._there.t.assign(self.t)
        if self._changed:
            self._there.copy_parameters(self._p, self._k)
            self._there.memory.assign(self._memory)
            self._there.act.assign(self._act)
            self.motion.assign_vessels(self._numbers)
            self.motion.set_states(self._y)
            self._changed = False

    def _read_from_device(self) -> None:
        """Copy states and actuators from the device if it has stepped."""
        if self._ahead:
            self._y[:] = self.motion.states()
            self._memory[:], self._act[:] = self._there.memory.numpy(), self._there.act.numpy()
            self._ahead = False

    def _check_courses(self) -> None:
        """Raise BadInput for a realisation whose number is not exact in single precision."""
        for effect, first in zip(self.program.effects, self.program.offsets, strict=True):
            pairs = zip(
                type(effect).params(), effect.values(), effect.with_seed(1).values(), strict=True
            )
            for place, (key, value, other) in enumerate(pairs):
                worst = self._p[:, first + place].max()
                if value != other and worst > MOST_EXACT and not self._double:
                    raise BadInput(
                        f"{effect.name}.{key} = {worst:.0f}; "
                        f"in single precision allowed to {MOST_EXACT}"
                    )
