"""Number of the last sample of a sensor with a fixed rate."""

from math import floor

EXACT = 1e-9  # of a sample: times of control steps are sums of floating-point numbers


def sample_number(t: float, rate: float) -> int:
    """Return the number of the last sample; number 0 is at t = 0.

    Args:
        t: Time [s].
        rate: Samples per second [Hz].
    """
    return floor(t * rate + EXACT)
