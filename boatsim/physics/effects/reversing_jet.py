"""Reversing jet: a water jet at idle whose bucket bends it ahead or astern and whose nozzle turns it aside."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import Force, Release, Role, Wrench, param, shift, wrench


@njit(inline="always")
def ahead(s: Any) -> float:
    """Share cos 2 beta: the bucket at an angle beta bends the jet by twice its own angle; negative astern."""
    return 2.0 * s.cos_bucket * s.cos_bucket - 1.0


@njit(inline="always")
def law(m: Any, q: Any, s: Any) -> Wrench:
    """Thrust and turning moment both go with the part of the jet that points astern, and with what leaks past."""
    share = ahead(s) + q.leak
    return wrench(X=q.thrust * share, N=q.yaw * share * s.angle)


@dataclass(frozen=True)
class ReversingJet(Force):
    """Idling water jet with a deflecting bucket; a positive nozzle angle turns to starboard going ahead."""

    words: ClassVar[str] = (
        "the idling jet pushes and turns as far as its bucket lets it point astern"
    )
    shown_by: ClassVar[str] = "circles at several bucket angles"
    source: ClassVar[str] = (
        "L. R. S. Theisen, R. Galeazzi, M. Blanke, IFAC CAMS 2013, equations 2, 5 and 9"
    )
    roles: ClassVar = {
        "angle": Role("rad", "the nozzle, positive turns to starboard going ahead"),
        "bucket": Role("rad", "the bucket, down positive"),
    }
    law: ClassVar = law

    thrust: float = param(
        0.0,
        low=0.0,
        high=1e7,
        unit="N",
        words="at idle, bucket up",
        calibrates="thrust",
        axis="surge",
    )
    yaw: float = param(
        0.0,
        low=-1e9,
        high=1e9,
        unit="N m/rad",
        words="N_delta, bucket up",
        calibrates="thrust",
        axis="yaw",
    )
    leak: float = param(
        0.0, low=-1.0, high=1.0, unit="", words="share of the jet that the bucket does not turn"
    )


@dataclass(frozen=True)
class JetLeak(Release):
    """A bucket that does not close: thrust and turning moment do not vanish where the bucket should cancel them."""

    words: ClassVar[str] = (
        "part of the jet leaks past the bucket and pushes ahead whatever the bucket's angle"
    )
    shown_by: ClassVar[str] = (
        "nozzle steps with the bucket near 45 deg, where the jet should neither push nor turn"
    )
    source: ClassVar[str] = (
        "L. R. S. Theisen, R. Galeazzi, M. Blanke, IFAC CAMS 2013, figures 3 and 4"
    )
    starts: ClassVar = ({"fraction": 0.1},)

    fraction: float = shift(
        "reversing_jet.leak", words="of the jet", unit="", spread=0.3, low=-1.0, high=1.0
    )
