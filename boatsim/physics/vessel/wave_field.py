"""The elevation field of the waves that act on a vessel."""

from collections.abc import Iterable
from dataclasses import replace

from boatsim.physics.kinds.effect import Effect
from boatsim.physics.kinds.flow import WaterFlow, is_varying_flow
from boatsim.physics.waves.field import WaveField
from boatsim.physics.waves.water_path import WaterPath


def wave_field(effects: Iterable[Effect]) -> WaveField:
    """Return the field of all waves of a vessel's effects, on the water that its currents move.

    Args:
        effects: Effects of the vessel, completed and with the seed of the run.
    """
    field = WaveField.calm()
    north = east = 0.0
    paths: list[WaterPath] = []
    for effect in effects:
        own = effect.wave_field()
        if own is not None:
            field = field.joined_with(own)
        if is_varying_flow(effect):
            paths.append(effect.water_path())
        elif isinstance(effect, WaterFlow):
            velocity = effect.velocity_at(0.0, 0.0, 0.0)
            north, east = north + velocity[0], east + velocity[1]
    return replace(field, water_velocity=(north, east), water_paths=tuple(paths))
