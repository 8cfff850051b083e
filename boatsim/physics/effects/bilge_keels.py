"""Bilge keels: a plate along each bilge that moves across the water when the hull rolls."""

from dataclasses import dataclass
from math import hypot, pi, sqrt
from typing import Any, ClassVar

from numba import njit

from boatsim.physics import particulars
from boatsim.physics.base import UNSET, Boat, Force, Wrench, param, wrench

FLAT_PLATE = 2.4  # drag coefficient at a large swing (Ikeda)
SMALL_SWING = 22.5  # grows with breadth per swing: 22.5 / pi breadth / (arm amplitude)


@njit(inline="always")
def law(m: Any, q: Any) -> Wrench:
    """Drag of both keels, whose coefficient is 2.4 + 22.5 / pi breadth / (arm amplitude flow).

    The second part is in proportion to 1 / amplitude, so it is a linear damping at the frequency of roll.
    """
    reach = q.density * q.length * q.breadth * q.arm * q.arm * q.flow
    linear = 8.0 / (3.0 * pi) * SMALL_SWING / pi * reach * q.breadth * q.frequency
    quadratic = FLAT_PLATE * reach * q.arm * q.flow
    return wrench(K=-(linear + quadratic * abs(m.p)) * m.p)


@dataclass(frozen=True)
class BilgeKeels(Force):
    """Normal force of a pair of bilge keels, without what they change in the pressure on the hull."""

    told_by: ClassVar = ("quadratic_damping",)
    words: ClassVar[str] = "bilge keels damp the roll, more so when it is large"
    shown_by: ClassVar[str] = "a roll decay from a large heel"
    source: ClassVar[str] = (
        "Y. Ikeda, Y. Himeno, N. Tanaka 1978, in ITTC Recommended Procedure 7.5-02-07-04.5, Estimation of Roll Damping"
    )
    law: ClassVar = law
    starts: ClassVar = ({"breadth": 0.01}, {"breadth": 0.04})

    breadth: float = param(
        0.0, low=0.0, high=3.0, unit="m", words="of a keel", fit=True, spread=0.02, axis="roll"
    )
    length: float = param(
        UNSET, low=0.0, high=300.0, unit="m", words="of a keel; if not given, 0.3 of the vessel's"
    )
    arm: float = param(
        UNSET,
        low=0.0,
        high=60.0,
        unit="m",
        words="from the roll axis; if not given, 0.8 of that to the hull's corner",
    )
    flow: float = param(
        1.0,
        low=0.5,
        high=2.0,
        unit="",
        words="speed of the water at the bilge per that of the keel",
    )
    frequency: float = param(
        UNSET, low=0.0, high=50.0, unit="rad/s", words="of roll; if not given, the vessel's own"
    )
    density: float = param(
        particulars.SEA_WATER, low=1.0, high=1500.0, unit="kg/m^3", words="of the water"
    )

    def rules(self, vessel: Boat) -> dict[str, float]:
        """What is not given, from the vessel's size, righting arm and inertia."""
        arm = 0.8 * hypot(0.5 * vessel.beam, vessel.draught)
        return {"length": 0.3 * vessel.length, "arm": arm, "frequency": _frequency(vessel)}


def _frequency(vessel: Boat) -> float:
    """Undamped frequency of roll [rad/s], 0 for a vessel that has no righting arm."""
    stiffness = getattr(vessel.effect("righting_arm"), "stiffness", 0.0)
    return sqrt(
        stiffness / (vessel.body.roll_inertia + getattr(vessel.effect("added_mass"), "roll", 0.0))
    )
