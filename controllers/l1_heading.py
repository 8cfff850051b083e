"""L1 adaptive heading control of a water-jet craft: its jet turns it as a second-order model would turn."""

from collections.abc import Mapping
from dataclasses import dataclass
from math import nan, radians
from typing import ClassVar

import numpy as np

from boatsim.control.adaptive_loop import AdaptiveLoop
from boatsim.control.base import Controller, Estimate, Sense, wrap
from boatsim.physics.base import Array, param

THETA_1, THETA_2, SIGMA, OMEGA = (-3.0, 3.0), (-5.0, 5.0), (-5.0, 5.0), (0.1, 10.0)  # chosen: none are published
JUMP = 1.0  # [rad/s] a reference that changes faster jumps
STIFFNESS = 1.0  # [1/s^2] of the motion asked for, A_m = [[0, -1], [1, -1.4]]


@dataclass
class L1Heading(Controller):
    """Heading error e and yaw rate r, r' = e - damping r + omega delta + theta'(e, r) + sigma; section 4.2.

    At bandwidth 80 and an input gain of 3 the input's filter is as quick as 240 rad/s: a delay of 10 ms makes the jet
    swing from stop to stop, and the control must run at 500 Hz or more. Goals: `psi_rad`, and `throttle`, passed on.
    """

    words: ClassVar[str] = "L1 adaptive heading of a water-jet craft on its jet"
    commands: ClassVar[tuple[str, ...]] = ("throttle", "jet_rad")
    goals: ClassVar[tuple[str, ...]] = ("psi_rad", "throttle")

    period: float = param(0.002, low=0.0001, high=0.1, unit="s", words="time between two control steps")
    substep: float = param(2e-4, low=1e-6, high=0.1, unit="s", words="of predictor, adaptation and filter")
    damping: float = param(1.4, low=0.1, high=20.0, unit="1/s", words="of the motion asked for, A_m")
    bandwidth: float = param(80.0, low=0.1, high=1e3, unit="1/s", words="k_h; published condition 60")
    adaptation: float = param(1e5, low=1.0, high=1e7, unit="", words="Gamma_h")
    first_omega: float = param(3.0, low=0.1, high=10.0, unit="1/s^2", words="input gain assumed at the start")
    largest: float = param(radians(15.0), low=0.0, high=1.5, unit="rad", words="jet deflection either way")
    rate: float = param(radians(30.0), low=0.001, high=1e3, unit="rad/s", words="fastest turning of the jet")
    jumps_shift: float = param(
        1.0, low=0.0, high=1.0, unit="", words="0: a step of the reference surprises, as printed"
    )
    knows_rate: float = param(1.0, low=0.0, high=1.0, unit="", words="0: the reference's rate is left out, as printed")
    regressor_as_published: float = param(0.0, low=0.0, high=1.0, unit="", words="1: sigma is adapted by delta, eq. 32")

    def __post_init__(self) -> None:
        super().__post_init__()
        self.reset()

    def reset(self) -> None:
        """Nothing learnt."""
        low, high = zip(THETA_1, THETA_2, SIGMA, OMEGA, strict=True)
        am = np.array([[0.0, -1.0], [STIFFNESS, -self.damping]])
        self._loop = AdaptiveLoop(
            am, low, high, (0.0, 0.0, 0.0, self.first_omega), gain=self.adaptation, bandwidth=self.bandwidth,
            period=self.period, step=self.substep,
        )  # fmt: skip
        if self.regressor_as_published:
            self._loop.by[2] = 3
        self._model: Array = np.zeros(2)  # heading error and yaw rate asked for
        self._goal = self._jet = 0.0

    def step(self, sense: Sense, goal: Mapping[str, float]) -> dict[str, float]:
        """Jet deflection for the next period."""
        wanted = goal["psi_rad"]
        if not self._loop.started:
            self._goal = wanted
            self._model[:] = wrap(wanted - sense.psi), sense.r
            self._loop.start(self._model, 0.0)
        else:
            self._observe(sense, wrap(wanted - self._goal))
            self._goal = wanted
        self._jet = self._loop.act(0.0, -self.largest, self.largest, self.rate)
        return {"throttle": goal.get("throttle", 1.0), "jet_rad": self._jet}

    def estimates(self) -> dict[str, Estimate]:
        """Theta, sigma and omega with their bounds, heading asked for and the one of the model."""
        theta_1, theta_2, sigma, omega = self._loop.estimates.tolist()
        return {
            "theta_1": Estimate(theta_1, *THETA_1),
            "theta_2": Estimate(theta_2, *THETA_2),
            "sigma_radps2": Estimate(sigma, *SIGMA),
            "omega_1ps2": Estimate(omega, *OMEGA),
            "reference_goal_rad": Estimate(self._goal, nan, nan),
            "reference_psi_rad": Estimate(self._goal - float(self._model[0]), nan, nan),
        }

    def _observe(self, sense: Sense, change: float) -> None:
        """One period back: the reference changed steadily, or it jumps now."""
        jump = change if abs(change) > JUMP * self.period else 0.0
        rate = (change - jump) / self.period
        self._loop.drift[0] = rate * self.knows_rate
        error = wrap(self._goal + change - jump - sense.psi)
        self._loop.observe((error, sense.r), self._jet)
        middle = self._model + 0.5 * self.period * self._slope(self._model, rate)
        self._model = self._model + self.period * self._slope(middle, rate)
        self._model[0] += jump
        if jump:
            self._loop.shift(jump, self.jumps_shift)

    def _slope(self, x: Array, rate: float) -> Array:
        """Of the motion asked for."""
        return np.array([rate - x[1], STIFFNESS * x[0] - self.damping * x[1]])
