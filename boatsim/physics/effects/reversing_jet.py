"""Reversing jet: idling water jet with a bucket that deflects it ahead and a steering nozzle."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import (
    CoefficientRelease,
    Force,
    Role,
    Wrench,
    param,
    shift_parameter,
    wrench,
)


@njit(inline="always")
def ahead_thrust_fraction(s: Any) -> float:
    """Return the share of a water jet's thrust that drives ahead, cos(2 beta) at bucket angle beta.

    Args:
        s: Signals with the cosine of the bucket angle.
    """
    return 2.0 * s.cos_bucket * s.cos_bucket - 1.0


@njit(inline="always")
def law(m: Any, q: Any, s: Any) -> Wrench:
    """Return thrust and steering moment of a water jet with a reversing bucket, engine idling.

    Both are proportional to the share of the jet that points astern: cos(2 beta) at the bucket
    angle beta, and the leak, which the bucket does not deflect.

    Args:
        m: Motion of the hull: velocities [m/s], rates [rad/s], position [m], attitude [rad].
        q: Parameters of the effect, with the names and units of its class.
        s: Signals bound to the roles of the effect.

    Returns:
        Force [N] and moment [N m] in body axes.
    """
    share = ahead_thrust_fraction(s) + q.leak
    return wrench(X=q.thrust * share, N=q.yaw * share * s.angle)


@dataclass(frozen=True)
class ReversingJet(Force):
    """Water jet with a reversing bucket while the engine idles.

    The bucket deflects the jet ahead as it is lowered; `leak` is the share of the jet that it does
    not deflect. A positive nozzle angle turns to starboard going ahead.

    X = T_0 (cos 2 beta + leak),  N = N_delta (cos 2 beta + leak) delta

    T_0 is `thrust` [N] and N_delta `yaw` [N m/rad], both with the bucket up; beta is the bucket
    angle.
    """

    formula: ClassVar[str] = (
        r"X = T_0 \left(\cos 2\beta + \mathrm{leak}\right), \quad N = N_\delta \left(\cos "
        r"2\beta + \mathrm{leak}\right) \delta"
    )
    symbols: ClassVar = {"thrust": "T_0", "yaw": r"N_\delta"}
    words: ClassVar[str] = (
        "thrust and steering moment of an idling jet are proportional to cos 2 beta of its bucket"
    )
    shown_by: ClassVar[str] = "circles at several bucket angles"
    source: ClassVar[str] = (
        "L. R. S. Theisen, R. Galeazzi, M. Blanke, IFAC CAMS 2013, equations 2, 5 and 9"
    )
    roles: ClassVar = {
        "angle": Role("rad", "nozzle angle, positive turns to starboard going ahead"),
        "bucket": Role("rad", "bucket angle, positive down"),
    }
    law: ClassVar = law

    thrust: float = param(
        0.0,
        low=0.0,
        high=1e7,
        unit="N",
        words="thrust at idle, bucket up",
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
        0.0, low=-1.0, high=1.0, unit="", words="share of the jet that the bucket does not deflect"
    )


@dataclass(frozen=True)
class JetLeak(CoefficientRelease):
    """Share of the jet that leaks past the bucket.

    Thrust and moment then do not vanish at a bucket angle of 45 deg.
    """

    formula: ClassVar[str] = r"\mathrm{leak} = \mathrm{leak}^0 + \mathrm{fraction}"
    words: ClassVar[str] = (
        "part of the jet leaks past the bucket and gives thrust ahead at every bucket angle"
    )
    shown_by: ClassVar[str] = (
        "nozzle steps with the bucket near 45 deg, where thrust and moment should vanish"
    )
    source: ClassVar[str] = (
        "L. R. S. Theisen, R. Galeazzi, M. Blanke, IFAC CAMS 2013, figures 3 and 4"
    )
    starts: ClassVar = ({"fraction": 0.1},)

    fraction: float = shift_parameter(
        "reversing_jet.leak",
        words="share of the jet",
        unit="",
        spread=0.3,
        low=-1.0,
        high=1.0,
        in_per_cent="{share} of the jet gives thrust ahead at every bucket angle",
    )
