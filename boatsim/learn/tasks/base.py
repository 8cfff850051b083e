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
from boatsim.physics.param import CheckedParameters
from boatsim.physics.signals import Array
from boatsim.simulate.tank import Tank

Flags = NDArray[np.bool_]


class Signal(NamedTuple):
    """Observation of a learner, such as a heading error, with its unit and bound.

    Its value is limited to the interval from -bound to bound.
    """

    name: str  # with its unit
    bound: float  # in this unit
    words: str


class Outcome(NamedTuple):
    """Reward of a control step for n boats, and whether it ended their episodes."""

    reward: Array  # (n,)
    terminated: Flags  # (n,) the task is done, or can no longer be done


@dataclass(frozen=True)
class Task(CheckedParameters):
    """Base class of learning tasks: start, observations, reward and end of an episode.

    Lengths are in boat lengths `scale.length` and speeds in `scale.speed`, unless a name or unit
    shows another one. A task computes `observed` quantities once per control step, each an array
    (n,). The first ones are those of `signals`; the others are used only by its own methods.
    """

    words: ClassVar[str] = ""
    use: ClassVar[Use] = "manoeuvring"  # selects the actions of the vessel
    least_actions: ClassVar[int] = 2  # number of actions that the task needs
    random_numbers: ClassVar[int] = 0  # uniform random numbers at the start of an episode
    goals: ClassVar[int] = 0  # numbers that define the goal of an episode
    memory: ClassVar[int] = 0  # numbers that are kept from one control step to the next

    @classmethod
    def task_name(cls) -> str:
        """Return the name of the learning task, which is that of its file."""
        return snake_case(cls.__name__)

    def check_actions(self, name: str, actions: Sequence[str]) -> None:
        """Check that a vessel has enough actions for the learning task.

        Args:
            name: Name of the vessel.
            actions: Names of the vessel's actions.

        Raises:
            BadInput: The vessel has fewer actions than the task needs.
        """
        if len(actions) < type(self).least_actions:
            raise BadInput(
                f"{name} can be moved by {', '.join(actions)} only; {type(self).__name__} needs "
                f"{type(self).least_actions} actions"
            )

    @abstractmethod
    def signals(self, scale: Scale) -> tuple[Signal, ...]:
        """Return the definitions of what a learner observes in this task.

        Args:
            scale: Scale of the vessel.
        """

    def basin(self, scale: Scale) -> Tank:
        """Return water and walls in which the task takes place: open water unless overridden.

        Pictures and MuJoCo use them.

        Args:
            scale: Scale of the vessel.
        """
        return Tank(12.0 * scale.length, 12.0 * scale.length, scale.length, walls=False)

    @abstractmethod
    def sample_episodes(self, uniforms: Array, scale: Scale) -> tuple[Array, Array]:
        """Sample the initial states and the goals of episodes of the task.

        Args:
            uniforms: Random numbers (k, `random_numbers`) between 0 and 1.
            scale: Scale of the vessel.

        Returns:
            Starts (k, 6): x, y [m], psi [rad], u, v [m/s], r [rad/s]; and goals (k, `goals`).
        """

    @abstractmethod
    def observe(
        self, m: Motion, t: Array, goal: Array, hulls: Hulls, scale: Scale
    ) -> tuple[Array, ...]:
        """Compute the quantities (n,) on which observations, reward and end of an episode depend.

        Args:
            m: True motion.
            t: Time (n,) [s] since the start of the episode.
            goal: Goals (n, `goals`).
            hulls: Waterplane rectangles of the boats.
            scale: Scale of the vessel.
        """

    def initial_memory(self, observed: tuple[Array, ...], scale: Scale) -> Array:
        """Return the task's memory (k, `memory`) at the start of episodes: zeros unless overridden.

        The memory holds quantities that the reward needs from one control step to the next.

        Args:
            observed: Observed quantities (k,).
            scale: Scale of the vessel.
        """
        return np.zeros((len(observed[0]), type(self).memory))

    @abstractmethod
    def outcome(
        self, observed: tuple[Array, ...], memory: Array, period: float, scale: Scale
    ) -> Outcome:
        """Return the reward of a control step and whether it ends an episode.

        Args:
            observed: Observed quantities (n,) at the end of the control step.
            memory: Memory (n, `memory`), which is updated in place.
            period: Duration of the control step [s].
            scale: Scale of the vessel.
        """

    @abstractmethod
    def metrics(
        self, observed: tuple[Array, ...], memory: Array, t: Array, scale: Scale
    ) -> dict[str, Array]:
        """Return the metrics (k,) of ended episodes of the task by name, among them `is_success`.

        Args:
            observed: Observed quantities (k,) at the end.
            memory: Memory (k, `memory`).
            t: Duration (k,) [s] of the episodes.
            scale: Scale of the vessel.
        """


def wrap_angle(angle: Array) -> Array:
    """Return angles in the interval [-pi, pi).

    Args:
        angle: Angles [rad], of any shape.
    """
    return (angle + pi) % (2.0 * pi) - pi
