"""Feedback loops of a sampled controller about steady motions, for stability margins on a vessel.

A controller describes in `operating_points` the steady motions at which its loops are analysed. A
loop leads from a measured velocity (and heading) through the control law to a force or moment, and
through the control allocation to commands. The vessel closes it: its actuators, lags, delays and
hull are linearised by the analysis.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from math import exp
from types import SimpleNamespace

import numpy as np

from boatsim.control.adaptive import Complex

PULSE = 1.0  # [s] length of the set-point pulse that excites a loop; below the motions' time scale
Slopes = Callable[[Mapping[str, float]], Mapping[str, float]]
# of z: response of the output to position, to velocity and to the force that was applied
SampledLaw = Callable[[Complex], tuple[Complex, Complex, Complex]]
# of the state (advanced in place), the measured velocity, the force that was applied over the last
# period, and the set point of the velocity: the force or moment of the next period
AxisLaw = Callable[[SimpleNamespace, float, float, float], float]


@dataclass(frozen=True)
class FeedbackLoop:
    """Feedback of one velocity: the control law and how its output changes the commands.

    The output is a force or moment: -(position response x position + velocity response x velocity)
    + applied response x nominal force of the commands. The position of the velocity r is the
    heading; the others have none. Slopes are taken at the commands of the steady motion.
    """

    measured: str  # velocity: "u", "v" or "r"
    axis: str  # of the output: "X", "Y" or "N"
    law: SampledLaw
    command_slopes: Slopes  # channel -> change of the command per unit of output
    wrench_slopes: Slopes  # axis -> change of the nominal force or moment per unit of output


@dataclass(frozen=True)
class OperatingPoint:
    """Steady motion at which the loops of a controller are analysed, all closed at once."""

    name: str
    loops: tuple[FeedbackLoop, ...]
    goal: Mapping[str, float]  # set points of the steady motion
    # change of the set points over one pulse, which excites the loops in a simulation
    pulse: Mapping[str, float]
    unmeasured: tuple[str, ...] = ()  # sensor readings that are missing
    settle: float = 60.0  # [s] after which the motion is steady
    pulse_length: float = PULSE  # [s]


def sampled_l1_law(
    pole: float, inertia: float, bandwidth: float, heading_gain: float, period: float
) -> SampledLaw:
    """Return the response of an L1 law with piecewise-constant adaptation, in z = e^(sT).

    It is exact for `filtered_disturbance`: the output is I pole x_ref - F(z) sigma with the
    estimate sigma = (x - e^(-aT) x / z) / gain - applied / z. The heading is the sum of the
    measured rates.

    Args:
        pole: Pole of the predictor [1/s].
        inertia: Assumed mass or inertia.
        bandwidth: Bandwidth of the low-pass filter [rad/s].
        heading_gain: Demanded rate per heading error [1/s].
        period: Sample time [s].
    """
    decay, smoothing = exp(-pole * period), 1.0 - exp(-bandwidth * period)
    gain = (1.0 - decay) / (pole * inertia)

    def response(z: Complex) -> tuple[Complex, Complex, Complex]:
        low_pass = smoothing / (1.0 - (1.0 - smoothing) / z)
        heading = period / (1.0 - 1.0 / z)
        output = inertia * pole * heading_gain * heading + low_pass * (1.0 - decay / z) / gain
        return np.zeros_like(z), output, low_pass / z

    return response


def sampled_pid_law(kp: float, ki: float, kd: float, inertia: float, period: float) -> SampledLaw:
    """Return the response of a sampled PID on the sum of the measured velocity, in z = e^(sT).

    Args:
        kp: Gain of the sum [1/s^2].
        ki: Gain of the sum's integral [1/s^3].
        kd: Gain of the velocity [1/s].
        inertia: Assumed mass or inertia, by which the gains are multiplied.
        period: Sample time [s].
    """

    def response(z: Complex) -> tuple[Complex, Complex, Complex]:
        total = period / (1.0 - 1.0 / z)
        nothing = np.zeros_like(z)
        return nothing, inertia * ((kp + ki * total) * total + kd), nothing

    return response


def sampled_linear_law(
    step: AxisLaw, names: Sequence[str], heading_gain: float, period: float
) -> SampledLaw:
    """Return the response of a linear law of one axis, in z = e^(sT), from its own steps.

    The law is evaluated at unit values of its state and inputs, which gives its state-space model.
    Its set point is the demanded rate, -heading gain x the sum of the measured rates.

    Args:
        step: The law, linear near zero and after its first step.
        names: Names of the numbers of its state.
        heading_gain: Demanded rate per heading error [1/s]; 0 for a speed.
        period: Sample time [s].
    """
    count = len(names)
    columns = []
    for unit in np.eye(count + 3).tolist():
        state = SimpleNamespace(**dict(zip(names, unit[:count], strict=True)))
        output = step(state, *unit[count:])
        columns.append([*(getattr(state, name) for name in names), output])
    table = np.array(columns, dtype=float).T
    a, b, c, d = table[:-1, :count], table[:-1, count:], table[-1, :count], table[-1, count:]

    def response(z: Complex) -> tuple[Complex, Complex, Complex]:
        states = np.linalg.solve(z[:, None, None] * np.eye(count) - a, b.astype(complex))
        measured, applied, wanted = (c @ states + d).T
        heading = period / (1.0 - 1.0 / z)
        return np.zeros_like(z), heading_gain * heading * wanted - measured, applied / z

    return response
