"""One axis of an L1 adaptive controller, compiled: predictor, piecewise-constant adaptation, low-pass.

The form is that of Hovakimyan and Cao, L1 Adaptive Control Theory (SIAM 2010), section 3.3, for one state:
x' = -pole x + (applied + sigma) / inertia, with sigma all that the predictor does not know.
"""

from math import exp
from typing import Any

from boatsim.control.compiled import record
from boatsim.physics.kernel.compiling import merged

AXIS = record("predicted", "sigma", "filtered", "model")


@merged
def missing(
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
    """Force or moment that the axis feels beside the one `applied` over the last period, low-passed.

    At the first step nothing has `acted`. `a.model` is the motion asked for: x' = -pole (x - reference). A lasting
    disturbance shows in `a.sigma` with the factor e^{-aT} only, so it is divided out.
    """
    decay = exp(-pole * period)
    gain = (1.0 - decay) / (pole * inertia)
    if acted:
        a.predicted = decay * a.predicted + gain * (applied + a.sigma)
    a.model += (1.0 - decay) * (reference - a.model)
    a.sigma = -(a.predicted - measured) * decay / gain
    a.filtered += (1.0 - exp(-bandwidth * period)) * (a.sigma / decay - a.filtered)
    return a.filtered
