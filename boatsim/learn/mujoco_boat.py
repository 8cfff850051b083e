"""Simulator of one boat on MuJoCo in a tank: slower than a batch, but with walls."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from boatsim.physics.signals import Array
from boatsim.physics.vessel import Vessel
from boatsim.simulate.engine import Engine, State
from boatsim.simulate.tank import Tank


class TankWorld:
    """Simulator of one boat in a walled tank for a learning environment, by MuJoCo.

    The MuJoCo model is rebuilt when an episode changes the vessel.
    """

    def __init__(self, vessels: Sequence[Vessel], step: float, tank: Tank) -> None:
        """Create a simulator.

        Args:
            vessels: Vessels among which episodes choose.
            step: Integration step [s].
            tank: The tank.
        """
        self.vessels = list(vessels)
        self.step = step
        self.tank = tank
        self.vessel = self.vessels[0]
        self._engine: Engine | None = None

    @property
    def engine(self) -> Engine:
        """MuJoCo simulation of the boat."""
        if self._engine is None:
            self._engine = Engine(self.vessel, self.tank, self.step, show=False)
        return self._engine

    @property
    def states(self) -> Array:
        """Present state (1, 2 NQ) of the boat in SI units."""
        state = self.engine.state
        return np.array([[getattr(state, name) for name in self._names]])

    @property
    def _names(self) -> list[str]:
        """Symbols of the entries of a state."""
        return [State._fields[1:][k] for k in self.engine.code.SHOWS]

    def advance(self, commands: ArrayLike, steps: int = 1) -> None:
        """Simulate the boat over a number of integration steps with constant commands.

        Args:
            commands: Commands (1, C).
            steps: Number of integration steps.
        """
        row = np.asarray(commands, dtype=float)[0].tolist()
        self.engine.command(dict(zip(self.vessel.commands, row, strict=True)))
        self.engine.advance(steps)

    def reset(
        self, states: ArrayLike, commands: ArrayLike | None = None, boats: ArrayLike | None = None
    ) -> None:
        """Set the state of the simulated boat, with its actuators settled at neutral.

        Args:
            states: State (1, 2 NQ) in SI units.
            commands: Ignored.
            boats: Ignored.
        """
        row = np.asarray(states, dtype=float)[0].tolist()
        self.engine.reset(State(**dict(zip(self._names, row, strict=True))))

    def assign(self, vessel: ArrayLike, boats: ArrayLike | None = None) -> None:
        """Replace the simulated boat by another vessel.

        Args:
            vessel: Number (1,) of the new vessel.
            boats: Ignored.
        """
        self._replace_vessel(self.vessels[int(np.asarray(vessel).reshape(-1)[0])])

    def set(self, parameter: str, values: ArrayLike, boats: ArrayLike | None = None) -> None:
        """Set a parameter of one of the boat's effects, such as a wind speed.

        Values that the vessel file derives from the parameter do not change.

        Args:
            parameter: "effect.parameter".
            values: Value (1,) in the unit of the parameter.
            boats: Ignored.
        """
        owner, _, name = parameter.partition(".")
        value = float(np.asarray(values).reshape(-1)[0])
        if owner == "body":
            body = self.vessel.body.model_copy(update={name: value})
            self._replace_vessel(replace(self.vessel, body=body))
            return
        effects = list(self.vessel.effects)
        for index, effect in enumerate(effects):
            if effect is self.vessel.effect(owner):
                effects[index] = effect.with_values({name: value})
        self._replace_vessel(replace(self.vessel, effects=tuple(effects)))

    def get(self, parameter: str) -> Array:
        """Return the value (1,) of a parameter of one of the boat's effects.

        Args:
            parameter: "effect.parameter".
        """
        owner, _, name = parameter.partition(".")
        holder: object = self.vessel.effect(owner)
        if owner == "body":
            holder = self.vessel.body
        return np.array([float(getattr(holder, name))])

    def _replace_vessel(self, vessel: Vessel) -> None:
        self.vessel = vessel
        self._engine = None


def make_tank_world(vessels: Sequence[Vessel], n: int, step: float, tank: Tank) -> TankWorld:
    """Return a simulator of one boat in a walled tank, by MuJoCo.

    Args:
        vessels: Vessels among which episodes choose.
        n: Number of boats, which is 1.
        step: Integration step [s].
        tank: The tank.
    """
    return TankWorld(vessels, step, tank)
