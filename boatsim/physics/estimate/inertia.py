"""Moments of inertia of the rigid boat from radii of gyration."""

from boatsim.physics.estimate.base import Estimate, HullParticulars

YAW = 0.25  # of the length; T. I. Fossen 2021, MSS otter.m; ITTC 7.5-02-07-02.1 has 0.25 L_pp
ROLL = 0.4  # of the beam; same sources have 0.35 to 0.40


def yaw_inertia(hull: HullParticulars) -> Estimate:
    """Estimate the yaw moment of inertia of a boat about its mass centre [kg m^2].

    Args:
        hull: Hull with its main particulars.
    """
    value = hull.mass * (YAW * hull.length) ** 2
    return Estimate(value, f"mass x ({YAW:g} L)^2, ITTC 7.5-02-07-02.1")


def roll_inertia(hull: HullParticulars) -> Estimate:
    """Estimate the roll moment of inertia of a boat about its mass centre [kg m^2].

    Args:
        hull: Hull with its main particulars.
    """
    return Estimate(
        hull.mass * (ROLL * hull.beam) ** 2, f"mass x ({ROLL:g} B)^2, ITTC 7.5-02-07-02.1"
    )
