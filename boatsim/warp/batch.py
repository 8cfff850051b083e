"""A batch of boats on one of Warp's devices: the calls of `boatsim.simulate.batch.Batch`, the steps of a GPU."""

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from boatsim.errors import BadInput
from boatsim.physics.signals import Array
from boatsim.physics.vessel import Vessel
from boatsim.simulate import batch
from boatsim.warp.device_state import Boats
from boatsim.warp.on_mujoco import OnMujoco
from boatsim.warp.standalone import Alone

MOST = 2**24  # whole numbers up to here are what they are in single precision


class Batch(batch.Batch):
    """Boats in open water on a device. What is read comes from there when it is asked for, what is set goes there then.

    The motion of a boat that diverges is `lost`; the others do not mind.
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
        """As the batch on cores; `device` is a name of Warp's, "cpu" or "cuda:0".

        On mujoco_warp, in single precision, or without it, then in double precision too. Raises BadInput, for an effect
        that has no form there too.
        """
        if mujoco and double:
            raise BadInput(
                "double = true; mujoco_warp knows single precision alone (allowed with mujoco = false)"
            )
        self._ahead = False  # the device has stepped since its states were read
        self._changed = True  # what is here has changed since it was sent there
        self._double = double
        self._numbers = np.zeros(0, dtype=np.int64)  # (n,) of each boat's vessel
        super().__init__(vessels, n, step, seeds=seeds)
        self._there = Boats(self.program, self.n, step, device, "float64" if double else "float32")
        self.motion: OnMujoco | Alone = (
            OnMujoco(self._there, self.vessels) if mujoco else Alone(self._there)
        )
        self.send()

    def reset(
        self,
        states: ArrayLike | None = None,
        commands: ArrayLike | Mapping[str, float] | None = None,
        boats: ArrayLike | None = None,
    ) -> None:
        """As there: boats (all) at states, actuators settled at commands, t = 0."""
        self._read()
        super().reset(states, commands, boats)
        self._changed = True

    def advance(
        self, commands: ArrayLike | Mapping[str, float] | None = None, steps: int = 1
    ) -> None:
        """As there: steps of all boats with the commands held."""
        if commands is not None:
            self._commands[:] = self._taken(commands, np.arange(self.n))
        self.send()
        self.motion.advance(steps)
        self.t += steps * self.step
        self._ahead = True

    def set(self, parameter: str, values: ArrayLike, boats: ArrayLike | None = None) -> None:
        """As there: other values of "effect.parameter"."""
        self._read()
        super().set(parameter, values, boats)
        self._check_courses()
        self._changed = True

    def assign(self, vessel: ArrayLike, boats: ArrayLike | None = None) -> None:
        """As there: boats become the vessel of that number."""
        self._read()
        super().assign(vessel, boats)
        if boats is None:
            self._numbers = np.zeros(self.n, dtype=np.int64)
        self._numbers[self._chosen(boats)] = vessel
        self._check_courses()
        self._changed = True

    @property
    def states(self) -> Array:
        """(n, 2 NQ) present states, body rates over ground."""
        self._read()
        return super().states

    @property
    def actuators(self) -> Array:
        """(n, A) actuators now, in the order of `vessel.actuators`."""
        self._read()
        return super().actuators

    @property
    def lost(self) -> NDArray[np.bool_]:
        """(n,) boats whose motion is no longer finite; the others go on."""
        self._read()
        return super().lost

    def feel(self, felt: Array) -> None:
        """As there: what instruments without noise would say."""
        self._read()
        super().feel(felt)

    def send(self) -> None:
        """To the device what has changed here; commands and clocks always."""
        self._there.commands.assign(self._commands)
        self._there.t.assign(self.t)
        if self._changed:
            self._there.take(self._p, self._k)
            self._there.memory.assign(self._memory)
            self._there.act.assign(self._act)
            self.motion.take(self._numbers)
            self.motion.put(self._y)
            self._changed = False

    def _read(self) -> None:
        """From the device what it has stepped."""
        if self._ahead:
            self._y[:] = self.motion.states()
            self._memory[:], self._act[:] = self._there.memory.numpy(), self._there.act.numpy()
            self._ahead = False

    def _check_courses(self) -> None:
        """Raises BadInput for a random course by a number that single precision lacks: it would be another one."""
        for effect, first in zip(self.program.effects, self.program.offsets, strict=True):
            pairs = zip(
                type(effect).params(), effect.values(), effect.seeded(1).values(), strict=True
            )
            for place, (key, value, other) in enumerate(pairs):
                worst = self._p[:, first + place].max()
                if value != other and worst > MOST and not self._double:
                    raise BadInput(
                        f"{effect.name}.{key} = {worst:.0f}; in single precision allowed to {MOST}"
                    )
