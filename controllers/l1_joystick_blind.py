"""The L1 joystick without a speed sensor: it finds out about its motors before it starts, then reckons its surge."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from math import cos, degrees, nan, sin
from typing import ClassVar

from boatsim.control.adaptive import LoopChannel
from boatsim.control.allocation import ANGLE_MAX, PWM_MAX, Setting
from boatsim.control.base import Estimate, Sense, clip, wrap
from boatsim.control.joystick import AdaptiveJoystick
from boatsim.control.motor_check import PORT, STARBOARD, Drift, MotorCheck, Pulse
from boatsim.physics.base import param

TURN_BACK = 0.03  # [rad/s] at which what the check turned is turned back


@dataclass
class L1JoystickBlind(AdaptiveJoystick):
    """Yaw by the gyro as its base; surge by what the motors are known to give, for nothing aboard feels it.

    From rest the motors are pulsed for 20 to 40 s in which the stick is not heard, or what such a check found before
    is stated (`known_`). Commands then go out as they must for the boat to do what the base believes: astern by a
    factor, both motors turned by an angle. So trimmed, speed and way are the sums of what was applied; the base
    takes that speed for measured and gives the way back.
    """

    words: ClassVar[str] = "L1 joystick for a boat without a speed sensor: tries its motors first"

    check_pwm: float = param(
        90.0, low=10.0, high=255.0, unit="", words="PWM of pulses ahead; choose that of a sway"
    )
    check_rest: float = param(
        0.48, low=0.08, high=5.0, unit="s", words="standstill of the motors between pulses"
    )
    check_reach: float = param(
        0.045, low=0.001, high=1.0, unit="m/s", words="speed that a pulse is to give"
    )
    check_shortest: float = param(
        0.24, low=0.08, high=5.0, unit="s", words="shortest pulse, the first ones"
    )
    check_longest: float = param(0.64, low=0.08, high=5.0, unit="s", words="longest pulse")
    check_lag: float = param(0.15, low=0.01, high=2.0, unit="s", words="assumed lag of thrust")
    check_yaw: float = param(
        1.0, low=0.0, high=10.0, unit="", words="yaw acceleration by drift per yaw rate squared"
    )
    check_surge: float = param(
        0.6, low=0.0, high=10.0, unit="m", words="deceleration by drift per yaw rate squared"
    )
    check_power: float = param(
        1.25, low=0.5, high=3.0, unit="", words="exponent of thrust assumed in the check"
    )
    check_enough: float = param(
        0.006, low=1e-4, high=0.5, unit="", words="standard deviation of the reverse it ends at"
    )
    check_most: float = param(
        4.0, low=2.0, high=50.0, unit="", words="most pairs of trains of pulses"
    )
    known_astern: float = param(
        0.0, low=0.0, high=5.0, unit="", words="factor on PWM astern; 0: to be found by a check"
    )
    known_angle: float = param(
        0.0, low=-0.5, high=0.5, unit="rad", words="by which both steerings are off"
    )
    known_scale: float = param(
        1.0, low=0.05, high=20.0, unit="", words="true over assumed acceleration by the motors"
    )
    way_gain: float = param(
        0.3, low=0.0, high=5.0, unit="1/s", words="surge speed asked for per way reckoned"
    )

    def reset(self) -> None:
        """At rest, motors untried unless they are known."""
        super().reset()
        self._check = None if self.known_astern else self._new_check()
        self._astern = self.known_astern or 1.0
        self._angle = self.known_angle
        self._scale = self.known_scale
        self._psi = self._start = nan  # [rad] compass when the base took over, and before the check
        self._left = 0.0  # [rad] still to be turned back
        self._u = self._x = 0.0  # [m/s], [m] reckoned, beside what the stick asked for

    def step(self, sense: Sense, goal: Mapping[str, float]) -> dict[str, float]:
        """Pulses until the motors are known, then the base's commands, trimmed."""
        if self._psi != self._psi:
            self._psi = sense.psi
        if self._check:
            self._start = sense.psi if self._start != self._start else self._start
            pulse = self._check.step(sense.r, sense.ax)
            if not self._check.done:
                return self._pulsed(self._check, pulse)
            self._take_over(self._check, sense.psi)
        return self._answered(sense, goal)

    def estimates(self) -> dict[str, Estimate]:
        """The base's, what was found of the motors, and the reckoning."""
        found = {
            "trim_astern": self._check.astern if self._check else self._astern,
            "trim_angle_rad": self._angle,
            "trim_scale": self._scale,
            "reckoned_u_mps": self._u,
            "reckoned_x_m": self._x,
        }
        return {
            **super().estimates(),
            **{name: Estimate(value, nan, nan) for name, value in found.items()},
        }

    @property
    def found(self) -> tuple[float, float, float] | None:
        """What to state as `known_astern`, `known_angle` and `known_scale` another time; None during the check."""
        return None if self._check else (self._astern, self._angle, self._scale)

    def loop_channels(self) -> tuple[LoopChannel, ...]:
        """Yaw alone: surge is reckoned, and no reading of the water closes its loop."""
        return tuple(channel for channel in super().loop_channels() if channel.name == "yaw")

    def _new_check(self) -> MotorCheck:
        return MotorCheck(
            period=self.period,
            rest=self.check_rest,
            reach=self.check_reach,
            shortest=self.check_shortest,
            longest=self.check_longest,
            lag=self.check_lag,
            drift=Drift(self.check_yaw, self.check_surge),
            power=self.check_power,
            enough=self.check_enough,
            most=round(self.check_most),
            straight=2.0 / (1.0 + cos(ANGLE_MAX)),
        )

    def _pulsed(self, check: MotorCheck, pulse: Pulse) -> dict[str, float]:
        """Both motors ahead, astern or off, one of them turned inward."""
        astern = max(check.astern * self.pwm(-self.thrust(self.check_pwm)), -PWM_MAX)
        pwm = float(round({1: self.check_pwm, -1: astern, 0: 0.0}[pulse.sense]))
        return {
            "pwm_port": pwm,
            "pwm_starboard": pwm,
            "steer_port_rad": ANGLE_MAX if pulse.inward == PORT else 0.0,
            "steer_starboard_rad": -ANGLE_MAX if pulse.inward == STARBOARD else 0.0,
        }

    def _take_over(self, check: MotorCheck, compass: float) -> None:
        """Note what the check found and what it left of motion."""
        d = ANGLE_MAX
        # a pulse of thrust F turns by F (lever(d) - B), of which an angle e more takes F e (B sin d
        # + L cos d + L)
        reach = self.half_spacing * sin(d) + self.arm * (cos(d) + 1.0)
        self._astern = check.astern
        self._angle = check.unevenness * (self.half_spacing - self.lever(d)) / reach
        self._scale = check.push * self.mass / (self.thrust(self.check_pwm) * (1.0 + cos(d)))
        self._u = check.speed
        self._psi, self._left = compass, wrap(self._start - compass)
        self._check = None

    def _answered(self, sense: Sense, goal: Mapping[str, float]) -> dict[str, float]:
        """The base's answer to the reckoned speed, trimmed for the motors as they are."""
        stick = goal.get("surge_mps", 0.0)
        turn = clip(self._left, -TURN_BACK * self.period, TURN_BACK * self.period)
        self._left -= turn
        asked = {
            **goal,
            "surge_mps": stick - self.way_gain * self._x,
            "yaw_radps": goal.get("yaw_radps", 0.0) + turn / self.period,
        }
        commands = super().step(replace(sense, u=self._u, psi=sense.psi - self._psi), asked)
        self._reckon(commands, stick)
        return {name: self._trim(name, value) for name, value in commands.items()}

    def _reckon(self, commands: Mapping[str, float], stick: float) -> None:
        """Speed and way after the next period."""
        pwm = int(commands["pwm_port"]), int(commands["pwm_starboard"])
        push = self.applied(Setting(*pwm, round(degrees(commands["steer_port_rad"]))))
        self._u += self.period * self._scale * push.X / self.mass
        self._x += self.period * (self._u - stick)

    def _trim(self, name: str, value: float) -> float:
        """Command under which these motors do what the base's would have done."""
        if name.startswith("steer"):
            return value - self._angle
        return value if value >= 0.0 else float(round(max(value * self._astern, -PWM_MAX)))
