"""Turning circle: the helm is set to an angle and held."""

from dataclasses import dataclass
from typing import ClassVar

from boatsim.control.base import HelmManoeuvre, Sense


@dataclass
class TurningCircle(HelmManoeuvre):
    """Turning circle manoeuvre: holds a helm angle to the end of the run."""

    words: ClassVar[str] = "standard manoeuvre: puts the helm over and holds it"

    def helm_angle(self, sense: Sense) -> float:
        """Return the constant helm angle of a turning circle [rad].

        Args:
            sense: Not used.
        """
        return self.angle
