"""Cross-flow drag: every section of the hull resists the water that crosses it."""

from dataclasses import dataclass
from math import sqrt
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import UNSET, Force, Wrench, param, wrench

FRESH_WATER = 1000.0  # [kg/m^3]
GAUSS = 0.5 / sqrt(3.0)  # two-point Gauss abscissa on an interval of length 1


@njit(inline="always")
def panel(a: float, b: float, v: float, r: float) -> tuple[float, float]:
    """Integrals of w|w| and x w|w|, w = v + x r, over [a, b] in which w keeps its sign: two points are exact."""
    mid, half = 0.5 * (a + b), GAUSS * (b - a)
    w0, w1 = v + (mid - half) * r, v + (mid + half) * r
    f0, f1 = w0 * abs(w0), w1 * abs(w1)
    return 0.5 * (b - a) * (f0 + f1), 0.5 * (b - a) * ((mid - half) * f0 + (mid + half) * f1)


@njit(inline="always")
def strips(v: float, r: float, q: Any) -> tuple[float, float]:
    """Integrals of w|w| and x w|w|, w = v + x r, along the hull: in closed form, or by the trapezoidal rule.

    Closed: split where the cross flow changes sign, Gauss on either side.
    """
    stern, bow = q.centre - 0.5 * q.length, q.centre + 0.5 * q.length
    if q.stations >= 2.0:
        force, moment, step = 0.0, 0.0, q.length / (q.stations - 1.0)
        for i in range(int(q.stations)):
            x = stern + i * step
            w = v + x * r
            f = w * abs(w) * (0.5 * step if i == 0 or i == int(q.stations) - 1 else step)
            force += f
            moment += x * f
        return force, moment
    turn = stern  # where the cross flow is zero, if it is inside the hull
    if r != 0.0:
        turn = min(max(-v / r, stern), bow)
    aft, aft_moment = panel(stern, turn, v, r)
    fore, fore_moment = panel(turn, bow, v, r)
    return aft + fore, aft_moment + fore_moment


@njit(inline="always")
def law(m: Any, q: Any) -> Wrench:
    """Sway and yaw, and where the sections resist vertical flow too, heave and pitch: a bow that rises moves up."""
    across, turning = strips(m.vr, m.r, q)
    down, bowing = strips(m.wr, -m.q, q) if q.vertical > 0.0 else (0.0, 0.0)
    k = 0.5 * q.density * q.section_drag_coefficient * q.draught  # [kg/m^2]
    even = q.linear * q.length * (m.vr + q.centre * m.r)
    even_moment = (
        q.linear
        * q.length
        * (q.centre * m.vr + (q.centre * q.centre + q.length * q.length / 12.0) * m.r)
    )
    return wrench(
        X=-q.surge_quadratic * m.ur * abs(m.ur),
        Y=-k * across - even,
        Z=-k * q.vertical * down,
        M=k * q.vertical * bowing,
        N=-k * turning - even_moment,
    )


@dataclass(frozen=True)
class CrossFlowDrag(Force):
    """Drag of a hull of constant section in sway and yaw together, by strips in closed form."""

    needs: ClassVar = ("sway", "yaw")
    words: ClassVar[str] = "hull sections drag sideways with the square of the water crossing them"
    shown_by: ClassVar[str] = "sway and spin at two speeds"
    source: ClassVar[str] = (
        "O. M. Faltinsen, Sea Loads on Ships and Offshore Structures, 1990, section 6"
    )
    law: ClassVar = law

    section_drag_coefficient: float = param(
        0.0,
        low=0.0,
        high=10.0,
        unit="",
        words="drag coefficient of a section",
        fit=True,
        spread=1.2,
        calibrates="damping",
    )
    surge_quadratic: float = param(
        0.0,
        low=0.0,
        high=1e9,
        unit="N s^2/m^2",
        words="-X_u|u| that goes with it",
        fit=True,
        spread=4.0,
    )
    length: float = param(
        UNSET,
        low=0.0,
        high=500.0,
        unit="m",
        words="waterline length; if not given, the vessel's own",
        follows="vessel.length",
    )
    draught: float = param(
        UNSET,
        low=0.0,
        high=50.0,
        unit="m",
        words="draught; if not given, the vessel's own",
        follows="vessel.draught",
    )
    density: float = param(FRESH_WATER, low=0.0, high=1500.0, unit="kg/m^3", words="of the water")
    vertical: float = param(
        0.0,
        low=0.0,
        high=100.0,
        unit="",
        words="drag area of a section in heave per that in sway; 0: none",
    )
    stations: float = param(
        0.0,
        low=0.0,
        high=1000.0,
        unit="",
        words="of the trapezoidal rule along the hull; 0: the exact integral",
    )
    centre: float = param(
        0.0, low=-250.0, high=250.0, unit="m", words="mid-length ahead of the origin of motion"
    )
    linear: float = param(
        0.0, low=0.0, high=1e9, unit="N s/m^2", words="linear sectional damping, for very slow flow"
    )
