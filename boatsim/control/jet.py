"""Power curve of a water jet over the throttle, and its inverse."""

from math import sqrt

from boatsim.control.allocation import limit
from boatsim.physics.kernel.compiling import lean

JET_Q2 = 154.9  # [m^2/s^3] printed 164.5, with which the power jumps at throttle 4


@lean
def power_at_throttle(throttle: float, q2: float) -> float:
    """Return the shaft power of a water jet per mass of the craft [m^2/s^3] at a throttle.

    The thrust per mass is this power over the speed of the craft. Svendsen et al., IFAC MCMC 2012,
    equation 10 and Table 2, where the s_i of the table are the coefficients of throttle^i.

    Args:
        throttle: Throttle, 1 (idle) to 7 (full).
        q2: Constant of the law for throttle above 4 [m^2/s^3].
    """
    if throttle < 2.0:
        return 12.10 * throttle - 11.30
    if throttle < 4.0:
        return -21.1 - 20.0 * throttle + 18.5 * throttle * throttle
    return 10.00 * throttle + q2


@lean
def throttle_for_power(power: float, q2: float) -> float:
    """Return the throttle at which a water jet has a given shaft power, within idle and full.

    Args:
        power: Shaft power per mass [m^2/s^3].
        q2: Constant of the law for throttle above 4 [m^2/s^3].
    """
    if power < 12.90:  # at 2
        return max((power + 11.30) / 12.10, 1.0)
    if power < 194.9:  # at 4
        return (20.0 + sqrt(400.0 + 74.0 * (power + 21.1))) / 37.0
    return limit(0.1 * (power - q2), 4.0, 7.0)
