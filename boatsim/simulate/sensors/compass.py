"""Magnetic compass: heading with noise, deviation and the error of a tilted magnetometer."""

from collections.abc import Mapping
from dataclasses import dataclass
from math import atan2, cos, hypot, pi, sin
from typing import ClassVar

import numpy as np

from boatsim.control.base import wrap
from boatsim.errors import BadInput, unknown_name_message
from boatsim.physics.base import Array, param
from boatsim.physics.particulars import GRAVITY
from boatsim.simulate.graded_sensor import GradedSensor
from boatsim.simulate.sensing import Instrument
from boatsim.simulate.sensor_motion import body_to_earth, rotation_of
from boatsim.simulate.stepper import State, Stepper

ORIGIN = np.zeros(3)
COMPENSATIONS = ("none", "accelerometer", "exact")


@dataclass(frozen=True)
class Compass(GradedSensor):
    """Measures `psi` of `Sense` with a magnetometer that is fixed to the hull.

    Its readings are turned to the horizontal plane by roll and pitch as the compass knows them:
    `compensation = "none"` takes the hull for upright; "accelerometer" takes the specific force,
    gravity and acceleration together since the last reading, for the vertical, as a compass without
    gyros does; "exact" has true roll and pitch. The vertical part of the earth's field then shows
    as a heading error.
    """

    words: ClassVar[str] = "magnetic compass with noise, deviation and tilt error"
    columns: ClassVar = {"psi": "psi_rad"}

    heading_sd: float = param(0.009, low=0.0, high=1.0, unit="rad", words="white noise")
    deviation: float = param(
        0.044,
        low=0.0,
        high=1.0,
        unit="rad",
        words="largest deviation, a sine of the heading with a random phase",
    )
    dip: float = param(
        1.2,
        low=-1.5,
        high=1.5,
        unit="rad",
        words="inclination of the earth's field, positive on the northern half: 69 deg in Germany",
    )
    compensation: str = "accelerometer"  # one of COMPENSATIONS

    def __post_init__(self) -> None:
        """Check the settings.

        Raises:
            BadInput: A parameter is out of bounds, or there is no such compensation.
        """
        super().__post_init__()
        if self.compensation not in COMPENSATIONS:
            message = unknown_name_message("compensation", self.compensation, COMPENSATIONS)
            raise BadInput(f"Compass: {message}")

    def start(self, rng: np.random.Generator) -> "Magnetometer":
        """Return the compass at the start of a run.

        Args:
            rng: Random generator of its errors.
        """
        return Magnetometer(self, rng)


class Magnetometer(Instrument):
    """A compass in a run: phase of its deviation and last motion."""

    def __init__(self, sensor: Compass, rng: np.random.Generator) -> None:
        """Draw the phase of the deviation.

        Args:
            sensor: The sensor.
            rng: Random generator of its errors.
        """
        self._sensor, self._rng = sensor, rng
        self._phase = 2.0 * pi * float(rng.uniform())
        self._last: State | None = None

    def read(self, engine: Stepper) -> Mapping[str, float]:
        """Return the heading.

        Args:
            engine: The engine, whose vessel is measured.
        """
        sensor, state = self._sensor, engine.state
        field = rotation_of(state).T @ np.array([cos(sensor.dip), 0.0, sin(sensor.dip)])
        roll, pitch = self._known_tilt(state)
        self._last = state
        level = body_to_earth(roll, pitch, 0.0) @ field
        error = wrap(atan2(-level[1], level[0]) - state.psi)
        error += sensor.deviation * sin(state.psi + self._phase)
        error += sensor.heading_sd * float(self._rng.standard_normal())
        return {"psi": state.psi + error}

    def _known_tilt(self, state: State) -> tuple[float, float]:
        """Roll and pitch as the compass knows them [rad]."""
        if self._sensor.compensation == "none":
            return 0.0, 0.0
        if self._sensor.compensation == "exact":
            return state.phi, state.theta
        x, y, z = self._specific_force(state)
        return atan2(-y, -z), atan2(x, hypot(y, z))

    def _specific_force(self, state: State) -> Array:
        """Specific force (3,) at the origin since the last reading, in body axes [m/s^2]."""
        turn, last = rotation_of(state), self._last
        acceleration = np.zeros(3)
        if last is not None and state.t > last.t:
            change = turn @ [state.u, state.v, state.w] - rotation_of(last) @ [
                last.u,
                last.v,
                last.w,
            ]
            acceleration = change / (state.t - last.t)
        return np.asarray(turn.T @ (acceleration - np.array([0.0, 0.0, GRAVITY])))
