"""Gymnasium spaces of a simulation."""

import numpy as np
from gymnasium.spaces import Box

from boatsim.learn.play import TaskSimulation


def make_spaces(play: TaskSimulation, normalised: bool) -> tuple[Box[np.float32], Box[np.float32]]:
    """Return the Gymnasium spaces of the observation and of the action of one boat.

    Args:
        play: The simulation.
        normalised: Whether observations are divided by their bounds.
    """
    bound = np.array([signal.bound for signal in play.signals], dtype=np.float32)
    if normalised:
        bound = np.ones(len(play.signals), dtype=np.float32)
    actions = (len(play.controls.names),)
    observation = Box(-bound, bound, dtype=np.float32)
    return observation, Box(-1.0, 1.0, actions, dtype=np.float32)
