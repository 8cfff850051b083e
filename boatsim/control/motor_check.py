"""Pulses from rest by which gyro and accelerometer tell how two outboards differ from what is believed of them.

One motor is turned inward, the other is straight. Both push ahead, twice as long astern, and ahead again, and the boat
ends where it was, at rest. Whatever her inertia and the levers, the two yaw accelerations are as the two thrusts, so
that what the motors lack astern is known. Then the other motor is turned inward: where both steerings are off by the
same angle, one side turns the boat more than the other.
"""

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from boatsim.control.base import LowPass, clip
from boatsim.physics.base import Array

PORT, STARBOARD, NEITHER = 0, 1, 2  # which motor is turned inward
WILDEST = 3.0  # thrust astern over ahead, or its inverse, beyond which a reading is not believed


class Pulse(NamedTuple):
    """What the motors are to do in a period."""

    sense: int  # both motors 1 ahead, -1 astern, 0 off
    inward: int  # PORT, STARBOARD or NEITHER


class Drift(NamedTuple):
    """What sideways drift does to a boat that is turned by pushes on one side, by the square of her yaw rate.

    Both go the same way whether she is pushed ahead or astern, so they would pass for a difference of the motors.
    """

    yaw: float  # [1] acceleration towards the side that ahead turns to
    surge: float  # [m] deceleration


class Found(NamedTuple):
    """What one train of pulses told."""

    turn: float  # [rad/s^2] while both motors push ahead
    reverse: float  # thrust astern over thrust ahead, of the settings that were played
    variance: float  # of that ratio
    push: float  # [m/s^2] ahead
    slowed: float  # [m/s] by drift


@dataclass
class Train:
    """One train of pulses and what was felt under it.

    The motors stand still between two senses, so that the lag of one has no part in the other.
    """

    pulse: int  # [periods] ahead at either end
    rest: int  # [periods] before, between and behind
    rates: list[float] = field(default_factory=list)  # [rad/s] one a period, the first before the train
    felt: list[float] = field(default_factory=list)  # [m/s^2] ahead, at the same times

    def __post_init__(self) -> None:
        still = [0] * self.rest
        parts = ((1, self.pulse), (-1, 2 * self.pulse), (1, self.pulse))
        self.senses = still + [s for sense, n in parts for s in [sense] * n + still]

    def feel(self, rate: float, felt: float) -> None:
        """Readings at the beginning of a period, and at the end of the last."""
        self.rates.append(rate)
        self.felt.append(felt)

    def found(self, period: float, lag: float, drift: Drift, aside: int) -> Found:
        """By least squares; `aside` is the sign of the yaw rate under thrust ahead."""
        on = np.column_stack([_lagged(self.senses, sense, period, lag) for sense in (1, -1)])
        gained = np.vstack([np.zeros(2), period * np.cumsum(0.5 * (on[1:] + on[:-1]), axis=0)])
        square = np.cumsum(np.square(self.rates)) * period
        turns, spread = _fitted(gained, np.array(self.rates) - aside * drift.yaw * square)
        pushes, _ = _fitted(on, np.array(self.felt))
        reverse = clip(float(-turns[1] / turns[0]), 1.0 / WILDEST, WILDEST)
        variance = float(spread[0] * reverse**2 + spread[1]) / float(turns[0]) ** 2
        return Found(float(turns[0]), reverse, variance, float(pushes[0]), drift.surge * float(square[-1]))


def _lagged(senses: list[int], sense: int, period: float, lag: float) -> Array:
    """Share of thrust in one sense (N + 1,) at each reading, behind its command by the lag [s]."""
    low_pass = LowPass(1.0 / lag)
    return np.array([0.0, *(low_pass.step(float(s == sense), period) for s in senses)])


def _fitted(columns: Array, values: Array) -> tuple[Array, Array]:
    """Factors of the columns beside a constant, and their variances."""
    a = np.column_stack([columns, np.ones(len(values))])
    inverse = np.linalg.inv(a.T @ a)
    factors = inverse @ (a.T @ values)
    noise = float(np.sum((values - a @ factors) ** 2)) / (len(values) - a.shape[1])
    return factors[:2], np.diag(inverse)[:2] * max(noise, 1e-12)


@dataclass
class MotorCheck:
    """Pairs of trains, one for either side, until the reverse is known well enough.

    A moment that lasts, of wind, adds to one side what it takes from the other. After each pair the astern setting is
    mended, and the speed that it left is taken out by pulses straight ahead or astern.
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
        self._reading = (0.0, 0.0)
        self._program: Iterator[Pulse] | None = None

    @property
    def push(self) -> float:
        """Acceleration [m/s^2] of both motors ahead, one of them turned inward."""
        return float(np.mean([f.push for f in self._found]))

    @property
    def unevenness(self) -> float:
        """(a - b)/(a + b) of the yaw accelerations with the port (a) and the starboard (b) motor inward."""
        a, b = (abs(float(np.mean([f.turn for f in self._found[side::2]]))) for side in (PORT, STARBOARD))
        return (a - b) / (a + b)

    def step(self, rate: float, felt: float) -> Pulse:
        """Take in yaw rate [rad/s] and acceleration ahead [m/s^2] each period; returns what the motors do next.

        Once it is `done` they are off.
        """
        self._reading = rate, felt
        self._program = self._program or self._play()
        pulse = next(self._program, None)
        self.done = pulse is None
        return pulse or Pulse(0, NEITHER)

    def _play(self) -> Iterator[Pulse]:
        """Pair after pair; a reading is that at the beginning of the pulse asked for next."""
        length = self.shortest
        for pair in range(self.most):
            for side in (PORT, STARBOARD):
                train = Train(round(length / self.period), round(self.rest / self.period))
                for sense in train.senses:
                    train.feel(*self._reading)
                    yield Pulse(sense, side)
                train.feel(*self._reading)
                self._found.append(train.found(self.period, self.lag, self.drift, 1 if side == STARBOARD else -1))
            reverse = self._learn(train.senses)
            for sense in self._amends(reverse):
                yield Pulse(sense, NEITHER)
            if pair and self._spread() < self.enough:
                return
            length = clip(self.reach / self.push, self.shortest, self.longest)

    def _learn(self, senses: list[int]) -> float:
        """Mend the astern setting by the last pair: in full at first, then by the mean of all pairs but the first.

        Returns thrust astern over ahead of what was played.
        """
        pair, count = self._found[-2:], len(self._found) // 2
        reverse = (pair[PORT].reverse * pair[STARBOARD].reverse) ** 0.5
        self.speed += 2.0 * self.push * self.period * (senses.count(1) - reverse * senses.count(-1))
        self.speed -= sum(found.slowed for found in pair)
        self.astern *= reverse ** (-1.0 / (self.power * max(count - 1, 1)))
        return reverse

    def _amends(self, reverse: float) -> list[int]:
        """Senses that take out the speed."""
        sense, thrust = (1, 1.0) if self.speed < 0.0 else (-1, reverse)
        gain = self.push * self.straight * thrust * self.period
        count = round(abs(self.speed) / gain)
        self.speed += sense * count * gain
        rest = [0] * round(self.rest / self.period)
        return [sense] * count + rest if count else []

    def _spread(self) -> float:
        """Standard deviation of the mean of all pairs but the first."""
        later = self._found[2:]
        return float(np.sqrt(sum(f.variance for f in later))) / len(later)
