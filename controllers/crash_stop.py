"""Crash stop: full astern from full ahead, helm midships."""

from dataclasses import dataclass, field
from typing import ClassVar

from boatsim.control.base import Sense, Steered


@dataclass
class CrashStop(Steered):
    """Commands the engines astern until the ship has lost her way."""

    words: ClassVar[str] = "standard manoeuvre: engines astern until the ship has lost her way"

    astern: dict[str, float] = field(default_factory=dict)
    _stopped: bool = field(default=False, init=False)
    _begun: bool = field(default=False, init=False)

    def reset(self) -> None:
        """Ahead again."""
        super().reset()
        self._stopped = self._begun = False

    def helm(self, sense: Sense) -> float:
        """Midships."""
        self._begun = True
        self._stopped = self._stopped or sense.u <= 0.0
        return 0.0

    def commanded(self, helm: float) -> dict[str, float]:
        """Astern once begun."""
        return {**super().commanded(helm), **(self.astern if self._begun else {})}

    @property
    def done(self) -> bool:
        """No way on any more."""
        return self._stopped
