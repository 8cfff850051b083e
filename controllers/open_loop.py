"""Commands played as they stand in the goal, for tests and for manoeuvres that show the boat to a diagnosis."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

from boatsim.control.base import Controller, Sense


@dataclass
class OpenLoop(Controller):
    """Each goal of the moment is the command of the channel of its name; nothing is measured."""

    words: ClassVar[str] = "plays the commands given as goals, channel by channel"
    passes_on: ClassVar[bool] = True

    def step(self, sense: Sense, goal: Mapping[str, float]) -> dict[str, float]:
        """The goal itself."""
        return dict(goal)
