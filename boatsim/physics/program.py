"""A vessel's effects as one compiled program that engine, compiled engine and diagnosis share.

`python -m boatsim.physics.program VESSEL` prints the laws that are composed for a vessel.
"""

import sys
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from types import FunctionType, ModuleType
from typing import Any, cast

import numpy as np

from boatsim.physics import cache
from boatsim.physics import vessel as vessels
from boatsim.physics.commands import clipped_commands
from boatsim.physics.compiled_program import CompiledProgram
from boatsim.physics.compose import Composition
from boatsim.physics.debugging import DEBUG, python_function
from boatsim.physics.groups import without_group
from boatsim.physics.kernel.records import VesselNumbers, VesselState
from boatsim.physics.kernel.source import motion_module_text
from boatsim.physics.kinds.effect import Effect
from boatsim.physics.kinds.flow import is_varying_flow
from boatsim.physics.kinds.release import CoefficientRelease
from boatsim.physics.native.build import NoCompiler, compiler_path, warn_of_slow_compilation
from boatsim.physics.native.declarations import NotTranslatable
from boatsim.physics.native.library import native_program
from boatsim.physics.signals import AXES, Array, MeasuredMotion
from boatsim.physics.vessel import Vessel

KINEMATICS = (
    "pose_and_velocities",
    "jacobian",
)  # functions of one state that are used in Python too


@dataclass(frozen=True)
class Program:
    """A vessel's effects and further candidate effects, compiled to one program.

    All parameters are in one array.

    Attributes:
        vessel: The vessel; its own effects always act.
        candidates: Further effects. They are compiled too, and act where `on` is 1.
        effects: All effects that have a law: the vessel's own, then the candidates.
        offsets: Place of each effect's first parameter in the flat array.
        table_offsets: Place of the first entry of each effect's table, after all parameters.
    """

    vessel: Vessel
    candidates: tuple[Effect, ...] = ()
    effects: tuple[Effect, ...] = field(init=False)
    offsets: tuple[int, ...] = field(init=False)
    table_offsets: tuple[int, ...] = field(init=False)

    def __post_init__(self) -> None:
        # A release changes a coefficient of the vessel and has no law.
        laws = (e for e in self.candidates if not isinstance(e, CoefficientRelease))
        object.__setattr__(self, "effects", (*self.vessel.effects, *laws))
        sizes = [len(type(e).params()) for e in self.effects]
        object.__setattr__(self, "offsets", tuple(int(n) for n in np.cumsum([0, *sizes])[:-1]))
        tables = [len(e.table()) for e in self.effects]
        begins = np.cumsum([sum(sizes), *tables])[:-1]
        object.__setattr__(self, "table_offsets", tuple(int(n) for n in begins))

    @property
    def candidate_names(self) -> tuple[str, ...]:
        """Names of the candidate effects, without placeholders for terms of symbolic regression."""
        return tuple(e.name for e in self.candidates if not type(e).described)

    def values(self) -> Array:
        """Parameters and then tables (P,) of all effects of the program, in SI units."""
        return self._values.copy()

    @cached_property
    def _values(self) -> Array:
        parameters = [v for e in self.effects for v in e.values()]
        tables = [e.table() for e in self.effects]
        return np.concatenate([parameters, *tables]).astype(float)

    def effect_switches(self, active: Sequence[str] = ()) -> Array:
        """Return an array (E,) that says which effects act: 1 for active effects, else 0.

        The vessel's own effects are always active.

        Args:
            active: Names of the candidate effects that act, in all recordings or in one group.
        """
        on, acting = np.ones(len(self.effects)), set(map(without_group, active))
        for i in range(len(self.vessel.effects), len(self.effects)):
            on[i] = float(self.effects[i].name in acting)
        return on

    def parameter_index(self, effect: str, parameter: str) -> int:
        """Return the index of an effect's parameter in the array of all parameters.

        Args:
            effect: Name of an effect.
            parameter: Name of one of its parameters.
        """
        i = [e.name for e in self.effects].index(effect)
        return self.offsets[i] + list(type(self.effects[i]).params()).index(parameter)

    @cached_property
    def body(self) -> Array:
        """Rigid body data (6,) of the vessel in SI units.

        They are mass [kg], mass centre x, z [m], and inertia in roll, pitch and yaw [kg m^2].
        """
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

    def vessel_numbers(self, active: Sequence[str] = ()) -> VesselNumbers:
        """Return rigid-body data, effect parameters and switches in the form of compiled functions.

        Args:
            active: Names of the candidate effects that act.
        """
        return VesselNumbers(self.body, self.values(), self.effect_switches(active))

    def vessel_state(
        self, y: Array, memory: Array | None = None, force: Array | None = None
    ) -> VesselState:
        """Return the initial state of a vessel in the form that the compiled simulation takes.

        Args:
            y: (2 NQ,) joint coordinates and rates, changed in place.
            memory: (memory_size,) state of the actuators, changed in place; zeros if None.
            force: (NQ,) constant further body force [N, N m]; zeros if None.
        """
        code = self.module
        if memory is None:
            memory = np.zeros(self.memory_size)
        if force is None:
            force = np.zeros(code.NQ)
        return VesselState(y, memory, np.zeros(self.actuator_signal_size), force)

    @cached_property
    def composition(self) -> Composition:
        """Layout of the program: indices of each effect's parameters, signals and states."""
        return Composition(self.vessel, self.effects, self.offsets, self.table_offsets)

    @property
    def memory_size(self) -> int:
        """Number of floats that hold the state of all actuators, at least one."""
        return max(self.composition.memory_size, 1)

    @property
    def actuator_signal_size(self) -> int:
        """Number of floats that hold the actuator signals at begin, middle and end of a step."""
        return 3 * int(self.module.HELD)

    def command_array(self, commands: Mapping[str, float]) -> Array:
        """Return an array (inputs,) of the vessel's inputs with commands limited to their ranges.

        Args:
            commands: Commands by name; the others are neutral.

        Raises:
            BadInput: A command does not exist or is not finite.
        """
        return clipped_commands(self.vessel, commands)

    def pose_and_velocities(self, state: Sequence[float]) -> MeasuredMotion:
        """Return position, attitude and body-axes velocities of a state (2 NQ,) of the vessel.

        The state holds joint coordinates and their rates.
        """
        found: MeasuredMotion = self._python_functions["pose_and_velocities"](state)
        return found

    def jacobian(self, state: Sequence[float]) -> Array:
        """Return the derivatives (6, NQ) of body velocities by joint rates at a state (2 NQ,)."""
        J = np.zeros((len(AXES), self.module.NQ))
        self._python_functions["jacobian"](state, J)
        return J

    def to_body_velocities(self, states: Array) -> Array:
        """Convert states (N, 2 NQ) from joint rates to body-axes velocities."""
        out = np.empty(states.shape)
        seen = self._vectorised("pose_and_velocities")(states.T)
        for i, k in enumerate(self.module.SHOWS):
            out[:, i] = seen[k]
        return out

    def to_joint_rates(self, states: Array) -> Array:
        """Convert states from body-axes velocities to joint rates.

        It is the inverse of `to_body_velocities`.

        Args:
            states: States (N, 2 NQ), or one state (2 NQ,).
        """
        code, rows = self.module, np.array(np.atleast_2d(states), dtype=float)
        J = np.zeros((len(AXES), code.NQ, len(rows)))
        self._vectorised("jacobian")(rows.T, J)
        rates = np.linalg.solve(J[list(code.FREE)].transpose(2, 0, 1), rows[:, code.NQ :, None])
        rows[:, code.NQ :] = rates[:, :, 0]
        return rows.reshape(np.shape(states))

    @cached_property
    def _python_functions(self) -> dict[str, Callable[..., Any]]:
        """Functions of one state in Python: for a single state they need no compilation."""
        return {name: python_function(getattr(self.module, name)) for name in KINEMATICS}

    def _vectorised(self, name: str) -> FunctionType:
        """A function of one state as a function of arrays over many states."""
        python = cast(FunctionType, self._python_functions[name])
        return FunctionType(python.__code__, {**python.__globals__, "cos": np.cos, "sin": np.sin})

    @cached_property
    def module(self) -> CompiledProgram:
        """The compiled package of the program.

        It comes from the disk cache if an equal program was compiled before.
        """
        text = {
            "laws.py": self.composition.source_text(),
            "motion.py": motion_module_text(
                self.vessel.dof,
                centred=self.vessel.body.centre == (0.0, 0.0),
                varying_water=any(is_varying_flow(e) for e in self.effects),
            ),
        }
        package: ModuleType = cache.import_program(text, {type(e) for e in self.effects})
        return cast(CompiledProgram, package)

    @cached_property
    def estimation_functions(self) -> CompiledProgram:
        """The functions of the program for the analysis of recordings, from C if possible.

        Their numbers are the same as those of `module`, which takes longer to compile.
        """
        return self._from_library("estimation")

    @cached_property
    def simulation_functions(self) -> CompiledProgram:
        """The functions of the program for simulations, from C if possible.

        Their numbers are the same as those of `module`, which takes longer to compile.
        """
        return self._from_library("simulation")

    def _from_library(self, library: str) -> CompiledProgram:
        if DEBUG:
            return self.module
        try:
            found: Any = native_program(cast(Any, self.module), library, compiler_path())
            return cast(CompiledProgram, found)
        except NotTranslatable:
            return self.module
        except NoCompiler as error:
            warn_of_slow_compilation(error)
            return self.module


def main(arguments: Sequence[str]) -> None:
    """Print the generated Python source that calls the laws of all effects of a vessel.

    Args:
        arguments: Name or folder of the vessel.
    """
    print(Program(vessels.load_vessel(arguments[0])).composition.source_text())


if __name__ == "__main__":
    main(sys.argv[1:])
