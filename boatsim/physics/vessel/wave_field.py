"""The elevation field of the waves that act on a vessel."""

from collections.abc import Iterable
from dataclasses import replace

from boatsim.physics.debugging import python_function
from boatsim.physics.kinds.effect import Effect
from boatsim.physics.kinds.flow import WaterFlow
from boatsim.physics.waves.field import WaveField


def wave_field(effects: Iterable[Effect]) -> WaveField:
    """Return the field of all waves of a vessel's effects, on the water that its currents move.

    Args:
        effects: Effects of the vessel, completed and with the seed of the run.
    """
    field = WaveField.calm()
    north = east = 0.0
    for effect in effects:
        own = effect.wave_field()
        if own is not None:
            field = field.joined_with(own)
        if isinstance(effect, WaterFlow):
            velocity = python_function(type(effect).water_velocity)(effect.values())
            north, east = north + velocity[0], east + velocity[1]
    return replace(field, water_velocity=(north, east))
