"""The boat as a dm_control environment: commands in, SNAME observations out, on the engine.

`load` gives an environment with the interface of dm_env; `examples/random_commands.py` uses it. Where there is no
display, import this module before dm_control: it has dm_control draw without one.
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
from boatsim.physics.signals import signals_of
from boatsim.physics.vessel import Vessel
from boatsim.simulate import scenario as scenarios
from boatsim.simulate.engine import Engine, State, installed
from boatsim.simulate.scenario import Scenario
from boatsim.simulate.world import Tank

if find_spec("dm_control") is None:
    raise ImportError(
        "boatsim.simulate.env needs dm_control, which is not installed: it supports Python up to 3.12"
    )


def _choose_renderer() -> None:
    """Without a display: EGL, else OSMesa, else none. Left alone, dm_control settles on a GLFW that only warns."""
    if {"MUJOCO_GL", "DISPLAY", "WAYLAND_DISPLAY"} & os.environ.keys():
        return
    for name in ("egl", "osmesa", "off"):
        os.environ["MUJOCO_GL"] = name
        try:
            import_module("dm_control.mujoco")
            return
        except (
            ImportError,
            AttributeError,
        ):  # PyOpenGL raises the latter where the library is not there
            os.environ.pop("PYOPENGL_PLATFORM", None)


_choose_renderer()
from dm_control.mujoco import Physics, wrapper  # noqa: E402
from dm_control.rl import control  # noqa: E402
from dm_env import specs  # noqa: E402

OUTBOARDS = {
    -1: "outboard_port",
    0: "outboard",
    1: "outboard_starboard",
}  # side of a steering channel -> body drawn


class BoatPhysics(Physics):
    """An engine's model and data behind dm_control's interface; its forces act in `step` and `forward` and only there.

    `named.data`, cameras and contacts are MuJoCo's, z up; `engine.state` and the environment's observations are SNAME.
    Controls are the vessel's commands.
    """

    def __init__(self, engine: Engine) -> None:
        """Take over an engine; whoever made it must no longer step it."""
        self.engine = engine
        boat = engine.vessel
        steered = [(n, OUTBOARDS[boat.side(n)]) for n in boat.actuators if boat.roles[n] == "angle"]
        bodies = {engine.model.body(i).name: i for i in range(engine.model.nbody)}
        self._outboards = [(name, bodies[body]) for name, body in steered if body in bodies]
        super().__init__(wrapper.MjData(engine.data))

    def step(self, nstep: int = 1) -> None:
        """Advance by steps of `timestep()`, the commands held. Raises PhysicsError or BadPhysics if motion diverges."""
        with self.check_invalid_state():
            self.engine.advance(nstep)
            self._turn_outboards()
            if (
                self.legacy_step
            ):  # positions and contacts of the state just reached, for cameras and observations
                with installed(self.engine.callback):
                    mujoco.mj_step1(self.engine.model, self.engine.data)

    def forward(self) -> None:
        """Recompute all that follows from the state, the boat's forces included."""
        self.engine._write_userdata()
        self._turn_outboards()
        with installed(self.engine.callback):
            super().forward()

    def reset(self, keyframe_id: int | None = None) -> None:
        """Put the boat at the origin, at rest. A boat has no keyframes: raises ValueError for one."""
        if keyframe_id is not None:
            raise ValueError(
                f"keyframe {keyframe_id}: a boat has none; set `engine.reset(state)` in reset_context()"
            )
        self.engine.reset()
        self.forward()

    def set_control(self, control: ArrayLike) -> None:
        """Send commands (C,), in the vessel's order; they act within their ranges. Raises BadInput for others."""
        values, names = np.asarray(control, dtype=float), self.engine.vessel.commands
        if values.shape != (len(names),) or not np.isfinite(values).all():
            raise BadInput(
                f"action {values.tolist()}; allowed are {len(names)} finite numbers: {', '.join(names)}"
            )
        self.engine.command(dict(zip(names, values.tolist(), strict=True)))

    def control(self) -> Array:
        """The commands (C,) in force."""
        return self.engine._commands[: len(self.engine.vessel.commands)].copy()

    def copy(self, share_model: bool = False) -> "BoatPhysics":
        """A boat of its own in the same state; its model is always its own, for outboards turn in the model."""
        restore, arguments = self.__reduce__()
        return restore(*arguments)

    def __reduce__(self) -> tuple[Callable[..., "BoatPhysics"], tuple[object, ...]]:
        """Compiled callbacks do not pickle: what goes on the way is the vessel, the tank and the state."""
        e = self.engine
        return _restored, (e.vessel, e.tank, e.step, self.get_state(WHOLE_STATE), self.get_state())

    def _reload_from_model(self, model: object) -> None:
        raise BadPhysics("another model needs another engine: load the environment anew")

    def _physics_state_items(self) -> list[Array]:
        """What a state is made of: besides positions and rates, what the actuators remember."""
        e = self.engine
        return [e.data.qpos, e.data.qvel, e._commands, e._memory, e._act]

    def _turn_outboards(self) -> None:
        """Draw each outboard at its actual angle a: its force points (cos a, sin a) in body axes, z down."""
        actual = self.engine.actuators
        for name, body in self._outboards:
            half = -0.5 * actual[name]
            self.engine.model.body_quat[body] = (cos(half), 0.0, 0.0, sin(half))


WHOLE_STATE = int(mujoco.mjtState.mjSTATE_INTEGRATION)  # all that MuJoCo's next step depends on


def _restored(vessel: Vessel, tank: Tank, step: float, whole: Array, state: Array) -> BoatPhysics:
    """A copy, or what was pickled."""
    physics = BoatPhysics(Engine(vessel, tank, step))
    physics.set_state(whole, WHOLE_STATE)
    physics.set_state(state)
    physics.forward()
    return physics


class BoatTask(control.Task):
    """Move as the scenario's goal says: `surge_mps`, `sway_mps` and `yaw_radps`, zero where it says nothing.

    The reward of a control step is minus the squared error of velocity at its end [m^2/s^2], yaw rate as the speed it
    gives bow and stern: -((u - u*)^2 + (v - v*)^2 + (L/2 (r - r*))^2). Episodes end with time only, discount 1.
    """

    def __init__(self, scenario: Scenario, seed: int, scatter: float = 0.0) -> None:
        """`scatter`: each episode starts up to that many boat lengths and radians off the scenario's start."""
        if not 0.0 <= scatter <= 1.0:
            raise BadInput(f"scatter = {scatter:g}; allowed 0 to 1 boat length (and rad)")
        self.scenario, self.scatter = scenario, scatter
        self._random = np.random.default_rng(seed)

    def initialize_episode(self, physics: BoatPhysics) -> None:
        """The scenario's start, actuators settled at its commands, others at those its controller begins with."""
        start, length = self.scenario.file.start, self.scenario.vessel.length
        x, y, psi = self._random.uniform(-self.scatter, self.scatter, 3) * (length, length, 1.0)
        scattered = {"x": start.x + x, "y": start.y + y, "psi": start.psi + psi}
        state = State(**{**start.motion(), **scattered})
        physics.engine.reset(
            state, {**self.scenario.controller.initial_commands(), **start.commands}
        )

    def before_step(self, action: ArrayLike, physics: BoatPhysics) -> None:
        """Send the action to the actuators, which follow with their lags and limits."""
        physics.set_control(action)

    def action_spec(self, physics: BoatPhysics) -> specs.BoundedArray:
        """(C,) command channels between their limits; the name lists them, separated by tabs."""
        taken = self.scenario.vessel.commands
        low, high = (
            np.array([(c.low, c.high) for c in taken.values()], dtype=float).reshape(-1, 2).T
        )
        return specs.BoundedArray(low.shape, float, low, high, name="\t".join(taken))

    def get_observation(self, physics: BoatPhysics) -> OrderedDict[str, np.float64]:
        """True pose in start axes and velocities in body axes, actual actuators, goal; units are in the names."""
        state, actual, goal = physics.engine.state, physics.engine.actuators, self._goal(physics)
        values = {s.column: getattr(state, s.symbol) for s in signals_of(self.scenario.vessel.dof)}
        values |= {f"actual_{name}": value for name, value in actual.items()}
        values |= {f"goal_{name}": value for name, value in zip(STICK, goal, strict=True)}
        return OrderedDict((name, np.float64(value)) for name, value in values.items())

    def get_reward(self, physics: BoatPhysics) -> float:
        """Minus the squared error of velocity [m^2/s^2]."""
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
    """The vessel of a scenario as an environment stepped once every period of the scenario's controller.

    The caller's actions take the controller's place; vessel, tank, start, goals and duration are the scenario's.
    `seed` (default: the scenario's) only matters with `scatter`, see `BoatTask`. Raises BadInput or BadPhysics.
    """
    one = scenarios.load(scenario) if isinstance(scenario, str) else scenario
    file, period = one.file, one.controller.period
    if not {"surge", "sway", "yaw"} <= set(one.vessel.dof):
        raise BadInput(
            f"{one.name}: {one.vessel.name} is not free in surge, sway and yaw, as an environment must be"
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
