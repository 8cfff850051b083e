"""How the filter takes one measurement at a time; compiled once for all vessels, which differ in the size n."""

from math import log, sqrt

from boatsim.physics.kernel.compiling import lean
from boatsim.physics.signals import Array

# [sd] a measurement further off is taken for an outlier: its pull falls with its distance, its
# penalty grows with the
# logarithm (as of a Cauchy distribution), neither with a jump at which a fit would get stuck
GATE = 5.0
# outliers of one channel; a further one means that the filter has lost track and must follow
IN_A_ROW = 2


@lean
def weigh(
    P: Array, row: Array, noise: float, gain: Array, Ph: Array, n: int, ny: int, own: int
) -> float:
    """Gain (n,) of one measurement and P row' (n,), in place; returns the inverse sd of its prediction error.

    A measurement shows the motion, the first `ny` entries of its `row`, and the state `own`, its instrument's wandering
    error; -1: it has none.
    """
    variance = noise
    for a in range(n):
        Ph[a] = 0.0
    for b in range(ny):
        if row[b] != 0.0:
            for a in range(n):
                Ph[a] += P[b, a] * row[b]
    if own >= 0:
        for a in range(n):
            Ph[a] += P[own, a]
        variance += Ph[own]
    for b in range(ny):
        variance += row[b] * Ph[b]
    for a in range(n):
        gain[a] = Ph[a] / variance
    return float(1.0 / sqrt(variance))


@lean
def take(
    error: float,
    row: Array,
    noise: float,
    full: bool,
    outliers: Array,
    z: Array,
    P: Array,
    Ph: Array,
    n: int,
    ny: int,
    own: int,
    gain: Array,
    scale: Array,
    white: Array,
) -> float:
    """Correct z by one measurement, and P if `full`; returns what it adds to the log likelihood.

    Of `outliers`, `scale` and `white` the first entry belongs to the measurement's channel.
    """
    likelihood = 0.0
    if full:
        scale[0] = weigh(P, row, noise, gain, Ph, n, ny, own)
        likelihood += log(scale[0])
        far = abs(error) * scale[0] > GATE and outliers[0] < IN_A_ROW
        outliers[0] = outliers[0] + 1.0 if far else 0.0
        if far:
            share = GATE / (abs(error) * scale[0])
            likelihood += GATE * GATE * log(share)
            scale[0] *= share
            for a in range(n):
                gain[a] *= share * share
    white[0] = error * scale[0]
    for a in range(n):
        z[a] += gain[a] * error
    if full:
        for a in range(n):
            for b in range(n):
                P[a, b] -= gain[a] * Ph[b]
    return float(likelihood - 0.5 * white[0] ** 2)
