"""Simulator of one boat on MuJoCo in a tank: slower than a batch, but with walls."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from boatsim.physics.signals import Array
from boatsim.physics.vessel import Vessel
from boatsim.simulate.engine import Engine, State
from boatsim.simulate.world import Tank


class Walled:
    """A `World` of one boat; the model is rebuilt when an episode changes the vessel."""

    def __init__(self, vessels: Sequence[Vessel], step: float, tank: Tank) -> None:
        """Create a simulator.

        Args:
            vessels: Vessels among which episodes choose.
            step: Integration step [s].
            tank: The tank.
        """
        self.vessels, self.step, self.tank = list(vessels), step, tank
        self.vessel = self.vessels[0]
        self._engine: Engine | None = None

    @property
    def engine(self) -> Engine:
        """The boat's engine."""
        self._engine = self._engine or Engine(self.vessel, self.tank, self.step, show=False)
        return self._engine

    @property
    def states(self) -> Array:
        """(1, 2 NQ) present state."""
        state = self.engine.state
        return np.array([[getattr(state, name) for name in self._names]])

    @property
    def _names(self) -> list[str]:
        """Symbols of a state's entries."""
        return [State._fields[1:][k] for k in self.engine.code.SHOWS]

    def advance(self, commands: ArrayLike, steps: int = 1) -> None:
        """Steps with commands (1, C) held."""
        row = np.asarray(commands, dtype=float)[0].tolist()
        self.engine.command(dict(zip(self.vessel.commands, row, strict=True)))
        self.engine.advance(steps)

    def reset(
        self, states: ArrayLike, commands: ArrayLike | None = None, boats: ArrayLike | None = None
    ) -> None:
        """Put the boat at a state, its actuators settled at neutral."""
        self.engine.reset(
            State(
                **dict(zip(self._names, np.asarray(states, dtype=float)[0].tolist(), strict=True))
            )
        )

    def assign(self, vessel: ArrayLike, boats: ArrayLike | None = None) -> None:
        """Make it the vessel of that number."""
        self.vessel, self._engine = self.vessels[int(np.asarray(vessel).reshape(-1)[0])], None

    def set(self, parameter: str, values: ArrayLike, boats: ArrayLike | None = None) -> None:
        """Give it another value of "effect.parameter"; what its file derives from it stays."""
        owner, _, name = parameter.partition(".")
        value = float(np.asarray(values).reshape(-1)[0])
        if owner == "body":
            body = self.vessel.body.model_copy(update={name: value})
            self.vessel, self._engine = replace(self.vessel, body=body), None
            return
        had = self.vessel.effect(owner)
        effects = [e.having({name: value}) if e is had else e for e in self.vessel.effects]
        self.vessel, self._engine = replace(self.vessel, effects=tuple(effects)), None

    def get(self, parameter: str) -> Array:
        """(1,) its value."""
        owner, _, name = parameter.partition(".")
        return np.array(
            [
                float(
                    getattr(
                        self.vessel.body if owner == "body" else self.vessel.effect(owner), name
                    )
                )
            ]
        )


def in_tank(vessels: Sequence[Vessel], n: int, step: float, tank: Tank) -> Walled:
    """A world of one boat on MuJoCo."""
    return Walled(vessels, step, tank)
