"""Motor check: pulses from rest that identify how two outboards differ from their nominal model.

One motor is turned inward, the other is straight. Both push ahead, twice astern, and ahead again,
and the boat ends at rest where it started. Whatever the inertia and the levers are, the two yaw
accelerations have the ratio of the two thrusts, which gives the reverse ratio. Then the other motor
is turned inward: if both steerings have the same offset, one side turns the boat faster than the
other.
"""

from collections.abc import Iterator
from dataclasses import dataclass, field
from math import exp, log
from typing import NamedTuple

import numpy as np

from boatsim.control.base import LowPass, clip
from boatsim.errors import BadInput
from boatsim.physics.base import Array

PORT, STARBOARD, NEITHER = 0, 1, 2  # which motor is turned inward
POWERS = (0.8, 2.0)  # plausible range of the exponent of thrust over setting
FAR = 0.15  # smallest logarithm of the ratio of two settings that identifies the exponent
WILDEST = 3.0  # largest plausible ratio of thrust astern to ahead, or its inverse


class Pulse(NamedTuple):
    """Motor settings of two outboards in one period of a motor check."""

    sense: int  # both motors 1 ahead, -1 astern, 0 off
    inward: int  # PORT, STARBOARD or NEITHER


class Drift(NamedTuple):
    """Effect of sideways drift on a boat that turns: yaw and surge per yaw rate squared.

    A motor check accounts for it: it has the same sign for thrust ahead and astern and would
    otherwise appear as a difference of the motors.
    """

    yaw: float  # [1] acceleration towards the side that ahead turns to
    surge: float  # [m] deceleration


class Found(NamedTuple):
    """Response of the boat to one series of thrust pulses of a motor check."""

    turn: float  # [rad/s^2] while both motors push ahead
    reverse: float  # thrust astern over thrust ahead, of the settings that were played
    variance: float  # of that ratio
    push: float  # [m/s^2] ahead
    slowed: float  # [m/s] by drift


@dataclass
class PulseTrain:
    """Train of thrust pulses of a motor check, and the sensor readings during it.

    The motors rest between the pulses and all pulses have the same length, so that the transients
    of the thrust cancel.
    """

    pulse: int  # [periods]
    rest: int  # [periods] before, between and behind
    # [rad/s] one a period, the first before the train
    rates: list[float] = field(default_factory=list)
    felt: list[float] = field(default_factory=list)  # [m/s^2] ahead, at the same times

    def __post_init__(self) -> None:
        still = [0] * self.rest
        self.senses = list(still)
        for sense in (1, -1, -1, 1):
            self.senses += [sense] * self.pulse + still

    def add_imu_readings(self, rate: float, felt: float) -> None:
        """Append gyro and accelerometer readings at the begin of a period to a pulse train.

        After the last period, those at its end are appended too.

        Args:
            rate: Yaw rate [rad/s].
            felt: Acceleration ahead [m/s^2].
        """
        self.rates.append(rate)
        self.felt.append(felt)

    def fit_pulse_response(self, period: float, lag: float, drift: Drift, aside: int) -> Found:
        """Return the boat's response to a train of thrust pulses, by least squares.

        Args:
            period: Length of a period [s].
            lag: Lag of the thrust [s].
            drift: Effect of drift.
            aside: Sign of the yaw rate under thrust ahead.

        Raises:
            BadInput: The boat did not move.
        """
        on = np.column_stack(
            [_delayed_thrust(self.senses, sense, period, lag) for sense in (1, -1)]
        )
        gained = np.vstack([np.zeros(2), period * np.cumsum(0.5 * (on[1:] + on[:-1]), axis=0)])
        square = np.cumsum(np.square(self.rates)) * period
        turns, spread = _fit_least_squares(
            gained, np.array(self.rates) - aside * drift.yaw * square
        )
        pushes, _ = _fit_least_squares(on, np.array(self.felt))
        if pushes[0] <= 0.0 or turns[0] == 0.0:
            raise BadInput(
                f"the motors were tried and pushed the boat ahead by {pushes[0]:.3g} m/s^2; is "
                "it free to move?"
            )
        reverse = clip(float(-turns[1] / turns[0]), 1.0 / WILDEST, WILDEST)
        variance = float(spread[0] * reverse**2 + spread[1]) / float(turns[0]) ** 2
        return Found(
            float(turns[0]), reverse, variance, float(pushes[0]), drift.surge * float(square[-1])
        )


def _delayed_thrust(senses: list[int], sense: int, period: float, lag: float) -> Array:
    """Return the share of thrust in one sense (N + 1,) at each reading, with the lag [s]."""
    low_pass = LowPass(1.0 / lag)
    return np.array([0.0, *(low_pass.step(float(s == sense), period) for s in senses)])


def _fit_least_squares(columns: Array, values: Array) -> tuple[Array, Array]:
    """Return the factors of the columns in a fit with a constant, and their variances."""
    a = np.column_stack([columns, np.ones(len(values))])
    inverse = np.linalg.inv(a.T @ a)
    factors = inverse @ (a.T @ values)
    noise = float(np.sum((values - a @ factors) ** 2)) / (len(values) - a.shape[1])
    return factors[:2], np.diag(inverse)[:2] * max(noise, 1e-12)


@dataclass
class MotorCheck:
    """Motor check: pulse trains that identify the thrust of two outboards astern over that ahead.

    Pairs of trains, one for each side, follow until the ratio is known well enough. A constant
    moment, of wind for instance, adds to one side what it subtracts from the other. After each pair
    the astern setting is corrected, and the remaining speed is removed by pulses straight ahead or
    astern.
    """

    period: float  # [s]
    rest: float  # [s] between pulses
    reach: float  # [m/s] that a pulse is to give
    shortest: float  # [s] of a pulse
    longest: float  # [s]
    lag: float  # [s] of thrust behind its command
    drift: Drift
    power: float  # guess of the exponent of thrust over setting
    enough: float  # standard deviation of the reverse at which it ends
    most: int  # pairs
    straight: float  # acceleration with both motors straight over that with one turned inward

    def __post_init__(self) -> None:
        self.astern = 1.0  # factor on settings astern that gives as much thrust as ahead
        self.speed = 0.0  # [m/s] that the boat is left with
        self.done = False
        self._found: list[Found] = []
        self._read: list[tuple[float, float]] = []  # logarithms of setting and reverse, by pair
        self._reading = (0.0, 0.0)
        self._program: Iterator[Pulse] | None = None

    @property
    def ahead_acceleration(self) -> float:
        """Measured acceleration [m/s^2] with both outboards ahead, one of them turned inward."""
        return float(np.mean([f.push for f in self._found]))

    @property
    def yaw_asymmetry(self) -> float:
        """Relative difference (a - b) / (a + b) of the yaw accelerations to both sides.

        They are measured with the port (a) and with the starboard (b) outboard turned inward.
        """
        a, b = (
            abs(float(np.mean([f.turn for f in self._found[side::2]])))
            for side in (PORT, STARBOARD)
        )
        return (a - b) / (a + b)

    def step(self, rate: float, felt: float) -> Pulse:
        """Process the readings of a period of the motor check and return the next motor settings.

        The motors are off when the check is `done`.

        Args:
            rate: Yaw rate [rad/s].
            felt: Acceleration ahead [m/s^2].
        """
        self._reading = rate, felt
        self._program = self._program or self._pulse_sequence()
        pulse = next(self._program, None)
        self.done = pulse is None
        return pulse or Pulse(0, NEITHER)

    def _pulse_sequence(self) -> Iterator[Pulse]:
        """Yield the pulses of all pairs; a reading is taken at the begin of the next pulse."""
        length = self.shortest
        for pair in range(self.most):
            for side in (PORT, STARBOARD):
                train = PulseTrain(round(length / self.period), round(self.rest / self.period))
                for sense in train.senses:
                    train.add_imu_readings(*self._reading)
                    yield Pulse(sense, side)
                train.add_imu_readings(*self._reading)
                self._found.append(
                    train.fit_pulse_response(
                        self.period, self.lag, self.drift, 1 if side == STARBOARD else -1
                    )
                )
            self._update_from_pair(train.senses)
            for sense in self._braking_pulses():
                yield Pulse(sense, NEITHER)
            if pair and self._standard_error() < self.enough:
                return
            length = clip(self.reach / self.ahead_acceleration, self.shortest, self.longest)

    def _update_from_pair(self, senses: list[int]) -> None:
        """Update the remaining speed by the last pair, and correct the astern setting."""
        pair = self._found[-2:]
        reverse = (pair[PORT].reverse * pair[STARBOARD].reverse) ** 0.5
        self.speed += (
            2.0
            * self.ahead_acceleration
            * self.period
            * (senses.count(1) - reverse * senses.count(-1))
        )
        self.speed -= sum(found.slowed for found in pair)
        self._read.append((log(self.astern), log(reverse)))
        self.astern = exp(self._balanced_astern_setting())

    def _balanced_astern_setting(self) -> float:
        """Return the logarithm of the balanced astern setting, a mean without the first pair."""
        power = self.power
        if len(self._read) > 1:
            (s0, r0), (s1, r1) = self._read[:2]
            power = clip((r1 - r0) / (s1 - s0), *POWERS) if abs(s1 - s0) > FAR else power
        return float(np.mean([s - r / power for s, r in self._read[1:] or self._read]))

    def _braking_pulses(self) -> list[int]:
        """Return the pulses that remove the remaining speed."""
        sense, gain = (
            -1 if self.speed > 0.0 else 1,
            self.ahead_acceleration * self.straight * self.period,
        )
        count = round(abs(self.speed) / gain)
        self.speed += sense * count * gain
        return [sense] * count + [0] * round(self.rest / self.period) if count else []

    def _standard_error(self) -> float:
        """Return the standard deviation of the mean of all pairs but the first."""
        later = self._found[2:]
        return float(np.sqrt(sum(f.variance for f in later))) / len(later)
