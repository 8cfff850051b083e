"""PID course keeping, the baseline of the comparison of Martin (1993)."""

from dataclasses import dataclass
from typing import ClassVar

from boatsim.control.helm import Helm
from boatsim.physics.base import param


@dataclass
class PidCourse(Helm):
    """PID of Martin (1993), section 2.4, in incremental form; positive rudder needs a gain < 0.

    u(k) = u(k-1) + K ((1 + T_D/h) y(k) - (1 + 2 T_D/h - h/T_I) y(k-1) + T_D/h y(k-2))

    u(k-1) is the previous demand and not the angle that the steering machine reached: only then
    does a course change move the rudder by its proportional part, as the printed responses show.
    """

    words: ClassVar[str] = "PID on the heading, rudder limits on its output only"

    gain: float = param(
        -1.0, low=-10.0, high=10.0, unit="", words="K: rudder angle per heading error"
    )
    derivative: float = param(1.0, low=0.0, high=100.0, unit="s", words="T_D")
    integral: float = param(45.0, low=0.1, high=1e4, unit="s", words="T_I")
    forgets_wish: bool = False  # True: the next change is added to the angle the rudder reached

    def reset(self) -> None:
        """Reset the autopilot's rudder demand and past heading errors to zero."""
        super().reset()
        # [rad] wish; heading errors one period ago and two
        self._wish = self._once = self._twice = 0.0

    def rudder_demand(self) -> float:
        """Return the wanted rudder angle: the previous demand plus the increment of the PID law."""
        lead, y = self.derivative / self.period, self.psi[0]
        change = (
            (1.0 + lead) * y
            - (1.0 + 2.0 * lead - self.period / self.integral) * self._once
            + lead * self._twice
        )
        self._wish = (self.rudder if self.forgets_wish else self._wish) + self.gain * change
        self._once, self._twice = y, self._once
        return self._wish
