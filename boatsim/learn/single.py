"""One boat as a Gymnasium environment."""

from typing import Any, Unpack

import gymnasium
import numpy as np
from numpy.typing import NDArray

from boatsim.errors import BadInput
from boatsim.learn import episode_random
from boatsim.learn.environment_options import EnvironmentOptions, make_simulation
from boatsim.learn.mujoco_boat import make_tank_world
from boatsim.learn.play import Observations, make_batch_world
from boatsim.learn.rendering import Camera
from boatsim.learn.spaces import make_spaces

ONLY_BOAT = np.zeros(1, dtype=np.int64)
WALL_STEP = 0.02  # [s] contact with a wall needs shorter integration steps than open water
SIMULATORS = ("batch", "mujoco")


class BoatEnv(gymnasium.Env[Observations, NDArray[np.float32]]):
    """Gymnasium environment of one boat at a task.

    `signals` are its observations, `controls` its actions. Observations are float32. They are
    divided by their bounds (-1 to 1) or, with `normalised=False`, in their units. `info` is empty
    until an episode is over; it then holds `is_success` and the metrics of the task.
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
        **options: Unpack[EnvironmentOptions],
    ) -> None:
        """Create an environment.

        Args:
            task: Name of the task.
            render_mode: "rgb_array" or None.
            normalised: Whether observations are divided by their bounds.
            simulator: "mujoco", which has the walls of the scenario's tank, or "batch", which is
                open water and ten times as fast.
            max_episode_steps: Ignored; Gymnasium passes it.
            options: Further arguments, see `EnvironmentOptions`.

        Raises:
            BadInput: An argument is wrong.
        """
        if simulator not in SIMULATORS:
            raise BadInput(f"simulator = {simulator!r}; allowed is {' or '.join(SIMULATORS)}")
        if render_mode not in (None, *self.metadata["render_modes"]):
            raise BadInput(f"render_mode = {render_mode!r}; allowed is rgb_array or none")
        world = make_batch_world(threads=1)
        if simulator == "mujoco":
            world = make_tank_world
            options.setdefault("step", WALL_STEP)
        self.play = make_simulation(task, 1, world, **options)
        self.signals = self.play.signals
        self.controls = self.play.controls
        self.render_mode = render_mode
        self.normalised = normalised
        self.observation_space, self.action_space = make_spaces(self.play, normalised)
        self.metadata = {**type(self).metadata, "render_fps": round(1.0 / self.play.period)}
        self._seed = np.zeros(1, dtype=np.uint64)
        self._number = np.zeros(1, dtype=np.uint64)
        self._seeded = False
        self._camera: Camera | None = None

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Observations, dict[str, Any]]:
        """Begin a new episode of the boat.

        Args:
            seed: Seed of this episode and of those that follow; None to continue the sequence.
            options: Ignored.

        Returns:
            Observation (S,) and an empty dictionary.
        """
        super().reset(seed=seed)
        if seed is not None or not self._seeded:
            self._seed[0] = self.np_random.integers(2**63) if seed is None else seed
            self._number[0] = 0
            self._seeded = True
        self.play.begin_episodes(episode_random.episode_seeds(self._seed, self._number), ONLY_BOAT)
        self._number += np.uint64(1)
        return self.play.observations(self.normalised)[0], {}

    def step(
        self, action: NDArray[np.float32]
    ) -> tuple[Observations, float, bool, bool, dict[str, Any]]:
        """Simulate one control step of the boat.

        Args:
            action: Action (A,) from -1 to 1.

        Returns:
            Observation (S,), reward, terminated, truncated, and `info`.
        """
        done = self.play.step(np.asarray(action, dtype=float)[None])
        info = {name: value[0].item() for name, value in done.metrics.items()}
        observation = self.play.observations(self.normalised)[0]
        terminated = bool(done.terminated[0])
        truncated = bool(done.truncated[0])
        return observation, float(done.reward[0]), terminated, truncated, info

    def render(self) -> NDArray[np.uint8] | None:
        """Return a picture of the boat from above (480, 640, 3); None without `render_mode`."""
        if self.render_mode is None:
            return None
        if self._camera is None:
            self._camera = Camera(self.play)
        return self._camera.render()

    def close(self) -> None:
        """Free the renderer of the environment."""
        if self._camera is not None:
            self._camera.close()
        self._camera = None
