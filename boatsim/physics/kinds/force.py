"""Force effects: forces of water, air or machines as functions of the motion."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from typing import Any, ClassVar

import numpy as np

from boatsim.physics.kinds.effect import EffectKind, InsertionPoint, ProgramFunction, ProgramLayout
from boatsim.physics.signals import Motion, Wrench

COMPONENTS = Wrench._fields
ADD = "; ".join(f"{c} += f.{c}" for c in COMPONENTS)
WRENCH = ProgramFunction(
    "wrench",
    "m, p, on, act, at",
    (f"{' = '.join(COMPONENTS)} = 0.0",),
    f"Wrench({', '.join(COMPONENTS)})",
    compiled="merged",
)
AIR_WRENCH = replace(WRENCH, name="air_wrench", compiled="inlined")


@dataclass(frozen=True)
class Force(EffectKind):
    """Base class of effects that exert a force given by the present motion of the hull.

    The force has no memory: compiled `law(motion, values) -> Wrench`.

    With `roles` the law takes the bound signals as a third argument. An effect with
    `per_instance_of` is evaluated once for each instance of that other effect, with its signals and
    parameters. An effect that can stand for another one (a propeller for a thruster) converts its
    signals by a compiled function `as_<name>`.

    With a compiled `influence(values, s, t, s2, t2) -> float` the instances act on each other: s, t
    are the signals and parameters of the instance on which the law acts, s2, t2 those of another
    one. The law takes the sum over all other instances as its last argument.
    """

    parts: ClassVar[tuple[ProgramFunction, ...]] = (WRENCH, AIR_WRENCH)
    laws: ClassVar[tuple[str, ...]] = ("law", "as_thruster", "influence")
    of_air: ClassVar[bool] = False  # a force of the air, logged separately
    # frame to which the force is tied other than the water: "the air", "walls"; empty: none
    tied_to: ClassVar[str] = ""
    law: ClassVar[Callable[..., Wrench]]
    # influence of another instance of `per_instance_of` on the one on which the law acts
    influence: ClassVar[Callable[..., float] | None] = None

    @classmethod
    def program_lines(
        cls, part: ProgramFunction, station: InsertionPoint, number: int, program: ProgramLayout
    ) -> Iterator[str]:
        """Yield the source lines that add the effect's force to the sum of all forces.

        A force of the air is also added to the sum of the forces of the air.

        Args:
            part: Function of the compiled program that receives the lines.
            station: Insertion point in that function.
            number: Index of the effect among all effects of the program.
            program: Layout of the program that is generated for the vessel.
        """
        effect = program.effects[number]
        of_air = isinstance(effect, Force) and type(effect).of_air
        if part is WRENCH or (part is AIR_WRENCH and of_air):
            for site in program.law_calls(number):
                yield f"f = {site.text('law', 'm')}"
                yield ADD

    def wrench(self, m: Motion, *given: tuple[float, ...], **signals: float) -> Wrench:
        """Return force and moment of this effect on the hull at one given motion.

        It evaluates the compiled law from Python, for tests and plots.

        Args:
            m: Motion of the hull.
            given: Signals and parameters of the instance on which the effect acts, if any, then
                those of the other instances, for an effect with `influence`.
            signals: Signals of the roles.
        """
        own: tuple[Any, ...] = ()
        if type(self).roles and not given:
            own = (type(self).signals(**signals),)
        if type(self).sees_table:
            own += (np.array([*self.table(), 0.0]), np.int64(0))  # no array is empty
        if type(self).influence is not None:
            own += (self.total_influence(*given),)
            given = given[:2]
        return Wrench(*type(self).law(m, self.values(), *given, *own))

    def total_influence(self, *given: tuple[float, ...]) -> float:
        """Return the sum of the influences of other instances on one instance.

        Args:
            given: Signals and parameters of the instance, then those of each other instance.
        """
        influence = type(self).influence
        assert influence is not None
        total = 0.0
        for i in range(2, len(given), 2):
            total += influence(self.values(), *given[:2], *given[i : i + 2])
        return total
