"""The filter's update by one measurement.

Compiled once for all vessels, which differ in the size of the state.
"""

from math import log, sqrt

from boatsim.physics.kernel.compiling import lean
from boatsim.physics.kernel.records import Measurement, MeasurementResults, StateEstimate
from boatsim.physics.signals import Array

# [sd] A measurement with a larger prediction error is an outlier. Its weight falls with the error
# and its penalty grows with the logarithm of the error, as of a Cauchy distribution. Both are
# continuous, so that a fit does not get stuck. Of normally distributed errors one in 1.7 million is
# larger than 5 sd.
GATE = 5.0
# Consecutive outliers of one channel. A further one means that the filter has diverged and must
# follow the measurements.
IN_A_ROW = 2
# Both influence a diagnosis but are no settings of it (`DiagnosisConfig`): they are compiled into
# the update, which all vessels, programs and callers share, and the thresholds of the diagnosis
# were chosen with them.


@lean
def kalman_gain(one: Measurement, estimate: StateEstimate, gain: Array, Ph: Array) -> float:
    """Compute the Kalman gain (n,) and P h' (n,) of one scalar measurement, in place.

    h is the measurement's row of the measurement matrix. Return the inverse sd of the prediction
    error.
    """
    row, n, ny, own = one.row, estimate.n, one.ny, one.own
    P, variance = estimate.P, one.variance
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
def update_by_measurement(
    one: Measurement, estimate: StateEstimate, gains: bool, channel: MeasurementResults, Ph: Array
) -> float:
    """Update a Kalman filter's state by one scalar measurement; return its log likelihood.

    The mean is corrected, and the covariance if `gains` is true. An outlier has a reduced weight.
    """
    z, P, n, error = estimate.z, estimate.P, estimate.n, one.error
    gain, scale, white, outliers = channel.gain, channel.scale, channel.white, channel.outliers
    likelihood = 0.0
    if gains:
        scale[0] = kalman_gain(one, estimate, gain, Ph)
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
    if gains:
        for a in range(n):
            for b in range(n):
                P[a, b] -= gain[a] * Ph[b]
    return float(likelihood - 0.5 * white[0] ** 2)
