"""Open-loop commands: the goals are sent as commands, for tests and identification manoeuvres."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

from boatsim.control.base import Controller, Sense


@dataclass
class OpenLoop(Controller):
    """Open-loop controller: each goal is the command of the channel of the same name.

    Sensors are not used.
    """

    words: ClassVar[str] = "plays the commands given as goals, channel by channel"
    passes_on: ClassVar[bool] = True

    def step(self, sense: Sense, goal: Mapping[str, float]) -> dict[str, float]:
        """Return the goals unchanged as commands of the channels with the same names.

        Args:
            sense: Not used.
            goal: Commands by channel.
        """
        return dict(goal)
