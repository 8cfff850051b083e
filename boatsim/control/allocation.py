"""Control allocation of surge, sway and yaw demands to two mirrored outboards.

Both motors are turned inward by one angle d >= 0 and run against each other. With D = T_port -
T_starboard, S = T_port + T_starboard (thrusts signed, astern negative), half spacing B and arm L
from the motors to the origin of the moment:

    X = S cos d        Y = D sin d        N = D (B cos d - L sin d) = D R sin(gamma - d)

with R = hypot(B, L) and the neutral angle gamma = atan(B / L). B, L and the thrust curve are
nominal; differences to the boat act on a control loop as a disturbance.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from math import asin, atan2, copysign, cos, degrees, exp, hypot, pi, radians, sin, tan
from typing import Any, NamedTuple

import numpy as np

from boatsim.control.base import clip
from boatsim.control.compiled import record_type
from boatsim.physics.base import CheckedParameters, param
from boatsim.physics.kernel.compiling import lean, merged

PWM_RATED = 150.0  # thrusts are quoted at this PWM value (Bayless 2017, appendix H: nominalpower)
PWM_MAX = 255.0  # eight bits
ANGLE_MAX = radians(45.0)  # [rad] inward range of the steering (Bayless 2017, Fig. 8)
HOLD_SHARE = 0.45  # surge correction over differential thrust while the motors give sway
TURN_SHARE = 0.8  # the same while they only turn the boat
# part of that share which a turn at the motors' limits leaves to surge, or the boat drifts ahead
SURGE_RESERVE = 0.3
# [N], [N m] or share of the rated thrust over which derivatives are taken, well above rounding
SLOPE_STEP = 1e-4


class Stick(NamedTuple):
    """Demands of the operator at a joystick: surge, sway and yaw."""

    surge: float  # [m/s] ahead
    sway: float  # [m/s] to starboard
    yaw: float  # [rad/s] clockwise

    @classmethod
    def from_goal(cls, goal: Mapping[str, float]) -> "Stick":
        """Return joystick demands from a controller's goal; missing ones are zero.

        Args:
            goal: Mapping with `surge_mps`, `sway_mps` and `yaw_radps`.
        """
        return cls(*(goal.get(name, 0.0) for name in STICK))


STICK = ("surge_mps", "sway_mps", "yaw_radps")


# [rad] integrated gyro, integrated stick, both from the start heading
HEADING = record_type("own", "wanted")


@merged
def integrate_heading(
    h: Any, rate: float, compass: float, stick: float, dt: float, trust: float
) -> None:
    """Integrate measured yaw rate and demanded yaw rate to two headings over one period.

    Full turns are counted. A compass may correct the drift of the gyro.

    Args:
        h: `HEADING` record, advanced in place.
        rate: Yaw rate of the gyro [rad/s].
        compass: Heading of the compass [rad].
        stick: Demanded yaw rate [rad/s].
        dt: Length of the period [s].
        trust: Rate at which the compass corrects the drift of the gyro [1/s].
    """
    h.own += dt * rate
    h.wanted += dt * stick
    if trust > 0.0:
        off = compass - h.own
        h.own += (1.0 - exp(-trust * dt)) * ((off + pi) % (2.0 * pi) - pi)


class Drive(NamedTuple):
    """Thrusts and steering angle of two mirrored outboard motors.

    Thrust astern is negative; the angle is the inward angle of both motors.
    """

    port: float  # [N]
    starboard: float  # [N]
    angle: float  # [rad] 0 to ANGLE_MAX


class Push(NamedTuple):
    """Surge force, sway force and yaw moment of two outboards on the hull."""

    X: float  # [N]
    Y: float  # [N]
    N: float  # [N m]


class OutboardSetting(NamedTuple):
    """Commands of two outboards: integer PWM of the motors and integer degrees of the servos."""

    pwm_port: int
    pwm_starboard: int
    degrees: int

    def commands(self) -> dict[str, float]:
        """Return the outboard commands by name of channel.

        The starboard angle mirrors the port one.
        """
        angle = radians(self.degrees)
        return {
            "pwm_port": float(self.pwm_port),
            "pwm_starboard": float(self.pwm_starboard),
            "steer_port_rad": angle,
            "steer_starboard_rad": -angle,
        }


class Nominal(NamedTuple):
    """Nominal properties of two outboards, such as spacing, lever arm and rated thrust.

    A record with these fields may be used too.
    """

    half_spacing: float  # [m]
    arm: float  # [m]
    rated_thrust: float  # [N]
    reverse_ratio: float
    dead_pwm: float
    thrust_power: float
    largest_difference: float  # [N]
    rated_sway: float  # [m/s]
    sway_thrust: float  # [N]
    sway_dead_zone: float  # [m/s]


limit: Callable[[float, float, float], float] = merged(clip)  # `clip` for compiled callers


@lean
def thrust_difference_for_sway(q: Any, sway: float) -> float:
    """Return the thrust difference D [N] of two outboards that meets a sway demand.

    Sway is an open-loop thrust.

    Args:
        q: Nominal outboards.
        sway: Sway demand [m/s].
    """
    if abs(sway) < q.sway_dead_zone:
        return 0.0
    return limit(q.sway_thrust * sway / q.rated_sway, -q.largest_difference, q.largest_difference)


@lean
def arm_per_thrust_difference(q: Any, angle: float) -> float:
    """Return the yaw moment per thrust difference [m] of two outboards turned inward by d.

    It is B cos d - L sin d with half spacing B and lever arm L.

    Args:
        q: Nominal outboards.
        angle: Inward angle d of both motors [rad].
    """
    return q.half_spacing * cos(angle) - q.arm * sin(angle)


@lean
def thrust_at_pwm(q: Any, pwm: float) -> float:
    """Return the nominal thrust [N] of an outboard at a signed PWM value.

    Args:
        q: Nominal outboards.
        pwm: Signed PWM value.
    """
    share = max(abs(pwm) - q.dead_pwm, 0.0) / (PWM_RATED - q.dead_pwm)
    ahead = q.rated_thrust * share**q.thrust_power
    return ahead if pwm >= 0.0 else -q.reverse_ratio * ahead


@lean
def pwm_for_thrust(q: Any, thrust: float) -> float:
    """Return the signed integer PWM value at which an outboard has nearly a given thrust.

    Args:
        q: Nominal outboards.
        thrust: Thrust [N].
    """
    return np.rint(exact_pwm_for_thrust(q, thrust))


@lean
def exact_pwm_for_thrust(q: Any, thrust: float) -> float:
    """Return the signed PWM value, not rounded, at which an outboard has a given thrust.

    Args:
        q: Nominal outboards.
        thrust: Thrust [N].
    """
    ahead = abs(thrust) if thrust > 0.0 else abs(thrust) / q.reverse_ratio
    if ahead == 0.0:
        return 0.0
    value = q.dead_pwm + (PWM_RATED - q.dead_pwm) * (ahead / q.rated_thrust) ** (
        1.0 / q.thrust_power
    )
    return copysign(min(value, PWM_MAX), thrust)


@lean
def allocate(
    q: Any, surge: float, difference: float, moment: float, room: float
) -> tuple[float, float, float]:
    """Distribute surge, sway and yaw demands to two outboards with a common inward angle.

    Returns port thrust [N], starboard thrust [N] and inward angle [rad]. Yaw has priority over sway
    and sway over surge. The motors swap direction only where `difference` changes its sign or, if
    it is zero, where `moment` does; otherwise the result is continuous. `largest_difference` limits
    the thrust difference for sway; a yaw moment may use all that the motors give.

    Args:
        q: Nominal outboards.
        surge: Surge force [N].
        difference: Thrust difference for sway [N].
        moment: Yaw moment [N m].
        room: Extension of the limit of the surge thrust beyond its share of D [N].
    """
    if difference == 0.0:
        d, share = 0.0, TURN_SHARE
        spread = moment / q.half_spacing
    else:
        share = HOLD_SHARE
        sway = limit(difference, -q.largest_difference, q.largest_difference)
        spread = thrust_difference_for_moment(q, sway, moment)
        d = inward_angle(q, spread, moment)
    largest = thrust_at_pwm(q, PWM_MAX) - thrust_at_pwm(q, -PWM_MAX)
    spread = limit(spread, -largest, largest)
    total, reached = limit_thrusts(q, surge / cos(d), spread, share * abs(spread) + room)
    if difference != 0.0:
        d = inward_angle(q, reached, moment)
    return 0.5 * (total + reached), 0.5 * (total - reached), d


@lean
def thrust_difference_for_moment(q: Any, difference: float, moment: float) -> float:
    """Return the thrust difference D [N] that sway and yaw need together, with the sign of sway.

    D is increased if no inward angle gives the demanded yaw moment otherwise.

    Args:
        q: Nominal outboards.
        difference: Thrust difference for sway [N], not zero.
        moment: Yaw moment [N m].
    """
    helps = moment * difference > 0.0
    needed = moment / arm_per_thrust_difference(q, 0.0 if helps else ANGLE_MAX)
    return copysign(max(abs(difference), abs(needed)), difference)


@lean
def inward_angle(q: Any, spread: float, moment: float) -> float:
    """Return the inward angle [rad] at which two outboards give a yaw moment, within its range.

    Args:
        q: Nominal outboards.
        spread: Thrust difference D [N], not zero.
        moment: Yaw moment [N m].
    """
    sine = moment / (spread * hypot(q.half_spacing, q.arm))
    return limit(atan2(q.half_spacing, q.arm) - asin(limit(sine, -1.0, 1.0)), 0.0, ANGLE_MAX)


@lean
def limit_thrusts(q: Any, total: float, spread: float, bound: float) -> tuple[float, float]:
    """Return sum S and difference D [N] of the thrusts of two outboards within the motors' limits.

    If a motor would exceed its limit, S is reduced to its reserve first, then D.

    Args:
        q: Nominal outboards.
        total: Sum of thrusts S [N].
        spread: Thrust difference D [N].
        bound: Limit of |S| [N].
    """
    ahead, astern = thrust_at_pwm(q, PWM_MAX), -thrust_at_pwm(q, -PWM_MAX)
    total = limit(total, -bound, bound)
    # the largest D that leaves its own share to a surge force astern is 2 astern / (1 + share)
    reserve = SURGE_RESERVE * min(abs(spread), 2.0 * astern / (1.0 + SURGE_RESERVE))
    kept = limit(total, -reserve, reserve)
    spread = copysign(min(abs(spread), 2.0 * astern + kept, 2.0 * ahead - kept), spread)
    total = limit(total, abs(spread) - 2.0 * astern, 2.0 * ahead - abs(spread))
    return total, spread


@lean
def command_outboards(
    q: Any, surge: float, difference: float, moment: float, room: float, sent: Any
) -> tuple[float, float, float]:
    """Allocate demands to two outboards and write the commands; return the nominal force they give.

    The force consists of X, Y [N] and N [N m] and is the input for a state predictor.

    Args:
        q: Nominal outboards.
        surge: Surge force [N].
        difference: Thrust difference for sway [N].
        moment: Yaw moment [N m].
        room: Extension of the limit of the surge thrust [N].
        sent: Record of commands to fill in.
    """
    port, starboard, angle = allocate(q, surge, difference, moment, room)
    write_outboard_commands(q, port, starboard, angle, sent)
    return nominal_wrench(
        q,
        thrust_at_pwm(q, sent.pwm_port),
        thrust_at_pwm(q, sent.pwm_starboard),
        sent.steer_port_rad,
    )


@lean
def write_outboard_commands(q: Any, port: float, starboard: float, angle: float, sent: Any) -> None:
    """Write thrusts and angle of two outboards to a record of commands.

    They are rounded to integer PWM and degrees. The fields are `pwm_port`, `pwm_starboard`,
    `steer_port_rad` and, mirrored, `steer_starboard_rad`.

    Args:
        q: Nominal outboards.
        port: Port thrust [N].
        starboard: Starboard thrust [N].
        angle: Inward angle [rad].
        sent: Record of commands to fill in.
    """
    sent.pwm_port, sent.pwm_starboard = pwm_for_thrust(q, port), pwm_for_thrust(q, starboard)
    turned = radians(np.rint(degrees(angle)))
    sent.steer_port_rad, sent.steer_starboard_rad = turned, -turned


@lean
def nominal_wrench(
    q: Any, port: float, starboard: float, angle: float
) -> tuple[float, float, float]:
    """Return the nominal force X, Y [N] and yaw moment N [N m] of two outboards on the hull.

    Args:
        q: Nominal outboards.
        port: Port thrust [N].
        starboard: Starboard thrust [N].
        angle: Inward angle [rad].
    """
    spread, total = port - starboard, port + starboard
    return total * cos(angle), spread * sin(angle), spread * arm_per_thrust_difference(q, angle)


@dataclass
class Outboards(CheckedParameters):
    """Nominal properties of two mirrored outboards, and the control allocation that uses them."""

    half_spacing: float = param(
        0.235, low=0.05, high=0.4, unit="m", words="assumed motor to centreline"
    )
    arm: float = param(
        0.62, low=0.45, high=2.0, unit="m", words="assumed motors to centre of lateral resistance"
    )
    rated_thrust: float = param(
        0.5, low=0.05, high=5.0, unit="N", words="assumed thrust of a motor at PWM 150"
    )
    reverse_ratio: float = param(
        0.67, low=0.2, high=1.0, unit="", words="assumed thrust astern over thrust ahead"
    )
    dead_pwm: float = param(
        0.0, low=0.0, high=120.0, unit="", words="assumed PWM below which a motor gives nothing"
    )
    thrust_power: float = param(
        1.0, low=0.5, high=3.0, unit="", words="assumed exponent of thrust over PWM"
    )
    largest_difference: float = param(
        0.9, low=0.05, high=5.0, unit="N", words="largest port minus starboard thrust for sway"
    )
    rated_sway: float = param(
        0.07, low=0.01, high=1.0, unit="m/s", words="sway command that gets the sway thrust"
    )
    sway_thrust: float = param(
        0.6, low=0.05, high=5.0, unit="N", words="thrust difference for that sway command"
    )
    sway_dead_zone: float = param(
        0.007, low=0.0, high=1.0, unit="m/s", words="smaller sway commands count as none"
    )
    compass_trust: float = param(
        0.0, low=0.0, high=5.0, unit="1/s", words="rate at which the compass corrects the gyro"
    )

    @property
    def nominal_properties(self) -> Nominal:
        """Nominal properties of the outboards as a record for compiled functions."""
        return Nominal(*(getattr(self, name) for name in Nominal._fields))

    def thrust_difference_for_sway(self, sway: float) -> float:
        """Return the thrust difference D [N] of two outboards for a sway demand.

        Sway is controlled in open loop.

        Args:
            sway: Sway demand [m/s].
        """
        return thrust_difference_for_sway(self.nominal_properties, sway)

    def largest_goals(self) -> Mapping[str, float]:
        """Return the largest sway demand [m/s], which needs the largest thrust difference."""
        return {"sway_mps": self.rated_sway * self.largest_difference / self.sway_thrust}

    def arm_per_thrust_difference(self, angle: float) -> float:
        """Return the yaw moment per thrust difference [m] of the outboards at an inward angle.

        Args:
            angle: Inward angle of both motors [rad].
        """
        return arm_per_thrust_difference(self.nominal_properties, angle)

    def neutral_angle(self) -> float:
        """Return the inward angle [rad] at which the outboards give sway without yaw moment."""
        return atan2(self.half_spacing, self.arm)

    def allocate(self, surge: float, difference: float, moment: float, room: float = 0.0) -> Drive:
        """Return thrusts and angle of the outboards for demanded surge force, sway and yaw moment.

        The function `allocate` explains the priorities.

        Args:
            surge: Surge force [N].
            difference: Thrust difference for sway [N].
            moment: Yaw moment [N m].
            room: Extension of the limit of the surge thrust [N].
        """
        return Drive(*allocate(self.nominal_properties, surge, difference, moment, room))

    def pwm_for_thrust(self, thrust: float) -> int:
        """Return the signed integer PWM value at which an outboard has nearly a given thrust.

        Args:
            thrust: Thrust [N].
        """
        return round(pwm_for_thrust(self.nominal_properties, thrust))

    def thrust_at_pwm(self, pwm: float) -> float:
        """Return the nominal thrust [N] of an outboard at a signed PWM value.

        Args:
            pwm: Signed PWM value.
        """
        return thrust_at_pwm(self.nominal_properties, pwm)

    def commands_for_thrusts(self, drive: Drive) -> OutboardSetting:
        """Return the PWM and servo commands for thrusts and angle of the outboards.

        They are rounded, and limited to what motors and servos accept.

        Args:
            drive: Thrusts and angle of the outboards.
        """
        return OutboardSetting(
            self.pwm_for_thrust(drive.port),
            self.pwm_for_thrust(drive.starboard),
            round(degrees(drive.angle)),
        )

    def command_slopes(
        self, axis: str, swaying: bool, commands: Mapping[str, float]
    ) -> dict[str, float]:
        """Return the change of each outboard command per unit of demanded force or moment.

        It is the derivative of `allocate` and of the conversion to commands, without rounding.

        Args:
            axis: "X" for a surge force, "Y" for a sway force, "N" for a yaw moment.
            swaying: Whether there is a sway demand, so that the steering angles give the moment.
            commands: Commands about which the derivative is taken, by name of channel.

        Returns:
            Derivatives by name of channel, per N or per N m.
        """
        q, change = self.nominal_properties, self._drive_slopes(axis, swaying, commands)
        near = SLOPE_STEP * self.rated_thrust
        slopes = {"steer_port_rad": change.angle, "steer_starboard_rad": -change.angle}
        for name, by in (("pwm_port", change.port), ("pwm_starboard", change.starboard)):
            thrust = self.thrust_at_pwm(commands[name])
            more, less = (exact_pwm_for_thrust(q, thrust + d) for d in (near, -near))
            slopes[name] = by * (more - less) / (2.0 * near)
        return slopes

    def wrench_slopes(
        self, axis: str, swaying: bool, commands: Mapping[str, float]
    ) -> dict[str, float]:
        """Return the change of the nominal force and moment per unit of a demanded one.

        Args:
            axis: Axis of the demand, as in `command_slopes`.
            swaying: Whether there is a sway demand.
            commands: Commands about which the derivative is taken, by name of channel.

        Returns:
            Derivatives by axis: "X", "Y" and "N".
        """
        port = self.thrust_at_pwm(commands["pwm_port"])
        starboard = self.thrust_at_pwm(commands["pwm_starboard"])
        drive = Drive(port, starboard, commands["steer_port_rad"])
        by = self._drive_slopes(axis, swaying, commands)
        pushes = []
        for d in (SLOPE_STEP, -SLOPE_STEP):
            changed = (x + d * slope for x, slope in zip(drive, by, strict=True))
            pushes.append(self.nominal_wrench(Drive(*changed)))
        slopes = {}
        for name in Push._fields:
            difference = getattr(pushes[0], name) - getattr(pushes[1], name)
            slopes[name] = difference / (2.0 * SLOPE_STEP)
        return slopes

    def _drive_slopes(self, axis: str, swaying: bool, commands: Mapping[str, float]) -> Drive:
        """Return the change of thrusts and angle per unit of demanded force or moment."""
        angle, neutral = commands["steer_port_rad"], self.neutral_angle()
        spread = self.thrust_at_pwm(commands["pwm_port"])
        spread -= self.thrust_at_pwm(commands["pwm_starboard"])
        total_change = spread_change = angle_change = 0.0
        if axis == "X":
            total_change = 1.0 / cos(angle)
        elif axis == "Y":
            spread_change = 1.0 / sin(neutral)
            # the moment D R sin(gamma - d) stays the same
            angle_change = spread_change * tan(neutral - angle) / spread
        elif swaying:
            lever = hypot(self.half_spacing, self.arm)
            angle_change = -1.0 / (spread * lever * cos(neutral - angle))
        else:
            spread_change = 1.0 / self.half_spacing
        return Drive(
            0.5 * (total_change + spread_change), 0.5 * (total_change - spread_change), angle_change
        )

    def nominal_wrench(self, drive: Drive) -> Push:
        """Return the nominal force and yaw moment of the outboards at given thrusts and angle.

        Args:
            drive: Thrusts and angle of the outboards.
        """
        return Push(
            *nominal_wrench(self.nominal_properties, drive.port, drive.starboard, drive.angle)
        )

    def wrench_for_commands(self, setting: OutboardSetting) -> Push:
        """Return the nominal force and yaw moment of the outboards under given commands.

        They are the input of a state predictor.

        Args:
            setting: PWM and servo commands of the outboards.
        """
        angle = radians(setting.degrees)
        return self.nominal_wrench(
            Drive(
                self.thrust_at_pwm(setting.pwm_port),
                self.thrust_at_pwm(setting.pwm_starboard),
                angle,
            )
        )
