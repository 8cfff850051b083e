"""Thrust loss with speed: the thrust of a propeller decreases with the speed of advance."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import Force, Wrench, param
from boatsim.physics.effects.thruster import thrust_wrench_at_mount


@njit(inline="always")
def law(m: Any, q: Any, s: Any, t: Any) -> Wrench:
    """Return the change of thrust of one thruster with the speed of advance.

    Thrust decreases when it drives the boat on and increases when it brakes.

    Args:
        m: Motion of the hull: velocities [m/s], rates [rad/s], position [m], attitude [rad].
        q: Parameters of the effect, with the names and units of its class.
        s: Signals of the thruster on which the effect acts.
        t: Parameters of that thruster.

    Returns:
        Force [N] and moment [N m] in body axes.
    """
    return thrust_wrench_at_mount(
        -t.gain * (q.loss + q.curve * abs(m.ur)) * m.ur * abs(s.thrust), s, t
    )


@dataclass(frozen=True)
class ThrustLossWithSpeed(Force):
    """Thrust of a constant command that decreases with the speed of advance.

    dT = -(loss u_r + curve u_r |u_r|) |T|
    """

    formula: ClassVar[str] = r"\Delta T = -g \left(l \, u_r + c \, u_r |u_r|\right) |T|"
    symbols: ClassVar = {"loss": "l", "curve": "c"}
    words: ClassVar[str] = "the thrust of the propellers decreases with the speed of the boat"
    refines: ClassVar[str] = "thrust"
    shown_by: ClassVar[str] = "the same thrust command from rest and at full speed"
    source: ClassVar[str] = (
        "T. I. Fossen, Handbook of Marine Craft Hydrodynamics, 2nd ed. 2021, section 9.3: K_T(J)"
    )
    per_instance_of: ClassVar[str] = "thruster"
    law: ClassVar = law

    loss: float = param(
        0.0,
        low=0.0,
        high=50.0,
        unit="s/m",
        words="share of the thrust lost per speed",
        fit=True,
        spread=0.5,
        calibrates="thrust",
    )
    curve: float = param(
        0.0,
        low=-20.0,
        high=20.0,
        unit="s^2/m^2",
        words="share of the thrust lost per speed squared",
        fit=True,
        spread=0.1,
    )
