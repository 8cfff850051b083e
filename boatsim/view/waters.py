"""Open water around what is recorded, for pictures of boats whose tank is not known."""

from collections.abc import Sequence

import numpy as np

from boatsim.physics.vessel import Vessel
from boatsim.recordings.table import Recording
from boatsim.simulate import world
from boatsim.view.scene import Scene, scene_from


def water_around(boat: Vessel, recordings: Sequence[Recording]) -> Scene:
    """Scene of a boat in open water that reaches one and a half boat lengths beyond where it went."""
    spans = []
    for name in ("x_m", "y_m"):
        there = [r.signals[name] for r in recordings if name in r.signals] or [np.zeros(1)]
        spans.append((min(float(np.nanmin(x)) for x in there), max(float(np.nanmax(x)) for x in there)))
    length, width = (high - low + 3 * boat.length for low, high in spans)
    centre = (sum(spans[0]) / 2, sum(spans[1]) / 2)
    return scene_in(boat, world.Tank(length, width, boat.draught * 2, walls=False, centre=centre))


def scene_in(boat: Vessel, tank: world.Tank) -> Scene:
    """Scene of a boat in a tank."""
    return scene_from(world.build(boat, tank), boat, tank)
