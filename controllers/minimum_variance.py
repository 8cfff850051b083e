"""Minimum variance control of yaw and roll by a three-way rudder.

The rudder moves to port, stops or moves to starboard in each period.
"""

from dataclasses import dataclass
from typing import ClassVar

from boatsim.control.helm import LearningHelm
from boatsim.physics.base import param


@dataclass
class MinimumVariance(LearningHelm):
    """Minimum variance control of Martin (1993), section 2.5, with the rudder movement as input.

    The difference equations are multiplied by 1 - z^-1. The reference response is s(k+1) = first
    y(k) + second y(k-1). The thesis prints rho u^2 without a definition of u; with the rudder
    movement as u the printed rudder and yaw in quartering seas are reproduced, with the angle they
    are not.
    """

    words: ClassVar[str] = (
        "adaptive minimum variance by three-way swings, with or without roll reduction"
    )
    nominal_yaw: ClassVar = (0.8, 0.03, 0.0)  # Martin's nominal ship, section 3.2
    nominal_roll: ClassVar = (-1.7624, 0.9561, 0.01, -0.3)

    yaw_first: float = param(1.8, low=-2.0, high=2.0, unit="", words="ideal yaw")
    yaw_second: float = param(
        -0.8099, low=-1.0, high=1.0, unit="", words="ideal yaw, one period earlier"
    )
    roll_first: float = param(
        1.59, low=-2.0, high=2.0, unit="", words="ideal roll: 7 s, damping 0.3"
    )
    roll_second: float = param(
        -0.764, low=-1.0, high=1.0, unit="", words="ideal roll, one period earlier"
    )
    roll_weight: float = param(1.0, low=0.0, high=100.0, unit="", words="K_r, with roll reduction")
    rudder_weight: float = param(5e-5, low=0.0, high=10.0, unit="", words="rho")
    weighs_angle: bool = False  # rho weighs the rudder angle instead of its swing

    def rudder_demand(self) -> float:
        """Return the rudder angle after that of three possible movements with the lowest cost."""
        yaw, roll = self._predict_with_stopped_rudder()
        b_yaw, b_roll = self.ship.yaw_coefficients[1], self.ship.roll_coefficients[2]
        weight = self.roll_weight if self.roll_reduction else 0.0

        def cost(u: float) -> float:
            du = u - self.rudder
            effort = self.rudder_weight * (u if self.weighs_angle else du) ** 2
            return (yaw + b_yaw * du) ** 2 + weight * (roll + b_roll * du) ** 2 + effort

        return min(self.possible_rudder_angles(), key=cost)

    def _predict_with_stopped_rudder(self) -> tuple[float, float]:
        """Return yaw and roll [rad] after a period with stopped rudder, less their reference."""
        (s0, s1, s2), (f0, f1, f2) = self.psi, self.phi
        (a2y, _, b2y), (a1r, a2r, _, b2r) = self.ship.yaw_coefficients, self.ship.roll_coefficients
        psi = (2.0 + a2y) * s0 - (1.0 + 2.0 * a2y) * s1 + a2y * s2 + b2y * (f0 - f1)
        phi = (1.0 - a1r) * f0 + (a1r - a2r) * f1 + a2r * f2 + b2r * (s0 - 2.0 * s1 + s2)
        return (
            psi - self.yaw_first * s0 - self.yaw_second * s1,
            phi - self.roll_first * f0 - self.roll_second * f1,
        )
