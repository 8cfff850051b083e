"""Cosine and sine of actuators that are angles."""

from math import cos, factorial, pi, sin
from typing import Any

from boatsim.physics.kernel.compiling import merged
from boatsim.physics.signals import Array, SignalSegment

SMALL = pi / 4.0  # [rad] largest angle of which the series are summed
# Coefficients of the Taylor series of cosine and sine. The terms that are left out are smaller than
# 2e-18 for small angles, a fiftieth of the spacing of floating-point numbers there.
C2, C4, C6, C8 = 1 / 2, 1 / factorial(4), -1 / factorial(6), 1 / factorial(8)
C10, C12, C14, C16 = -1 / factorial(10), 1 / factorial(12), -1 / factorial(14), 1 / factorial(16)
S3, S5, S7, S9 = -1 / 6, 1 / factorial(5), -1 / factorial(7), 1 / factorial(9)
S11, S13, S15, S17 = -1 / factorial(11), 1 / factorial(13), -1 / factorial(15), 1 / factorial(17)


@merged
def cosine_and_sine(x: float) -> tuple[float, float]:
    """Return the cosine and the sine of an angle x [rad], with errors of about 1e-16.

    For small angles the Taylor series are summed, in pairs of terms that a processor computes side
    by side, which is faster than a call of the C library.
    """
    if abs(x) > SMALL:
        return cos(x), sin(x)
    z = x * x
    z2 = z * z
    z4 = z2 * z2
    cosine = (C4 + z * C6) + z2 * (C8 + z * C10) + z4 * ((C12 + z * C14) + z2 * C16)
    sine = (S3 + z * S5) + z2 * (S7 + z * S9) + z4 * ((S11 + z * S13) + z2 * (S15 + z * S17))
    return 1.0 - (C2 * z - z2 * cosine), x + x * z * sine


@merged
def write_cosine_and_sine(
    x: SignalSegment, act: Array, held: Any, angle: int, cosine: int, sine: int
) -> None:
    """Write cosine and sine of an actuator's angle at three times of a step to act (3 held,).

    They take longer than the rest of an actuator and are not computed again for an angle that has
    not changed. The begin is the end of the step before, which act still holds; zeros in both mean
    that there was no step before.
    """
    last = 2 * held
    if act[last + angle] == x.begin and (act[last + cosine] != 0.0 or act[last + sine] != 0.0):
        act[cosine], act[sine] = act[last + cosine], act[last + sine]
    else:
        act[cosine], act[sine] = cosine_and_sine(x.begin)
    if x.middle == x.begin and x.end == x.begin:
        act[held + cosine], act[held + sine] = act[cosine], act[sine]
        act[last + cosine], act[last + sine] = act[cosine], act[sine]
    else:
        act[held + cosine], act[held + sine] = cosine_and_sine(x.middle)
        act[last + cosine], act[last + sine] = cosine_and_sine(x.end)
