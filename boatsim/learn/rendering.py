"""Picture of the first boat of a simulation, rendered by MuJoCo."""

import numpy as np
from numpy.typing import NDArray

from boatsim.learn.play import Play
from boatsim.simulate.engine import Engine, State

HEIGHT, WIDTH = 480, 640


class Picture:
    """A camera over the first boat of a play, in the task's basin."""

    def __init__(self, play: Play) -> None:
        from boatsim.simulate.env import BoatPhysics  # chooses a renderer, which takes a second

        self.play = play
        self.physics = BoatPhysics(Engine(play.vessel, play.tank, play.period))

    def taken(self) -> NDArray[np.uint8]:
        """Return the present picture (480, 640, 3)."""
        m = {name: float(x[0]) for name, x in self.play.motion._asdict().items()}
        self.physics.engine.reset(
            State(**m),
            dict(zip(self.play.vessel.commands, self.play.commands[0].tolist(), strict=True)),
        )
        self.physics.forward()
        picture: NDArray[np.uint8] = self.physics.render(HEIGHT, WIDTH, camera_id="above")
        return picture.copy()

    def close(self) -> None:
        """Free the renderer."""
        self.physics.free()
