"""The corrected L1 joystick controller: one program for surge, sway and yaw commands at once."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import partial
from math import isnan, nan
from typing import ClassVar

from boatsim.control.adaptive import LoopChannel, PiecewiseConstant
from boatsim.control.allocation import STICK, Heading, Outboards, Push, Stick
from boatsim.control.base import Controller, Estimate, LowPass, Sense, clip
from boatsim.physics.base import param

SERVO_LAG = 0.06  # [s] "about one time step" in the thesis; used for the printed margins only


@dataclass
class Axis:
    """One adaptive channel: predictor, adaptation and low-pass of what the predictor does not know."""

    block: PiecewiseConstant
    low_pass: LowPass
    model: float = 0.0  # the motion asked for: x' = -pole (x - x_ref)

    def missing(self, measured: float, applied: float | None, reference: float) -> float:
        """Force or moment the boat feels beside the applied one, low-passed; `applied` is None at the first step.

        A lasting disturbance shows in `sig` with the factor e^{-aT} only, so it is divided out.
        """
        block = self.block
        if applied is not None:
            block.predict(applied)
        self.model += (1.0 - block.decay) * (reference - self.model)
        return self.low_pass.step(block.adapt(measured) / block.decay, block.period)


@dataclass
class L1Joystick(Outboards, Controller):
    """L1 adaptive control of yaw rate and, where a sensor gives it, surge speed; sway is thrust in open loop.

    Each channel asks for x' = -pole (x - x_ref) of an assumed inertia. Whatever else moves the boat (unknown motor
    spacing, arm, reverse thrust, wind, drag) shows as a prediction error, is expressed as a force or moment `sig`
    and, low-passed, subtracted. Goals: `surge_mps`, `sway_mps`, `yaw_radps`.
    """

    words: ClassVar[str] = "L1 adaptive joystick, corrected: surge, sway and yaw commands at once"
    commands: ClassVar[tuple[str, ...]] = ("pwm_port", "pwm_starboard", "steer_port_rad", "steer_starboard_rad")
    goals: ClassVar[tuple[str, ...]] = STICK

    pole: float = param(1.4, low=0.1, high=10.0, unit="1/s", words="pole of the motion asked for")
    inertia: float = param(2.0, low=0.1, high=50.0, unit="kg m^2", words="assumed yaw inertia, added mass included")
    mass: float = param(5.0, low=0.5, high=500.0, unit="kg", words="assumed surge mass")
    yaw_bandwidth: float = param(2.0, low=0.1, high=20.0, unit="rad/s", words="low-pass of the yaw estimate")
    surge_bandwidth: float = param(2.0, low=0.05, high=20.0, unit="rad/s", words="low-pass of the surge estimate")
    heading_gain: float = param(0.2, low=0.0, high=5.0, unit="1/s", words="yaw rate asked for per heading error")
    hold_rate: float = param(0.1, low=0.01, high=2.0, unit="rad/s", words="largest yaw rate without a yaw command")
    turn_rate: float = param(0.25, low=0.01, high=2.0, unit="rad/s", words="largest yaw rate in a rated turn")
    rated_yaw: float = param(0.1396, low=0.01, high=2.0, unit="rad/s", words="the rated turn, 8 deg/s")
    blind_surge: float = param(1.0, low=0.0, high=100.0, unit="N s/m", words="surge force per m/s with no speed sensor")

    def __post_init__(self) -> None:
        super().__post_init__()
        self.reset()

    def reset(self) -> None:
        """At rest on the start heading, with nothing learnt."""
        self._yaw = Axis(PiecewiseConstant(self.pole, 1.0 / self.inertia, self.period), LowPass(self.yaw_bandwidth))
        self._surge = Axis(PiecewiseConstant(self.pole, 1.0 / self.mass, self.period), LowPass(self.surge_bandwidth))
        self._heading = Heading()
        self._applied: Push | None = None

    def step(self, sense: Sense, goal: Mapping[str, float]) -> dict[str, float]:
        """Commands for the next period from the gyro, the surge speed if there is one, and the stick."""
        stick = Stick.read(goal)
        moment = self._moment(sense, stick.yaw)
        surge = self._surge_force(sense.u, stick.surge)
        room = self.pole * self.mass * abs(stick.surge)
        setting = self.setting(self.allocate(surge, self.sway_difference(stick.sway), moment, room))
        self._applied = self.applied(setting)
        return setting.commands()

    def estimates(self) -> dict[str, Estimate]:
        """What each channel takes for missing force and moment, and the motion asked for."""
        return {
            "sigma_yaw_Nm": Estimate(self._yaw.block.sig, nan, nan),
            "sigma_surge_N": Estimate(self._surge.block.sig, nan, nan),
            "reference_u_mps": Estimate(self._surge.model, nan, nan),
            "reference_r_radps": Estimate(self._yaw.model, nan, nan),
        }

    def loop_channels(self) -> tuple[LoopChannel, ...]:
        """The feedback loops, for margins; the input gain spans the boats of the Monte Carlo study."""
        delayed = partial(
            LoopChannel, pole=self.pole, hold_s=0.5 * self.period, servo_lag_s=SERVO_LAG, input_gain=(0.5, 1.0, 1.8)
        )
        return (
            delayed("yaw", bandwidth=self.yaw_bandwidth, heading_gain=self.heading_gain),
            delayed("surge", bandwidth=self.surge_bandwidth),
        )

    def _moment(self, sense: Sense, wanted: float) -> float:
        """Yaw moment [N m]."""
        if self._applied is not None:
            self._heading.step(sense.r, sense.psi, wanted, self.period, self.compass_trust)
        reference = self._rate_reference(wanted)
        missing = self._yaw.missing(sense.r, self._applied.N if self._applied else None, reference)
        return self.inertia * self.pole * reference - missing

    def _rate_reference(self, wanted: float) -> float:
        """Yaw rate asked for: the stick's, corrected for the heading error and bounded."""
        bound = self.hold_rate + (self.turn_rate - self.hold_rate) * abs(wanted) / self.rated_yaw
        return clip(wanted + self.heading_gain * self._heading.error(), -bound, bound)

    def _surge_force(self, speed: float, wanted: float) -> float:
        """Surge force [N]; without a speed sensor only a guess of what the stick asks for."""
        if isnan(speed):
            return self.blind_surge * wanted
        missing = self._surge.missing(speed, self._applied.X if self._applied else None, wanted)
        return self.mass * self.pole * wanted - missing
