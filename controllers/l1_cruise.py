"""L1 adaptive cruise control of a water-jet craft: the throttle that holds a speed, whatever slows the craft."""

from collections.abc import Mapping
from dataclasses import dataclass
from math import exp, isnan, nan
from typing import ClassVar

from boatsim.control.adaptive import LinearSystem, l1_norm, unfiltered
from boatsim.control.adaptive_loop import AdaptiveLoop
from boatsim.control.allocation import JetThrottle
from boatsim.control.base import Controller, Estimate, Sense, clip
from boatsim.physics.base import param

THETA, SIGMA, OMEGA = (0.2025, 1.7716), (-23.17, 23.17), (0.1, 2.0)  # section 4.1; 1/s, m/s^2, 1
SLOWEST = 0.5  # [m/s] thrust is power / speed down to here
IDLE, FULL = 1.0, 7.0  # throttle
LINEAR, QUADRATIC = 0.1926, 0.0035  # [1/s], [1/m] drag per mass, Table 3: only where the filter starts


@dataclass
class L1Cruise(Controller):
    """Speed u' = -pole u + omega tau + theta u + sigma with the thrust tau per mass found by adaptation; eqs. 17-24.

    The thrust is limited to what the throttle can give at this speed, and the predictor gets the limited one. Goals:
    `u_mps`, and `jet_rad`, which is passed on.
    """

    words: ClassVar[str] = "L1 adaptive speed of a water-jet craft on its throttle"
    commands: ClassVar[tuple[str, ...]] = ("throttle", "jet_rad")
    goals: ClassVar[tuple[str, ...]] = ("u_mps", "jet_rad")

    period: float = param(0.002, low=0.0001, high=0.1, unit="s", words="time between two control steps")
    substep: float = param(1e-4, low=1e-6, high=0.1, unit="s", words="of predictor, adaptation and filter")
    pole: float = param(1.4, low=0.1, high=20.0, unit="1/s", words="-alpha_des: of the motion asked for")
    bandwidth: float = param(35.0, low=0.1, high=1e3, unit="1/s", words="k_u; the L1-norm condition needs 12.1")
    adaptation: float = param(1e4, low=1.0, high=1e7, unit="", words="Gamma_u")
    q2: float = param(154.9, low=0.0, high=1e3, unit="m^2/s^3", words="of the power curve; printed 164.5")
    gain_as_published: float = param(0.0, low=0.0, high=1.0, unit="", words="1: k_g = 1/pole, which is wrong")

    def __post_init__(self) -> None:
        super().__post_init__()
        self.reset()

    def reset(self) -> None:
        """Nothing learnt."""
        low, high = zip(THETA, SIGMA, OMEGA, strict=True)
        self._loop = AdaptiveLoop(
            [[-self.pole]], low, high, (1.0, 0.0, 1.0), gain=self.adaptation, bandwidth=self.bandwidth,
            period=self.period, step=self.substep,
        )  # fmt: skip
        self._jet = JetThrottle(self.q2)
        self._model = self._speed = self._goal = nan
        self._throttle = IDLE
        self._decay = exp(-self.pole * self.period)

    def step(self, sense: Sense, goal: Mapping[str, float]) -> dict[str, float]:
        """Throttle for the next period."""
        wanted, u = goal["u_mps"], max(sense.u, SLOWEST)
        if isnan(self._model):
            self._model = sense.u
            self._loop.start((sense.u,), clip((LINEAR + QUADRATIC * u) * u, *self._range(u)))
        else:
            mean = max(0.5 * (self._speed + sense.u), SLOWEST)
            self._loop.observe((sense.u,), self._jet.power(self._throttle) / mean)
            self._model += (1.0 - self._decay) * (self._goal - self._model)
        gain = 1.0 / self.pole if self.gain_as_published else self.pole
        thrust = self._loop.act(gain * wanted, *self._range(u))
        self._speed, self._goal, self._throttle = sense.u, wanted, self._jet.throttle(thrust * u)
        return {"throttle": self._throttle, "jet_rad": goal.get("jet_rad", 0.0)}

    def estimates(self) -> dict[str, Estimate]:
        """Theta, sigma and omega with their bounds, and the speed asked for."""
        theta, sigma, omega = self._loop.estimates.tolist()
        return {
            "theta_1ps": Estimate(theta, *THETA),
            "sigma_mps2": Estimate(sigma, *SIGMA),
            "omega": Estimate(omega, *OMEGA),
            "reference_goal_mps": Estimate(self._goal, nan, nan),
            "reference_u_mps": Estimate(self._model, nan, nan),
        }

    def filtered_uncertainty(self) -> LinearSystem:
        """What the low-pass leaves of an uncertainty, at the lowest input gain: its L1 norm is that of the design."""
        return unfiltered([[-self.pole]], [1.0], OMEGA[0] * self.bandwidth)

    def l1_condition(self) -> float:
        """L1 norm times the largest slope of the uncertainty: below 1 the loop stays bounded (Fig. 8)."""
        return l1_norm(self.filtered_uncertainty()) * THETA[1]

    def _range(self, u: float) -> tuple[float, float]:
        """Least and most thrust per mass [m/s^2] at a speed."""
        return self._jet.power(IDLE) / u, self._jet.power(FULL) / u
