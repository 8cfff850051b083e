"""Linear hull: sway force and yaw moment of a displacement hull about its approach speed."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.physics import particulars
from boatsim.physics.base import UNSET, Boat, Force, Wrench, param, wrench


@njit(inline="always")
def law(m: Any, q: Any) -> Wrench:
    """Return the linear hull forces: sway force, yaw moment, and the roll moment they cause.

    `arm` adds a roll moment proportional to the force that accelerates the hull in sway.

    Args:
        m: Motion of the hull: velocities [m/s], rates [rad/s], position [m], attitude [rad].
        q: Parameters of the effect, with the names and units of its class.

    Returns:
        Force [N] and moment [N m] in body axes.
    """
    Y = -q.sway * m.vr - q.sway_by_yaw * m.r
    N = -q.yaw_by_sway * m.vr - q.yaw * m.r + q.yaw_by_heel * m.phi
    return wrench(Y=Y, K=-q.below * Y + q.arm * (Y - q.mass * m.ur * m.r), N=N)


@dataclass(frozen=True)
class LinearHull(Force):
    """Linear derivatives of a hull at constant forward speed, estimated from its main particulars.

    Y = Y_v v_r + Y_r r,  N = N_v v_r + N_r r + N_phi phi
    K = -z_H Y + arm (Y - m u_r r)

    The sway added mass acts at the depth z_H as well, m_y z_H v' in roll. Martin's equations have
    this term in the roll equation only. As v' is the sum of all sway forces over m + m_y, each of
    them heels the hull with the additional lever `arm` = z_H m_y / (m + m_y). If the vessel's
    `added_mass.sway_below` is set, the mass matrix has the coupling in both equations, as
    conservation of energy requires, and `arm` is zero.
    """

    formula: ClassVar[str] = (
        r"\begin{aligned} Y &= Y_v v_r + Y_r r, \quad N = N_v v_r + N_r r + N_\phi \phi "
        r"\\ K &= -z_H Y + l \left(Y - m \, u_r r\right) \end{aligned}"
    )
    symbols: ClassVar = {
        "sway": "-Y_v",
        "sway_by_yaw": "-Y_r",
        "yaw_by_sway": "-N_v",
        "yaw": "-N_r",
        "yaw_by_heel": r"N_\phi",
        "below": "z_H",
        "arm": "l",
        "mass": "m",
    }
    words: ClassVar[str] = "drift and yaw rate cause a side force, a yaw moment and a heel"
    shown_by: ClassVar[str] = "a zig-zag at small rudder angles"
    source: ClassVar[str] = (
        "C. R. Martin, Rudder Roll Reduction for Small Ships, UBC 1993, Appendix IV; Inoue, "
        "Hirano, Kijima 1981"
    )
    law: ClassVar = law

    trim: float = param(
        0.0, low=-20.0, high=20.0, unit="m", words="trim: draught aft less draught forward"
    )
    block: float = param(0.5, low=0.05, high=1.0, unit="", words="block coefficient")
    ahead: float = param(
        0.0, low=-200.0, high=200.0, unit="m", words="mass centre ahead of midship, LCG"
    )
    above_keel: float = param(
        0.0, low=0.0, high=100.0, unit="m", words="mass centre above the keel, VCG"
    )
    heel_to_yaw: float = param(
        -0.0076, low=-1.0, high=1.0, unit="", words="N'phi; -0.0076 for Martin's worked example"
    )
    density: float = param(
        particulars.SEA_WATER, low=1.0, high=1500.0, unit="kg/m^3", words="density of the water"
    )
    speed: float = param(
        UNSET, low=-50.0, high=50.0, unit="m/s", words="approach speed", follows="speed_hold.speed"
    )
    sway: float = param(
        UNSET, low=-1e11, high=1e11, unit="N s/m", words="-Y_v", calibrates="damping", axis="sway"
    )
    sway_by_yaw: float = param(
        UNSET, low=-1e11, high=1e11, unit="N s", words="-Y_r", calibrates="damping"
    )
    yaw_by_sway: float = param(
        UNSET, low=-1e11, high=1e11, unit="N s", words="-N_v", calibrates="damping"
    )
    yaw: float = param(
        UNSET, low=-1e13, high=1e13, unit="N m s", words="-N_r", calibrates="damping", axis="yaw"
    )
    yaw_by_heel: float = param(
        UNSET, low=-1e13, high=1e13, unit="N m", words="N_phi", calibrates="damping", axis="roll"
    )
    below: float = param(
        UNSET, low=-100.0, high=100.0, unit="m", words="depth of the sway force, z_H", axis="roll"
    )
    arm: float = param(
        UNSET,
        low=-100.0,
        high=100.0,
        unit="m",
        words="roll moment per force that accelerates the hull in sway",
    )
    mass: float = param(
        UNSET, low=0.0, high=1e9, unit="kg", words="mass of the vessel", follows="vessel.body.mass"
    )

    def derived_parameters(self, vessel: Boat) -> dict[str, float]:
        """Return default derivatives and levers of a linear hull, estimated by published formulas.

        They follow from the size, approach speed and added mass of the vessel.

        Args:
            vessel: Vessel with length, beam, draught [m], body and an `added_mass`.

        Returns:
            `sway` [N s/m], `sway_by_yaw`, `yaw_by_sway` [N s], `yaw` [N m s], `yaw_by_heel` [N m],
            `below`, `arm` [m].

        Raises:
            BadInput: The vessel has no added mass.
        """
        L, T = vessel.length, vessel.draught
        m_x, m_y, sway_below = (
            self.inherited_value(f"added_mass.{key}", vessel)
            for key in ("surge", "sway", "sway_below")
        )
        d = particulars.linear_derivatives(L, vessel.beam, T, self.trim, self.block)
        # x: midship seen from the mass centre
        q = 0.5 * self.density * L * T * self.speed
        x = -self.ahead
        below = self.above_keel - 0.5 * T
        return {
            "sway": -q * d.sway_by_sway,
            "sway_by_yaw": -q * L * d.sway_by_yaw
            + m_x * self.speed,  # m_x V: Coriolis force of the water
            "yaw_by_sway": -q * (L * d.yaw_by_sway + d.sway_by_sway * x),
            "yaw": -q * L * (L * d.yaw_by_yaw + d.sway_by_yaw * x),
            "yaw_by_heel": q * L * self.speed * self.heel_to_yaw,
            "below": below,
            "arm": 0.0 if sway_below else below * m_y / (vessel.body.mass + m_y),
        }
