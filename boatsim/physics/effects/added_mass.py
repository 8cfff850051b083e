"""Added mass: inertia of the water that accelerates with the hull, and its Coriolis force."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.physics import particulars
from boatsim.physics.base import (
    UNSET,
    Boat,
    CoefficientRelease,
    Force,
    Inertia,
    MassMatrix,
    Wrench,
    factor_parameter,
    mass_matrix,
    param,
    shift_parameter,
    wrench,
)


@njit(inline="always")
def inertia(q: Any) -> MassMatrix:
    """Return the added mass matrix of the hull.

    The sway added mass acts at (sway_at, sway_below) and so couples into roll and yaw.

    Args:
        q: Parameters of the effect, with the names and units of its class.

    Returns:
        Entries of the mass matrix [kg, kg m, kg m^2] about the origin of motion.
    """
    a, z = q.sway_at, q.sway_below
    return mass_matrix(
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
    """Return the Coriolis force of the added mass, -C_A(nu_r) nu_r, Munk moment included.

    Fossen 2021, equations 3.46 and 6.42. `coriolis` scales the force.

    Args:
        m: Motion of the hull: velocities [m/s], rates [rad/s], position [m], attitude [rad].
        q: Parameters of the effect, with the names and units of its class.

    Returns:
        Force [N] and moment [N m] in body axes.
    """
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
    """Added mass of the hull about the origin of motion, and its Coriolis and centripetal force.

    tau = -M_A nu_r' - coriolis C_A(nu_r) nu_r

    M_A has the entries surge = -X_udot, sway = -Y_vdot, heave = -Z_wdot [kg] and roll = -K_pdot,
    pitch = -M_qdot, yaw = -N_rdot [kg m^2]. With `spheroid` = 1 surge, sway and yaw are those of a
    prolate spheroid of the vessel's length and draught (H. Lamb, Hydrodynamics, 1932), and roll is
    `roll_share` times the roll inertia of the body, about the origin. X_C, Y_C and N_C are the
    Coriolis force in the plane, with the sway added mass at the origin.
    """

    formula: ClassVar[str] = (
        r"\begin{aligned} \tau &= -\mathbf{M}_A \dot{\nu_r} - c \, \mathbf{C}_A(\nu_r) "
        r"\nu_r \\ X_C &= -c \, Y_{\dot v} v_r r, \quad Y_C = c \, X_{\dot u} u_r r \\ "
        r"N_C &= c \, (Y_{\dot v} - X_{\dot u}) \, u_r v_r \end{aligned}"
    )
    symbols: ClassVar = {
        "surge": r"-X_{\dot u}",
        "sway": r"-Y_{\dot v}",
        "heave": r"-Z_{\dot w}",
        "roll": r"-K_{\dot p}",
        "pitch": r"-M_{\dot q}",
        "yaw": r"-N_{\dot r}",
        "coriolis": "c",
    }
    alone: ClassVar = True
    ruled_out_by: ClassVar = {"no_water": (True,)}
    words: ClassVar[str] = "the water that moves with the hull adds inertia"
    refines: ClassVar[str] = "added_mass"
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
        0.0,
        low=-500.0,
        high=500.0,
        unit="m",
        words="centre of the sway added mass, ahead of the origin",
    )
    sway_below: float = param(
        0.0,
        low=-100.0,
        high=100.0,
        unit="m",
        words="centre of the sway added mass, below the origin",
    )
    yaw: float = param(
        UNSET,
        low=0.0,
        high=1e13,
        unit="kg m^2",
        words="-N_rdot about the centre of the sway added mass",
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
        words="-K_pdot about the centre of the sway added mass",
        fit=True,
        spread=0.02,
        axis="roll",
        calibrates="added_mass",
    )
    coriolis: float = param(
        1.0, low=-1.0, high=3.0, unit="", words="factor on the Coriolis force; 1: as the theory"
    )
    spheroid: float = param(
        0.0,
        low=0.0,
        high=1.0,
        unit="",
        words="1: surge, sway, yaw and roll from the size of the hull",
    )
    roll_share: float = param(
        0.2,
        low=0.0,
        high=2.0,
        unit="",
        words="roll added inertia over that of the body, for spheroid = 1",
    )

    def derived_parameters(self, vessel: Boat) -> dict[str, float]:
        """Return the default added masses [kg, kg m^2]: those of a spheroid of the vessel's size.

        Args:
            vessel: Vessel with length, draught [m] and body.

        Returns:
            Name of the parameter -> value; empty if `spheroid` is 0.
        """
        if not self.spheroid:
            return {}
        share, body = particulars.spheroid_added_mass(vessel.length, vessel.draught), vessel.body
        sway = share.sway * body.mass
        roll = self.roll_share * body.roll_inertia - sway * self.sway_below**2
        return {
            "surge": share.surge * body.mass,
            "sway": sway,
            "yaw": share.yaw * body.yaw_inertia,
            "roll": roll,
        }


@dataclass(frozen=True)
class AddedMassError(CoefficientRelease):
    """Added mass that differs from its specified value by one factor in each axis.

    Causes are another draught, shallow water or a formula that does not suit the hull.
    """

    formula: ClassVar[str] = (
        r"X_{\dot u} = k_u X_{\dot u}^0, \quad Y_{\dot v} = k_v Y_{\dot v}^0, \quad "
        r"N_{\dot r} = k_r N_{\dot r}^0, \quad Z_{\dot w} = k_w Z_{\dot w}^0, \quad "
        r"M_{\dot q} = k_q M_{\dot q}^0"
    )
    symbols: ClassVar = {
        "surge_factor": "k_u",
        "sway_factor": "k_v",
        "yaw_factor": "k_r",
        "heave_factor": "k_w",
        "pitch_factor": "k_q",
    }
    ruled_out_by: ClassVar = {"no_water": (True,)}
    words: ClassVar[str] = (
        "the added mass differs from its specified value: the hull floats deeper or shallower"
    )
    refines: ClassVar[str] = "added_mass"
    shown_by: ClassVar[str] = AddedMass.shown_by
    source: ClassVar[str] = AddedMass.source

    surge_factor: float = factor_parameter(
        "added_mass.surge",
        words="factor on the surge added mass",
        axis="surge",
        in_per_cent="the added mass in surge is {share} of its value in the vessel file",
    )
    sway_factor: float = factor_parameter(
        "added_mass.sway",
        words="factor on the sway added mass",
        axis="sway",
        in_per_cent="the added mass in sway is {share} of its value in the vessel file",
    )
    yaw_factor: float = factor_parameter(
        "added_mass.yaw",
        words="factor on the yaw added mass",
        axis="yaw",
        in_per_cent="the added mass in yaw is {share} of its value in the vessel file",
    )
    heave_factor: float = factor_parameter(
        "added_mass.heave",
        words="factor on the heave added mass",
        axis="heave",
        in_per_cent="the added mass in heave is {share} of its value in the vessel file",
    )
    pitch_factor: float = factor_parameter(
        "added_mass.pitch",
        words="factor on the pitch added mass",
        axis="pitch",
        in_per_cent="the added mass in pitch is {share} of its value in the vessel file",
    )


@dataclass(frozen=True)
class AddedMassCoriolis(CoefficientRelease):
    """Share of the Coriolis force of the added mass that the vessel's model omits.

    It adds `fraction` to the `coriolis` factor of the vessel's added mass.
    """

    formula: ClassVar[str] = (
        r"c = c^0 + \mathrm{fraction}, \quad N_C = c \, (Y_{\dot v} - X_{\dot u}) \, u_r "
        r"v_r"
    )
    ruled_out_by: ClassVar = {"no_water": (True,)}
    words: ClassVar[str] = (
        "the water that moves with the hull turns it broadside to its course (Munk moment)"
    )
    refines: ClassVar[str] = "added_mass"
    shown_by: ClassVar[str] = "turning while moving ahead and sideways"
    source: ClassVar[str] = AddedMass.source

    fraction: float = shift_parameter(
        "added_mass.coriolis",
        words="share of the Coriolis force that the model omits",
        unit="",
        spread=0.8,
        low=-1.0,
        high=2.0,
        in_per_cent="the model omits {share} of the Coriolis force of the added mass",
    )


@dataclass(frozen=True)
class AddedMassDepth(CoefficientRelease):
    """Depth of the centre of the sway added mass, by which sway and roll accelerate each other."""

    formula: ClassVar[str] = (
        r"z_A = z_A^0 + \mathrm{shift}, \quad K_{\dot v} = Y_{\dot p} = -z_A Y_{\dot v}"
    )
    needs: ClassVar = ("sway", "roll")
    required_facts: ClassVar = {"guided": True}
    words: ClassVar[str] = "the water that moves with the hull in sway acts at another depth"
    refines: ClassVar[str] = "added_mass"
    shown_by: ClassVar[str] = "a roll decay of a hull that is free to sway"
    source: ClassVar[str] = AddedMass.source

    shift: float = shift_parameter(
        "added_mass.sway_below",
        words="shift of the centre, positive downward",
        unit="m",
        spread=0.1,
        low=-100.0,
        high=100.0,
    )


@dataclass(frozen=True)
class ShallowWater(CoefficientRelease):
    """Larger sway and yaw added mass and cross-flow drag in shallow water, by one factor k."""

    formula: ClassVar[str] = (
        r"Y_{\dot v} = k \, Y_{\dot v}^0, \quad N_{\dot r} = k \, N_{\dot r}^0, \quad C_D "
        r"= k \, C_D^0"
    )
    symbols: ClassVar = {"factor": "k"}
    needs: ClassVar = ("sway", "yaw")
    confounded_with: ClassVar = ("added_mass_error",)
    ruled_out_by: ClassVar = {"no_water": (True,)}
    words: ClassVar[str] = "shallow water increases the added mass and the drag in sway and yaw"
    shown_by: ClassVar[str] = "the same sway in deep and in shallow water"
    source: ClassVar[str] = (
        "assumption [A] of the checked specification of Bayless 2017, section 2 (factor k)"
    )

    factor: float = factor_parameter(
        "added_mass.sway",
        "added_mass.yaw",
        "cross_flow_drag.section_drag_coefficient",
        "cross_flow_drag.linear",
        words="factor k; 1 in deep water",
        low=1.0,
        high=10.0,
    )
