"""How a joystick's surge, sway and yaw demands become settings of two mirrored outboards, and what those then give.

Both motors turn inward by one angle d >= 0 and run against each other. With D = T_port - T_starboard, S = T_port +
T_starboard (thrusts signed, astern negative), half spacing B and arm L from the motors to the origin of the moment:

    X = S cos d        Y = D sin d        N = D (B cos d - L sin d) = D R sin(gamma - d)

with R = hypot(B, L) and gamma = atan(B/L) the neutral angle. B, L and the thrust curve are nominal values: what the
boat really has enters a control loop as a disturbance.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from math import asin, atan2, copysign, cos, degrees, exp, hypot, pi, radians, sin
from typing import Any, NamedTuple

import numpy as np

from boatsim.control.compiled import record
from boatsim.physics.base import Checked, param
from boatsim.physics.kernel.compiling import lean, merged

PWM_RATED = 150.0  # thrusts are quoted at this PWM value (Bayless 2017, appendix H: nominalpower)
PWM_MAX = 255.0  # eight bits
ANGLE_MAX = radians(45.0)  # [rad] inward range of the steering (Bayless 2017, Fig. 8)
HOLD_SHARE = 0.45  # surge correction over differential thrust while the motors give sway
TURN_SHARE = 0.8  # the same while they only turn the boat
# part of that share which a turn at the motors' limits leaves to surge, or the boat drifts ahead
SURGE_RESERVE = 0.3


class Stick(NamedTuple):
    """What the operator asks for."""

    surge: float  # [m/s] ahead
    sway: float  # [m/s] to starboard
    yaw: float  # [rad/s] clockwise

    @classmethod
    def read(cls, goal: Mapping[str, float]) -> "Stick":
        """From the goal's `surge_mps`, `sway_mps`, `yaw_radps`; what is not given is zero."""
        return cls(*(goal.get(name, 0.0) for name in STICK))


STICK = ("surge_mps", "sway_mps", "yaw_radps")


# [rad] integrated gyro, integrated stick, both from the start heading
HEADING = record("own", "wanted")


@merged
def keep_heading(
    h: Any, rate: float, compass: float, stick: float, dt: float, trust: float
) -> None:
    """One period of dt [s] of a `HEADING`; `trust` [1/s] is the rate at which the compass takes the gyro's drift out.

    Whole turns count.
    """
    h.own += dt * rate
    h.wanted += dt * stick
    if trust > 0.0:
        off = compass - h.own
        h.own += (1.0 - exp(-trust * dt)) * ((off + pi) % (2.0 * pi) - pi)


class Drive(NamedTuple):
    """Thrust of each motor, astern negative, and the angle by which both turn inward."""

    port: float  # [N]
    starboard: float  # [N]
    angle: float  # [rad] 0 to ANGLE_MAX


class Push(NamedTuple):
    """Force on the hull in body axes and moment about the origin of the nominal arm."""

    X: float  # [N]
    Y: float  # [N]
    N: float  # [N m]


class Setting(NamedTuple):
    """A drive as the servos and motor controllers take it: whole PWM steps and whole degrees."""

    pwm_port: int
    pwm_starboard: int
    degrees: int

    def commands(self) -> dict[str, float]:
        """By name of command channel; the starboard angle is the mirror image of the port one."""
        angle = radians(self.degrees)
        return {
            "pwm_port": float(self.pwm_port),
            "pwm_starboard": float(self.pwm_starboard),
            "steer_port_rad": angle,
            "steer_starboard_rad": -angle,
        }


class Nominal(NamedTuple):
    """What the laws below take of two outboards; a record with fields of these names serves as well."""

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


@merged
def within(value: float, low: float, high: float) -> float:
    """Nearest value inside [low, high]."""
    return low if value < low else high if value > high else value


@lean
def sway_difference(q: Any, sway: float) -> float:
    """Thrust difference D [N] for a sway command [m/s]."""
    if abs(sway) < q.sway_dead_zone:
        return 0.0
    return within(q.sway_thrust * sway / q.rated_sway, -q.largest_difference, q.largest_difference)


@lean
def lever(q: Any, angle: float) -> float:
    """Moment over thrust difference [m] with both motors turned inward by `angle` [rad]."""
    return q.half_spacing * cos(angle) - q.arm * sin(angle)


@lean
def thrust_at(q: Any, pwm: float) -> float:
    """Nominal thrust [N] at a signed PWM value."""
    share = max(abs(pwm) - q.dead_pwm, 0.0) / (PWM_RATED - q.dead_pwm)
    ahead = q.rated_thrust * share**q.thrust_power
    return ahead if pwm >= 0.0 else -q.reverse_ratio * ahead


@lean
def pwm(q: Any, thrust: float) -> float:
    """Signed whole PWM value whose nominal thrust is nearest to `thrust` [N]."""
    ahead = abs(thrust) if thrust > 0.0 else abs(thrust) / q.reverse_ratio
    if ahead == 0.0:
        return 0.0
    value = q.dead_pwm + (PWM_RATED - q.dead_pwm) * (ahead / q.rated_thrust) ** (
        1.0 / q.thrust_power
    )
    return np.rint(copysign(min(value, PWM_MAX), thrust))


@lean
def allocate(
    q: Any, surge: float, difference: float, moment: float, room: float
) -> tuple[float, float, float]:
    """Thrusts and angle of a `Drive` for a surge force [N], a sway thrust difference [N] and a moment [N m].

    Yaw comes first, then sway, then surge. `room` [N] widens the bound on the surge thrust beyond its share of D. The
    motors swap direction only where `difference` changes sign or, where it is zero, where `moment` does; elsewhere the
    drive is continuous.
    """
    if difference == 0.0:
        d, spread, share = 0.0, moment / q.half_spacing, TURN_SHARE
    else:
        d, spread = steered(q, difference, moment)
        share = HOLD_SHARE
    spread = within(spread, -q.largest_difference, q.largest_difference)
    port, starboard = powered(q, surge / cos(d), spread, share * abs(spread) + room)
    return port, starboard, d


@lean
def steered(q: Any, difference: float, moment: float) -> tuple[float, float]:
    """Angle and D for sway: D as asked or, if no angle then gives the moment, as large as the moment needs."""
    helps = moment * difference > 0.0
    needed = moment / lever(q, 0.0 if helps else ANGLE_MAX)
    spread = copysign(max(abs(difference), abs(needed)), difference)
    sine = moment / (spread * hypot(q.half_spacing, q.arm))
    return within(
        atan2(q.half_spacing, q.arm) - asin(within(sine, -1.0, 1.0)), 0.0, ANGLE_MAX
    ), spread


@lean
def powered(q: Any, total: float, spread: float, bound: float) -> tuple[float, float]:
    """Both thrusts from S and D; where a motor would exceed its bound S yields, all but its reserve, then D."""
    ahead, astern = thrust_at(q, PWM_MAX), -thrust_at(q, -PWM_MAX)
    total = within(total, -bound, bound)
    kept = within(total, -SURGE_RESERVE * abs(spread), SURGE_RESERVE * abs(spread))
    spread = copysign(min(abs(spread), 2.0 * astern + kept, 2.0 * ahead - kept), spread)
    total = within(total, abs(spread) - 2.0 * astern, 2.0 * ahead - abs(spread))
    return 0.5 * (total + spread), 0.5 * (total - spread)


@lean
def set_outboards(
    q: Any, surge: float, difference: float, moment: float, room: float, sent: Any
) -> tuple[float, float, float]:
    """Allocate and send; nominal force and moment of what was sent, which is what a predictor should be told."""
    port, starboard, angle = allocate(q, surge, difference, moment, room)
    send_outboards(q, port, starboard, angle, sent)
    return push(
        q, thrust_at(q, sent.pwm_port), thrust_at(q, sent.pwm_starboard), sent.steer_port_rad
    )


@lean
def send_outboards(q: Any, port: float, starboard: float, angle: float, sent: Any) -> None:
    """A drive as servos and motor controllers take it, whole PWM steps and whole degrees, to a record of commands.

    Its fields are `pwm_port`, `pwm_starboard`, `steer_port_rad` and, its mirror image, `steer_starboard_rad`.
    """
    sent.pwm_port, sent.pwm_starboard = pwm(q, port), pwm(q, starboard)
    turned = radians(np.rint(degrees(angle)))
    sent.steer_port_rad, sent.steer_starboard_rad = turned, -turned


@lean
def push(q: Any, port: float, starboard: float, angle: float) -> tuple[float, float, float]:
    """Nominal force X, Y [N] and moment N [N m] of thrusts [N] at an inward angle [rad]."""
    spread, total = port - starboard, port + starboard
    return total * cos(angle), spread * sin(angle), spread * lever(q, angle)


@dataclass
class Outboards(Checked):
    """What a controller believes of its two outboards, and the allocation built on it."""

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
        0.9, low=0.05, high=5.0, unit="N", words="largest port minus starboard thrust"
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
    def nominal(self) -> Nominal:
        """Its numbers, as the compiled laws take them."""
        return Nominal(*(getattr(self, name) for name in Nominal._fields))

    def sway_difference(self, sway: float) -> float:
        """Thrust difference D [N] for a sway command [m/s]; sway is open loop, so D is all there is to choose."""
        return sway_difference(self.nominal, sway)

    def largest_goals(self) -> Mapping[str, float]:
        """The sway command [m/s] that takes the largest thrust difference."""
        return {"sway_mps": self.rated_sway * self.largest_difference / self.sway_thrust}

    def lever(self, angle: float) -> float:
        """Moment over thrust difference [m] with both motors turned inward by `angle` [rad]."""
        return lever(self.nominal, angle)

    def neutral_angle(self) -> float:
        """Inward angle [rad] at which the motors give sway without a moment."""
        return atan2(self.half_spacing, self.arm)

    def allocate(self, surge: float, difference: float, moment: float, room: float = 0.0) -> Drive:
        """Drive for a surge force [N], a sway thrust difference [N] and a moment [N m]; see `allocate`."""
        return Drive(*allocate(self.nominal, surge, difference, moment, room))

    def pwm(self, thrust: float) -> int:
        """Signed whole PWM value whose nominal thrust is nearest to `thrust` [N]."""
        return round(pwm(self.nominal, thrust))

    def thrust(self, pwm: float) -> float:
        """Nominal thrust [N] at a signed PWM value."""
        return thrust_at(self.nominal, pwm)

    def setting(self, drive: Drive) -> Setting:
        """The drive rounded and capped to what motors and servos accept."""
        return Setting(self.pwm(drive.port), self.pwm(drive.starboard), round(degrees(drive.angle)))

    def push(self, drive: Drive) -> Push:
        """Nominal force and moment of a drive."""
        return Push(*push(self.nominal, drive.port, drive.starboard, drive.angle))

    def applied(self, setting: Setting) -> Push:
        """Nominal force and moment of a rounded and capped setting: what a predictor should be told."""
        angle = radians(setting.degrees)
        return self.push(
            Drive(self.thrust(setting.pwm_port), self.thrust(setting.pwm_starboard), angle)
        )
