"""Thruster interaction: a drive in the race of another one gives less thrust."""

from dataclasses import dataclass, replace
from math import atan2, exp, hypot, log, pi
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import UNSET, Boat, Force, Wrench, param, preset_effect
from boatsim.physics.debugging import python_function
from boatsim.physics.drive_ranges import DriveRange, drive_ranges
from boatsim.physics.effects.thruster import thrust_wrench_at_mount

# Propeller diameter over draught T of a bulk carrier or tanker, largest usual value: MAN Diesel &
# Turbo, Basic Principles of Ship Propulsion, 2011, chapter 2, not verified against its text. It
# lies among the regressions of H. O. Kristensen and M. Luetzen 2013, as in the function calcPropDia
# of a public R package: 0.395 T + 1.3 m for tankers and bulk carriers, which is 0.49 T at 13.6 m;
# 0.623 T - 0.16 m for container ships; 0.713 T - 0.08 m for others. That small boats are alike is
# an assumption.
DIAMETER_PER_DRAUGHT = 0.65
# Two drives at one depth are at least a diameter apart, or their blades would meet. The published
# ratio is zero for one place, so that nearer mounts count as one diameter apart.
LEAST_DIAMETERS = 1.0
# Smallest published loss for which a diagnosis tests the effect: less than a tenth of the thrust
# of one drive is within the usual uncertainty of its thrust.
LEAST_LOSS = 0.1
# Base of the ratio for two drives in line, and [deg^3] width of the race with a steering angle. The
# text of the paper was not available. Public code has the same numbers: the package
# pyMarineCybernetics the ratio in line, as that of the American Bureau of Shipping, and a
# manoeuvring model with three azimuth thrusters both of them.
BASE = 0.75
WIDTH = 130.0


@njit  # not inlined: a vessel with six drives has thirty calls, and would take longer to compile
def thrust_ratio(distance: float, angle: float) -> float:
    """Return the thrust of a drive in the race of another one over its thrust in open water.

    Args:
        distance: Distance from the other drive over the propeller diameter.
        angle: Angle between the race and the line from the other drive [rad], 0 to pi.
    """
    ratio = 1.0 - BASE ** (max(distance, LEAST_DIAMETERS) ** (2.0 / 3.0))
    steered = (ratio * angle * 180.0 / pi) ** 3
    return ratio + (1.0 - ratio) * steered / (WIDTH + steered)


@njit(inline="always")
def influence(q: Any, s: Any, t: Any, s2: Any, t2: Any) -> float:
    """Return by how much the race of one drive lowers the logarithm of the thrust of another.

    Args:
        q: Parameters of the effect, with the names and units of its class.
        s: Signals of the thruster that loses thrust.
        t: Parameters of that thruster.
        s2: Signals of the thruster whose race it is.
        t2: Parameters of that thruster.

    Returns:
        Logarithm of the published ratio, negated, times the weight of unequal thrust.
    """
    own, other = abs(t.gain * s.thrust), abs(t2.gain * s2.thrust)
    if own == 0.0 or other == 0.0:
        return 0.0
    x, y = t.x - t2.x, t.y - t2.y
    along = -(x * s2.cos_angle + y * s2.sin_angle)  # of the race of a thrust ahead
    if s2.thrust < 0.0:
        along = -along
    angle = atan2(abs(x * s2.sin_angle - y * s2.cos_angle), along)
    return -log(thrust_ratio(hypot(x, y) / q.diameter, angle)) * 2.0 * other / (own + other)


@njit(inline="always")
def law(m: Any, q: Any, s: Any, t: Any, total: float) -> Wrench:
    """Return the thrust that one thruster loses in the races of the others.

    Args:
        m: Motion of the hull: velocities [m/s], rates [rad/s], position [m], attitude [rad].
        q: Parameters of the effect, with the names and units of its class.
        s: Signals of the thruster on which the effect acts.
        t: Parameters of that thruster.
        total: Sum of the influences of the other thrusters.

    Returns:
        Force [N] and moment [N m] in body axes.
    """
    return thrust_wrench_at_mount(t.gain * s.thrust * (exp(-q.size * total) - 1.0), s, t)


@dataclass(frozen=True)
class ThrusterInteraction(Force):
    """Loss of thrust of a drive that works in the race of another one.

    T_i = T_i0 prod_j t_ij^(size w_ij),  w_ij = 2 |T_j| / (|T_i| + |T_j|)

    t = 1 - 0.75^((d / D)^(2/3)) is the published ratio for equal thrusts at the distance d. The
    angle phi [deg] between race and connecting line brings it to t + (1 - t) phi^3 / (130 / t^3 +
    phi^3). The weight w_ij is an assumption: it is 1 for equal thrusts and 0 if the other drive is
    idle, and it grows at equal thrusts with the square root of the ratio of the thrusts, like the
    speed of the race over that of the drive's own flow. The races of several drives multiply.
    """

    formula: ClassVar[str] = (
        r"\begin{aligned} \Delta T_i &= T_i \left(\prod_{j \ne i} t_{ij}^{k \, w_{ij}} - 1\right),"
        r" \quad w_{ij} = \frac{2 |T_j|}{|T_i| + |T_j|} \\ t_{ij} &= t + (1 - t) "
        r"\frac{\phi_{ij}^3}{130 / t^3 + \phi_{ij}^3}, \quad t = 1 - 0.75^{(d_{ij} / D)^{2/3}} "
        r"\end{aligned}"
    )
    symbols: ClassVar = {"size": "k", "diameter": "D"}
    ruled_out_by: ClassVar = {"no_water": (True,)}
    words: ClassVar[str] = "drives give less thrust in the race of another drive"
    shown_by: ClassVar[str] = "one drive alone, then with the race of another one turned on it"
    source: ClassVar[str] = (
        "J. Dang, H. Laheij, Hydrodynamic Aspects of Steerable Thrusters, Dynamic Positioning "
        "Conference 2004, section 5.2; the ratio in line as quoted for the American Bureau of "
        "Shipping in the open package pyMarineCybernetics"
    )
    per_instance_of: ClassVar[str] = "thruster"
    law: ClassVar = law
    influence: ClassVar = influence

    size: float = param(
        0.0,
        low=0.0,
        high=3.0,
        unit="",
        words="exponent of the published ratio; 1 as published, 0 no interaction",
        fit=True,
        spread=0.5,
    )
    diameter: float = param(
        UNSET,
        low=1e-3,
        high=20.0,
        unit="m",
        words="propeller diameter; 0.65 of the draught if omitted",
    )

    def derived_parameters(self, vessel: Boat) -> dict[str, float]:
        """Return the propeller diameter [m] that is usual for the vessel's draught.

        Args:
            vessel: Vessel on which the effect acts.
        """
        return {"diameter": DIAMETER_PER_DRAUGHT * vessel.draught}

    def missing_for_test(self, vessel: Boat) -> str:
        """Return that no drive can turn its race on another one, if so; else "".

        Args:
            vessel: Vessel on which the effect acts.
        """
        racing = replace(self, on=()) if type(self).influenced_by_all else self
        for name, drive in _named_ranges(self, vessel):
            for other_name, other in _named_ranges(racing, vessel):
                if name != other_name and largest_loss(drive, other, self.diameter) >= LEAST_LOSS:
                    return ""
        return "no drive that can work in the race of another one"


def _named_ranges(effect: Force, vessel: Boat) -> list[tuple[str, DriveRange]]:
    """Names and ranges of the drives on which an effect acts."""
    names = [drive.name for drive in vessel.host_effects(effect)]
    return list(zip(names, drive_ranges(effect, vessel), strict=True))


def largest_loss(drive: DriveRange, other: DriveRange, diameter: float) -> float:
    """Return the largest share of thrust that a drive can lose in the race of another one.

    Args:
        drive: Range of the drive that loses thrust.
        other: Range of the drive whose race it is.
        diameter: Propeller diameter [m].
    """
    x, y = drive.x - other.x, drive.y - other.y
    most = 0.0
    for forward, starboard in other.race_directions():
        across = abs(x * starboard - y * forward)
        angle = atan2(across, x * forward + y * starboard)
        ratio: float = python_function(thrust_ratio)(hypot(x, y) / diameter, angle)
        most = max(most, 1.0 - ratio)
    return most


DriveInteraction = preset_effect(
    ThrusterInteraction,
    "DriveInteraction",
    words="one drive alone gives less thrust in the race of another drive",
    shown_by="this drive alone, then with the race of another one turned on it",
    once_per="thruster",
    tried_last=True,
    of_all=("thruster_interaction",),
    influenced_by_all=True,
    frees={
        "size": {
            "words": "exponent of the published ratio for this drive; 1 as published, 0 no "
            "interaction",
        },
    },
)
