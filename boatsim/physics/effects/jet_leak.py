"""Jet leak: part of a water jet passes its bucket, so that it pushes ahead however far the bucket is down."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import Force, Wrench, param


@njit(inline="always")
def law(m: Any, q: Any) -> Wrench:
    """A share of the undeflected jet beside what the bucket makes of it: cos 2 beta + fraction."""
    return Wrench(q.fraction * q.thrust, 0.0, 0.0, q.fraction * q.yaw * m.jet_rad)


@dataclass(frozen=True)
class JetLeak(Force):
    """A bucket that does not close: thrust and turning moment do not vanish where the bucket should cancel them."""

    words: ClassVar[str] = "part of the jet leaks past the bucket and pushes ahead whatever the bucket's angle"
    shown_by: ClassVar[str] = "nozzle steps with the bucket near 45 deg, where the jet should neither push nor turn"
    source: ClassVar[str] = "L. R. S. Theisen, R. Galeazzi, M. Blanke, IFAC CAMS 2013, figures 3 and 4"
    law: ClassVar = law
    starts: ClassVar = ({"fraction": 0.1},)

    fraction: float = param(0.0, low=-1.0, high=1.0, unit="", words="of the jet", fit=True, spread=0.3)
    thrust: float = param(0.0, low=0.0, high=1e7, unit="N", words="the vessel's", follows="reversing_jet.thrust")
    yaw: float = param(0.0, low=-1e9, high=1e9, unit="N m/rad", words="the vessel's", follows="reversing_jet.yaw")
