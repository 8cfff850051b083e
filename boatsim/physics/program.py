"""A vessel's effects as one compiled program that engine, twin and diagnosis share."""

import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from types import FunctionType, ModuleType

import numpy as np

from boatsim.physics import cache
from boatsim.physics import vessel as vessels
from boatsim.physics.commands import taken_row
from boatsim.physics.compose import Composition
from boatsim.physics.kernel.source import written
from boatsim.physics.kinds.effect import Effect
from boatsim.physics.kinds.release import Release
from boatsim.physics.signals import AXES, Array
from boatsim.physics.vessel import Vessel


@dataclass(frozen=True)
class Program:
    """The effects of a vessel, some of them optional, as compiled functions over one flat parameter array.

    `module` offers `constants, step_in_place, steps, forces, actuate_in_place, rollout` and, for the diagnosis, the
    filter; see `boatsim/physics/kernel/`.
    """

    vessel: Vessel
    # effects that act only where `on` switches them on
    candidates: tuple[Effect, ...] = ()
    effects: tuple[Effect, ...] = field(init=False)
    offsets: tuple[int, ...] = field(init=False)  # where each effect's parameters start

    def __post_init__(self) -> None:
        # a release has nothing to compile
        laws = (e for e in self.candidates if not isinstance(e, Release))
        object.__setattr__(self, "effects", (*self.vessel.effects, *laws))
        sizes = [len(type(e).params()) for e in self.effects]
        object.__setattr__(self, "offsets", tuple(int(n) for n in np.cumsum([0, *sizes])[:-1]))

    @property
    def entries(self) -> tuple[str, ...]:
        """Names of the candidates without the placeholder effects of symbolic regression."""
        return tuple(e.name for e in self.candidates if not type(e).described)

    def values(self) -> Array:
        """Parameters of all effects, flat."""
        return np.array([v for e in self.effects for v in e.values()], dtype=float)

    def switches(self, active: Sequence[str] = ()) -> Array:
        """`on` (effects,) with the named candidates switched on."""
        own = len(self.vessel.effects)
        return np.array(
            [i < own or e.name in active for i, e in enumerate(self.effects)], dtype=np.float64
        )

    def index(self, effect: str, parameter: str) -> int:
        """Position of one parameter in the flat array."""
        i = next(i for i, e in enumerate(self.effects) if e.name == effect)
        return self.offsets[i] + list(type(self.effects[i]).params()).index(parameter)

    @cached_property
    def body(self) -> Array:
        """(6,) mass [kg], mass centre x, z [m], inertia about it in roll, pitch and yaw [kg m^2]."""
        b = self.vessel.body
        return np.array(
            [
                b.mass,
                b.centre[0],
                b.centre[1],
                b.roll_inertia,
                b.effective_pitch_inertia(),
                b.yaw_inertia,
            ]
        )

    @cached_property
    def composition(self) -> Composition:
        """The effects in their places."""
        return Composition(self.vessel, self.effects, self.offsets)

    @property
    def memory_size(self) -> int:
        """Floats that all channels together remember, at least one."""
        return max(self.composition.memory_size, 1)

    @property
    def held_size(self) -> int:
        """Floats that hold all actuators over a step."""
        return 3 * int(self.module.HELD)

    def command_array(self, commands: Mapping[str, float]) -> Array:
        """(C,) in force when these are sent, in the vessel's order; those not given are neutral. Raises BadInput."""
        return taken_row(self.vessel, commands)

    def body_rates(self, states: Array) -> Array:
        """States (N, 2 NQ), joint rates replaced by body rates."""
        code, out = self.module, np.empty(states.shape)
        seen = self._of_many("moved")(states.T)
        for i, k in enumerate(code.SHOWS):
            out[:, i] = seen[k]
        return out

    def joint_rates(self, states: Array) -> Array:
        """The inverse of `body_rates`, for states (N, 2 NQ) or one (2 NQ,)."""
        code, rows = self.module, np.array(np.atleast_2d(states), dtype=float)
        J = np.zeros((len(AXES), code.NQ, len(rows)))
        self._of_many("jacobian")(rows.T, J)
        rates = np.linalg.solve(J[list(code.FREE)].transpose(2, 0, 1), rows[:, code.NQ :, None])
        rows[:, code.NQ :] = rates[:, :, 0]
        return rows.reshape(np.shape(states))

    def _of_many(self, name: str) -> FunctionType:
        """A function of the motion of one state, in Python and over all states at once."""
        motion = self.module.motion
        return FunctionType(
            getattr(motion, name).py_func.__code__, {**vars(motion), "cos": np.cos, "sin": np.sin}
        )

    @cached_property
    def module(self) -> ModuleType:
        """The compiled program, from the cache if the same one was composed before."""
        text = {
            "laws.py": self.composition.source_text(),
            "motion.py": written(self.vessel.dof, centred=self.vessel.body.centre == (0.0, 0.0)),
        }
        return cache.module(text, {type(e) for e in self.effects})


def main(arguments: Sequence[str]) -> None:
    """Print a vessel's composed laws."""
    print(Program(vessels.load(arguments[0])).composition.source_text())


if __name__ == "__main__":
    main(sys.argv[1:])
