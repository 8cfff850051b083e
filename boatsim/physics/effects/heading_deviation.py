"""Heading deviation: compass error that is constant or depends on the heading."""

from dataclasses import dataclass
from math import cos, sin
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import MeasuredMotion, Measurement, param, preset_effect


@njit(inline="always")
def apply_measurement_error(m: MeasuredMotion, q: Any) -> MeasuredMotion:
    """Return the motion as recorded with a compass that has a deviation.

    The heading contains the deviation, and the velocities are those along the recorded heading.

    Args:
        m: True motion: position [m], attitude [rad], velocities [m/s], rates [rad/s].
        q: Parameters of the effect, with the names and units of its class.

    Returns:
        The recorded motion.
    """
    off = q.offset + q.cos * cos(m.psi) + q.sin * sin(m.psi)
    rate = (q.sin * cos(m.psi) - q.cos * sin(m.psi)) * m.r
    c, s = cos(off), sin(off)
    return MeasuredMotion(
        m.x,
        m.y,
        m.z,
        m.phi,
        m.theta,
        m.psi + off,
        c * m.u + s * m.v,
        c * m.v - s * m.u,
        m.w,
        m.p,
        m.q,
        m.r + rate,
    )


@dataclass(frozen=True)
class HeadingDeviation(Measurement):
    """Semicircular deviation of a compass, caused by iron or current-carrying wires on board.

    psi_recorded = psi + offset + cos cos(psi) + sin sin(psi)

    `cos` and `sin` [rad] are the coefficients C and B of the classical deviation formula.
    """

    formula: ClassVar[str] = (
        r"\begin{aligned} \psi_\mathrm{recorded} &= \psi + \Delta, \quad \Delta = A + C "
        r"\cos\psi + B \sin\psi \\ u_\mathrm{recorded} &= u \cos\Delta + v \sin\Delta, "
        r"\quad v_\mathrm{recorded} = v \cos\Delta - u \sin\Delta \\ r_\mathrm{recorded} "
        r"&= r \left(1 + B \cos\psi - C \sin\psi\right) \end{aligned}"
    )
    symbols: ClassVar = {"offset": "A", "cos": "C", "sin": "B"}
    of_columns: ClassVar = ("psi_rad",)
    needs: ClassVar = ("surge", "yaw")
    words: ClassVar[str] = "the compass deviates with the heading (not physics)"
    shown_by: ClassVar[str] = "straight runs on four headings, or a slow full turn"
    source: ClassVar[str] = (
        "coefficients B and C of the classical deviation formula (Archibald Smith)"
    )
    apply_measurement_error: ClassVar = apply_measurement_error

    cos: float = param(
        0.0,
        low=-0.6,
        high=0.6,
        unit="rad",
        words="deviation on heading north",
        fit=True,
        spread=0.1,
    )
    sin: float = param(
        0.0, low=-0.6, high=0.6, unit="rad", words="deviation on heading east", fit=True, spread=0.1
    )
    offset: float = param(0.0, low=-1.0, high=1.0, unit="rad", words="constant error")


HeadingOffset = preset_effect(
    HeadingDeviation,
    "HeadingOffset",
    formula=(
        r"\psi_\mathrm{recorded} = \psi + A, \quad u_\mathrm{recorded} = u \cos A + v "
        r"\sin A, \quad v_\mathrm{recorded} = v \cos A - u \sin A"
    ),
    symbols={"offset": "A"},
    words="the recorded heading has a constant error (not physics)",
    shown_by="a straight run ahead followed by one astern",
    source="misaligned compass or marker, or declination not applied",
    frees={"offset": {"words": "constant error of the heading", "spread": 0.1}},
    fixed={"cos": 0.0, "sin": 0.0},
)
