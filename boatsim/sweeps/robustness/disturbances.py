"""Disturbances of a robustness benchmark, each with a ladder of values.

Every disturbance acts through effects of the library or through the sensors. At its neutral value
it changes nothing. Ladders are for a hull of 1 m; times and speeds grow with the square root of
the length, heights with the length (Froude's law).
"""

from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import replace
from math import inf, pi, sqrt
from typing import ClassVar

import numpy as np

from boatsim.errors import BadInput
from boatsim.physics.effects.fan_wind import AIR_DENSITY
from boatsim.physics.estimate.wind_areas import frontal_drag_area, lateral_drag_area
from boatsim.physics.particulars import GRAVITY
from boatsim.physics.signals import Array
from boatsim.physics.vessel import Vessel
from boatsim.simulate.sensing import Sensors
from boatsim.sweeps.robustness.drawn_boats import DrawnBoats, drive_gains, parameter_definition

Changes = Mapping[str, Array]  # "effect.parameter" -> values (n,)
PREFIX = "disturbance_"  # of the names of the effects by which disturbances act


class Disturbance(ABC):
    """Disturbance of a closed loop with one value, its strength."""

    name: ClassVar[str]
    unit: ClassVar[str]
    words: ClassVar[str]
    neutral: ClassVar[float] = 0.0
    largest: ClassVar[float] = inf  # possible value
    ladder: ClassVar[tuple[float, ...]]  # for a hull of 1 m, from weak to strong
    froude_exponent: ClassVar[float] = 0.0  # of the length, with which the ladder is scaled

    def scaled_ladder(self, length: float) -> tuple[float, ...]:
        """Return the values of the ladder for a hull.

        The scale has one significant digit, so that the values remain round.

        Args:
            length: Length of the hull [m].
        """
        scale = float(f"{length**self.froude_exponent:.1g}")
        return tuple(float(f"{scale * value:.3g}") for value in self.ladder)

    def add_effects(self, vessel: Vessel) -> Vessel:
        """Return the vessel with the effects of this disturbance at its neutral value.

        Args:
            vessel: The vessel.

        Raises:
            BadInput: The disturbance does not apply to the vessel; the message is the reason.
        """
        return vessel

    @abstractmethod
    def changes(self, boats: DrawnBoats, value: float) -> Changes:
        """Return the parameters of the boats that the disturbance changes.

        Args:
            boats: The boats, whose vessel has the effects of the disturbance.
            value: Strength in the unit of the disturbance.
        """

    def disturbed_sensors(self, sensors: Sensors, value: float) -> Sensors:
        """Return the sensors under the disturbance.

        Args:
            sensors: The usual sensors.
            value: Strength in the unit of the disturbance.
        """
        return sensors


class Delay(Disturbance):
    """Additional dead time of all commands."""

    name = "delay"
    unit = "s"
    words = "additional delay of all commands"
    ladder = (0.05, 0.1, 0.15, 0.2, 0.25, 0.3, 0.4, 0.5, 0.6, 0.8, 1.0, 1.5)
    froude_exponent = 0.5

    def add_effects(self, vessel: Vessel) -> Vessel:
        """Add a dead time of zero to all channels."""
        return vessel.with_effect({"use": "command_delay", "name": f"{PREFIX}delay"})

    def changes(self, boats: DrawnBoats, value: float) -> Changes:
        """Return the delay [s] of all boats."""
        return {f"{PREFIX}delay.delay": np.full(len(boats), value)}


class MotorLag(Disturbance):
    """Additional time constant of the thrust."""

    name = "motor_lag"
    unit = "s"
    words = "additional time constant of the motors"
    ladder = (0.1, 0.2, 0.3, 0.4, 0.5, 0.65, 0.8, 1.0, 1.5, 2.0, 3.0)
    froude_exponent = 0.5

    def add_effects(self, vessel: Vessel) -> Vessel:
        """Add a lag of zero to the motors of a vessel that has none."""
        if vessel.names_of("thrust_lag"):
            return vessel
        return vessel.with_effect(
            {"use": "thrust_lag", "name": f"{PREFIX}lag", "time_constant": 0.0}
        )

    def changes(self, boats: DrawnBoats, value: float) -> Changes:
        """Return the time constants [s] of all motors."""
        return _increased(boats, "thrust_lag", "time_constant", value)


class SteeringLag(Disturbance):
    """Additional time constant of the steering servos."""

    name = "steering_lag"
    unit = "s"
    words = "additional time constant of the steering"
    ladder = MotorLag.ladder
    froude_exponent = 0.5

    def add_effects(self, vessel: Vessel) -> Vessel:
        """Check that the vessel has steering servos."""
        if not vessel.names_of("servo"):
            raise BadInput("the vessel has no servo")
        return vessel

    def changes(self, boats: DrawnBoats, value: float) -> Changes:
        """Return the time constants [s] of all servos."""
        return _increased(boats, "servo", "lag", value)


class WeakThrust(Disturbance):
    """Share of the thrust that all drives lack."""

    name = "weak_thrust"
    unit = ""
    words = "share of the thrust that all drives lack"
    largest = 0.9  # the lower bound of a drive's gain is 0.1
    ladder = (0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8)

    def add_effects(self, vessel: Vessel) -> Vessel:
        """Check that the thrust of the vessel can be scaled."""
        if not drive_gains(vessel):
            raise BadInput("the vessel has no drive whose thrust can be scaled")
        return vessel

    def changes(self, boats: DrawnBoats, value: float) -> Changes:
        """Return the gains of all drives."""
        return _scaled_gains(boats, 1.0 - value)


class StrongThrust(WeakThrust):
    """Share by which all drives push more than specified."""

    name = "strong_thrust"
    words = "share by which all drives push more"
    largest = 4.0  # the upper bound of a drive's gain is 5
    ladder = (0.1, 0.2, 0.35, 0.5, 0.75, 1.0, 1.5, 2.0)

    def changes(self, boats: DrawnBoats, value: float) -> Changes:
        """Return the gains of all drives."""
        return _scaled_gains(boats, 1.0 + value)


class MotorLoss(Disturbance):
    """Share of the thrust that one drive, chosen at random, has lost; 1 is the whole drive."""

    name = "motor_loss"
    unit = ""
    words = "share of its thrust that one drive has lost"
    largest = 1.0
    ladder = (0.1, 0.2, 0.3, 0.4, 0.5, 0.7, 0.85, 1.0)
    whole: ClassVar[float] = 1e4  # [N or 1/s] half width of a dead band that no command exceeds

    def add_effects(self, vessel: Vessel) -> Vessel:
        """Add a dead band of zero width to each drive of a vessel with two or more."""
        gains = drive_gains(vessel)
        if len(gains) < 2:
            raise BadInput("the vessel has fewer than two drives")
        for number, gain in enumerate(gains):
            effect = vessel.effect(gain.partition(".")[0])
            if effect is None or not isinstance(effect.on, Mapping):
                continue
            for role, kind in (("thrust", "thrust_deadband"), ("shaft", "shaft_deadband")):
                channel = effect.on.get(role)
                if isinstance(channel, str):
                    table = {"use": kind, "name": _dead_band(number), "on": [channel]}
                    vessel = vessel.with_effect(table)
        return vessel

    def changes(self, boats: DrawnBoats, value: float) -> Changes:
        """Return gains and dead bands of the drives that are lost."""
        gains = drive_gains(boats.vessel)
        last = len(gains) - 1
        lost = np.minimum((boats.lost_drives * len(gains)).astype(int), last)
        found: dict[str, Array] = {}
        for number, key in enumerate(gains):
            factor = np.where(lost == number, 1.0 - value, 1.0)
            found[key] = _within_bounds(boats, key, boats.value(key) * factor)
            if value >= 1.0 and boats.vessel.names_of(_dead_band(number)):
                width = np.where(lost == number, self.whole, 0.0)
                found[f"{_dead_band(number)}.width"] = width
        return found


class WindDisturbance(Disturbance):
    """Steady wind from a random direction."""

    name = "wind"
    unit = "m/s"
    words = "steady wind from a random direction"
    ladder = (0.5, 1.0, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0)
    froude_exponent = 0.5

    def add_effects(self, vessel: Vessel) -> Vessel:
        """Add a calm wind."""
        end_on = frontal_drag_area(vessel.beam) / lateral_drag_area(vessel.length, vessel.beam)
        table = {"use": "wind", "name": f"{PREFIX}wind", "end_on": end_on}
        return vessel.with_effect(table)

    def changes(self, boats: DrawnBoats, value: float) -> Changes:
        """Return force [N], direction [rad] and lever [m] of the wind."""
        vessel = boats.vessel
        area = lateral_drag_area(vessel.length, vessel.beam)
        force = 0.5 * AIR_DENSITY * area * value**2
        return {
            f"{PREFIX}wind.force": np.full(len(boats), force),
            f"{PREFIX}wind.toward": boats.directions,
            f"{PREFIX}wind.arm": boats.wind_levers * vessel.length,
        }


class Waves(Disturbance):
    """Irregular sea from a random direction, of waves about twice as long as the hull."""

    name = "waves"
    unit = "m"
    words = "significant height of waves twice as long as the hull"
    ladder = (0.002, 0.004, 0.006, 0.008, 0.01, 0.015, 0.02, 0.03, 0.05)
    froude_exponent = 1.0
    lengths: ClassVar[float] = 2.0  # [L] length of the waves, which turn a hull most
    # of the sea: fewer than usual, since each boat has a sea of its own and the cost grows with it
    components: ClassVar[float] = 10.0

    def add_effects(self, vessel: Vessel) -> Vessel:
        """Add a calm sea."""
        period = sqrt(2.0 * pi * self.lengths * vessel.length / GRAVITY)
        return vessel.with_effect(
            {
                "use": "irregular_sea",
                "name": f"{PREFIX}sea",
                "modal_period": period,
                "components": self.components,
            }
        )

    def changes(self, boats: DrawnBoats, value: float) -> Changes:
        """Return height [m] and direction [rad] of the waves."""
        return {
            f"{PREFIX}sea.significant_height": np.full(len(boats), value),
            f"{PREFIX}sea.toward": boats.directions,
        }


class SensorNoise(Disturbance):
    """Factor of the noise of all sensors."""

    name = "sensor_noise"
    unit = ""
    words = "factor of the noise of all sensors"
    neutral = 1.0
    ladder = (2.0, 3.0, 5.0, 7.0, 10.0, 15.0, 20.0, 30.0)
    noises: ClassVar[tuple[str, ...]] = (
        "heading_sd",
        "gyro_sd",
        "acceleration_sd",
        "speed_sd",
        "position_sd",
    )

    def changes(self, boats: DrawnBoats, value: float) -> Changes:
        """Return no change of the boats."""
        return {}

    def disturbed_sensors(self, sensors: Sensors, value: float) -> Sensors:
        """Return sensors with noise multiplied by the value; biases stay."""
        noisier = {}
        for name in self.noises:
            sd = getattr(sensors, name)
            if sd > 0.0:
                noisier[name] = min(sd * value, Sensors.params()[name].high)
        return replace(sensors, **noisier)


def _increased(boats: DrawnBoats, kind: str, parameter: str, by: float) -> Changes:
    """A parameter of all effects of a kind, increased by a value."""
    found = {}
    for name in boats.vessel.names_of(kind):
        key = f"{name}.{parameter}"
        found[key] = boats.value(key) + by
    return found


def _scaled_gains(boats: DrawnBoats, factor: float) -> Changes:
    """Gains of all drives, multiplied by a factor."""
    found = {}
    for key in drive_gains(boats.vessel):
        found[key] = _within_bounds(boats, key, boats.value(key) * factor)
    return found


def _within_bounds(boats: DrawnBoats, key: str, values: Array) -> Array:
    definition = parameter_definition(boats.vessel, key)
    return np.asarray(np.clip(values, definition.low, definition.high))


def _dead_band(number: int) -> str:
    """Name of the dead band by which a drive is lost."""
    return f"{PREFIX}loss_{number}"


DISTURBANCES: tuple[Disturbance, ...] = (
    Delay(),
    MotorLag(),
    SteeringLag(),
    WeakThrust(),
    StrongThrust(),
    WindDisturbance(),
    Waves(),
    SensorNoise(),
    MotorLoss(),
)
