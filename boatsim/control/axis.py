"""One axis of an L1 adaptive controller with piecewise-constant adaptation, compiled.

After Hovakimyan and Cao, L1 Adaptive Control Theory (SIAM 2010), section 3.3, for one state: x' =
-pole x + (applied + sigma) / inertia with the lumped uncertainty sigma.
"""

from math import exp
from typing import Any

from boatsim.control.compiled import record_type
from boatsim.physics.kernel.compiling import merged

AXIS = record_type("predicted", "sigma", "filtered", "model")


@merged
def filtered_disturbance(
    a: Any,
    measured: float,
    applied: float,
    acted: bool,
    reference: float,
    pole: float,
    inertia: float,
    bandwidth: float,
    period: float,
) -> float:
    """Return the estimated disturbance force or moment on one axis of a boat, low-pass filtered.

    It acts in addition to the applied force. `a.model` is the reference model x' = -pole (x -
    reference). A constant disturbance appears in `a.sigma` multiplied by e^(-aT), so it is divided
    by that factor.

    Args:
        a: `AXIS` record, advanced in place.
        measured: Measured velocity [m/s or rad/s].
        applied: Force or moment applied over the last period [N or N m].
        acted: False in the first step, before anything was applied.
        reference: Demanded velocity.
        pole: Pole of the predictor [1/s].
        inertia: Assumed mass or inertia [kg or kg m^2].
        bandwidth: Bandwidth of the low-pass filter [rad/s].
        period: Length of the period [s].
    """
    decay = exp(-pole * period)
    gain = (1.0 - decay) / (pole * inertia)
    if acted:
        a.predicted = decay * a.predicted + gain * (applied + a.sigma)
    a.model += (1.0 - decay) * (reference - a.model)
    a.sigma = -(a.predicted - measured) * decay / gain
    a.filtered += (1.0 - exp(-bandwidth * period)) * (a.sigma / decay - a.filtered)
    return a.filtered
