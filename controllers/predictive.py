"""Generalised predictive control with a control horizon of 1.

The rudder movement of this period, with none after it, minimises the errors of the next periods.
"""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from boatsim.control.helm import LearningHelm
from boatsim.control.identification import append_rudder_state
from boatsim.physics.base import Array, param


def prediction_matrices(
    a: Array, b: Array, periods: int, outputs: list[int]
) -> tuple[Array, Array]:
    """Return the matrices that predict future outputs of a linear system, period by period.

    They are the forced response H (rows,) to a change of the input and the matrix (rows, n) of the
    free response.

    Args:
        a: A (n, n).
        b: B (n,).
        periods: Prediction horizon.
        outputs: Indices of the states that are predicted.
    """
    free, forced, power, column = [], [], a, b
    for _ in range(periods):
        free.append(power[outputs])
        forced.append(column[outputs])
        power, column = a @ power, a @ column
    return np.concatenate(forced), np.concatenate(free)


@dataclass
class Predictive(LearningHelm):
    """Autopilot by generalised predictive control (GPC) of Martin (1993), section 2.6, appendix II.

    The rudder movement is bang-bang or rate-limited.
    """

    words: ClassVar[str] = (
        "adaptive GPC, bang-bang or rate-constrained, with or without roll reduction"
    )
    nominal_yaw: ClassVar = (0.8, 0.03, 0.0)  # Martin's nominal ship, section 3.2
    nominal_roll: ClassVar = (-1.7624, 0.9561, 0.01, -0.3)

    bang_bang: bool = False  # port, stop or starboard only
    horizon: float = param(
        0.0, low=0.0, high=100.0, unit="", words="N, periods; 0: 10 with roll reduction, else 11"
    )
    sign_as_published: bool = False  # the thesis prints du = +(H'H)^-1 H' Psi0

    def rudder_demand(self) -> float:
        """Return the rudder angle after the movement that predictive control finds best."""
        periods = round(self.horizon) or (10 if self.roll_reduction else 11)
        forced, free = prediction_matrices(
            *append_rudder_state(*self.ship.state_space_matrices()),
            periods,
            [0, 2] if self.roll_reduction else [0],
        )
        drift = free @ np.array([*self.psi[:2], *self.phi[:2], self.rudder])
        along, size = float(forced @ drift), float(forced @ forced)
        if self.bang_bang:  # |H du + Psi0|^2, less what all swings share
            return min(
                self.possible_rudder_angles(),
                key=lambda u: (u - self.rudder) * (size * (u - self.rudder) + 2.0 * along),
            )
        best = along / size if size > 0.0 else 0.0
        return self.rudder + (best if self.sign_as_published else -best)
