"""One boat as a Gymnasium environment."""

from typing import Any, Unpack

import gymnasium
import numpy as np
from numpy.typing import NDArray

from boatsim.errors import BadInput
from boatsim.learn import episode_random
from boatsim.learn.environment_options import Told, play
from boatsim.learn.mujoco_boat import in_tank
from boatsim.learn.play import Seen, open_water
from boatsim.learn.rendering import Picture
from boatsim.learn.spaces import boxes

ME = np.zeros(1, dtype=np.int64)
WALL_STEP = 0.02  # [s] a wall wants finer steps than water
SIMULATORS = ("batch", "mujoco")


class BoatEnv(gymnasium.Env[Seen, NDArray[np.float32]]):
    """One boat at a task; `signals` are its observations, `controls` its actions.

    Observations are float32, over their bounds (-1 to 1) or, with `normalised=False`, in their units. `info` is empty
    until an episode is over; then it holds `is_success` and the task's norms.
    """

    metadata: dict[str, Any] = {"render_modes": ["rgb_array"], "render_fps": 5}

    def __init__(
        self,
        task: str,
        *,
        render_mode: str | None = None,
        normalised: bool = True,
        simulator: str = "batch",
        max_episode_steps: int | None = None,
        **told: Unpack[Told],
    ) -> None:
        """`simulator` "mujoco" has the walls of the scenario's tank, "batch" is open water and ten times as fast."""
        if simulator not in SIMULATORS:
            raise BadInput(f"simulator = {simulator!r}; allowed is {' or '.join(SIMULATORS)}")
        if render_mode not in (None, *self.metadata["render_modes"]):
            raise BadInput(f"render_mode = {render_mode!r}; allowed is rgb_array or none")
        if simulator == "mujoco":
            told.setdefault("step", WALL_STEP)
        self.play = play(
            task, 1, in_tank if simulator == "mujoco" else open_water(threads=1), **told
        )
        self.signals, self.controls = self.play.signals, self.play.controls
        self.render_mode, self.normalised = render_mode, normalised
        self.observation_space, self.action_space = boxes(self.play, normalised)
        self.metadata = {**type(self).metadata, "render_fps": round(1.0 / self.play.period)}
        self._seed, self._number = np.zeros(1, dtype=np.uint64), np.zeros(1, dtype=np.uint64)
        self._drawn = False
        self._picture: Picture | None = None

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Seen, dict[str, Any]]:
        """Begin an episode; the same seed begins the same episodes, one after the other."""
        super().reset(seed=seed)
        if seed is not None or not self._drawn:
            self._seed[0] = seed if seed is not None else self.np_random.integers(2**63)
            self._number[0], self._drawn = 0, True
        self.play.begin(episode_random.episode(self._seed, self._number), ME)
        self._number += np.uint64(1)
        return self.play.observations(self.normalised)[0], {}

    def step(self, action: NDArray[np.float32]) -> tuple[Seen, float, bool, bool, dict[str, Any]]:
        """One control step."""
        done = self.play.step(np.asarray(action, dtype=float)[None])
        info = {name: value[0].item() for name, value in done.norms.items()}
        seen = self.play.observations(self.normalised)[0]
        return seen, float(done.reward[0]), bool(done.ended[0]), bool(done.late[0]), info

    def render(self) -> NDArray[np.uint8] | None:
        """The boat from above, (480, 640, 3), where `render_mode` asks for it."""
        if self.render_mode is None:
            return None
        self._picture = self._picture or Picture(self.play)
        return self._picture.taken()

    def close(self) -> None:
        """Give the renderer back."""
        if self._picture is not None:
            self._picture.close()
        self._picture = None
