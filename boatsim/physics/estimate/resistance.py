"""Resistance ahead, from the speed at full thrust if known, else from friction and wave making."""

from math import log10, sqrt

from boatsim.physics.estimate.base import DENSITY, VISCOSITY, Estimate, HullParticulars
from boatsim.physics.estimate.thrust import LEFT
from boatsim.physics.particulars import GRAVITY

SERVICE = 0.3  # Froude number of the service speed, at which wave making begins
FORM = 0.2  # form factor k on the friction of a flat plate, ITTC 1978 method
# residuary resistance coefficient at that speed: M. Insel, A. F. Molland 1992, slender hulls
WAVES = 4e-3
# part of it that goes with the first power; friction of a long hull with the 1.85th
LINEAR = 0.5
LINEAR_SLENDER = 0.1


def service_speed(hull: HullParticulars) -> float:
    """Return the assumed speed of a boat [m/s] at which speed-dependent coefficients are estimated.

    Args:
        hull: Hull with its main particulars.
    """
    return SERVICE * sqrt(GRAVITY * hull.length)


def wetted_surface(hull: HullParticulars) -> float:
    """Estimate the wetted surface of all hulls [m^2] by Denny and Mumford, 1.7 L T + V / T.

    Args:
        hull: Hull with its main particulars.
    """
    return hull.hulls * 1.7 * hull.length * hull.draught + hull.mass / DENSITY / hull.draught


def service_resistance(hull: HullParticulars) -> Estimate:
    """Estimate the resistance of a boat at its service speed [N] from friction and wave making.

    Args:
        hull: Hull with its main particulars.
    """
    speed = service_speed(hull)
    friction = 0.075 / (log10(speed * hull.length / VISCOSITY) - 2.0) ** 2
    total = (1.0 + FORM) * friction + WAVES
    rule = f"ITTC 1957 friction x {1.0 + FORM:g} + {WAVES:g} of waves, on 1.7 L T + V / T"
    return Estimate(0.5 * DENSITY * wetted_surface(hull) * total * speed * speed, rule)


def surge_damping(
    hull: HullParticulars, thrust: float | None, top_speed: float | None
) -> tuple[Estimate, Estimate]:
    """Estimate linear [N s/m] and quadratic [N s^2/m^2] surge damping of a boat.

    Their sum is the resistance at the speed reached with full thrust if both are known, else that
    at the service speed.

    Args:
        hull: Hull with its main particulars.
        thrust: Full thrust at rest [N], or None.
        top_speed: Speed reached with full thrust [m/s], or None.
    """
    if thrust is not None and top_speed is not None:
        force = LEFT * thrust
        speed = top_speed
        rule = f"{LEFT:g} of full thrust at the top speed stated"
    else:
        (force, rule), speed = service_resistance(hull), service_speed(hull)
        rule = f"{rule} at {speed:.3g} m/s"
    part = LINEAR_SLENDER if hull.is_slender else LINEAR
    return (
        Estimate(part * force / speed, f"{part:g} of {force:.3g} N at {speed:.3g} m/s: {rule}"),
        Estimate((1.0 - part) * force / speed**2, "the rest of it"),
    )
