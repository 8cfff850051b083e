"""Elevation of a sea at a place on a hull, for compiled laws."""

from math import cos
from typing import Any

from numba import njit

from boatsim.physics.signals import Array
from boatsim.physics.waves.dispersion import wave_number
from boatsim.physics.waves.encounter import heading_of_waves
from boatsim.physics.waves.sea_state import (
    has_directions,
    sea_state,
    wave_component,
    wave_direction,
)


@njit
def elevation_at_hull(x: float, y: float, m: Any, q: Any, p: Array, at: Any) -> float:
    """Return the elevation of the sea of an effect at a place on the hull, zero in calm water.

    Args:
        x: Place ahead of the origin of motion [m].
        y: Place to starboard of it [m].
        m: Motion of the hull.
        q: Parameters of the effect, those of `SeaParameters` among them.
        p: Parameters and tables of all effects.
        at: Index of the table of a tabulated sea.

    Returns:
        Elevation above the still water [m], positive upward.
    """
    total = 0.0
    if q.significant_height == 0.0:
        return total
    sea = sea_state(q, p, at)
    ahead, across, run = heading_of_waves(q.toward, m)
    for k in range(int(sea.number)):
        w, amplitude, phase = wave_component(k, q, sea, p, at)
        if has_directions(q):
            ahead, across, run = heading_of_waves(wave_direction(k, q, p, at), m)
        place = run + ahead * x + across * y
        # Components have a trough at phase 0
        total -= amplitude * cos(w * m.t - wave_number(w, q.depth) * place + phase)
    return total
