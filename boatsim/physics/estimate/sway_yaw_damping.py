"""Sway and yaw damping: lift proportional to the forward speed, linear damping at rest, drag."""

from math import pi, sqrt
from typing import NamedTuple

from boatsim.physics.estimate import added_mass, inertia, resistance
from boatsim.physics.estimate.base import DENSITY, Estimate, HullParticulars

SECOND = 2.0  # [m] length of the boat whose sway and yaw die out in 1 s, the Otter (MSS otter.m)
# [lengths] ahead of the middle: that of a slender body is -0.5, at its stern; a real one leaves
# earlier
LIFT_AT = -0.3
SLOW = 0.1  # of a slender hull's lift at an easy speed, at rest: friction and keel, as in surge
# drag coefficient of a section across the flow: 0.85 by Hoerner's curve for a pontoon of the Otter
# without load, which has 0.93 beams per two draughts (MSS Hoerner.m)
SECTION = 0.8


class ClarkeDerivatives(NamedTuple):
    """Linear sway and yaw derivatives by Clarke's regression, each divided by the forward speed.

    They are positive for damping and contain the Munk moment.
    """

    sway: float  # [N s^2/m^2] -Y_uv
    yaw: float  # [N s^2] -N_ur
    sway_by_yaw: float  # [N s^2/m] -Y_ur
    yaw_by_sway: float  # [N s^2/m] -N_uv


class LiftDerivatives(NamedTuple):
    """Hull lift at forward speed: side force per local drift angle, and the remaining yaw damping.

    Both are proportional to the forward speed.
    """

    sway: Estimate  # [N s^2/m^2]
    at: Estimate  # [m] ahead of the middle
    yaw: Estimate  # [N s^2]


def clarke_derivatives(hull: HullParticulars) -> ClarkeDerivatives:
    """Estimate the linear sway and yaw derivatives of a boat by Clarke's regression over ships.

    They are those of all hulls, without the Coriolis force of the rigid body.

    Args:
        hull: Hull with its main particulars.
    """
    L, T = hull.length, hull.draught
    wide, deep = hull.breadth / L, hull.breadth / T
    scale = hull.hulls * pi * (T / L) ** 2 * 0.5 * DENSITY * L**2
    return ClarkeDerivatives(
        scale * (1.0 + 0.4 * hull.block_coefficient * deep),
        scale * L * L * max(0.25 + 0.039 * deep - 0.56 * wide, 0.05),
        scale * L * (-0.5 + 2.2 * wide - 0.08 * deep),
        scale * L * (0.5 + 2.4 * T / L),
    )


def lift_derivatives(hull: HullParticulars) -> LiftDerivatives:
    """Estimate the lift forces on a hull in sway and yaw, per forward speed.

    For a slender hull they are Clarke's less the Munk moment, else those of a low-aspect wing.

    Args:
        hull: Hull with its main particulars.
    """
    if not hull.is_slender:
        force = hull.hulls * 0.5 * pi * DENSITY * hull.draught**2
        return LiftDerivatives(
            Estimate(force, "0.5 pi rho T^2, R. T. Jones 1946: a wing of low aspect"),
            Estimate(LIFT_AT * hull.length, f"{LIFT_AT:g} lengths; -0.5 of a slender body"),
            Estimate(0.0, "that at its place resists turning"),
        )
    whole, rule = clarke_derivatives(hull), added_mass.CLARKE
    munk = added_mass.sway_added_mass(hull).value - added_mass.surge_added_mass(hull).value
    at = (whole.yaw_by_sway - munk) / whole.sway
    return LiftDerivatives(
        Estimate(whole.sway, rule),
        Estimate(at, f"{rule}, less the Munk moment"),
        Estimate(
            max(whole.yaw - whole.sway * at * at, 0.0),
            f"{rule}, less that of the force at its place",
        ),
    )


def damping_at_rest(hull: HullParticulars) -> tuple[Estimate, Estimate]:
    """Estimate the linear damping in sway [N s/m] and yaw [N m s] of a boat without forward speed.

    Sway and yaw decay with a time constant of 1 s for a boat of 2 m, scaled by Froude's law; much
    more slowly for slender hulls.

    Args:
        hull: Hull with its main particulars.
    """
    if hull.is_slender:
        speed, own = resistance.service_speed(hull), lift_derivatives(hull)
        turning = own.yaw.value + own.sway.value * own.at.value**2
        rule = f"{SLOW:g} of the lift at an easy {speed:.3g} m/s"
        return Estimate(SLOW * speed * own.sway.value, rule), Estimate(SLOW * speed * turning, rule)
    time = sqrt(hull.length / SECOND)
    rule = (
        f"mass with that of the water / {time:.3g} s, "
        f"which is 1 s on a boat of {SECOND:g} m (MSS otter.m)"
    )
    return (
        Estimate((hull.mass + added_mass.sway_added_mass(hull).value) / time, rule),
        Estimate(
            (inertia.yaw_inertia(hull).value + added_mass.yaw_added_mass(hull).value) / time, rule
        ),
    )


def section_drag_coefficient() -> Estimate:
    """Return the assumed cross-flow drag coefficient of hull sections."""
    return Estimate(SECTION, "Otter 0.85 (MSS Hoerner.m); S. F. Hoerner, Fluid-Dynamic Drag, 1965")
