"""Measures the speed of a vessel, by which a learning task is scaled, in a simulation."""

from math import sqrt

import numpy as np

from boatsim.errors import BadInput
from boatsim.learn.hull import Scale
from boatsim.physics.particulars import GRAVITY
from boatsim.physics.signals import AXES, Array
from boatsim.physics.vessel import Vessel
from boatsim.simulate.batch import Batch

# The run under full thrust that measures the speed: interval of its rows, and their number after
# which a vessel counts as one that does not move ahead.
ROW_INTERVAL = 0.1  # [sqrt(L/g)]
MOST_ROWS = 4000


def task_scale(vessel: Vessel, full_ahead: Array) -> Scale:
    """Return length, beam and attainable speed of a vessel, by which a learning task is scaled.

    The speed is reached one length after the start from rest under full thrust.

    Args:
        vessel: The vessel.
        full_ahead: Commands (C,) of full thrust ahead.

    Raises:
        BadInput: The vessel lacks a degree of freedom or does not move ahead.
    """
    if not {"surge", "sway", "yaw"} <= set(vessel.dof):
        raise BadInput(f"{vessel.name} lacks surge, sway or yaw; a task needs all three")
    interval = ROW_INTERVAL * sqrt(vessel.length / GRAVITY)
    at_rest = [0.0] * (2 * len(vessel.dof))
    commands = np.tile(full_ahead, (MOST_ROWS, 1))
    states = Batch(vessel, step=interval / 10.0).rollout(at_rest, commands, interval)
    x, y, _, u, v, _ = states[:, planar_state_indices(vessel)].T
    beyond = np.flatnonzero(np.hypot(x, y) >= vessel.length)
    if not len(beyond):
        raise BadInput(f"{vessel.name} does not get a length ahead under full thrust")
    first = beyond[0]
    return Scale(vessel.length, vessel.beam, float(np.hypot(u[first], v[first])))


def planar_state_indices(vessel: Vessel) -> list[int]:
    """Return the indices of x, y, psi, u, v, r in the state array of a vessel.

    Args:
        vessel: The vessel.
    """
    free = [axis for axis in AXES if axis in vessel.dof]
    plane = [free.index(axis) for axis in ("surge", "sway", "yaw")]
    return [*plane, *(len(free) + i for i in plane)]
