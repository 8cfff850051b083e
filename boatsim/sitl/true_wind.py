"""The true wind at a vessel, from the effects that describe it by a speed."""

from math import cos, sin
from typing import Any

from boatsim.physics.effects.gusty_wind import gust_speed
from boatsim.physics.gust_spectra import mean_speed_at
from boatsim.physics.kinds.effect import Effect
from boatsim.physics.vessel import Vessel

Velocity = tuple[float, float]


class TrueWind:
    """The wind over ground in which a vessel moves.

    A wind that is only known as a force (`wind`, `measured_relative_wind`) has no speed.
    """

    def __init__(self, vessel: Vessel) -> None:
        """Find the effect that describes the wind.

        Args:
            vessel: The vessel, with the seed of the run.
        """
        self._vessel = vessel
        self._effects: list[Effect] = []
        for effect in vessel.effects:
            if type(effect).type_name() in ("fan_wind", "gusty_wind", "measured_wind"):
                self._effects.append(effect)

    def velocity(self, t: float) -> Velocity | None:
        """Return the velocity of the air over ground, to north and east [m/s].

        Args:
            t: Time [s].

        Returns:
            The velocity; None if no effect of the vessel describes the wind by a speed.
        """
        if not self._effects:
            return None
        north = east = 0.0
        for effect in self._effects:
            own = self._velocity_of(effect, t)
            north, east = north + own[0], east + own[1]
        return north, east

    def _velocity_of(self, effect: Effect, t: float) -> Velocity:
        use = type(effect).type_name()
        if use == "measured_wind":
            bound = self._vessel.bindings(effect)
            speed, comes_from = self._signal(bound["speed"]), self._signal(bound["comes_from"])
            return -speed * cos(comes_from), -speed * sin(comes_from)
        values: Any = effect.values()  # a named tuple of the effect's parameters
        speed = values.speed
        if use == "gusty_wind":
            speed = mean_speed_at(values.height, values.speed) + gust_speed(t, values)
        return speed * cos(values.toward), speed * sin(values.toward)

    def _signal(self, bound: str | float) -> float:
        """Value of a constant or of a measured channel, which is constant during a run."""
        if isinstance(bound, str):
            return self._vessel.measured[bound].neutral
        return bound
