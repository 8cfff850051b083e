"""A scenario's vessel as a dm_control environment: commands in, SNAME observations out.

`load` returns an environment with the interface of dm_env; `examples/random_commands.py` uses it.
Without a display, import this module before dm_control, so that dm_control renders without one.
"""

import os
from collections import OrderedDict
from collections.abc import Callable
from importlib import import_module
from importlib.util import find_spec
from math import cos, sin

import mujoco
import numpy as np
from numpy.typing import ArrayLike

from boatsim.control.allocation import STICK
from boatsim.errors import BadInput, BadPhysics
from boatsim.physics.base import Array
from boatsim.physics.signals import motion_signals
from boatsim.physics.vessel import Vessel
from boatsim.simulate import scenario as scenarios
from boatsim.simulate.engine import Engine, State, installed_callback
from boatsim.simulate.scenario import Scenario
from boatsim.simulate.tank import Tank

if find_spec("dm_control") is None:
    raise ImportError(
        "boatsim.simulate.env needs dm_control, which is not installed: "
        "it supports Python up to 3.12"
    )


def _choose_renderer() -> None:
    """Without a display choose EGL, OSMesa or none; dm_control would choose GLFW, which fails."""
    if {"MUJOCO_GL", "DISPLAY", "WAYLAND_DISPLAY"} & os.environ.keys():
        return
    for name in ("egl", "osmesa", "off"):
        os.environ["MUJOCO_GL"] = name
        try:
            import_module("dm_control.mujoco")
            return
        # PyOpenGL raises AttributeError where the library is missing
        except (ImportError, AttributeError):
            os.environ.pop("PYOPENGL_PLATFORM", None)


_choose_renderer()
from dm_control.mujoco import Physics, wrapper  # noqa: E402
from dm_control.rl import control  # noqa: E402
from dm_env import specs  # noqa: E402

# side of a steering channel -> drawn body
OUTBOARDS = {-1: "outboard_port", 0: "outboard", 1: "outboard_starboard"}


class BoatPhysics(Physics):
    """Physics of dm_control for a simulated vessel, with its forces in `step` and `forward`.

    `named.data`, cameras and contacts are MuJoCo's, z up; `engine.state` and the observations of
    the environment are SNAME. Controls are the vessel's commands.

    Attributes:
        engine: The engine.
    """

    def __init__(self, engine: Engine) -> None:
        """Take over an engine, which the caller must no longer step.

        Args:
            engine: The engine.
        """
        self.engine = engine
        vessel = engine.vessel
        bodies = {engine.model.body(i).name: i for i in range(engine.model.nbody)}
        self._outboards: list[tuple[str, int]] = []  # actuator and number of its body
        for name in vessel.actuators:
            body = OUTBOARDS[vessel.side(name)] if vessel.roles[name] == "angle" else ""
            if body in bodies:
                self._outboards.append((name, bodies[body]))
        super().__init__(wrapper.MjData(engine.data))

    def step(self, nstep: int = 1) -> None:
        """Integrate the motion of the vessel over steps of `timestep()` with constant commands.

        Args:
            nstep: Number of steps.

        Raises:
            PhysicsError: If dm_control finds the state invalid.
            BadPhysics: If the motion diverges.
        """
        with self.check_invalid_state():
            self.engine.advance(nstep)
            self._turn_outboards()
            if self.legacy_step:  # contacts of the new state, for cameras and observations
                with installed_callback(self.engine.callback):
                    mujoco.mj_step1(self.engine.model, self.engine.data)

    def forward(self) -> None:
        """Recompute all quantities of the MuJoCo model that follow from the state, also forces."""
        self.engine._write_userdata()
        self._turn_outboards()
        with installed_callback(self.engine.callback):
            super().forward()

    def reset(self, keyframe_id: int | None = None) -> None:
        """Put the simulated vessel at the origin, at rest.

        Raises:
            ValueError: If a keyframe is given; a vessel has none.
        """
        if keyframe_id is not None:
            raise ValueError(
                f"keyframe {keyframe_id}: a boat has none; "
                "set `engine.reset(state)` in reset_context()"
            )
        self.engine.reset()
        self.forward()

    def set_control(self, control: ArrayLike) -> None:
        """Send commands to the vessel's actuators; they are limited to their ranges.

        Args:
            control: Commands (C,) in the vessel's order.

        Raises:
            BadInput: If the shape is wrong or a value is not finite.
        """
        values, names = np.asarray(control, dtype=float), self.engine.vessel.commands
        if values.shape != (len(names),) or not np.isfinite(values).all():
            raise BadInput(
                f"action {values.tolist()}; "
                f"allowed are {len(names)} finite numbers: {', '.join(names)}"
            )
        self.engine.command(dict(zip(names, values.tolist(), strict=True)))

    def control(self) -> Array:
        """Return the vessel's commands in force (C,)."""
        return self.engine._commands[: len(self.engine.vessel.commands)].copy()

    def copy(self, share_model: bool = False) -> "BoatPhysics":
        """Return a copy of the simulated vessel in the same state.

        It always has its own MuJoCo model, since outboards turn within the model.
        """
        restore, arguments = self.__reduce__()
        return restore(*arguments)

    def __reduce__(self) -> tuple[Callable[..., "BoatPhysics"], tuple[object, ...]]:
        """Pickle vessel, tank and state, because compiled callbacks cannot be pickled."""
        e = self.engine
        return _restore_physics, (
            e.vessel,
            e.tank,
            e.step,
            self.get_state(WHOLE_STATE),
            self.get_state(),
        )

    def _reload_from_model(self, model: object) -> None:
        raise BadPhysics("another model needs another engine: load the environment again")

    def _physics_state_items(self) -> list[Array]:
        """Arrays of the state: positions, rates, and the memory of the actuators."""
        e = self.engine
        return [e.data.qpos, e.data.qvel, e._commands, e._memory, e._act]

    def _turn_outboards(self) -> None:
        """Turn each drawn outboard to its angle a, with its force along (cos a, sin a)."""
        actual = self.engine.actuators
        for name, body in self._outboards:
            half = -0.5 * actual[name]
            self.engine.model.body_quat[body] = (cos(half), 0.0, 0.0, sin(half))


# everything on which MuJoCo's next step depends
WHOLE_STATE = int(mujoco.mjtState.mjSTATE_INTEGRATION)


def _restore_physics(
    vessel: Vessel, tank: Tank, step: float, whole: Array, state: Array
) -> BoatPhysics:
    """The physics of a copy or a pickle."""
    physics = BoatPhysics(Engine(vessel, tank, step))
    physics.set_state(whole, WHOLE_STATE)
    physics.set_state(state)
    physics.forward()
    return physics


class BoatTask(control.Task):
    """Reinforcement-learning task of dm_control: follow the velocity goals of a scenario.

    The goals are `surge_mps`, `sway_mps` and `yaw_radps`; missing goals are zero. The reward of a
    control step is minus the squared velocity error at its end [m^2/s^2], with the yaw rate as the
    speed of bow and stern: -((u - u*)^2 + (v - v*)^2 + (L/2 (r - r*))^2). Episodes end at a time
    only; the discount is 1.

    Attributes:
        scenario: The scenario.
        scatter: Scatter of the starts.
    """

    def __init__(self, scenario: Scenario, seed: int, scatter: float = 0.0) -> None:
        """Create a task.

        Args:
            scenario: The scenario.
            seed: Seed of the starts.
            scatter: Largest deviation of a start from the scenario's [lengths of the vessel, rad].

        Raises:
            BadInput: If `scatter` is out of range.
        """
        if not 0.0 <= scatter <= 1.0:
            raise BadInput(f"scatter = {scatter:g}; allowed 0 to 1 boat length (and rad)")
        self.scenario, self.scatter = scenario, scatter
        self._random = np.random.default_rng(seed)

    def initialize_episode(self, physics: BoatPhysics) -> None:
        """Put the vessel at the start of an episode, with actuators settled at its commands."""
        start, length = self.scenario.file.start, self.scenario.vessel.length
        x, y, psi = self._random.uniform(-self.scatter, self.scatter, 3) * (length, length, 1.0)
        scattered = {"x": start.x + x, "y": start.y + y, "psi": start.psi + psi}
        state = State(**{**start.initial_state_values(), **scattered})
        physics.engine.reset(
            state, {**self.scenario.controller.initial_commands(), **start.commands}
        )

    def before_step(self, action: ArrayLike, physics: BoatPhysics) -> None:
        """Send an agent's action to the actuators, which follow with their dynamics and limits."""
        physics.set_control(action)

    def action_spec(self, physics: BoatPhysics) -> specs.BoundedArray:
        """Return the specification of an action: lower and upper limits of the vessel's C commands.

        Its name lists the commands.
        """
        channels = self.scenario.vessel.commands
        limits = [(channel.low, channel.high) for channel in channels.values()]
        low, high = np.array(limits, dtype=float).reshape(-1, 2).T
        return specs.BoundedArray(low.shape, float, low, high, name="\t".join(channels))

    def get_observation(self, physics: BoatPhysics) -> OrderedDict[str, np.float64]:
        """Return an agent's observation: true pose and velocities, actuators and goals.

        The pose is in start axes, velocities are in body axes. Units are part of the names.
        """
        state, actual, goal = physics.engine.state, physics.engine.actuators, self._goal(physics)
        values = {
            s.column: getattr(state, s.symbol) for s in motion_signals(self.scenario.vessel.dof)
        }
        values |= {f"actual_{name}": value for name, value in actual.items()}
        values |= {f"goal_{name}": value for name, value in zip(STICK, goal, strict=True)}
        return OrderedDict((name, np.float64(value)) for name, value in values.items())

    def get_reward(self, physics: BoatPhysics) -> float:
        """Return the reward of a control step: minus the squared velocity error [m^2/s^2]."""
        s, (surge, sway, yaw) = physics.engine.state, self._goal(physics)
        swing = 0.5 * self.scenario.vessel.length * (s.r - yaw)
        return -float((s.u - surge) ** 2 + (s.v - sway) ** 2 + swing**2)

    def _goal(self, physics: BoatPhysics) -> list[float]:
        goal = self.scenario.goal_at(physics.time())
        return [goal.get(name, 0.0) for name in STICK]


def load(
    scenario: str | Scenario,
    *,
    seed: int | None = None,
    scatter: float = 0.0,
    flat_observation: bool = False,
) -> control.Environment:
    """Return a dm_control environment of a scenario, whose actions replace its controller.

    A control step is one period of the scenario's controller.

    Args:
        scenario: Name of a scenario, or a scenario.
        seed: Seed of the starts; default: the scenario's.
        scatter: Largest deviation of a start, see `BoatTask`.
        flat_observation: Whether the observation is one array.

    Raises:
        BadInput: If the vessel cannot turn and move sideways, or the period is not a whole number
            of steps.
        BadPhysics: If the model cannot be stepped.
    """
    one = scenarios.load(scenario) if isinstance(scenario, str) else scenario
    file, period = one.file, one.controller.period
    if not {"surge", "sway", "yaw"} <= set(one.vessel.dof):
        raise BadInput(
            f"{one.name}: {one.vessel.name} is not free in surge, sway and yaw, "
            "as an environment must be"
        )
    if abs(period / file.step - round(period / file.step)) > 1e-6 or period < file.step:
        raise BadInput(
            f"{one.name}: period {period:g} s is not a whole number of steps of {file.step:g} s"
        )
    tank = Tank(**file.tank.model_dump()) if file.tank else None
    return control.Environment(
        BoatPhysics(Engine(one.vessel, tank, file.step)),
        BoatTask(one, file.seed if seed is None else seed, scatter),
        time_limit=file.duration,
        n_sub_steps=round(period / file.step),
        flat_observation=flat_observation,
    )
