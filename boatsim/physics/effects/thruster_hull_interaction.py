"""Thruster-hull interaction: a drive whose race strikes the hull gives less thrust."""

from dataclasses import dataclass
from math import hypot, pi
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import Boat, Force, Wrench, param, preset_effect
from boatsim.physics.drive_ranges import drive_ranges
from boatsim.physics.effects.thruster import thrust_wrench_at_mount

# A diagnosis tests the effect where a drive turns through more than this angle, 60 degrees to
# either side. The race of a drive that turns less always strikes the hull, or never does, or only
# astern, which a thrust gain and `weak_reverse` describe.
LEAST_SWEEP = 2.0 * pi / 3.0  # [rad]


@njit(inline="always")
def race_share_on_hull(s: Any, t: Any) -> float:
    """Return the squared cosine of the angle between a race and the direction to the hull's middle.

    It is 0 if the race points away from the hull, and for a drive mounted in the middle.

    Args:
        s: Signals of the thruster: thrust [N], cosine and sine of its angle.
        t: Parameters of the thruster, with its mount from the hull's middle [m].
    """
    distance = hypot(t.x, t.y)
    if distance == 0.0:
        return 0.0
    toward = (t.x * s.cos_angle + t.y * s.sin_angle) / distance
    if s.thrust < 0.0:
        toward = -toward
    return float(max(toward, 0.0) ** 2)


@njit(inline="always")
def law(m: Any, q: Any, s: Any, t: Any) -> Wrench:
    """Return the thrust that one thruster loses because its race strikes the hull.

    Args:
        m: Motion of the hull: velocities [m/s], rates [rad/s], position [m], attitude [rad].
        q: Parameters of the effect, with the names and units of its class.
        s: Signals of the thruster on which the effect acts.
        t: Parameters of that thruster.

    Returns:
        Force [N] and moment [N m] in body axes.
    """
    lost = q.loss * race_share_on_hull(s, t)
    return thrust_wrench_at_mount(-lost * t.gain * s.thrust, s, t)


@dataclass(frozen=True)
class ThrusterHullInteraction(Force):
    """Loss of thrust of a drive whose race is directed at the hull.

    T = T_0 (1 - loss max(0, cos gamma)^2)

    gamma is the angle between the race and the direction from the drive to the middle of the hull,
    for which the origin of motion is taken. A race strikes a hull more fully the more it is
    directed at its middle; the square is a simple assumption that makes the loss smooth where
    the race leaves the hull.
    """

    formula: ClassVar[str] = (
        r"\Delta T = -k \, T \max(0, \cos\gamma)^2, \quad \cos\gamma = "
        r"\operatorname{sgn}(T) \frac{x \cos\alpha + y \sin\alpha}{\sqrt{x^2 + y^2}}"
    )
    symbols: ClassVar = {"loss": "k"}
    words: ClassVar[str] = "drives give less thrust where their race strikes the hull"
    shown_by: ClassVar[str] = "a steered drive turned through all directions at constant thrust"
    per_instance_of: ClassVar[str] = "thruster"
    law: ClassVar = law

    loss: float = param(
        0.0,
        low=0.0,
        high=1.0,
        unit="",
        words="share of the thrust lost with the race directed at the hull's middle",
        fit=True,
        spread=0.2,
        in_per_cent="with its race directed at the hull's middle a drive loses {share} of its "
        "thrust",
    )

    def missing_for_test(self, vessel: Boat) -> str:
        """Return that no drive can turn its race toward the hull and away from it; else "".

        Args:
            vessel: Vessel on which the effect acts.
        """
        if all(drive.sweep <= LEAST_SWEEP for drive in drive_ranges(self, vessel)):
            return "no drive that turns more than 60 degrees to either side"
        return ""


DriveHullInteraction = preset_effect(
    ThrusterHullInteraction,
    "DriveHullInteraction",
    words="one drive alone gives less thrust where its race strikes the hull",
    shown_by="this drive turned through all directions at constant thrust",
    once_per="thruster",
    tried_last=True,
    of_all=("thruster_hull_interaction",),
    frees={
        "loss": {
            "words": "share of the thrust of this drive lost with the race directed at the hull's "
            "middle",
        },
    },
)
