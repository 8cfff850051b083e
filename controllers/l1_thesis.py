"""The L1 controller of Bayless' simulations: gradient adaptation with projection, steering behind a low-pass."""

from collections.abc import Mapping
from dataclasses import dataclass
from math import nan, pi, radians, sin
from typing import ClassVar

from boatsim.control.adaptive import Gradient, lyapunov
from boatsim.control.base import Controller, Estimate, Sense, clip
from boatsim.physics.base import param

MODEL = ((0.0, -1.0), (1.0, -1.4))  # [1/s] A_m of sway velocity and yaw rate, T8; b = I
ROOM = pi / 4  # [rad] both motors turn inward as far as this, T9
MODULATED_AT = radians(23.6)  # steering angle at which modulated power is the nominal one, Fig 24


@dataclass
class Row:
    """What is unknown of one state: xh' = A_m xh + omega input + theta'x + sigma."""

    omega: Gradient
    theta_v: Gradient
    theta_r: Gradient
    sigma: Gradient

    def known(self, given: float, v: float, r: float) -> float:
        """Acceleration that the input and the states are taken to cause."""
        return self.omega.value * given + self.theta_v.value * v + self.theta_r.value * r + self.sigma.value

    def adapt(self, error: float, given: float, v: float, r: float, dt: float) -> None:
        """E34 to E36: each estimate against its regressor; error is its entry of (xh - x)' P."""
        self.omega.step(given, error, dt)
        self.theta_v.step(v, error, dt)
        self.theta_r.step(r, error, dt)
        self.sigma.step(1.0, error, dt)


@dataclass
class L1Thesis(Controller):
    """Sways with constant nominal power while the steering keeps the yaw rate at zero, its neutral angle unknown.

    E37 with a plus sign throughout. Sway is open loop, so the sway speed there is counts as the one asked for, and the
    feed-forward is -A_m: v alone asks for no turning. `feed_forward_as_published` takes the thesis' diagonal one.
    """

    words: ClassVar[str] = "L1 adaptive sway of the thesis' simulations, steering the only control"
    commands: ClassVar[tuple[str, ...]] = (
        "thrust_port_N", "thrust_starboard_N", "steer_port_rad", "steer_starboard_rad",
    )  # fmt: skip

    period: float = param(5e-4, low=5e-4, high=0.01, unit="s", words="time between two control steps")
    power: float = param(0.5, low=0.01, high=8.0, unit="N", words="nominal power F0: both thrusts together")
    modulated: bool = False  # F = F0 sin d / sin 23.6 deg instead of F0, d the angle the motors have reached
    servo_lag: float = param(0.15, low=0.0, high=60.0, unit="s", words="assumed, of the steering")
    adaptation: float = param(1e4, low=0.0, high=1e6, unit="", words="gain of the gradient laws")
    mass: float = param(10.4, low=0.1, high=1e3, unit="kg", words="assumed, sway")
    inertia: float = param(2.0, low=0.01, high=1e3, unit="kg m^2", words="assumed, yaw")
    neutral: float = param(0.3875, low=0.0, high=0.7854, unit="rad", words="assumed neutral angle")
    slope: float = param(0.62, low=0.01, high=10.0, unit="m/rad", words="assumed fall of the lever with the angle")
    filter_gain: float = param(4.5, low=0.01, high=100.0, unit="", words="times 1.07 (s + 17.7)/(s (s + 50)), AppH")
    feed_forward_as_published: bool = False

    def __post_init__(self) -> None:
        super().__post_init__()
        (self._p_vv, self._p_vr), (_, self._p_rr) = lyapunov(MODEL).tolist()
        self.reset()

    def reset(self) -> None:
        """Nothing learnt, motors straight ahead."""
        self._sway, self._yaw = self._row(), self._row()
        self._predicted = (0.0, 0.0)
        self._given = (0.0, 0.0)  # [m/s^2], [rad/s^2] inputs in force
        self._slow = self._fast = 0.0  # [rad/s^2] both poles of the low-pass
        self._angle = self._reached = 0.0  # [rad] commanded, and where the servo is taken to be

    def step(self, sense: Sense, goal: Mapping[str, float]) -> dict[str, float]:
        """Thrusts and angles from the measured sway velocity and yaw rate."""
        v, r = sense.v, sense.r
        vh, rh = self._predicted
        error_v, error_r = vh - v, rh - r
        given_v, given_r = self._given
        self._sway.adapt(self._p_vv * error_v + self._p_vr * error_r, given_v, v, r, self.period)
        self._yaw.adapt(self._p_vr * error_v + self._p_rr * error_r, given_r, v, r, self.period)
        thrust = self._steer(v, r)
        self._predict(vh, rh, v, r)
        angle = self._angle
        return {
            "thrust_port_N": 0.5 * thrust, "thrust_starboard_N": -0.5 * thrust,
            "steer_port_rad": angle, "steer_starboard_rad": -angle,
        }  # fmt: skip

    def estimates(self) -> dict[str, Estimate]:
        """All estimates with their bounds, and the predicted states."""
        found = {
            f"{name}_{axis}": Estimate(g.value, g.low, g.high)
            for axis, row in (("sway", self._sway), ("yaw", self._yaw))
            for name, g in vars(row).items()
        }
        vh, rh = self._predicted
        return found | {"reference_v_mps": Estimate(vh, nan, nan), "reference_r_radps": Estimate(rh, nan, nan)}

    def _row(self) -> Row:
        """Bounds are assumptions, wide enough for the plants of T10 to T14 and the disturbance of T12."""
        gain = self.adaptation
        theta_v, theta_r, sigma = (Gradient(0.0, -2.0, 2.0, gain) for _ in range(3))
        return Row(Gradient(1.0, 0.5, 2.0, gain), theta_v, theta_r, sigma)

    def _steer(self, v: float, r: float) -> float:
        """Set the angle by the filtered law and return the power for it [N]."""
        wanted = 0.0 if self.feed_forward_as_published else -MODEL[1][0] * v
        over = self._yaw.known(self._given[1], v, r) - wanted
        drive = -1.07 * self.filter_gain * over * self.period
        self._slow += 17.7 / 50.0 * drive
        self._fast += (50.0 - 17.7) / 50.0 * drive - 50.0 * self.period * self._fast
        per_angle = self.slope * self.power / self.inertia  # [1/s^2]
        self._angle = clip(self.neutral - (self._slow + self._fast) / per_angle, 0.0, ROOM)
        self._reached += (self._angle - self._reached) * self.period / max(self.servo_lag, self.period)
        thrust = self.power * (sin(self._reached) / sin(MODULATED_AT) if self.modulated else 1.0)
        self._given = (thrust * sin(self._angle) / self.mass, per_angle * (self.neutral - self._angle))
        return thrust

    def _predict(self, vh: float, rh: float, v: float, r: float) -> None:
        """E37 over one period."""
        dv = MODEL[0][0] * vh + MODEL[0][1] * rh + self._sway.known(self._given[0], v, r)
        dr = MODEL[1][0] * vh + MODEL[1][1] * rh + self._yaw.known(self._given[1], v, r)
        self._predicted = (vh + self.period * dv, rh + self.period * dr)
