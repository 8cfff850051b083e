"""The industry's course keeper: PID on the heading, the baseline of Martin's comparison."""

from dataclasses import dataclass
from typing import ClassVar

from boatsim.control.helm import Helm
from boatsim.physics.base import param


@dataclass
class PidCourse(Helm):
    """Martin (1993), section 2.4, in the form that adds a change to its last wish; positive rudder needs a gain < 0.

    The wish is kept as it was, not as the steering machine could follow it: only then does a course offset kick the
    rudder by its proportional part, as the printed responses show.
    """

    words: ClassVar[str] = "PID on the heading, rudder limits on its output only"

    gain: float = param(
        -1.0, low=-10.0, high=10.0, unit="", words="K: rudder angle per heading error"
    )
    derivative: float = param(1.0, low=0.0, high=100.0, unit="s", words="T_D")
    integral: float = param(45.0, low=0.1, high=1e4, unit="s", words="T_I")
    forgets_wish: bool = False  # True: the next change is added to the angle the rudder reached

    def reset(self) -> None:
        """On the course, nothing wished for."""
        super().reset()
        # [rad] wish; heading errors one period ago and two
        self._wish = self._once = self._twice = 0.0

    def demand(self) -> float:
        """q0 y + q1 y(k-1) + q2 y(k-2) beside the last wish; before its first sight the ship was on her course."""
        lead, y = self.derivative / self.period, self.psi[0]
        change = (
            (1.0 + lead) * y
            - (1.0 + 2.0 * lead - self.period / self.integral) * self._once
            + lead * self._twice
        )
        self._wish = (self.rudder if self.forgets_wish else self._wish) + self.gain * change
        self._once, self._twice = y, self._once
        return self._wish
