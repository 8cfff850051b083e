"""Cross-flow drag: quadratic drag of the hull sections in sway and yaw."""

from dataclasses import dataclass
from math import sqrt
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import UNSET, Force, Wrench, param, wrench

FRESH_WATER = 1000.0  # [kg/m^3]
GAUSS = 0.5 / sqrt(3.0)  # two-point Gauss abscissa on an interval of unit length


@njit(inline="always")
def panel_integrals(a: float, b: float, v: float, r: float) -> tuple[float, float]:
    """Return the integrals of w|w| and x w|w| over a part [a, b] of the hull, w = v + x r.

    They give the cross-flow drag and its moment. w must keep its sign in the interval. Two-point
    Gauss quadrature is exact for these integrands.

    Args:
        a: Begin of the interval, ahead of the origin [m].
        b: End of the interval [m].
        v: Cross-flow velocity at x = 0 [m/s].
        r: Slope of the cross-flow velocity along the hull, the yaw rate [1/s].
    """
    mid, half = 0.5 * (a + b), GAUSS * (b - a)
    w0, w1 = v + (mid - half) * r, v + (mid + half) * r
    f0, f1 = w0 * abs(w0), w1 * abs(w1)
    return 0.5 * (b - a) * (f0 + f1), 0.5 * (b - a) * ((mid - half) * f0 + (mid + half) * f1)


@njit(inline="always")
def hull_integrals(v: float, r: float, q: Any) -> tuple[float, float]:
    """Return the integrals of w|w| and x w|w| over the whole hull, w = v + x r.

    They give the cross-flow drag and its moment. With `stations` = 0 the hull is split where the
    cross flow changes sign and each part integrated exactly; otherwise the trapezoidal rule over
    that many stations is used.

    Args:
        v: Cross-flow velocity at x = 0 [m/s].
        r: Slope of the cross-flow velocity along the hull, the yaw rate [1/s].
        q: Parameters of the effect.
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
    turn = stern  # station at which the cross flow is zero, limited to the hull
    if r != 0.0:
        turn = min(max(-v / r, stern), bow)
    aft, aft_moment = panel_integrals(stern, turn, v, r)
    fore, fore_moment = panel_integrals(turn, bow, v, r)
    return aft + fore, aft_moment + fore_moment


@njit(inline="always")
def law(m: Any, q: Any) -> Wrench:
    """Return the quadratic cross-flow drag of the hull and its drag in surge.

    It acts in surge, sway and yaw, and in heave and pitch if `vertical` is set.

    Args:
        m: Motion of the hull: velocities [m/s], rates [rad/s], position [m], attitude [rad].
        q: Parameters of the effect, with the names and units of its class.

    Returns:
        Force [N] and moment [N m] in body axes.
    """
    across, turning = hull_integrals(m.vr, m.r, q)
    down, bowing = hull_integrals(m.wr, -m.q, q) if q.vertical > 0.0 else (0.0, 0.0)
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
    """Drag of a hull of constant section in sway and yaw, integrated over strips.

    Y = -0.5 rho T C_D integral(w|w| dx),  N = -0.5 rho T C_D integral(x w|w| dx),  w = v_r + x r

    The integrals run over the length about `centre`. C_D is the `section_drag_coefficient`, T the
    draught. `linear` [N s/m^2] adds a linear sectional damping; `vertical` scales the same drag in
    heave and pitch; `surge_quadratic` is -X_u|u|.
    """

    formula: ClassVar[str] = (
        r"\begin{aligned} Y &= -\tfrac{1}{2} \rho \, T C_D \int w \, |w| \, \mathrm{d}x - "
        r"d \int w \, \mathrm{d}x, \quad w = v_r + x r \\ N &= -\tfrac{1}{2} \rho \, T "
        r"C_D \int x \, w \, |w| \, \mathrm{d}x - d \int x \, w \, \mathrm{d}x \\ X &= "
        r"X_{|u|u} |u_r| u_r \end{aligned}"
    )
    symbols: ClassVar = {
        "section_drag_coefficient": "C_D",
        "surge_quadratic": "-X_{|u|u}",
        "draught": "T",
        "density": r"\rho",
        "linear": "d",
    }
    needs: ClassVar = ("sway", "yaw")
    ruled_out_by: ClassVar = {"no_water": (True,)}
    words: ClassVar[str] = "the drag of the hull sections grows with the square of the cross flow"
    refines: ClassVar[str] = "damping"
    shown_by: ClassVar[str] = "sway and yaw at two speeds"
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
        words="quadratic surge damping, -X_u|u|",
        fit=True,
        spread=4.0,
    )
    length: float = param(
        UNSET,
        low=0.0,
        high=500.0,
        unit="m",
        words="waterline length; default: that of the vessel",
        follows="vessel.length",
    )
    draught: float = param(
        UNSET,
        low=0.0,
        high=50.0,
        unit="m",
        words="draught; default: that of the vessel",
        follows="vessel.draught",
    )
    density: float = param(
        FRESH_WATER, low=0.0, high=1500.0, unit="kg/m^3", words="density of the water"
    )
    vertical: float = param(
        0.0,
        low=0.0,
        high=100.0,
        unit="",
        words="drag area of a section in heave over that in sway; 0: no drag in heave",
    )
    stations: float = param(
        0.0,
        low=0.0,
        high=1000.0,
        unit="",
        words="stations of the trapezoidal rule along the hull; 0: exact integral",
    )
    centre: float = param(
        0.0, low=-250.0, high=250.0, unit="m", words="mid-length ahead of the origin of motion"
    )
    linear: float = param(
        0.0, low=0.0, high=1e9, unit="N s/m^2", words="linear sectional damping, for very slow flow"
    )
