"""Sliding mode control: a three-way relay moves the rudder by the sign of a switching function."""

from dataclasses import dataclass
from math import degrees, radians
from typing import ClassVar

import numpy as np

from boatsim.control.helm import Helm
from boatsim.control.identification import append_rudder_state, state_space
from boatsim.errors import BadInput
from boatsim.physics.base import Array, param

FAST = radians(10.0)  # [rad/s] design rates above this are those of the repeat at 15 deg/s
YAW, ROLL = (0.8, 0.03, 0.0), (-1.7624, 0.9561, 0.01, -0.3)  # the nominal ship, section 3.2
PRINTED = {  # (roll reduction, fast) -> G as printed, section 3.2
    (False, False): (107.8961, -254.926, 150.573),
    (True, False): (43.06, -38.32, 16.69, -0.839, 4.6215),
    (True, True): (14.24, -12.67, 5.56, -0.3188, 1.536),
}
WEIGHTS = {  # diagonal of Q, not printed: found so that the iteration gives the printed G
    (False, False): (0.34483, 0.34483, 0.34483),
    (True, False): (0.85, 0.85, 17.0, 17.0, 0.0095),
    (True, True): (0.28, 0.28, 5.6, 5.6, 0.003),
}


def switching_surface(a: Array, b: Array, weights: Array, swing: float) -> Array:
    """Return the gains G = B'P of a sliding mode controller's switching function.

    P solves P = Q + (A - B F)' P (A - B F), F = swing B'P, by iteration (appendix III).

    Args:
        a: A (n, n).
        b: B (n,).
        weights: Diagonal of Q (n,).
        swing: Rudder movement of the relay in a period [rad].

    Raises:
        BadInput: The iteration does not converge.
    """
    p = q = np.diag(weights)
    for _ in range(10_000):
        closed = a - np.outer(b, swing * (b @ p))
        last, p = p, q + closed.T @ p @ closed
        size = np.abs(p).max()
        if size > 1e12:
            break
        if np.abs(p - last).max() < 1e-13 * size:
            return np.asarray(b @ p)
    raise BadInput(
        f"sliding: no switching surface for a swing of {degrees(swing):g} deg in a period"
    )


def nominal_ship(roll_reduction: bool) -> tuple[Array, Array]:
    """Return the matrices A and B of the nominal ship for which switching functions are designed.

    Args:
        roll_reduction: State (psi, psi-1, phi, phi-1, u-1) if true, else (psi-2, psi-1, psi).
    """
    if roll_reduction:
        return append_rudder_state(*state_space(YAW, ROLL))
    return np.array([[0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.8, -2.6, 2.8]]), np.array(
        [0.0, 0.0, 0.017]
    )


@dataclass
class Sliding(Helm):
    """Autopilot by sliding mode control of Martin (1993), section 2.7: du = -swing sign(S).

    u is the rudder angle and S the switching function. There is no movement where |S| is inside the
    boundary layer. Angles in S are radians: only then does the boundary layer contain the headings
    at which the printed runs come to rest.
    """

    words: ClassVar[str] = "three-way relay on a switching surface, with or without roll reduction"

    roll_reduction: bool = False
    boundary: float = param(
        0.04, low=0.0, high=100.0, unit="", words="half width of the layer around the surface"
    )
    design_rate: float = param(
        radians(5.0), low=1e-3, high=1.0, unit="rad/s", words="rudder rate of the surface"
    )
    # the surface as printed; False: computed from the nominal ship for the design rate
    printed: bool = True
    in_degrees: bool = False  # angles in S in degrees, as the thesis states angles elsewhere

    def reset(self) -> None:
        """Reset the histories of the controller and compute its switching function."""
        super().reset()
        self._surface = self.switching_gains()

    def needs_roll(self) -> bool:
        """Return whether the controller reduces roll and so needs a measured roll angle."""
        return bool(self.roll_reduction)

    def switching_gains(self) -> tuple[float, ...]:
        """Return the gains G of the switching function.

        The state is (psi, psi-1, phi, phi-1, u-1) with roll reduction, else (psi-2, psi-1, psi).
        """
        key = (bool(self.roll_reduction), self.roll_reduction and self.design_rate > FAST)
        if self.printed:
            return PRINTED[key]
        found = switching_surface(
            *nominal_ship(self.roll_reduction),
            np.array(WEIGHTS[key]),
            self.design_rate * self.period,
        )
        return tuple(found.tolist())

    def switching_function(self) -> float:
        """Return the present value of the switching function S = G x, which should become zero."""
        x = (
            (*self.psi[:2], *self.phi[:2], self.rudder)
            if self.roll_reduction
            else reversed(self.psi)
        )
        return sum(
            g * (degrees(s) if self.in_degrees else s)
            for g, s in zip(self._surface, x, strict=True)
        )

    def rudder_demand(self) -> float:
        """Return the rudder angle after a movement against the sign of the switching function S.

        Inside the boundary layer it is the present angle.
        """
        side = self.switching_function()
        if abs(side) < self.boundary:
            return self.rudder
        return (
            self.rudder - self.largest_rudder_step
            if side > 0.0
            else self.rudder + self.largest_rudder_step
        )
