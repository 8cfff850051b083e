"""Crash stop: full astern from full ahead, helm midships."""

from dataclasses import dataclass, field
from typing import ClassVar

from boatsim.control.base import HelmManoeuvre, Sense


@dataclass
class CrashStop(HelmManoeuvre):
    """Crash stop manoeuvre: commands the engines astern until the ship has stopped."""

    words: ClassVar[str] = "standard manoeuvre: engines astern until the ship has stopped"

    astern: dict[str, float] = field(default_factory=dict)
    _stopped: bool = field(default=False, init=False)
    _begun: bool = field(default=False, init=False)

    def reset(self) -> None:
        """Reset the crash stop to its approach ahead."""
        super().reset()
        self._stopped = self._begun = False

    def helm_angle(self, sense: Sense) -> float:
        """Keep the helm midships and detect the end of the crash stop (no speed ahead).

        Args:
            sense: Sensor readings.
        """
        self._begun = True
        self._stopped = self._stopped or sense.u <= 0.0
        return 0.0

    def commands_at_helm(self, helm: float) -> dict[str, float]:
        """Return the commands of the approach ahead or, once the crash stop has begun, of astern.

        Args:
            helm: Helm angle [rad].
        """
        return {**super().commands_at_helm(helm), **(self.astern if self._begun else {})}

    @property
    def done(self) -> bool:
        """Whether the crash stop is complete: the ship has stopped."""
        return self._stopped
