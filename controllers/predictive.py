"""Generalised predictive control: the swing now that, never moved again, keeps the next periods' errors smallest."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from boatsim.control.helm import LearningHelm
from boatsim.control.identification import with_rudder
from boatsim.physics.base import Array, param


def predictions(a: Array, b: Array, periods: int, outputs: list[int]) -> tuple[Array, Array]:
    """H (rows,) and the free response's matrix (rows, n): outputs after 1, 2, ... periods, those of a period together.

    A (n, n), B (n,); `outputs` are the states that count.
    """
    free, forced, power, column = [], [], a, b
    for _ in range(periods):
        free.append(power[outputs])
        forced.append(column[outputs])
        power, column = a @ power, a @ column
    return np.concatenate(forced), np.concatenate(free)


@dataclass
class Predictive(LearningHelm):
    """Martin (1993), section 2.6 and appendix II, control horizon 1: bang-bang, or any swing within the rate."""

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

    def demand(self) -> float:
        """The rudder angle after the best swing."""
        periods = round(self.horizon) or (10 if self.roll_reduction else 11)
        forced, free = predictions(
            *with_rudder(*self.ship.matrices()), periods, [0, 2] if self.roll_reduction else [0]
        )
        drift = free @ np.array([*self.psi[:2], *self.phi[:2], self.rudder])
        along, size = float(forced @ drift), float(forced @ forced)
        if self.bang_bang:  # |H du + Psi0|^2, less what all swings share
            return min(
                self.choices(),
                key=lambda u: (u - self.rudder) * (size * (u - self.rudder) + 2.0 * along),
            )
        best = along / size if size > 0.0 else 0.0
        return self.rudder + (best if self.sign_as_published else -best)
