"""Online identification of yaw and roll by approximate maximum likelihood.

M. E. Salgado, G. C. Goodwin, R. H. Middleton, Int. J. Control 47 (1988) 477, as used by Martin
(1993), appendix I. Angles are in degrees here, because the constants of forgetting and resetting
depend on the scale of the signals.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field
from math import degrees

import numpy as np

from boatsim.physics.base import Array, CheckedParameters, param


@dataclass
class Forgetting(CheckedParameters):
    """Constants of exponential forgetting and resetting in recursive least squares.

    Martin (1993) does not print his constants; these are chosen.
    """

    alpha: float = param(0.5, low=0.0, high=1.0, unit="", words="share of the gain that is used")
    forgetting: float = param(
        0.99, low=0.5, high=1.0, unit="", words="lambda: weight of a sample one period later"
    )
    beta: float = param(
        1e-5, low=0.0, high=10.0, unit="", words="keeps the covariance from vanishing"
    )
    delta: float = param(
        0.05, low=0.0, high=10.0, unit="", words="keeps the covariance from growing"
    )
    covariance: float = param(0.01, low=1e-6, high=1e4, unit="", words="P(0)")
    inverse_alone: bool = False  # Martin 1993 prints 1/lambda where P/lambda is meant
    later_gain: bool = False  # Martin 1993 prints P(t+1) in the gain where P(t) is meant


@dataclass
class LeastSquaresEstimator:
    """Recursive least-squares estimator of theta in y = x'theta + noise, with forgetting.

    P(t+1) = P / lambda - alpha P x x' P / (1 + x'P x) + beta I - delta P^2
    theta(t+1) = theta + alpha P x (y - x'theta) / (1 + x'P x)
    """

    theta: Array  # (n,)
    law: Forgetting
    p: Array = field(init=False)  # (n, n) covariance

    def __post_init__(self) -> None:
        self.p = self.law.covariance * np.eye(len(self.theta))

    def update(self, x: Array, y: float) -> float:
        """Update the least-squares estimate by one sample; return the residual after the update.

        Args:
            x: Regressor (n,).
            y: Measured output.
        """
        law, p = self.law, self.p
        px = p @ x
        scale = 1.0 + x @ px
        kept = np.eye(len(x)) if law.inverse_alone else p
        self.p = (
            kept / law.forgetting
            - (law.alpha / scale) * np.outer(px, px)
            + law.beta * np.eye(len(x))
            - law.delta * (p @ p)
        )
        gain = (law.alpha / scale) * (self.p @ x if law.later_gain else px)
        self.theta = self.theta + gain * (y - x @ self.theta)
        return float(y - x @ self.theta)


class IdentifiedShip:
    """Difference equations of yaw and roll over one period, identified separately.

    psi(k+1) = (1 + a2y) psi(k) - a2y psi(k-1) + b1y u(k) + b2y phi(k)
    phi(k+1) = -a1r phi(k) - a2r phi(k-1) + b1r u(k) + b2r (psi(k) - psi(k-1))
    """

    def __init__(self, law: Forgetting, yaw: Sequence[float], roll: Sequence[float]) -> None:
        """Start from a nominal ship, with no noise model of the roll.

        Args:
            law: Constants of the identification.
            yaw: (a2y, b1y, b2y).
            roll: (a1r, a2r, b1r, b2r).
        """
        self._yaw = LeastSquaresEstimator(np.array(yaw), law)
        self._roll = LeastSquaresEstimator(np.array([*roll, 0.0, 0.0]), law)
        self._left = [0.0, 0.0]  # [deg] errors of roll that were left, one period ago and two

    @property
    def yaw_coefficients(self) -> tuple[float, ...]:
        """Coefficients a2y, b1y, b2y of the ship's difference equation of yaw."""
        return tuple(self._yaw.theta.tolist())

    @property
    def roll_coefficients(self) -> tuple[float, ...]:
        """Coefficients a1r, a2r, b1r, b2r of the ship's difference equation of roll."""
        return tuple(self._roll.theta[:4].tolist())

    def update(self, psi: Sequence[float], phi: Sequence[float], rudder: float) -> None:
        """Update the identified difference equations of yaw and roll by one period of data.

        Args:
            psi: Heading [rad] now, one period ago, two ago.
            phi: Roll [rad], likewise.
            rudder: Rudder angle [rad] in the last period.
        """
        (s0, s1, s2), (f0, f1, f2), u = map(degrees, psi), map(degrees, phi), degrees(rudder)
        self._yaw.update(np.array([s1 - s2, u, f1]), s0 - s1)
        left = self._roll.update(np.array([-f1, -f2, u, s1 - s2, *self._left]), f0)
        self._left = [left, self._left[0]]

    def named_estimates(self) -> dict[str, float]:
        """Return the identified coefficients of yaw and roll by name, for a log."""
        return dict(
            zip(
                ("a2y", "b1y", "b2y", "a1r", "a2r", "b1r", "b2r"),
                self.yaw_coefficients + self.roll_coefficients,
                strict=True,
            )
        )

    def state_space_matrices(self) -> tuple[Array, Array]:
        """Return state-space matrices A (4, 4) and B (4,) of the identified ship.

        The state is (psi, psi one period ago, phi, phi one period ago), the input the rudder angle.
        """
        return state_space(self.yaw_coefficients, self.roll_coefficients)


def state_space(yaw: Sequence[float], roll: Sequence[float]) -> tuple[Array, Array]:
    """Return state-space matrices A (4, 4) and B (4,) of the difference equations of yaw and roll.

    Args:
        yaw: (a2y, b1y, b2y).
        roll: (a1r, a2r, b1r, b2r).
    """
    (a2y, b1y, b2y), (a1r, a2r, b1r, b2r) = yaw, roll
    a = np.array(
        [
            [1.0 + a2y, -a2y, b2y, 0.0],
            [1.0, 0.0, 0.0, 0.0],
            [b2r, -b2r, -a1r, -a2r],
            [0.0, 0.0, 1.0, 0.0],
        ]
    )
    return a, np.array([b1y, 0.0, b1r, 0.0])


def append_rudder_state(a: Array, b: Array) -> tuple[Array, Array]:
    """Extend a state-space model of a ship by the rudder angle as last state.

    Returns A (n + 1, n + 1) and B (n + 1,); the input is the change of the rudder angle.

    Args:
        a: System matrix A (n, n).
        b: Input vector B (n,).
    """
    n = len(b)
    whole = np.block([[a, b[:, None]], [np.zeros((1, n)), np.ones((1, 1))]])
    return whole, np.array([*b, 1.0])
