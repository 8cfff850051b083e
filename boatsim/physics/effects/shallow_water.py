"""Shallow water: a bottom near the keel raises added mass and cross-flow drag in sway and yaw."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import Force, Inertia, Mass, Wrench, param
from boatsim.physics.effects import added_mass, cross_flow_drag


@njit(inline="always")
def inertia(q: Any) -> Mass:
    """(factor - 1) times the sway and yaw added mass."""
    k = q.factor - 1.0
    a, z = q.sway_at, q.sway_below
    b = k * q.sway * a
    return Mass(0.0, k * q.sway, b, k * q.yaw + b * a, -k * q.sway * z, k * q.sway * z * z, -b * z)


@njit(inline="always")
def law(m: Any, q: Any) -> Wrench:
    """Coriolis force of that added mass and (factor - 1) times the cross-flow drag."""
    drag = cross_flow_drag.law(m, q)
    coriolis = added_mass.law(m, q)
    k = q.factor - 1.0
    return Wrench(k * coriolis.X, k * (drag.Y + coriolis.Y), 0.0, k * (drag.N + coriolis.N))


@dataclass(frozen=True)
class ShallowWater(Inertia, Force):
    """What a small water depth adds to the sway and yaw of a hull that has added mass and cross-flow drag."""

    words: ClassVar[str] = "the bottom is near: sway and yaw move more water and drag more"
    shown_by: ClassVar[str] = "the same sway in deep and in shallow water"
    source: ClassVar[str] = "assumption [A] of the checked specification of Bayless 2017, section 2 (factor k)"
    moves_with: ClassVar[str] = "water"
    inertia: ClassVar = inertia
    law: ClassVar = law

    factor: float = param(1.0, low=1.0, high=10.0, unit="", words="k of shallow water; 1 in deep water", absent=1.0)
    surge: float = param(0.0, low=0.0, high=0.0, unit="kg", words="surge added mass is not raised")
    sway: float = param(0.0, low=0.0, high=1e9, unit="kg", words="the vessel's -Y_vdot", follows="added_mass.sway")
    sway_at: float = param(0.0, low=-500.0, high=500.0, unit="m", words="where it acts", follows="added_mass.sway_at")
    sway_below: float = param(
        0.0, low=-100.0, high=100.0, unit="m", words="how far below", follows="added_mass.sway_below"
    )
    yaw: float = param(0.0, low=0.0, high=1e13, unit="kg m^2", words="the vessel's -N_rdot", follows="added_mass.yaw")
    coriolis: float = param(1.0, low=0.0, high=1.0, unit="", words="the vessel's share", follows="added_mass.coriolis")
    section_drag_coefficient: float = param(
        0.0, low=0.0, high=10.0, unit="", words="the vessel's", follows="cross_flow_drag.section_drag_coefficient"
    )
    surge_quadratic: float = param(0.0, low=0.0, high=0.0, unit="N s^2/m^2", words="surge drag is not raised")
    length: float = param(0.0, low=0.0, high=500.0, unit="m", words="the vessel's", follows="cross_flow_drag.length")
    draught: float = param(0.0, low=0.0, high=50.0, unit="m", words="the vessel's", follows="cross_flow_drag.draught")
    centre: float = param(0.0, low=-250.0, high=250.0, unit="m", words="the vessel's", follows="cross_flow_drag.centre")
    linear: float = param(
        0.0, low=0.0, high=1e9, unit="N s/m^2", words="the vessel's", follows="cross_flow_drag.linear"
    )
