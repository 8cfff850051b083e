"""Thruster: thrust at a place on the hull, fixed or steered."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import (
    CoefficientRelease,
    Force,
    Role,
    Wrench,
    factor_parameter,
    param,
    wrench,
)


@njit(inline="always")
def thrust_wrench_at_mount(thrust: float, s: Any, q: Any) -> Wrench:
    """Return force and moment on the hull of a thrust along the axis of a thruster at its mount.

    Args:
        thrust: Force along the axis [N].
        s: Signals with cosine and sine of the angle.
        q: Parameters with the mount `x`, `y`, `z` [m].
    """
    X, Y = thrust * s.cos_angle, thrust * s.sin_angle
    return wrench(X=X, Y=Y, K=-q.z * Y, M=q.z * X, N=q.x * Y - q.y * X)


@njit(inline="always")
def speed_of_advance(m: Any, s: Any, t: Any) -> float:
    """Return the speed of a thruster through the water along its axis [m/s].

    It is that of the undisturbed flow at the mount: a propeller to the side of the hull advances
    faster or slower in a turn, and one across the hull advances with the sway of its place.

    Args:
        m: Motion of the hull through the water [m/s, rad/s].
        s: Signals with cosine and sine of the angle of the thruster.
        t: Parameters with its mount `x`, `y` [m].
    """
    along, across = m.ur - t.y * m.r, m.vr + t.x * m.r
    return float(along * s.cos_angle + across * s.sin_angle)


@njit(inline="always")
def law(m: Any, q: Any, s: Any) -> Wrench:
    """Return force and moment on the hull of one thruster, fixed or steered, at its mount.

    Args:
        m: Motion of the hull: velocities [m/s], rates [rad/s], position [m], attitude [rad].
        q: Parameters of the effect, with the names and units of its class.
        s: Signals bound to the roles of the effect.

    Returns:
        Force [N] and moment [N m] in body axes.
    """
    return thrust_wrench_at_mount(q.gain * s.thrust, s, q)


@dataclass(frozen=True)
class Thruster(Force):
    """One thruster of any number, fixed or steered.

    (X, Y) = gain T (cos a, sin a) at (x, y, z)

    Without a steering channel the angle a is a constant, 0 straight ahead.
    """

    formula: ClassVar[str] = (
        r"\begin{aligned} X &= g \, T \cos\alpha, \quad Y = g \, T \sin\alpha \\ K &= -z "
        r"Y, \quad M = z X, \quad N = x Y - y X \end{aligned}"
    )
    symbols: ClassVar = {"x": "x", "y": "y", "z": "z", "gain": "g"}
    words: ClassVar[str] = "thrust of a thruster, steered where it can be turned"
    shown_by: ClassVar[str] = "any manoeuvre"
    source: ClassVar[str] = (
        "T. I. Fossen, Handbook of Marine Craft Hydrodynamics, 2nd ed. 2021, section 11.2"
    )
    roles: ClassVar = {
        "thrust": Role("N", "its thrust, ahead positive"),
        "angle": Role(
            "rad", "direction of the thrust, 0 ahead, positive to starboard", 0.0, direction=True
        ),
    }
    law: ClassVar = law

    x: float = param(
        0.0, low=-500.0, high=500.0, unit="m", words="mount ahead of the origin of motion"
    )
    y: float = param(
        0.0, low=-100.0, high=100.0, unit="m", words="mount to starboard of the origin"
    )
    z: float = param(0.0, low=-100.0, high=100.0, unit="m", words="mount below the origin")
    gain: float = param(
        1.0, low=0.1, high=5.0, unit="", words="thrust per commanded thrust", calibrates="thrust"
    )


@dataclass(frozen=True)
class ThrustGainError(CoefficientRelease):
    """Thrust of all drives that differs by one factor from its specified value."""

    formula: ClassVar[str] = r"g = k \, g^0"
    symbols: ClassVar = {"factor": "k"}
    words: ClassVar[str] = "all thrust is stronger or weaker than specified by one factor"
    refines: ClassVar[str] = "thrust"
    shown_by: ClassVar[str] = "runs at several thrust levels"

    factor: float = factor_parameter(
        "thruster.gain",
        "propeller.gain",
        "mmg_propeller.gain",
        "mmg_low_speed_propeller.gain",
        "water_jet.gain",
        words="thrust over specified thrust",
        spread=0.3,
        low=0.2,
        high=3.0,
        in_per_cent="all thrust is {share} of the specified thrust",
    )
