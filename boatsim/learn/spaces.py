"""Gymnasium's spaces of a play."""

import numpy as np
from gymnasium.spaces import Box

from boatsim.learn.play import Play


def boxes(play: Play, normalised: bool) -> tuple[Box[np.float32], Box[np.float32]]:
    """Spaces of the observation and of the action of one boat."""
    bound = np.array([1.0 if normalised else s.bound for s in play.signals], dtype=np.float32)
    return Box(-bound, bound, dtype=np.float32), Box(
        -1.0, 1.0, (len(play.controls.names),), dtype=np.float32
    )
