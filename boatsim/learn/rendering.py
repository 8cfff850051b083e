"""Picture of the first boat of a simulation, rendered by MuJoCo."""

import numpy as np
from numpy.typing import NDArray

from boatsim.learn.play import TaskSimulation
from boatsim.simulate.engine import Engine, State

HEIGHT, WIDTH = 480, 640


class Camera:
    """Camera that renders pictures of the first boat of a simulation in the basin of its task."""

    def __init__(self, play: TaskSimulation) -> None:
        """Create a camera.

        Args:
            play: The simulation.
        """
        from boatsim.simulate.env import BoatPhysics  # chooses a renderer, which takes a second

        self.play = play
        self.physics = BoatPhysics(Engine(play.vessel, play.tank, play.period))

    def render(self) -> NDArray[np.uint8]:
        """Return a picture of the present state of the first boat, (480, 640, 3)."""
        motion = [float(values[0]) for values in self.play.motion]
        state = State(**dict(zip(self.play.motion._fields, motion, strict=True)))
        commands = self.play.commands[0].tolist()
        self.physics.engine.reset(
            state, dict(zip(self.play.vessel.commands, commands, strict=True))
        )
        self.physics.forward()
        picture: NDArray[np.uint8] = self.physics.render(HEIGHT, WIDTH, camera_id="above")
        return picture.copy()

    def close(self) -> None:
        """Free the resources of the camera's renderer."""
        self.physics.free()
