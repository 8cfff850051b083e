"""The scene of boats that went somewhere: water beyond all of their paths, and boats large enough to be seen on it."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from boatsim.physics.base import Array
from boatsim.physics.vessel import Vessel
from boatsim.recordings.table import Recording
from boatsim.simulate import world
from boatsim.view.scene import Scene, scene_from

SEEN = 0.08  # length of a boat, at least, by the size of the track on which it is drawn
MARGIN = 1.0  # lengths of a boat as drawn, around all paths
BEYOND = 4.0  # times as much water as the view shows


def around(boat: Vessel, boats: Mapping[str, Sequence[Recording]]) -> Scene:
    """The scene for an overlay; a nominal boat, which may run away, does not decide how much of the water is shown."""
    paths = [
        r for name, runs in boats.items() for r in runs if name != "nominal" or len(boats) == 1
    ]
    spans = [_span([r.signals[n] for r in paths if n in r.signals]) for n in ("x_m", "y_m")]
    sizes, centre = [high - low for low, high in spans], (sum(spans[0]) / 2, sum(spans[1]) / 2)
    times = max(1.0, SEEN * max(sizes) / boat.length)
    length, width = (size + 2.0 * MARGIN * times * boat.length for size in sizes)
    far = BEYOND * max(length, width)
    tank = world.Tank(far, far, boat.draught * 2, walls=False, centre=centre)
    scene = scene_from(world.build(boat, tank), boat, tank).enlarged(times)
    return replace(scene, tank=(length, width, *centre))


def _span(values: Sequence[Array]) -> tuple[float, float]:
    """Least and largest of what was recorded; 0 where nothing was."""
    finite = np.concatenate([v[np.isfinite(v)] for v in values] or [np.zeros(0)])
    return (float(finite.min()), float(finite.max())) if len(finite) else (0.0, 0.0)
