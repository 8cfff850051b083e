"""Heading control of a water-jet craft at low speed: PD, wave filter and discrete L1.

L. R. S. Theisen, R. Galeazzi, M. Blanke, IFAC CAMS 2013.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from math import cos, exp, nan, radians
from typing import ClassVar

import numpy as np

from boatsim.control.adaptive import Complex, DiscreteFilter, SampledLoop, zero_order_hold
from boatsim.control.base import Controller, Estimate, Sense, clip, wrap
from boatsim.physics.base import param

IDLE = 1.0  # throttle position
PRINTED_LEAD = 0.2754  # k_H, Table B.1


@dataclass
class L1HeadingDiscrete(Controller):
    """Heading controller of Theisen, Galeazzi and Blanke (2013) at 10 Hz: PD, wave filter and L1.

    Switches select the printed form of formulas with misprints. The control input is the yaw
    acceleration u; the nozzle angle is u / (N_delta / (I_z - N_r')), where N_delta contains cos 2
    beta. Near beta = 45 deg, where the jet has no moment, the nozzle stays straight. The predictor
    uses u after saturation. The adaptation gain is as printed: the estimate of a constant
    disturbance is f22 times its value, so that 1 - f22 = 5.8 % of the disturbance remains. Goals:
    `psi_rad`, `elevator_rad`.
    """

    words: ClassVar[str] = (
        "discrete L1 heading control of a water-jet craft at low speed and astern"
    )
    commands: ClassVar[tuple[str, ...]] = ("throttle", "jet_rad", "elevator_rad")
    goals: ClassVar[tuple[str, ...]] = ("psi_rad", "elevator_rad")

    period: float = param(
        0.1, low=0.001, high=10.0, unit="s", words="time between two control steps, T_s"
    )
    k_p: float = param(
        0.5, low=0.0, high=100.0, unit="1/s^2", words="yaw acceleration per heading error"
    )
    k_d: float = param(0.7, low=0.0, high=100.0, unit="1/s", words="yaw acceleration per yaw rate")
    time_constant: float = param(1.67, low=0.05, high=100.0, unit="s", words="T_n assumed")
    jet_gain: float = param(
        0.599, low=1e-3, high=100.0, unit="1/s^2", words="yaw acceleration per nozzle angle, beta 0"
    )
    jet_range: float = param(
        radians(15.0), low=0.0, high=1.6, unit="rad", words="largest nozzle angle"
    )
    elevator_rate: float = param(
        radians(30.0), low=1e-3, high=1e3, unit="rad/s", words="largest rate of the bucket command"
    )
    elevator_start: float = param(
        0.0, low=0.0, high=1.6, unit="rad", words="bucket before the first step"
    )
    least_share: float = param(
        0.1, low=1e-3, high=1.0, unit="", words="|cos 2 beta| below which the nozzle stays straight"
    )
    wave_filter: float = param(
        1.0, low=0.0, high=1.0, unit="", words="1: PD behind the wave filter; 0: PD alone"
    )
    adaptive: float = param(1.0, low=0.0, high=1.0, unit="", words="1: with L1; 0: without")
    omega_1: float = param(4.5, low=0.1, high=50.0, unit="rad/s", words="wave filter: notch")
    omega_2: float = param(7.0, low=0.1, high=50.0, unit="rad/s", words="wave filter: roll-off")
    alpha: float = param(0.3, low=0.01, high=1.0, unit="", words="wave filter: width of the notch")
    zeta: float = param(0.3, low=0.0, high=1.0, unit="", words="wave filter: depth of the notch")
    k: float = param(0.16, low=1e-4, high=100.0, unit="", words="L1 feedback gain")
    k_1: float = param(4.894e-3, low=1e-6, high=1.0, unit="", words="gain of D(z)")
    p_1: float = param(0.938, low=0.0, high=1.0, unit="", words="pole of D(z)")
    z_1: float = param(
        0.9789, low=-1.0, high=1.0, unit="", words="zero of D(z), -z_1; Table B.1 leaves it out: 0"
    )
    pd_as_published: float = param(
        0.0, low=0.0, high=1.0, unit="", words="1: eq. 15's minus sign on the heading error"
    )
    filter_as_published: float = param(
        0.0, low=0.0, high=1.0, unit="", words="1: zeros of s taken for zeros of z"
    )

    def __post_init__(self) -> None:
        super().__post_init__()
        self.reset()

    def reset(self) -> None:
        """Reset the controller's wave filter, low-pass filter and adaptive estimate."""
        self._filter, self._low_pass = self.make_wave_filter(), self.make_low_pass()
        self._decay = exp(-self.period / self.time_constant)  # f22
        self._gain = self.time_constant * (1.0 - self._decay)  # g2
        self._predicted: float | None = None
        self._sigma, self._elevator = 0.0, self.elevator_start

    def initial_commands(self) -> dict[str, float]:
        """Return the commands before the first step: idle throttle and a straight nozzle."""
        return {"throttle": IDLE, "jet_rad": 0.0, "elevator_rad": self.elevator_start}

    def make_wave_filter(self) -> DiscreteFilter:
        """Return the filter that removes wave frequencies from the PD control signal.

        It is H_f of the source: notch at omega_1, roll-off at omega_2, static gain 1.
        """
        w1, w2 = self.omega_1, self.omega_2
        notch = [1.0, 2.0 * self.zeta * w1, w1 * w1]
        poles = np.poly([-self.alpha * w1, -w1 / self.alpha, -w2])
        if self.filter_as_published:
            at = np.exp(np.roots(poles).real * self.period)
            return DiscreteFilter([PRINTED_LEAD * b for b in notch], np.poly(at).tolist())
        return zero_order_hold([w2 * b for b in notch], poles.tolist(), self.period)

    def make_low_pass(self) -> DiscreteFilter:
        """Return the low-pass filter C through which the estimated disturbance is cancelled.

        C = k D / (1 + k D), D = k_1 (z + z_1) / ((z - 1)(z - p_1)); equations 22 to 24 of the
        source.
        """
        g = self.k * self.k_1
        return DiscreteFilter([g, g * self.z_1], [1.0, g - self.p_1 - 1.0, self.p_1 + g * self.z_1])

    def step(self, sense: Sense, goal: Mapping[str, float]) -> dict[str, float]:
        """Return the bucket and nozzle commands of a water jet for the next period.

        The bucket is rate-limited; the nozzle follows from heading and gyro.

        Args:
            sense: Sensor readings.
            goal: `psi_rad` and `elevator_rad`.
        """
        wanted, reach = goal.get("elevator_rad", 0.0), self.elevator_rate * self.period
        before = self._elevator
        self._elevator = clip(wanted, self._elevator - reach, self._elevator + reach)
        adding = self._cancelling_acceleration(sense.r) if self.adaptive else 0.0
        u = self._pd_acceleration(wrap(goal.get("psi_rad", 0.0) - sense.psi), sense.r) + adding
        per_angle = self._nozzle_effectiveness(before)
        jet = clip(u / per_angle, -self.jet_range, self.jet_range) if per_angle else 0.0
        self._predicted = self._decay * (self._predicted or 0.0) + self._gain * (
            per_angle * jet + self._sigma
        )
        return {"throttle": IDLE, "jet_rad": jet, "elevator_rad": self._elevator}

    def estimates(self) -> dict[str, Estimate]:
        """Return the estimated disturbance of the yaw motion, an acceleration, for the log."""
        return {"sigma_radps2": Estimate(self._sigma, nan, nan)}

    def feedback_loops(self) -> tuple[SampledLoop, ...]:
        """Return the controller's feedback loop for an analysis of stability margins.

        It is broken at the yaw acceleration.
        """
        pole = 1.0 / self.time_constant
        return (
            SampledLoop("yaw", self._controller_response, pole, self.period, (0.5, 1.0, 2.0), pole),
        )

    def _pd_acceleration(self, error: float, r: float) -> float:
        """Return the yaw acceleration of the PD [rad/s^2]."""
        sign = -1.0 if self.pd_as_published else 1.0
        u = sign * self.k_p * error - self.k_d * r
        return self._filter.step(u) if self.wave_filter else u

    def _cancelling_acceleration(self, r: float) -> float:
        """Return the yaw acceleration that cancels the disturbance [rad/s^2]."""
        if self._predicted is None:
            self._predicted = r
        self._sigma = -self._decay / self._gain * (self._predicted - r)
        return -self._low_pass.step(self._sigma)

    def _nozzle_effectiveness(self, before: float) -> float:
        """Return the yaw acceleration per nozzle angle [1/s^2]; 0 if it passes zero."""
        share = [
            cos(2.0 * beta) for beta in (before, 0.5 * (before + self._elevator), self._elevator)
        ]
        return self.jet_gain * share[1] if min(map(abs, share)) >= self.least_share else 0.0

    def _controller_response(self, z: Complex) -> tuple[Complex, Complex]:
        """Return the response to heading and yaw rate.

        By equations 18 and 19 r_hat = (f22 r + g2 u) / z.
        """
        h = self.make_wave_filter().evaluate(z) if self.wave_filter else 1.0
        c = self.make_low_pass().evaluate(z) if self.adaptive else 0.0
        inner = 1.0 - c * self._decay / z
        to_rate = h * self.k_d - c * self._decay / self._gain * (self._decay / z - 1.0)
        return h * self.k_p / inner, to_rate / inner
