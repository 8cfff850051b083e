"""Inertial unit in six degrees of freedom: turn rates and specific force, with wandering biases."""

from collections.abc import Mapping
from dataclasses import dataclass
from math import sqrt
from typing import ClassVar

import numpy as np

from boatsim.physics.base import Array, param
from boatsim.physics.particulars import GRAVITY
from boatsim.simulate.graded_sensor import GradedSensor
from boatsim.simulate.sensing import Instrument
from boatsim.simulate.sensor_motion import rotation_of, velocity_of
from boatsim.simulate.stepper import State, Stepper

READINGS = ("p", "q", "r", "ax", "ay", "az")


@dataclass(frozen=True)
class Imu(GradedSensor):
    """Measures `p`, `r`, `ax` and `ay` of `Sense`, and gives `q` and `az`, at its own place.

    f = a - g

    The accelerometers measure the specific force f, the acceleration a of their place less that of
    gravity g (down): at rest and upright az is -9.81 m/s^2, and with a heel phi ay is
    -g sin(phi).
    All readings are means since the last one, from the motion at both ends: the control period has
    to be short against that of the motion. The rates of an oscillation at w have a relative error
    of (w T)^2 / 12, 0.8 % for twenty readings in its period. Each axis has white noise, a bias
    drawn at the start, and a random walk of the bias.
    """

    words: ClassVar[str] = "inertial unit in six degrees of freedom, with gravity and bias walk"
    columns: ClassVar = {
        "p": "p_radps",
        "q": "q_radps",
        "r": "r_radps",
        "ax": "ax_mps2",
        "ay": "ay_mps2",
        "az": "az_mps2",
    }

    gyro_noise: float = param(
        2.44e-4, low=0.0, high=1.0, unit="rad/s/sqrt(Hz)", words="white noise of the turn rates"
    )
    gyro_bias_sd: float = param(
        1.7e-2, low=0.0, high=1.0, unit="rad/s", words="bias of the turn rates at the start"
    )
    gyro_walk: float = param(
        2.0e-6, low=0.0, high=1.0, unit="rad/s/sqrt(s)", words="random walk of this bias"
    )
    accelerometer_noise: float = param(
        1.47e-3,
        low=0.0,
        high=10.0,
        unit="m/s^2/sqrt(Hz)",
        words="white noise of the specific force",
    )
    accelerometer_bias_sd: float = param(
        0.29, low=0.0, high=10.0, unit="m/s^2", words="bias of the specific force at the start"
    )
    accelerometer_walk: float = param(
        1.3e-4, low=0.0, high=10.0, unit="m/s^2/sqrt(s)", words="random walk of this bias"
    )
    ahead: float = param(0.0, low=-1e3, high=1e3, unit="m", words="ahead of the origin of motion")
    starboard: float = param(0.0, low=-1e3, high=1e3, unit="m", words="to starboard of it")
    above: float = param(0.0, low=-1e3, high=1e3, unit="m", words="above it")

    def start(self, rng: np.random.Generator) -> "InertialUnit":
        """Return the inertial unit at the start of a run.

        Args:
            rng: Random generator of its errors.
        """
        return InertialUnit(self, rng)


class InertialUnit(Instrument):
    """An inertial unit in a run: biases and last motion."""

    def __init__(self, sensor: Imu, rng: np.random.Generator) -> None:
        """Draw the biases of the start.

        Args:
            sensor: The sensor.
            rng: Random generator of its errors.
        """
        self._rng = rng
        self._place = np.array([sensor.ahead, sensor.starboard, -sensor.above])
        self._noise = np.repeat([sensor.gyro_noise, sensor.accelerometer_noise], 3)
        self._walk = np.repeat([sensor.gyro_walk, sensor.accelerometer_walk], 3)
        biases = np.repeat([sensor.gyro_bias_sd, sensor.accelerometer_bias_sd], 3)
        self._bias = biases * rng.standard_normal(6)
        self._last: State | None = None
        self._value = np.zeros(6)

    def read(self, engine: Stepper) -> Mapping[str, float]:
        """Return turn rates and specific force since the last reading.

        Args:
            engine: The engine, whose vessel is measured.
        """
        state = engine.state
        last = self._last
        if last is None or state.t > last.t:
            elapsed = 0.0 if last is None else state.t - last.t
            self._value = self._true(last, state)
            noise = self._rng.standard_normal((2, 6))
            if elapsed > 0.0:
                self._bias = self._bias + self._walk * sqrt(elapsed) * noise[0]
                self._value += self._noise / sqrt(elapsed) * noise[1]
            self._value += self._bias
            self._last = state
        return dict(zip(READINGS, self._value.tolist(), strict=True))

    def _true(self, last: State | None, state: State) -> Array:
        """Mean turn rates (3,) and specific force (3,) since the last reading."""
        down = np.array([0.0, 0.0, GRAVITY])
        rates = np.array([state.p, state.q, state.r])
        turn = rotation_of(state)
        if last is None:
            return np.concatenate([rates, turn.T @ -down])
        before = rotation_of(last)
        change = turn @ velocity_of(state, self._place) - before @ velocity_of(last, self._place)
        acceleration = change / (state.t - last.t)
        mean_rates = 0.5 * (rates + np.array([last.p, last.q, last.r]))
        # in body axes at both ends; the mean of both is exact to second order
        force = 0.5 * (turn + before).T @ (acceleration - down)
        return np.concatenate([mean_rates, force])
