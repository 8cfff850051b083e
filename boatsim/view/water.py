"""Scene of vessels that travelled far: water around all paths, and enlarged vessels."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from boatsim.physics.base import Array
from boatsim.physics.vessel import Vessel
from boatsim.recordings.table import Recording
from boatsim.simulate import world
from boatsim.simulate.tank import Tank
from boatsim.view.scene import Scene, scene_from_model

SMALLEST = 0.08  # length of a drawn vessel at least, as a share of the size of all paths
MARGIN = 1.0  # lengths of the drawn vessel around all paths
BEYOND = 4.0  # size of the water by the size of the view


def comparison_scene(vessel: Vessel, runs: Mapping[str, Sequence[Recording]]) -> Scene:
    """Return the scene in which several runs are drawn together, with water around all their paths.

    Vessels are enlarged where the paths are long.

    Args:
        vessel: The vessel that is drawn.
        runs: Recordings by name. One named "before" does not count for the size of the water
            unless it is the only one, because the model before a fit may run away.
    """
    paths: list[Recording] = []
    for name, recordings in runs.items():
        if name != "before" or len(runs) == 1:
            paths += recordings
    x_low, x_high = _range_of("x_m", paths)
    y_low, y_high = _range_of("y_m", paths)
    centre = ((x_low + x_high) / 2, (y_low + y_high) / 2)
    times = max(1.0, SMALLEST * max(x_high - x_low, y_high - y_low) / vessel.length)
    margin = 2.0 * MARGIN * times * vessel.length
    length, width = x_high - x_low + margin, y_high - y_low + margin
    far = BEYOND * max(length, width)
    tank = Tank(far, far, vessel.draught * 2, walls=False, centre=centre)
    scene = scene_from_model(world.build_model(vessel, tank), vessel, tank).enlarge_vessels(times)
    return replace(scene, tank=(length, width, *centre))


def _range_of(column: str, recordings: Sequence[Recording]) -> tuple[float, float]:
    """Smallest and largest finite value of a column; 0 if there is none."""
    finite: list[Array] = [np.zeros(0)]
    for recording in recordings:
        values = recording.signals.get(column, np.zeros(0))
        finite.append(values[np.isfinite(values)])
    known = np.concatenate(finite)
    if not len(known):
        return 0.0, 0.0
    return float(known.min()), float(known.max())
