"""The plain rival: PID on the heading, PI on the surge speed, on the same allocation as the L1 joystick."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import partial
from math import isnan
from typing import ClassVar

from boatsim.control.adaptive import LoopChannel
from boatsim.control.allocation import STICK, Heading, Outboards, Push, Stick
from boatsim.control.base import Controller, Sense, clip
from boatsim.physics.base import param

SERVO_LAG = 0.06  # [s] "about one time step" in the thesis; used for the printed margins only


@dataclass
class PidAutopilot(Outboards, Controller):
    """PID on the integrated gyro with rate feed-forward; integrators stop where the outboards saturate.

    Gains are per unit of assumed inertia, so they read as squared frequency, its cube, and damping. Goals:
    `surge_mps`, `sway_mps`, `yaw_radps`.
    """

    words: ClassVar[str] = "PID heading and PI surge speed on the joystick's allocation"
    commands: ClassVar[tuple[str, ...]] = ("pwm_port", "pwm_starboard", "steer_port_rad", "steer_starboard_rad")
    goals: ClassVar[tuple[str, ...]] = STICK

    inertia: float = param(2.0, low=0.1, high=50.0, unit="kg m^2", words="assumed yaw inertia, added mass included")
    mass: float = param(5.0, low=0.5, high=500.0, unit="kg", words="assumed surge mass")
    kp: float = param(0.64, low=0.0, high=25.0, unit="1/s^2", words="yaw acceleration per heading error")
    ki: float = param(0.1, low=0.0, high=25.0, unit="1/s^3", words="the same per integrated heading error")
    kd: float = param(1.3, low=0.0, high=25.0, unit="1/s", words="yaw acceleration per yaw rate error")
    surge_kp: float = param(0.5, low=0.0, high=25.0, unit="1/s", words="surge acceleration per speed error")
    surge_ki: float = param(0.1, low=0.0, high=25.0, unit="1/s^2", words="the same per integrated speed error")
    largest_error: float = param(0.5, low=0.01, high=3.1, unit="rad", words="heading errors count up to this much")
    blind_surge: float = param(1.0, low=0.0, high=100.0, unit="N s/m", words="surge force per m/s with no speed sensor")

    def __post_init__(self) -> None:
        super().__post_init__()
        self.reset()

    def reset(self) -> None:
        """At rest on the start heading, integrators empty."""
        self._heading = Heading()
        self._moment_held = self._surge_held = 0.0  # [N m], [N] integral parts
        self._missed = Push(0.0, 0.0, 0.0)  # asked for minus applied in the last step
        self._first = True

    def step(self, sense: Sense, goal: Mapping[str, float]) -> dict[str, float]:
        """Commands for the next period from the gyro, the surge speed if there is one, and the stick."""
        stick = Stick.read(goal)
        moment = self._moment(sense, stick.yaw)
        surge = self._surge_force(sense.u, stick.surge)
        room = self.surge_kp * self.mass * abs(stick.surge) + abs(self.blind_surge * stick.surge)
        drive = self.allocate(surge, self.sway_difference(stick.sway), moment, room)
        setting, given = self.setting(drive), self.push(drive)
        self._missed = Push(surge - given.X, 0.0, moment - given.N)
        self._first = False
        return setting.commands()

    def loop_channels(self) -> tuple[LoopChannel, ...]:
        """The feedback loops, for margins; PI on a speed is PD on its integral."""
        delayed = partial(LoopChannel, hold_s=0.5 * self.period, servo_lag_s=SERVO_LAG, input_gain=(0.5, 1.0, 1.8))
        return (
            delayed("yaw", pid=(self.kp, self.ki, self.kd)),
            delayed("surge", pid=(self.surge_ki, 0.0, self.surge_kp)),
        )

    def _moment(self, sense: Sense, wanted: float) -> float:
        """Yaw moment [N m]."""
        if not self._first:
            self._heading.step(sense.r, sense.psi, wanted, self.period, self.compass_trust)
        error = clip(self._heading.error(), -self.largest_error, self.largest_error)
        if self._missed.N * error <= 0.0:
            self._moment_held += self.period * self.inertia * self.ki * error
        return self.inertia * (self.kp * error + self.kd * (wanted - sense.r)) + self._moment_held

    def _surge_force(self, speed: float, wanted: float) -> float:
        """Surge force [N]; without a speed sensor only a guess of what the stick asks for."""
        if isnan(speed):
            return self.blind_surge * wanted
        error = wanted - speed
        if self._missed.X * error <= 0.0:
            self._surge_held += self.period * self.mass * self.surge_ki * error
        return self.blind_surge * wanted + self.mass * self.surge_kp * error + self._surge_held
