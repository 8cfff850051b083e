"""Controller that runs a policy trained by reinforcement learning, from a file in ONNX."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from math import cos, isnan, nan, sin
from pathlib import Path
from typing import ClassVar

import numpy as np

from boatsim.control import paths
from boatsim.control.base import Controller, Estimate, Sense, wrap
from boatsim.control.planned_path import PlannedPath
from boatsim.errors import BadInput
from boatsim.learn.hull import Motion
from boatsim.learn.policy import Policy, load_policy
from boatsim.learn.tasks.berth import Berth
from boatsim.learn.tasks.follow_path import FollowPath
from boatsim.learn.tasks.hold_station import HoldStation
from boatsim.learn.tasks.joystick import MOVES, Joystick
from boatsim.physics.base import UNSET, Array, param

POSE = ("x_m", "y_m", "psi_rad")
STICK = ("sway_mps", "yaw_radps")
# Goals of a scenario that each task uses; a path is given by waypoints
TASK_GOALS: Mapping[type, tuple[str, ...]] = {
    Berth: POSE,
    HoldStation: POSE,
    Joystick: STICK,
    FollowPath: (),
}
# Readings that the observations need; a scenario without one of the sensors gives nan
VELOCITY = ("u", "v", "r")
NEEDED: Mapping[type, tuple[str, ...]] = {
    task: VELOCITY if task is Joystick else ("x", "y", "psi", *VELOCITY) for task in TASK_GOALS
}


@dataclass
class LearnedPolicy(PlannedPath, Controller):
    """A policy that was trained for one of the tasks of `boatsim.learn`; `use` is its file.

    `use = "out/berth/policy.onnx"` runs a policy of `boatsim.learn.train`. A policy that berths or
    holds a station takes the goals `x_m`, `y_m` and `psi_rad`; a station is the position at the
    start without them. A policy of the joystick takes `sway_mps` and `yaw_radps`; one that follows
    a path takes `waypoints` and the shape `path` that connects them.
    """

    words: ClassVar[str] = 'policy of reinforcement learning; use = its file, "policy.onnx"'
    goals: ClassVar[tuple[str, ...]] = (*POSE, *STICK)
    use_ending: ClassVar[str] = ".onnx"
    policy_file: ClassVar[Path | None] = None

    period: float = param(
        UNSET,
        low=0.001,
        high=10.0,
        unit="s",
        words="time between two control steps; default: that of the training",
    )
    _last: Array = field(default_factory=lambda: np.zeros(0), init=False)
    _start: tuple[float, float, float] | None = field(default=None, init=False)

    @classmethod
    def from_file(cls, path: Path) -> type["LearnedPolicy"]:
        """Return the class of controllers that run one policy.

        Args:
            path: The ONNX file.
        """
        return type(cls.__name__, (cls,), {"policy_file": path, "__module__": cls.__module__})

    def __post_init__(self) -> None:
        """Read the policy.

        Raises:
            BadInput: There is no file, it is no policy, or a parameter is not allowed.
        """
        super().__post_init__()
        path = type(self).policy_file
        self._loaded = None if path is None else load_policy(path)
        self._path: paths.Path | None = None
        if self._loaded is not None:
            self._prepare(self._loaded)
        self.reset()

    def _prepare(self, policy: Policy) -> None:
        """Take period and path from the policy and the settings."""
        if self.period is UNSET:
            self.period = policy.description.period
        if isinstance(policy.task, FollowPath):
            self._path = self.planned_path(policy.scale.length)
        elif self.waypoints:
            raise BadInput(
                f"{type(self).policy_file}: waypoints are given; the policy is for "
                f"{policy.description.task}, which has no path"
            )

    @property
    def _policy(self) -> Policy:
        """The policy. Raises BadInput if no file is given."""
        if self._loaded is None:
            raise BadInput('learned_policy: use names no policy; allowed is its file, "NAME.onnx"')
        return self._loaded

    def reset(self) -> None:
        """Forget the last actions, the start and the place on the path, before a run."""
        count = 0 if self._loaded is None else len(self._loaded.description.actions)
        self._last = np.zeros(count)
        self._start = None
        self._along = 0.0
        self._sent: dict[str, float] = {}

    def channels(self) -> tuple[str, ...]:
        """Return the command channels that the policy sets."""
        return tuple(self._policy.description.channels)

    def step(self, sense: Sense, goal: Mapping[str, float]) -> dict[str, float]:
        """Return the commands of the policy for the next period.

        In an outage of a sensor the last commands stay.

        Args:
            sense: Sensor readings, with position, heading and velocity.
            goal: Goals of the task of the policy.

        Raises:
            BadInput: A reading is missing at the first step, or a goal belongs to another task.
        """
        self._check_goals(goal)
        needed = NEEDED[type(self._policy.task)]
        missing = [name for name in needed if isnan(getattr(sense, name))]
        if missing and self._start is not None:
            return self._sent
        if missing:
            raise BadInput(
                f"no sensor measures {', '.join(missing)}, which the policy observes; [sensors] "
                "with ideal = true measures all, [[sensor]] gnss and dvl position and velocity"
            )
        if self._start is None:
            self._start = (sense.x, sense.y, sense.psi)
            if self._path is not None:
                self._along = self._path.nearest(sense.x, sense.y)
        row = np.array([[*self._observed(sense, goal), *self._last]], dtype=np.float32)
        self._last = self._policy.act(row)[0]
        commands = self._policy.controls.commands(self._last[None])[0]
        self._sent = dict(zip(self.channels(), commands.tolist(), strict=True))
        return self._sent

    def estimates(self) -> dict[str, Estimate]:
        """Return the foot point on the path, for the log of a run."""
        if self._path is None:
            return {}
        here = self._path.point(self._along)
        values = {
            "reference_x_m": here.x,
            "reference_y_m": here.y,
            "reference_course_rad": here.course,
        }
        return {name: Estimate(value, nan, nan) for name, value in values.items()}

    def _check_goals(self, goal: Mapping[str, float]) -> None:
        """Check that no goal belongs to another task."""
        allowed = TASK_GOALS[type(self._policy.task)]
        for name in goal:
            if name in type(self).goals and name not in allowed:
                takes = ", ".join(allowed) or "waypoints of [controller]"
                raise BadInput(
                    f"goal {name} does not apply to a policy for "
                    f"{self._policy.description.task}, which takes {takes}"
                )

    def _observed(self, sense: Sense, goal: Mapping[str, float]) -> Sequence[float]:
        """Observations of the task in their units, without the last actions."""
        policy, task = self._policy, self._policy.task
        if isinstance(task, FollowPath):
            values = self._observed_path(sense, task)
        elif isinstance(task, Joystick):
            requests = [np.full(MOVES, goal.get(name, 0.0)) for name in STICK]
            stick = np.concatenate(requests)[None]
            values = task.observe(_motion(sense), np.zeros(1), stick, policy.hull, policy.scale)
        else:
            motion, no_goal = self._relative_motion(sense, goal), np.empty((1, 0))
            values = task.observe(motion, np.array([sense.t]), no_goal, policy.hull, policy.scale)
        count = len(task.signals(policy.scale))
        return [float(value[0]) for value in values[:count]]

    def _relative_motion(self, sense: Sense, goal: Mapping[str, float]) -> Motion:
        """Motion in axes of the berth or station."""
        assert self._start is not None
        if isinstance(self._policy.task, Berth):
            for name in POSE:
                if name not in goal:
                    raise BadInput(f"a berth needs the goal {name}")
        x, y, psi = [goal.get(name, old) for name, old in zip(POSE, self._start, strict=True)]
        north, east = sense.x - x, sense.y - y
        c, s = cos(psi), sin(psi)
        ahead, starboard = north * c + east * s, east * c - north * s
        return _motion(sense, (ahead, starboard, wrap(sense.psi - psi)))

    def _observed_path(self, sense: Sense, task: FollowPath) -> Sequence[Array]:
        """Observations relative to the planned path, at the foot point of the position."""
        assert self._path is not None
        self._along = self._path.follow(sense.x, sense.y, self._along)
        here = self._path.point(self._along)
        length = self._policy.scale.length
        courses = [here.course]
        for lengths in (1.0, 2.0):
            courses.append(self._path.point(self._along + lengths * length).course)
        aside = np.array([paths.cross_track_error(here, sense.x, sense.y)])
        return task.observe_path(_motion(sense), aside, [np.array([c]) for c in courses])


def _motion(sense: Sense, pose: tuple[float, float, float] | None = None) -> Motion:
    """Measured motion of one boat, with another pose if one is given."""
    places = (sense.x, sense.y, sense.psi) if pose is None else pose
    return Motion(*[np.array([value]) for value in (*places, sense.u, sense.v, sense.r)])
