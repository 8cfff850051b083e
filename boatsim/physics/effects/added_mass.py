"""Added mass: the water a hull sets in motion when it accelerates."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.physics import particulars
from boatsim.physics.base import (
    UNSET,
    Boat,
    Force,
    Inertia,
    Mass,
    Release,
    Wrench,
    factor,
    mass,
    param,
    shift,
    wrench,
)


@njit(inline="always")
def inertia(q: Any) -> Mass:
    """Sway mass acts at its own centre, ahead and below, so it couples into yaw and roll."""
    a, z = q.sway_at, q.sway_below
    return mass(
        surge=q.surge,
        sway=q.sway,
        heave=q.heave,
        pitch=q.pitch,
        sway_yaw=q.sway * a,
        yaw=q.yaw + q.sway * a * a,
        sway_roll=-q.sway * z,
        roll=q.roll + q.sway * z * z,
        roll_yaw=-q.sway * z * a,
    )


@njit(inline="always")
def law(m: Any, q: Any) -> Wrench:
    """Coriolis force -C_A(nu_r) nu_r of the added mass, Munk moment included (Fossen 2021, eqs 3.46 and 6.42)."""
    along = q.coriolis * q.surge * m.ur  # [kg m/s] momentum of the water, linear
    across = q.coriolis * q.sway * (m.vr - q.sway_below * m.p + q.sway_at * m.r)
    down = q.coriolis * q.heave * m.wr
    rolling = q.coriolis * q.roll * m.p - q.sway_below * across  # [kg m^2/s] and angular
    pitching = q.coriolis * q.pitch * m.q
    turning = q.coriolis * q.yaw * m.r + q.sway_at * across
    return wrench(
        X=across * m.r - down * m.q,
        Y=down * m.p - along * m.r,
        Z=along * m.q - across * m.p,
        K=across * m.wr - down * m.vr + pitching * m.r - turning * m.q,
        M=down * m.ur - along * m.wr + turning * m.p - rolling * m.r,
        N=along * m.vr - across * m.ur + rolling * m.q - pitching * m.p,
    )


@dataclass(frozen=True)
class AddedMass(Inertia, Force):
    """Inertia of the surrounding water about the origin of motion, and its Coriolis force.

    With `spheroid` the values of surge, sway and yaw are those of a prolate spheroid of the vessel's length and draught
    (H. Lamb, Hydrodynamics, 1932), and roll is `roll_share` of the body's own roll inertia, about the origin.
    """

    alone: ClassVar = True
    words: ClassVar[str] = "the water that moves with the hull adds inertia"
    shown_by: ClassVar[str] = "sharp starts and stops in sway and yaw"
    source: ClassVar[str] = (
        "T. I. Fossen, Handbook of Marine Craft Hydrodynamics, 2nd ed. 2021, section 6.3"
    )
    moves_with: ClassVar[str] = "water"
    inertia: ClassVar = inertia
    law: ClassVar = law

    surge: float = param(
        UNSET,
        low=0.0,
        high=1e9,
        unit="kg",
        words="-X_udot",
        fit=True,
        spread=0.5,
        axis="surge",
        calibrates="added_mass",
    )
    sway: float = param(
        UNSET,
        low=0.0,
        high=1e9,
        unit="kg",
        words="-Y_vdot",
        fit=True,
        spread=5.0,
        axis="sway",
        calibrates="added_mass",
    )
    heave: float = param(
        0.0,
        low=0.0,
        high=1e9,
        unit="kg",
        words="-Z_wdot",
        fit=True,
        spread=5.0,
        axis="heave",
        calibrates="added_mass",
    )
    pitch: float = param(
        0.0,
        low=0.0,
        high=1e13,
        unit="kg m^2",
        words="-M_qdot",
        fit=True,
        spread=0.7,
        axis="pitch",
        calibrates="added_mass",
    )
    sway_at: float = param(
        0.0, low=-500.0, high=500.0, unit="m", words="sway added mass acts this far ahead"
    )
    sway_below: float = param(
        0.0, low=-100.0, high=100.0, unit="m", words="sway added mass acts this far below"
    )
    yaw: float = param(
        UNSET,
        low=0.0,
        high=1e13,
        unit="kg m^2",
        words="-N_rdot about the point where sway acts",
        fit=True,
        spread=0.7,
        axis="yaw",
        calibrates="added_mass",
    )
    roll: float = param(
        UNSET,
        low=0.0,
        high=1e13,
        unit="kg m^2",
        words="-K_pdot about that point",
        fit=True,
        spread=0.02,
        axis="roll",
        calibrates="added_mass",
    )
    coriolis: float = param(
        1.0, low=-1.0, high=3.0, unit="", words="share of the Coriolis force that is modelled"
    )
    spheroid: float = param(
        0.0, low=0.0, high=1.0, unit="", words="1: surge, sway, yaw and roll by the hull's size"
    )
    roll_share: float = param(
        0.2, low=0.0, high=2.0, unit="", words="roll inertia per the body's, if by size"
    )

    def rules(self, vessel: Boat) -> dict[str, float]:
        """Values by the vessel's size, where they are wanted."""
        if not self.spheroid:
            return {}
        share, body = particulars.spheroid(vessel.length, vessel.draught), vessel.body
        sway = share.sway * body.mass
        roll = self.roll_share * body.roll_inertia - sway * self.sway_below**2
        return {
            "surge": share.surge * body.mass,
            "sway": sway,
            "yaw": share.yaw * body.yaw_inertia,
            "roll": roll,
        }


@dataclass(frozen=True)
class AddedMassError(Release):
    """Added mass off by a factor in each axis: another draught, shallow water, a wrong formula."""

    words: ClassVar[str] = "the added mass is off: the hull lies deeper or shallower than stated"
    shown_by: ClassVar[str] = AddedMass.shown_by
    source: ClassVar[str] = AddedMass.source

    surge_factor: float = factor("added_mass.surge", words="surge", axis="surge")
    sway_factor: float = factor("added_mass.sway", words="sway", axis="sway")
    yaw_factor: float = factor("added_mass.yaw", words="yaw", axis="yaw")


@dataclass(frozen=True)
class AddedMassCoriolis(Release):
    """What the Coriolis force of the vessel's own added mass has beyond the share its model keeps."""

    words: ClassVar[str] = (
        "the water that moves with the hull turns it broadside to its course (Munk moment)"
    )
    shown_by: ClassVar[str] = "turning while making way sideways and ahead"
    source: ClassVar[str] = AddedMass.source

    fraction: float = shift(
        "added_mass.coriolis",
        words="share of the force that is missing",
        unit="",
        spread=0.8,
        low=-1.0,
        high=2.0,
    )


@dataclass(frozen=True)
class ShallowWater(Release):
    """What a small water depth adds to the sway and yaw of a hull that has added mass, and to its cross-flow drag."""

    needs: ClassVar = ("sway", "yaw")
    told_by: ClassVar = ("added_mass_error",)
    words: ClassVar[str] = "the bottom is near: sway and yaw move more water and drag more"
    shown_by: ClassVar[str] = "the same sway in deep and in shallow water"
    source: ClassVar[str] = (
        "assumption [A] of the checked specification of Bayless 2017, section 2 (factor k)"
    )

    factor: float = factor(
        "added_mass.sway",
        "added_mass.yaw",
        "cross_flow_drag.section_drag_coefficient",
        "cross_flow_drag.linear",
        words="k of shallow water; 1 in deep water",
        low=1.0,
        high=10.0,
    )
