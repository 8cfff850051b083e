"""Propeller: thrust proportional to the square of the shaft rate, at a place on the hull."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import Force, Role, Wrench, param
from boatsim.physics.effects.thruster import Thruster, thrust_wrench_at_mount

ThrusterSignals = Thruster.signals_type()


@njit(inline="always")
def propeller_thrust(n: float, q: Any) -> float:
    """Return the propeller thrust k n |n| [N], with a coefficient k for each sense of rotation.

    Args:
        n: Shaft rate [rad/s], positive ahead.
        q: Parameters with `ahead` and `astern` [N s^2/rad^2].
    """
    return float((q.ahead if n > 0.0 else q.astern) * n * abs(n))


@njit(inline="always")
def law(m: Any, q: Any, s: Any) -> Wrench:
    """Return force and moment on the hull of a propeller's thrust along its axis, at its mount.

    Args:
        m: Motion of the hull: velocities [m/s], rates [rad/s], position [m], attitude [rad].
        q: Parameters of the effect, with the names and units of its class.
        s: Signals bound to the roles of the effect.

    Returns:
        Force [N] and moment [N m] in body axes.
    """
    return thrust_wrench_at_mount(q.gain * propeller_thrust(s.shaft, q), s, q)


@njit(inline="always")
def as_thruster(s: Any, q: Any) -> Any:
    """Convert the signals of a propeller to those of a thruster with the same thrust and angle.

    Effects that act on thrusters can so act on propellers.

    Args:
        s: Signals of the propeller: its shaft rate and angle.
        q: Parameters of the propeller.
    """
    return ThrusterSignals(propeller_thrust(s.shaft, q), s.angle, s.cos_angle, s.sin_angle)


@dataclass(frozen=True)
class Propeller(Force):
    """Propeller in open water at zero advance ratio.

    T = k n |n|,  (X, Y) = gain T (cos a, sin a) at (x, y, z)

    k is `ahead` or `astern`. Without a steering channel the angle a is a constant, 0 straight
    ahead.
    """

    formula: ClassVar[str] = (
        r"\begin{aligned} T &= g \, k \, n |n|, \quad X = T \cos\alpha, \quad Y = T "
        r"\sin\alpha \\ K &= -z Y, \quad M = z X, \quad N = x Y - y X \end{aligned}"
    )
    symbols: ClassVar = {"ahead": "k", "astern": "k", "x": "x", "y": "y", "z": "z", "gain": "g"}
    words: ClassVar[str] = (
        "the thrust of a propeller is proportional to the square of its shaft rate"
    )
    shown_by: ClassVar[str] = "a staircase of shaft rates"
    source: ClassVar[str] = (
        "T. I. Fossen, Handbook of Marine Craft Hydrodynamics, 2nd ed. 2021, section 9.3: K_T "
        "at J = 0"
    )
    roles: ClassVar = {
        "shaft": Role("rad/s", "shaft rate, positive ahead"),
        "angle": Role(
            "rad", "direction of the thrust, 0 ahead, positive to starboard", 0.0, direction=True
        ),
    }
    law: ClassVar = law
    as_thruster: ClassVar = as_thruster

    ahead: float = param(1.0, low=0.0, high=1e9, unit="N s^2/rad^2", words="k ahead")
    astern: float = param(1.0, low=0.0, high=1e9, unit="N s^2/rad^2", words="k astern")
    x: float = param(
        0.0, low=-500.0, high=500.0, unit="m", words="mount ahead of the origin of motion"
    )
    y: float = param(
        0.0, low=-100.0, high=100.0, unit="m", words="mount to starboard of the origin"
    )
    z: float = param(0.0, low=-100.0, high=100.0, unit="m", words="mount below the origin")
    gain: float = param(
        1.0, low=0.1, high=5.0, unit="", words="thrust over specified thrust", calibrates="thrust"
    )
