"""What a water jet gives at a throttle, and the throttle for what it is to give."""

from math import sqrt

from boatsim.control.allocation import within
from boatsim.physics.kernel.compiling import lean

JET_Q2 = 154.9  # [m^2/s^3] printed 164.5, with which the power jumps at throttle 4


@lean
def power_of(throttle: float, q2: float) -> float:
    """Shaft power per mass [m^2/s^3] of a water jet at a throttle, 1 idle to 7 full; thrust is power / speed.

    Svendsen et al., IFAC MCMC 2012, eq. 10 and Table 2, with the printed s_i taken as the coefficients of throttle^i.
    """
    if throttle < 2.0:
        return 12.10 * throttle - 11.30
    if throttle < 4.0:
        return -21.1 - 20.0 * throttle + 18.5 * throttle * throttle
    return 10.00 * throttle + q2


@lean
def throttle_of(power: float, q2: float) -> float:
    """Throttle of a power, within idle and full."""
    if power < 12.90:  # at 2
        return max((power + 11.30) / 12.10, 1.0)
    if power < 194.9:  # at 4
        return (20.0 + sqrt(400.0 + 74.0 * (power + 21.1))) / 37.0
    return within(0.1 * (power - q2), 4.0, 7.0)
