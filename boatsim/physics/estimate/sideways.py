"""What resists a hull in sway and yaw: derivatives for slender hulls, time constants and lift for others, drag."""

from math import pi, sqrt
from typing import NamedTuple

from boatsim.physics.estimate import added_mass, inertia
from boatsim.physics.estimate.base import DENSITY, Estimate, Hull

SECOND = 2.0  # [m] length of the boat whose sway and yaw die out in 1 s, the Otter (MSS otter.m)
LIFT_AT = -0.3  # [lengths] ahead of the middle: that of a slender body is -0.5, at its stern; a real one leaves earlier
SECTION = 0.8  # drag coefficient of a section across the flow: Otter 0.85, S. F. Hoerner 1965


class Derivatives(NamedTuple):
    """Linear damping in sway and yaw, positive where it resists."""

    sway: Estimate  # [N s/m] -Y_v
    yaw: Estimate  # [N m s] -N_r
    sway_by_yaw: Estimate | None  # [N s] -Y_r
    yaw_by_sway: Estimate | None  # [N s] -N_v


def by_speed(hull: Hull, speed: float) -> Derivatives:
    """Clarke's derivatives at a speed ahead [m/s], of all hulls; they hold the Munk moment."""
    L, T = hull.length, hull.draught
    wide, deep = hull.breadth / L, hull.breadth / T
    scale = hull.hulls * pi * (T / L) ** 2 * 0.5 * DENSITY * speed * L**2
    rule = f"{added_mass.CLARKE}, at {speed:.3g} m/s"
    return Derivatives(
        Estimate(scale * (1.0 + 0.4 * hull.block * deep), rule),
        Estimate(scale * L * L * max(0.25 + 0.039 * deep - 0.56 * wide, 0.05), rule),
        Estimate(scale * L * (-0.5 + 2.2 * wide - 0.08 * deep), rule),
        Estimate(scale * L * (0.5 + 2.4 * T / L), rule),
    )


def by_time(hull: Hull) -> Derivatives:
    """Sway and yaw that die out in 1 s on a boat of 2 m, by Froude's law on others."""
    time = sqrt(hull.length / SECOND)
    rule = f"mass with that of the water / {time:.3g} s, which is 1 s on a boat of {SECOND:g} m (MSS otter.m)"
    return Derivatives(
        Estimate((hull.mass + added_mass.sway(hull).value) / time, rule),
        Estimate((inertia.yaw(hull).value + added_mass.yaw(hull).value) / time, rule),
        None,
        None,
    )


def lift(hull: Hull) -> tuple[Estimate, Estimate]:
    """Side force per speed ahead and across [N s^2/m^2] of all hulls, and where it acts [m] ahead of the middle."""
    value = hull.hulls * 0.5 * pi * DENSITY * hull.draught**2
    return (
        Estimate(value, "0.5 pi rho T^2, R. T. Jones 1946: a wing of low aspect"),
        Estimate(LIFT_AT * hull.length, f"{LIFT_AT:g} lengths; -0.5 of a slender body"),
    )


def section_drag() -> Estimate:
    """Drag coefficient of the sections in cross flow."""
    return Estimate(SECTION, "Otter 0.85 (MSS otter.m); S. F. Hoerner, Fluid-Dynamic Drag, 1965")
