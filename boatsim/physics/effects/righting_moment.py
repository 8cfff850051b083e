"""Righting moment: restoring roll moment that is valid at any angle."""

from dataclasses import dataclass
from math import sin
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import (
    CoefficientRelease,
    Force,
    Wrench,
    factor_parameter,
    param,
    shift_parameter,
    wrench,
)


@njit(inline="always")
def law(m: Any, q: Any) -> Wrench:
    """Return the restoring roll moment of a weight or of buoyancy, a sine series of the heel.

    Args:
        m: Motion of the hull: velocities [m/s], rates [rad/s], position [m], attitude [rad].
        q: Parameters of the effect, with the names and units of its class.

    Returns:
        Force [N] and moment [N m] in body axes.
    """
    heel = m.phi - q.list
    series = sin(heel)
    if q.second != 0.0 or q.third != 0.0:
        series += q.second * sin(2.0 * heel) + q.third * sin(3.0 * heel)
    return wrench(K=-q.moment * series)


@dataclass(frozen=True)
class RightingMoment(Force):
    """Restoring moment in roll at any angle, also over the top and after several turns.

    K = -moment (sin h + second sin 2h + third sin 3h),  h = phi - list

    With the first term alone it is the weight of a pendulum, or a hull whose metacentre is fixed:
    moment = m g GM. Any lever curve GZ that is equal on both sides is a sine series of the heel;
    the terms with sin 2h and sin 3h give its vanishing angle and its shape.
    """

    formula: ClassVar[str] = (
        r"K = -m g \, GM \left(\sin h + c_2 \sin 2h + c_3 \sin 3h\right), \quad h = \phi - \phi_0"
    )
    symbols: ClassVar = {
        "moment": r"m g \, GM",
        "second": "c_2",
        "third": "c_3",
        "list": r"\phi_0",
    }
    words: ClassVar[str] = "the restoring moment follows the sine of the heel"
    shown_by: ClassVar[str] = "a roll decay from a large heel"
    source: ClassVar[str] = (
        "A. Biran, Ship Hydrostatics and Stability, 2nd ed. 2014, chapter 5 (curve of statical "
        "stability), as a Fourier series"
    )
    law: ClassVar = law

    moment: float = param(
        0.0,
        low=0.0,
        high=1e13,
        unit="N m",
        words="amplitude of the first term, m g GM",
        calibrates="restoring",
        axis="roll",
    )
    second: float = param(
        0.0, low=-5.0, high=5.0, unit="", words="relative size of the term sin 2h", axis="roll"
    )
    third: float = param(
        0.0, low=-5.0, high=5.0, unit="", words="relative size of the term sin 3h", axis="roll"
    )
    list: float = param(0.0, low=-3.2, high=3.2, unit="rad", words="heel at rest", axis="roll")


@dataclass(frozen=True)
class RightingMomentError(CoefficientRelease):
    """Restoring moment at any angle that differs from its specified value by one factor."""

    formula: ClassVar[str] = r"m g \, GM = k \, (m g \, GM)^0"
    symbols: ClassVar = {"factor": "k"}
    words: ClassVar[str] = "the restoring moment is larger or smaller than specified by one factor"
    refines: ClassVar[str] = "restoring"
    shown_by: ClassVar[str] = "the period of a roll decay"
    source: ClassVar[str] = RightingMoment.source
    # a period off is a separate local maximum of the likelihood
    starts: ClassVar = ({"factor": 0.5}, {"factor": 0.8}, {"factor": 1.25}, {"factor": 2.0})

    factor: float = factor_parameter(
        "righting_moment.moment",
        words="restoring moment over its specified value",
        axis="roll",
        in_per_cent="the restoring moment is {share} of its value in the vessel file",
    )


@dataclass(frozen=True)
class RightingMomentShape(CoefficientRelease):
    """Restoring moment whose curve over the heel has another shape than specified."""

    formula: ClassVar[str] = (
        r"c_2 = c_2^0 + \Delta_2, \quad c_3 = c_3^0 + \Delta_3, \quad K = -m g \, GM "
        r"\left(\sin h + c_2 \sin 2h + c_3 \sin 3h\right)"
    )
    symbols: ClassVar = {"second": r"\Delta_2", "third": r"\Delta_3"}
    words: ClassVar[str] = "the curve of the restoring moment over the heel has another shape"
    refines: ClassVar[str] = "restoring"
    shown_by: ClassVar[str] = "a roll decay from a large heel"
    source: ClassVar[str] = RightingMoment.source

    second: float = shift_parameter(
        "righting_moment.second",
        words="change of the relative size of the term sin 2h",
        unit="",
        spread=0.2,
        low=-5.0,
        high=5.0,
        axis="roll",
    )
    third: float = shift_parameter(
        "righting_moment.third",
        words="change of the relative size of the term sin 3h",
        unit="",
        spread=0.2,
        low=-5.0,
        high=5.0,
        axis="roll",
    )
