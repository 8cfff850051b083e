"""L1 joystick without a speed sensor: motor check, then dead reckoning of the speed."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from math import cos, degrees, nan, sin
from typing import ClassVar

from boatsim.control.adaptive import LoopChannel
from boatsim.control.allocation import ANGLE_MAX, PWM_MAX, OutboardSetting
from boatsim.control.base import Estimate, Sense, clip, wrap
from boatsim.control.joystick import YAW_PULSE, AdaptiveJoystick
from boatsim.control.motor_check import PORT, STARBOARD, Drift, MotorCheck, Pulse
from boatsim.control.operating_points import OperatingPoint
from boatsim.physics.base import param

LATER = 120.0  # [s] a check of the motors takes up to 40 s before the motion can settle
TURN_BACK = 0.03  # [rad/s] rate at which the rotation by the check is reversed


@dataclass
class L1JoystickBlind(AdaptiveJoystick):
    """L1 control of yaw by the gyro, and of surge by dead reckoning from the thrust of the motors.

    From rest the motors are pulsed for 20 to 40 s, during which the stick is ignored, unless the
    result of an earlier check is given (`known_` parameters). Commands are then corrected so that
    the boat responds as the base class assumes: PWM astern by a factor, both steering angles by an
    offset. Speed and distance are integrals of the applied thrust; the base class uses that speed
    as a measurement and returns the accumulated distance.
    """

    words: ClassVar[str] = "L1 joystick for a boat without a speed sensor: checks its motors first"

    check_pwm: float = param(
        90.0, low=10.0, high=255.0, unit="", words="PWM of pulses ahead; choose that of a sway"
    )
    check_rest: float = param(
        0.48, low=0.08, high=5.0, unit="s", words="standstill of the motors between pulses"
    )
    check_reach: float = param(
        0.045, low=0.001, high=1.0, unit="m/s", words="speed that a pulse should give"
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
        0.006,
        low=1e-4,
        high=0.5,
        unit="",
        words="standard deviation of the reverse ratio at which the check ends",
    )
    check_most: float = param(
        4.0, low=2.0, high=50.0, unit="", words="most pairs of trains of pulses"
    )
    known_astern: float = param(
        0.0, low=0.0, high=5.0, unit="", words="factor on PWM astern; 0: to be found by a check"
    )
    known_angle: float = param(
        0.0, low=-0.5, high=0.5, unit="rad", words="offset of both steering angles"
    )
    known_scale: float = param(
        1.0, low=0.05, high=20.0, unit="", words="true over assumed acceleration by the motors"
    )
    way_gain: float = param(
        0.3, low=0.0, high=5.0, unit="1/s", words="surge speed demanded per reckoned distance"
    )

    def reset(self) -> None:
        """Reset the controller to a boat at rest.

        The motors are checked again unless their properties are given as parameters.
        """
        super().reset()
        self._check = None if self.known_astern else self._make_motor_check()
        self._astern = self.known_astern or 1.0
        self._angle = self.known_angle
        self._scale = self.known_scale
        self._psi = self._start = nan  # [rad] compass when the base took over, and before the check
        self._left = 0.0  # [rad] rotation that remains to be reversed
        self._u = self._x = 0.0  # [m/s], [m] reckoned speed, and distance relative to the demand

    def step(self, sense: Sense, goal: Mapping[str, float]) -> dict[str, float]:
        """Return test pulses of the motors until they are known, then joystick commands.

        The commands are those of the base class, corrected by the result of the test.

        Args:
            sense: Sensor readings.
            goal: Demands of the stick.
        """
        if self._psi != self._psi:
            self._psi = sense.psi
        if self._check:
            self._start = sense.psi if self._start != self._start else self._start
            pulse = self._check.step(sense.r, sense.ax)
            if not self._check.done:
                return self._pulse_commands(self._check, pulse)
            self._store_check_result(self._check, sense.psi)
        return self._corrected_commands(sense, goal)

    def estimates(self) -> dict[str, Estimate]:
        """Return the base class's estimates, the motor check's result and the reckoned motion."""
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
    def check_result(self) -> tuple[float, float, float] | None:
        """Result of the motor check, for `known_astern`, `known_angle` and `known_scale`.

        None while the check is running.
        """
        return None if self._check else (self._astern, self._angle, self._scale)

    def feedback_loops(self) -> tuple[LoopChannel, ...]:
        """Return the yaw feedback loop for an analysis of stability margins.

        There is no surge loop, because no measurement closes it.
        """
        return tuple(channel for channel in super().feedback_loops() if channel.name == "yaw")

    def operating_points(self) -> tuple[OperatingPoint, ...]:
        """Return the steady motions at which the yaw loop is analysed on a vessel.

        The motors are checked first, so that they settle later than those of the base class. Ahead
        no motion is steady, because the speed is estimated from the thrust alone.
        """
        points = []
        for point in super().operating_points():
            yaw = tuple(loop for loop in point.loops if loop.measured == "r")
            if yaw and "surge_mps" not in point.goal:
                name = point.name.replace(", surge", "")
                points.append(
                    replace(
                        point,
                        name=name,
                        loops=yaw,
                        pulse={"yaw_radps": YAW_PULSE},
                        unmeasured=("u", "v"),
                        settle=LATER,
                    )
                )
        return tuple(points)

    def command_slopes(
        self, axis: str, swaying: bool, commands: Mapping[str, float]
    ) -> dict[str, float]:
        """Return the change of each corrected command per unit of demanded force or moment.

        Args:
            axis: "X" for a surge force, "N" for a yaw moment.
            swaying: Whether there is a sway demand.
            commands: Corrected commands about which the derivative is taken, by name of channel.
        """
        uncorrected = self._uncorrected_commands(commands)
        slopes = super().command_slopes(axis, swaying, uncorrected)
        for name, value in uncorrected.items():
            if not name.startswith("steer") and value < 0.0:
                slopes[name] *= self._astern
        return slopes

    def wrench_slopes(
        self, axis: str, swaying: bool, commands: Mapping[str, float]
    ) -> dict[str, float]:
        """Return the change of the assumed force and moment per unit of a demanded one.

        Args:
            axis: "X" for a surge force, "N" for a yaw moment.
            swaying: Whether there is a sway demand.
            commands: Corrected commands about which the derivative is taken, by name of channel.
        """
        return super().wrench_slopes(axis, swaying, self._uncorrected_commands(commands))

    def _uncorrected_commands(self, commands: Mapping[str, float]) -> dict[str, float]:
        """Return the commands of the base class that lead to given corrected ones."""
        found = {}
        for name, value in commands.items():
            if name.startswith("steer"):
                found[name] = value + self._angle
            elif value < 0.0:
                found[name] = value / self._astern
            else:
                found[name] = value
        return found

    def _make_motor_check(self) -> MotorCheck:
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

    def _pulse_commands(self, check: MotorCheck, pulse: Pulse) -> dict[str, float]:
        """Return the commands of a pulse: both motors ahead, astern or off, one turned inward."""
        astern = max(
            check.astern * self.pwm_for_thrust(-self.thrust_at_pwm(self.check_pwm)), -PWM_MAX
        )
        pwm = float(round({1: self.check_pwm, -1: astern, 0: 0.0}[pulse.sense]))
        return {
            "pwm_port": pwm,
            "pwm_starboard": pwm,
            "steer_port_rad": ANGLE_MAX if pulse.inward == PORT else 0.0,
            "steer_starboard_rad": -ANGLE_MAX if pulse.inward == STARBOARD else 0.0,
        }

    def _store_check_result(self, check: MotorCheck, compass: float) -> None:
        """Store the result of the check and the motion that it left."""
        d = ANGLE_MAX
        # a pulse of thrust F turns by F (lever(d) - B), of which an angle e more takes F e (B sin d
        # + L cos d + L)
        reach = self.half_spacing * sin(d) + self.arm * (cos(d) + 1.0)
        self._astern = check.astern
        self._angle = (
            check.yaw_asymmetry * (self.half_spacing - self.arm_per_thrust_difference(d)) / reach
        )
        self._scale = (
            check.ahead_acceleration
            * self.mass
            / (self.thrust_at_pwm(self.check_pwm) * (1.0 + cos(d)))
        )
        self._u = check.speed
        self._psi, self._left = compass, wrap(self._start - compass)
        self._check = None

    def _corrected_commands(self, sense: Sense, goal: Mapping[str, float]) -> dict[str, float]:
        """Return the base commands for the reckoned speed, corrected for the motors."""
        stick = goal.get("surge_mps", 0.0)
        turn = clip(self._left, -TURN_BACK * self.period, TURN_BACK * self.period)
        self._left -= turn
        asked = {
            **goal,
            "surge_mps": stick - self.way_gain * self._x,
            "yaw_radps": goal.get("yaw_radps", 0.0) + turn / self.period,
        }
        commands = super().step(replace(sense, u=self._u, psi=sense.psi - self._psi), asked)
        self._dead_reckon(commands, stick)
        return {name: self._correct_command(name, value) for name, value in commands.items()}

    def _dead_reckon(self, commands: Mapping[str, float], stick: float) -> None:
        """Advance reckoned speed and distance by one period."""
        pwm = int(commands["pwm_port"]), int(commands["pwm_starboard"])
        push = self.wrench_for_commands(
            OutboardSetting(*pwm, round(degrees(commands["steer_port_rad"])))
        )
        self._u += self.period * self._scale * push.X / self.mass
        self._x += self.period * (self._u - stick)

    def _correct_command(self, name: str, value: float) -> float:
        """Return the command that makes the motors respond as the base class assumes."""
        if name.startswith("steer"):
            return value - self._angle
        return value if value >= 0.0 else float(round(max(value * self._astern, -PWM_MAX)))
