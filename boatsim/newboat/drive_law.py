"""Commands of the thrusters of a new boat: newtons, revolutions, or those of a measured curve."""

import math
from dataclasses import dataclass

import numpy as np

from boatsim.physics.base import Array
from boatsim.recordings.expression import UNITS


@dataclass(frozen=True)
class DriveLaw:
    """How the command of a thruster becomes thrust.

    Attributes:
        rpm: Full revolutions [1/min] of propellers that are commanded by their shaft rate; None for
            other commands.
        curve: Measured pairs of a raw command and its thrust [N]; () for other commands.
    """

    rpm: float | None = None
    curve: tuple[tuple[float, float], ...] = ()

    @property
    def full_rate(self) -> float:
        """Shaft rate at full revolutions [rad/s]."""
        assert self.rpm is not None
        return self.rpm * UNITS["rpm"]

    @property
    def neutral_command(self) -> float:
        """Raw command without thrust, the middle of a dead zone of the curve."""
        commands, thrusts = np.transpose(self.curve)
        below = commands[thrusts <= 0.0]
        above = commands[thrusts >= 0.0]
        if len(below) and len(above) and below[-1] >= above[0]:
            return float(0.5 * (above[0] + below[-1]))
        return float(np.interp(0.0, thrusts, commands))

    def channel_name(self, name: str) -> str:
        """Return the name of the command channel of a thruster."""
        if self.rpm is not None:
            return f"n_{name}_radps"
        if self.curve:
            return f"throttle_{name}"
        return f"thrust_{name}_N"

    def command_for_thrust(self, thrust: float, ahead: float, astern: float) -> float:
        """Return the command that gives a thrust at rest.

        Args:
            thrust: Thrust, negative astern [N].
            ahead: Full thrust ahead [N].
            astern: Full thrust astern [N].
        """
        if self.curve:
            return self._command_of_curve(thrust)
        if self.rpm is None:
            return thrust
        full = ahead
        if thrust < 0.0:
            full = astern
        if full == 0.0:
            return 0.0
        return math.copysign(self.full_rate * math.sqrt(abs(thrust) / full), thrust)

    def _command_of_curve(self, thrust: float) -> float:
        if thrust == 0.0:
            return self.neutral_command
        commands, thrusts = np.transpose(self.curve)
        used = thrusts > 0.0
        if thrust < 0.0:
            used = thrusts < 0.0
        xs: Array = np.append(thrusts[used], 0.0)
        ys: Array = np.append(commands[used], self._end_of_dead_zone(thrust))
        order = np.argsort(xs, kind="stable")
        return float(np.interp(thrust, xs[order], ys[order]))

    def _end_of_dead_zone(self, thrust: float) -> float:
        """The command at which thrust of this sense begins."""
        commands, thrusts = np.transpose(self.curve)
        still = commands[thrusts == 0.0]
        if not len(still):
            return float(np.interp(0.0, thrusts, commands))
        if thrust > 0.0:
            return float(still[-1])
        return float(still[0])
