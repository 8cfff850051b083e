"""Cosine and sine of actuators that are angles."""

from math import cos, sin
from typing import Any

from boatsim.physics.kernel.compiling import merged
from boatsim.physics.signals import Array, SignalSegment


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
        act[cosine], act[sine] = cos(x.begin), sin(x.begin)
    if x.middle == x.begin and x.end == x.begin:
        act[held + cosine], act[held + sine] = act[cosine], act[sine]
        act[last + cosine], act[last + sine] = act[cosine], act[sine]
    else:
        act[held + cosine], act[held + sine] = cos(x.middle), sin(x.middle)
        act[last + cosine], act[last + sine] = cos(x.end), sin(x.end)
