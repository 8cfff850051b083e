"""Thrust loss with speed: a propeller pushes less the faster the water already goes its way."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import Force, Wrench, param
from boatsim.physics.effects.thruster import at_mount


@njit(inline="always")
def law(m: Any, q: Any, s: Any, t: Any) -> Wrench:
    """Each thruster's thrust T loses (loss u + curve u |u|) |T|: falls ahead, grows when it brakes."""
    return at_mount(-t.gain * (q.loss + q.curve * abs(m.ur)) * m.ur * abs(s.thrust), s, t)


@dataclass(frozen=True)
class ThrustLossWithSpeed(Force):
    """The thrust of a fixed command falls in proportion to the advance speed."""

    words: ClassVar[str] = "the propellers push less the faster the boat goes"
    shown_by: ClassVar[str] = "the same thrust command from rest and at full speed"
    source: ClassVar[str] = (
        "T. I. Fossen, Handbook of Marine Craft Hydrodynamics, 2nd ed. 2021, section 9.3: K_T(J)"
    )
    rides: ClassVar[str] = "thruster"
    law: ClassVar = law

    loss: float = param(
        0.0,
        low=0.0,
        high=50.0,
        unit="s/m",
        words="share lost per speed ahead",
        fit=True,
        spread=0.5,
        calibrates="thrust",
    )
    curve: float = param(
        0.0,
        low=-20.0,
        high=20.0,
        unit="s^2/m^2",
        words="and per speed squared",
        fit=True,
        spread=0.1,
    )
