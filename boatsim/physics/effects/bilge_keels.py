"""Bilge keels: roll damping by the drag of a plate along each bilge."""

from dataclasses import dataclass
from math import hypot, pi, sqrt
from typing import Any, ClassVar

from numba import njit

from boatsim.physics import particulars
from boatsim.physics.base import UNSET, Boat, Force, Wrench, param, wrench

FLAT_PLATE = 2.4  # drag coefficient at a large amplitude (Ikeda et al. 1978)
# of the part 22.5 / pi breadth / (arm amplitude) of the coefficient (Ikeda et al. 1978)
SMALL_AMPLITUDE = 22.5


@njit(inline="always")
def law(m: Any, q: Any) -> Wrench:
    """Return the roll damping moment by the drag of both bilge keels.

    The drag coefficient is 2.4 + (22.5 / pi) breadth / (arm amplitude flow). Its second part is
    proportional to 1 / amplitude and so acts as a linear damping at the roll frequency.

    Args:
        m: Motion of the hull: velocities [m/s], rates [rad/s], position [m], attitude [rad].
        q: Parameters of the effect, with the names and units of its class.

    Returns:
        Force [N] and moment [N m] in body axes.
    """
    reach = q.density * q.length * q.breadth * q.arm * q.arm * q.flow
    linear = 8.0 / (3.0 * pi) * SMALL_AMPLITUDE / pi * reach * q.breadth * q.frequency
    quadratic = FLAT_PLATE * reach * q.arm * q.flow
    return wrench(K=-(linear + quadratic * abs(m.p)) * m.p)


@dataclass(frozen=True)
class BilgeKeels(Force):
    """Normal force of a pair of bilge keels, without their effect on the pressure on the hull.

    K = -(B1 + B2 |p|) p
    B2 = 2.4 rho length breadth arm^3 flow^2
    B1 = 8 / (3 pi) (22.5 / pi) rho length breadth^2 arm^2 flow omega

    `breadth`, `length` [m] are those of one keel, `arm` [m] its distance from the roll axis, `flow`
    the ratio of the water speed at the bilge to that of the keel, omega the `frequency` of roll
    [rad/s].
    """

    formula: ClassVar[str] = (
        r"\begin{aligned} K &= -\left(B_1 + B_2 |p|\right) p \\ B_1 &= \frac{8}{3 \pi} \, "
        r"\frac{22.5}{\pi} \, \rho \, l \, b^2 a^2 f \, \omega, \quad B_2 = 2.4 \, \rho "
        r"\, l \, b \, a^3 f^2 \end{aligned}"
    )
    symbols: ClassVar = {
        "breadth": "b",
        "length": "l",
        "arm": "a",
        "flow": "f",
        "frequency": r"\omega",
        "density": r"\rho",
    }
    confounded_with: ClassVar = ("quadratic_damping",)
    ruled_out_by: ClassVar = {"no_water": (True,)}
    words: ClassVar[str] = "bilge keels damp the roll, the more the larger its amplitude"
    shown_by: ClassVar[str] = "a roll decay from a large heel"
    source: ClassVar[str] = (
        "Y. Ikeda, Y. Himeno, N. Tanaka 1978, in ITTC Recommended Procedure 7.5-02-07-04.5, "
        "Estimation of Roll Damping"
    )
    law: ClassVar = law
    starts: ClassVar = ({"breadth": 0.01}, {"breadth": 0.04})

    breadth: float = param(
        0.0,
        low=0.0,
        high=3.0,
        unit="m",
        words="breadth of a keel",
        fit=True,
        spread=0.02,
        axis="roll",
    )
    length: float = param(
        UNSET,
        low=0.0,
        high=300.0,
        unit="m",
        words="length of a keel; default: 0.3 of the vessel's length",
    )
    arm: float = param(
        UNSET,
        low=0.0,
        high=60.0,
        unit="m",
        words="distance from the roll axis; default: 0.8 of the half diagonal of the section",
    )
    flow: float = param(
        1.0,
        low=0.5,
        high=2.0,
        unit="",
        words="speed of the water at the bilge over that of the keel",
    )
    frequency: float = param(
        UNSET,
        low=0.0,
        high=50.0,
        unit="rad/s",
        words="roll frequency; default: the undamped frequency of the vessel",
    )
    density: float = param(
        particulars.SEA_WATER, low=1.0, high=1500.0, unit="kg/m^3", words="density of the water"
    )

    def derived_parameters(self, vessel: Boat) -> dict[str, float]:
        """Return default length, lever arm and roll frequency of bilge keels from the vessel data.

        Args:
            vessel: Vessel with length, beam, draught [m] and body.

        Returns:
            `length` [m], `arm` [m] and `frequency` [rad/s].
        """
        arm = 0.8 * hypot(0.5 * vessel.beam, vessel.draught)
        return {"length": 0.3 * vessel.length, "arm": arm, "frequency": _roll_frequency(vessel)}


def _roll_frequency(vessel: Boat) -> float:
    """Return the undamped roll frequency [rad/s]; 0 for a vessel without a righting arm."""
    stiffness = getattr(vessel.effect("righting_arm"), "stiffness", 0.0)
    return sqrt(
        stiffness / (vessel.body.roll_inertia + getattr(vessel.effect("added_mass"), "roll", 0.0))
    )
