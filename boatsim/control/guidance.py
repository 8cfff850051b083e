"""Line-of-sight guidance: the heading that brings a vessel to a path and keeps it there.

A vessel aims at a point on the path that is a look-ahead distance ahead of it. In a current its
course differs from its heading by the crab angle, which leaves an offset; the integral and the
adaptive law remove it.

T. I. Fossen, Handbook of Marine Craft Hydrodynamics and Motion Control, 2nd ed. 2021, chapter 12;
E. Borhaug, A. Pavlov, K. Y. Pettersen, Integral LOS control for path following of underactuated
marine surface vessels in the presence of constant ocean currents, IEEE CDC 2008; T. I. Fossen, An
adaptive line-of-sight (ALOS) guidance law for path following of aircraft and marine craft, IEEE
Trans. Control Systems Technology 31, 2023.
"""

from dataclasses import dataclass, field
from math import atan, hypot, sin, tan
from typing import NamedTuple

from boatsim.control.base import clip
from boatsim.control.paths import PathPoint, cross_track_error
from boatsim.errors import BadInput, unknown_name_message

LAWS = ("line_of_sight", "integral", "adaptive")
# [rad] largest crab angle that the laws compensate: a side current of 0.84 of the speed through the
# water. A larger one leaves little speed along the path.
LARGEST_CRAB_ANGLE = 1.0


class Guidance(NamedTuple):
    """Heading to steer, and the deviation from the path."""

    heading: float  # [rad]
    heading_rate: float  # [rad/s]
    cross_track: float  # [m] positive to starboard of the path
    crab_angle: float  # [rad] estimated course minus heading


def line_of_sight_angle(cross_track: float, lookahead: float) -> float:
    """Return the angle from the course of the path to the line of sight [rad].

    Args:
        cross_track: Distance from the path, positive to starboard [m].
        lookahead: Look-ahead distance [m].
    """
    return -atan(cross_track / lookahead)


def integral_rate(cross_track: float, integral: float, lookahead: float, gain: float) -> float:
    """Return the rate of the integral of integral line-of-sight guidance [m/s per m/s].

    Far from the path it is small, so that the integral does not wind up on the approach
    (Borhaug, Pavlov and Pettersen 2008).

    Args:
        cross_track: Distance from the path, positive to starboard [m].
        integral: The integral [s].
        lookahead: Look-ahead distance [m].
        gain: Integral gain sigma [m/s].
    """
    aim = cross_track + gain * integral
    return lookahead * cross_track / (lookahead * lookahead + aim * aim)


def crab_angle_rate(cross_track: float, lookahead: float, gain: float) -> float:
    """Return the rate of the crab angle estimate of adaptive line-of-sight guidance [rad/s].

    Args:
        cross_track: Distance from the path, positive to starboard [m].
        lookahead: Look-ahead distance [m].
        gain: Adaptation gain gamma [rad/(m s)].
    """
    return gain * lookahead * cross_track / hypot(lookahead, cross_track)


def integral_gain(speed: float, damping_ratio: float) -> float:
    """Return the gain sigma of the integral law for a damping ratio of the cross-track error [m/s].

    Near the path, e'' + (U / D) e' + (U sigma / D^2) e = 0 with the speed U and the look-ahead
    distance D, so that sigma = U / (4 zeta^2).

    Args:
        speed: Speed over ground [m/s].
        damping_ratio: Damping ratio zeta.
    """
    return speed / (4.0 * damping_ratio**2)


def adaptation_gain(speed: float, lookahead: float, damping_ratio: float) -> float:
    """Return the gain gamma of the adaptive law for a damping ratio of the error [rad/(m s)].

    Near the path, e'' + (U / D) e' + U gamma e = 0 with the speed U and the look-ahead distance D,
    so that gamma = U / (4 zeta^2 D^2).

    Args:
        speed: Speed over ground [m/s].
        lookahead: Look-ahead distance [m].
        damping_ratio: Damping ratio zeta.
    """
    return speed / (4.0 * (damping_ratio * lookahead) ** 2)


@dataclass
class LineOfSight:
    """Line-of-sight guidance by one of three laws.

    line_of_sight:  psi = chi - atan(e / D)
    integral:       psi = chi - atan((e + sigma i) / D),  i' = D e / (D^2 + (e + sigma i)^2)
    adaptive:       psi = chi - b - atan(e / D),          b' = gamma D e / sqrt(D^2 + e^2)

    chi is the course of the path, e the cross-track error, D the look-ahead distance and b the
    estimated crab angle. The gains follow from the damping ratio and the present speed.

    Attributes:
        law: Name of the law, one of `LAWS`.
        lookahead: Look-ahead distance D [m].
        damping_ratio: Damping ratio of the cross-track error.
    """

    law: str
    lookahead: float
    damping_ratio: float = 1.0
    _crab: float = field(default=0.0, init=False)  # [rad] estimate of the adaptive law
    _offset: float = field(default=0.0, init=False)  # [m] sigma i of the integral law

    def __post_init__(self) -> None:
        """Check the law.

        Raises:
            BadInput: There is no such law, or a number is not positive.
        """
        if self.law not in LAWS:
            raise BadInput(unknown_name_message("law", self.law, LAWS))
        if not (self.lookahead > 0.0 and self.damping_ratio > 0.0):
            raise BadInput(
                f"lookahead = {self.lookahead:g} m, damping_ratio = {self.damping_ratio:g}; "
                "allowed is more than 0"
            )

    def reset(self) -> None:
        """Forget the crab angle and the integral."""
        self._crab, self._offset = 0.0, 0.0

    def step(
        self, point: PathPoint, x: float, y: float, course: float, speed: float, period: float
    ) -> Guidance:
        """Return the heading to steer, and advance the integral or the estimate of the crab angle.

        Args:
            point: Foot point of the vessel on the path.
            x: Position to north [m].
            y: Position to east [m].
            course: Course over ground, or the heading where it is not known [rad].
            speed: Speed over ground [m/s].
            period: Time to the next step [s].
        """
        error = cross_track_error(point, x, y)
        aim = error + self._offset
        turned = line_of_sight_angle(aim, self.lookahead)
        heading = point.course - self._crab + turned
        error_rate = speed * sin(course - point.course)
        rate = self._advance(error, speed, period)
        closing = -self.lookahead * error_rate / (self.lookahead**2 + aim * aim)
        heading_rate = point.curvature * speed + closing - rate
        crab = self._crab
        if self.law == "integral":
            crab = atan(self._offset / self.lookahead)
        return Guidance(heading, heading_rate, error, crab)

    def _advance(self, error: float, speed: float, period: float) -> float:
        """Advance the estimates; return the rate of the crab angle of the adaptive law [rad/s]."""
        if self.law == "integral":
            gain = integral_gain(speed, self.damping_ratio)
            # the integral is kept as the distance sigma i, so that it is continuous if sigma varies
            integral = self._offset / gain if gain > 0.0 else 0.0
            rate = gain * integral_rate(error, integral, self.lookahead, gain)
            largest = self.lookahead * tan(LARGEST_CRAB_ANGLE)
            self._offset = clip(self._offset + period * rate, -largest, largest)
            return 0.0
        if self.law == "adaptive":
            gain = adaptation_gain(speed, self.lookahead, self.damping_ratio)
            rate = crab_angle_rate(error, self.lookahead, gain)
            before = self._crab
            after = before + period * rate
            self._crab = clip(after, -LARGEST_CRAB_ANGLE, LARGEST_CRAB_ANGLE)
            return (self._crab - before) / period
        return 0.0
