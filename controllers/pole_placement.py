"""Adaptive pole placement: state feedback with given poles of yaw and roll."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from boatsim.control.helm import LearningHelm
from boatsim.physics.base import Array, param


def ackermann_gains(a: Array, b: Array, wanted: Array) -> Array | None:
    """Return the state feedback gains (n,) that give a wanted characteristic polynomial.

    Ackermann's formula is used. None if (A, B) is not controllable.

    Args:
        a: A (n, n).
        b: B (n,).
        wanted: Characteristic polynomial of A - B K (n + 1,).
    """
    columns = [b]
    value = wanted[0] * np.eye(len(b))
    for coefficient in wanted[1:]:
        columns.append(a @ columns[-1])
        value = value @ a + coefficient * np.eye(len(b))
    reach = np.array(columns[:-1]).T
    if abs(np.linalg.det(reach)) < 1e-15:
        return None
    return np.asarray(np.linalg.solve(reach.T, np.eye(len(b))[-1]) @ value)


@dataclass
class PolePlacement(LearningHelm):
    """Autopilot by adaptive pole placement of Martin (1993), section 2.8.

    The rudder angle is the state feedback u = -K x on heading, and on roll, of the identified ship.
    """

    words: ClassVar[str] = "adaptive pole placement, with or without roll reduction"
    nominal_yaw: ClassVar = (0.8, 0.03, 0.0)  # Martin's nominal ship, section 3.2
    nominal_roll: ClassVar = (-1.7624, 0.9561, 0.01, -0.3)

    yaw_fast: float = param(0.89, low=0.0, high=1.0, unit="", words="pole of yaw in z")
    yaw_slow: float = param(0.91, low=0.0, high=1.0, unit="", words="the other pole of yaw")
    roll_real: float = param(
        0.798, low=-1.0, high=1.0, unit="", words="real part of the poles of roll: 7 s"
    )
    roll_imaginary: float = param(
        0.363, low=0.0, high=1.0, unit="", words="imaginary part: damping 0.3"
    )

    def reset(self) -> None:
        """Reset the feedback gains and the identification of the ship to the nominal ship."""
        super().reset()
        self._gains = np.zeros(4 if self.roll_reduction else 2)
        self._wanted: Array = np.array(
            [1.0, -self.yaw_fast - self.yaw_slow, self.yaw_fast * self.yaw_slow]
        )
        if self.roll_reduction:
            roll = [1.0, -2.0 * self.roll_real, self.roll_real**2 + self.roll_imaginary**2]
            self._wanted = np.convolve(self._wanted, roll)

    def rudder_demand(self) -> float:
        """Return the rudder angle of the state feedback.

        The gains are kept while the identified rudder has no effect.
        """
        n = len(self._gains)
        a, b = self.ship.state_space_matrices()
        found = ackermann_gains(a[:n, :n], b[:n], self._wanted)
        self._gains = self._gains if found is None else found
        return -float(self._gains @ np.array([*self.psi[:2], *self.phi[:2]])[:n])
