"""Base class of tasks; its methods work on arrays with a row or an entry for each boat."""

from abc import abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from math import pi
from typing import ClassVar, NamedTuple

import numpy as np
from numpy.typing import NDArray

from boatsim.errors import BadInput
from boatsim.learn.actions import Use
from boatsim.learn.hull import Hulls, Motion, Scale
from boatsim.physics.content import snake_case
from boatsim.physics.param import Checked
from boatsim.physics.signals import Array
from boatsim.simulate.world import Tank

Flags = NDArray[np.bool_]


class Signal(NamedTuple):
    """One observation: within -bound and bound, beyond which it is clipped."""

    name: str  # with its unit
    bound: float  # in that unit
    words: str


class Judged(NamedTuple):
    """(n,) each, of a control step at its end."""

    reward: Array
    ended: Flags  # for good: what was asked is done, or can no longer be


@dataclass(frozen=True)
class Task(Checked):
    """Base of tasks. Lengths are in boat lengths `scale.length`, speeds in `scale.speed` where not in m/s."""

    words: ClassVar[str] = ""
    use: ClassVar[Use] = "manoeuvring"  # which actions it takes
    least_actions: ClassVar[int] = 2  # with fewer it can not be done
    shares: ClassVar[int] = 0  # numbers drawn by lot for an episode
    goals: ClassVar[int] = 0  # numbers that an episode's goal is made of
    memory: ClassVar[int] = 0  # numbers that are remembered along an episode

    @classmethod
    def idea(cls) -> str:
        """Return the name of the task, which is that of its file."""
        return snake_case(cls.__name__)

    def check(self, name: str, actions: Sequence[str]) -> None:
        """Raises BadInput for a boat that moves in too few ways."""
        if len(actions) < type(self).least_actions:
            raise BadInput(
                f"{name} can be moved by {', '.join(actions)} only; {type(self).__name__} needs "
                f"{type(self).least_actions} actions"
            )

    @abstractmethod
    def signals(self, scale: Scale) -> tuple[Signal, ...]:
        """Return the observations.

        Args:
            scale: Scale of the vessel.
        """

    def basin(self, scale: Scale) -> Tank:
        """Water and walls, for pictures and for MuJoCo: open water unless a task says otherwise."""
        return Tank(12.0 * scale.length, 12.0 * scale.length, scale.length, walls=False)

    @abstractmethod
    def begin(self, shares: Array, scale: Scale) -> tuple[Array, Array]:
        """Starts (k, 6) of x, y, psi, u, v, r and goals (k, G), from numbers drawn by lot (k, `shares`)."""

    @abstractmethod
    def look(
        self, m: Motion, t: Array, goal: Array, hulls: Hulls, scale: Scale
    ) -> tuple[Array, ...]:
        """What the task needs to know of boats at times t [s] of their episodes; the first entries are `signals`."""

    def start(self, seen: tuple[Array, ...], scale: Scale) -> Array:
        """(k, `memory`) what is remembered at the beginning."""
        return np.zeros((len(seen[0]), type(self).memory))

    @abstractmethod
    def judge(self, seen: tuple[Array, ...], memory: Array, period: float, scale: Scale) -> Judged:
        """Reward of a control step of `period` s by what is seen at its end; `memory` goes on in place."""

    @abstractmethod
    def norms(
        self, seen: tuple[Array, ...], memory: Array, t: Array, scale: Scale
    ) -> dict[str, Array]:
        """How episodes went that end now, `is_success` among it."""


def wrapped(angle: Array) -> Array:
    """The same directions inside [-pi, pi)."""
    return (angle + pi) % (2.0 * pi) - pi
