"""Astern time constant: a craft that goes astern turns more quickly or more slowly than one that goes ahead."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import UNSET, Force, Wrench, param, wrench
from boatsim.physics.effects.reversing_jet import ahead


@njit(inline="always")
def law(m: Any, q: Any, s: Any, t: Any) -> Wrench:
    """Nomoto's r' = (K delta - r) / T with another T astern: what jet and damping give, less what they would give."""
    if m.ur >= 0.0:
        return wrench()
    return wrench(N=(1.0 / q.factor - 1.0) * (t.yaw * ahead(s) * s.angle - q.yaw * m.r))


@dataclass(frozen=True)
class AsternTimeConstant(Force):
    """The steady turn stays as it is; it is reached in another time while the hull goes astern."""

    words: ClassVar[str] = (
        "going astern the craft turns with another time constant than going ahead"
    )
    shown_by: ClassVar[str] = "nozzle steps while going astern, and the same going ahead"
    source: ClassVar[str] = (
        "L. R. S. Theisen, R. Galeazzi, M. Blanke, IFAC CAMS 2013, section 3.2: 1/T is not consistent"
    )
    rides: ClassVar[str] = "reversing_jet"
    law: ClassVar = law
    starts: ClassVar = ({"factor": 0.7}, {"factor": 1.4})

    factor: float = param(
        1.0, low=0.1, high=10.0, unit="", words="astern per ahead", fit=True, spread=0.4, absent=1.0
    )
    yaw: float = param(
        UNSET, low=0.0, high=1e13, unit="N m s", words="the vessel's", follows="linear_damping.yaw"
    )
