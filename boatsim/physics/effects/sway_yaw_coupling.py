"""Sway-yaw coupling: forces proportional to products of two velocities."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import Force, Wrench, param, preset_effect, wrench

# [kg] bounds for a boat of 4.6 kg: no added mass exceeds twice the mass of the hull
TWICE = (-9.2, 9.2)


@njit(inline="always")
def law(m: Any, q: Any) -> Wrench:
    """Return the hull forces X_vr v r, Y_ur u r and N_uv u v, products of two velocities.

    The last two change sign with the direction of motion.

    Args:
        m: Motion of the hull: velocities [m/s], rates [rad/s], position [m], attitude [rad].
        q: Parameters of the effect, with the names and units of its class.

    Returns:
        Force [N] and moment [N m] in body axes.
    """
    return wrench(X=q.mass * m.vr * m.r, Y=-q.sway * m.ur * m.r, N=-q.yaw * m.ur * m.vr)


@dataclass(frozen=True)
class SwayYawCoupling(Force):
    """Cross terms of hull lift and added mass at a small angle to the flow.

    X = X_vr v_r r,  Y = Y_ur u_r r,  N = N_uv u_r v_r

    They are added to the Coriolis terms of the rigid body. N_uv alone is the Munk moment.
    """

    formula: ClassVar[str] = r"X = X_{vr} v_r r, \quad Y = Y_{ur} u_r r, \quad N = N_{uv} u_r v_r"
    symbols: ClassVar = {"mass": "X_{vr}", "sway": "-Y_{ur}", "yaw": "-N_{uv}"}
    needs: ClassVar = ("surge", "sway", "yaw")
    ruled_out_by: ClassVar = {"no_water": (True,)}
    words: ClassVar[str] = (
        "a moving hull has a side force when it turns and a yaw moment when it drifts"
    )
    refines: ClassVar[str] = "added_mass"
    shown_by: ClassVar[str] = "the same turns at two speeds ahead, and astern"
    source: ClassVar[str] = (
        "T. I. Fossen, Handbook of Marine Craft Hydrodynamics, 2nd ed. 2021, chapter 6"
    )
    law: ClassVar = law

    sway: float = param(
        0.0, low=-1e9, high=1e9, unit="kg", words="-Y_ur", fit=True, spread=5.0, within=TWICE
    )
    yaw: float = param(
        0.0, low=-1e9, high=1e9, unit="kg", words="-N_uv", fit=True, spread=5.0, within=TWICE
    )
    mass: float = param(0.0, low=-1e9, high=1e9, unit="kg", words="X_vr")


SpeedLossInTurn = preset_effect(
    SwayYawCoupling,
    "SpeedLossInTurn",
    formula=r"X = X_{vr} v_r r",
    symbols={"mass": "X_{vr}"},
    words="a hull that drifts while it turns loses speed, in proportion to drift times yaw rate",
    shown_by="turning circles and large zig-zags with the propeller held",
    source="H. Yasukawa, Y. Yoshimura, J. Mar. Sci. Technol. 20, 2015: m_y + X_vr",
    frees={
        "mass": {"words": "m_y + X_vr", "spread": 4.0}
    },  # a negative force, because the hull drifts outwards
    fixed={"sway": 0.0, "yaw": 0.0},
)
