"""The thesis' eight tests as functions of what its model may have left out: fast closed-loop runs on the compiled twin.

The scenarios, controllers, sensors, camera and norms are those of `boatsim run`; only walls and log are left out. At
the rate of the published turns the thesis' program runs in open loop: steering straight, the port motor at 104 or 105
of 255 by the noise of its sensors. So a turn's commands can be played to boats that turn about as fast (`played`).
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from boatsim.control.base import Sense
from boatsim.physics.base import Array, Release
from boatsim.physics.content import load_class
from boatsim.physics.kernel.records import Model
from boatsim.physics.program import Program
from boatsim.simulate import scenario
from boatsim.simulate.camera_metric import CameraFrames, CameraMetricSet
from boatsim.simulate.cases import content
from boatsim.simulate.scenario import Scenario

TESTS = ("sway_1", "sway_2", "sway_3", "sway_4", "yaw_1", "yaw_2", "yaw_3", "yaw_4")
WINDY = ("yaw_2", "yaw_4")  # T18


@dataclass(frozen=True)
class Knob:
    """One strength: where it acts, the value at which it does nothing, prior sd and bounds."""

    effect: str  # of the vessel, or "controller", "camera", "body"
    name: str
    unit: str
    mean: float  # absent
    sd: float
    low: float
    high: float
    how: str = "set"  # or "add" to the scenario's own value, or "times" it
    tests: tuple[str, ...] = TESTS

    @property
    def label(self) -> str:
        """Name for tables."""
        of = " and ".join(sorted({t.split("_")[0] for t in self.tests}))
        return f"{self.effect}.{self.name}" + (f" ({of})" if self.effect == "pwm_thrust" else "")

    def applied(self, own: float, x: float) -> float:
        """The value that goes into the run."""
        return {"set": x, "add": own + x, "times": own * x}[self.how]


class Bench:
    """A test of the thesis, ready to run with any knobs."""

    def __init__(
        self,
        name: str,
        extra: Sequence[Mapping[str, Any]] = (),
        nominal: Mapping[str, Any] | None = None,
        played: bool = False,
    ) -> None:
        """`extra` effects replace the scenario's own of these names; `nominal` are [set] tables.

        `played`: every boat gets the commands that the scenario's own boat gets.
        """
        raw = content(f"joystick_boat/{name}")[0]
        own = [t for t in raw.get("effect", []) if t["use"] not in {e["use"] for e in extra}]
        wind: dict[str, Any] = next(
            (t for t in raw.get("effect", []) if t["use"] == "fan_wind"), {}
        )
        told = [{**wind, **e} if e["use"] == "fan_wind" else dict(e) for e in extra]
        settings = {k: {**raw.get("set", {}).get(k, {}), **v} for k, v in (nominal or {}).items()}
        over = {"tank": None, "effect": [*own, *told], "set": {**raw.get("set", {}), **settings}}
        self.scenario: Scenario = scenario.load(f"joystick_boat/{name}", over)
        assert isinstance(self.scenario.measure, CameraMetricSet)
        self.name, self.measure = name, self.scenario.measure
        self.program = Program(self.scenario.vessel)
        self.published = {
            n: t.published for n, t in self.scenario.file.norms.items() if t.published is not None
        }
        self._links = _links(self.program)
        kinds = {e["use"]: load_class("effect", e["use"]) for e in extra}
        releases = {name: kind() for name, kind in kinds.items() if issubclass(kind, Release)}
        self._released = {name: one.changes(self.scenario.vessel) for name, one in releases.items()}
        self._own = Bench(name) if played else None
        self._played: dict[int, Array] = {}  # seed -> commands (N, C), one row a step

    def norms(
        self, knobs: Sequence[Knob], values: Sequence[float], seeds: Sequence[int]
    ) -> dict[str, float]:
        """Mean norms over seeds; empty where a run never got as far as they ask."""
        found = [self.measure.from_frames(self._film(knobs, values, seed)) for seed in seeds]
        return {n: float(np.mean([f[n] for f in found])) for n in found[0]} if all(found) else {}

    def _film(self, knobs: Sequence[Knob], values: Sequence[float], seed: int) -> CameraFrames:
        """What the camera sees of one run."""
        p, body = self.program.values(), self.program.body.copy()
        controller, camera = self.scenario.controller, self.scenario.camera
        own = dict(vars(controller))
        for knob, x in zip(knobs, values, strict=True):
            if knob.effect == "controller":
                setattr(controller, knob.name, knob.applied(getattr(controller, knob.name), x))
            elif knob.effect == "camera":
                place = (knob.applied(camera.marks[knob.name][0], x), camera.marks[knob.name][1])
                camera = replace(camera, marks={**camera.marks, knob.name: place})
            elif knob.effect == "body":
                body[-1] = knob.applied(body[-1], x)  # yaw inertia
            elif knob.effect in self._released:
                for change in (c for c in self._released[knob.effect] if c.parameter == knob.name):
                    at = self.program.index(change.owner, change.key)
                    p[at] = change.of(p[at], x)
            else:
                at = self.program.index(knob.effect, knob.name)
                p[at] = knob.applied(p[at], x)
        for to, source in self._links:
            p[to] = p[source]
        imu, marks = (np.random.default_rng(s) for s in np.random.SeedSequence(seed).spawn(2))
        if self._own is None:
            t, y = self._run(p, body, imu)
        else:
            if seed not in self._played:
                self._played[seed] = self._own.commands(imu)
            t, y = self._play(p, body, self._played[seed])
        for name, value in own.items():
            setattr(controller, name, value)
        every = round(camera.rate / self.measure.scored)
        frames = np.arange(0.0, t[-1] + 1e-9, 1.0 / camera.rate)
        noise = marks.standard_normal((len(frames), 2 * len(camera.marks)))[::every]
        frames = frames[::every]
        x, east, psi = (np.interp(frames, t, y[:, i]) for i in (0, 1, 2))
        seen = camera.seen(x + 1j * east, psi, noise)
        points = {
            name: np.stack([z.real, z.imag], axis=-1)
            for name, z in zip(camera.marks, seen.T, strict=True)
        }
        return CameraFrames(frames, camera.pose(seen)[1], points, np.stack([x, east], axis=-1), psi)

    def commands(self, rng: np.random.Generator) -> Array:
        """Commands of every step of the boat without knobs, the last ones held until the duration is over."""
        given: list[Array] = []
        self._run(self.program.values(), self.program.body, rng, given)
        found, file = np.concatenate(given), self.scenario.file
        return np.concatenate(
            [found, np.tile(found[-1], (round(file.duration / file.step) - len(found), 1))]
        )

    def _play(self, p: Array, body: Array, commands: Array) -> tuple[Array, Array]:
        """Times (N,) and states (N, 6) in earth axes of a run with given commands."""
        code, on, y, step = (
            self.program.module,
            self.program.switches(),
            np.zeros(6),
            self.scenario.file.step,
        )
        memory, out = np.zeros(self.program.memory_size), np.zeros((len(commands) + 1, 6))
        start = self.program.command_array(self.scenario.controller.initial_commands())
        code.settle(start, memory, p, on, np.zeros(self.program.held_size))
        code.rollout(Model(body, p, on), self.program.plant(y, memory), commands, 0.0, step, 1, out)
        return np.asarray(step * np.arange(len(out)), float), np.asarray(out, float)

    def _run(
        self, p: Array, body: Array, rng: np.random.Generator, given: list[Array] | None = None
    ) -> tuple[Array, Array]:
        """Times (N,) and states (N, 6) in earth axes of one run to its end; `given` gets the commands of every step."""
        told, code = self.scenario, self.program.module
        controller, file, sensors = told.controller, told.file, told.sensors
        controller.reset()
        period = round(controller.period / file.step)
        memory, act = np.zeros(self.program.memory_size), np.zeros(self.program.held_size)
        on = self.program.switches()
        code.settle(self.program.command_array(controller.initial_commands()), memory, p, on, act)
        y, out, pull = np.zeros(6), np.zeros((period + 1, 6)), (0.0, 0.0)
        parts, t = [np.zeros((1, 6))], 0.0
        while t < file.duration - 1e-9 and not _over(file.until, y):
            x, east, psi, *_ = y.tolist()
            u, v, r = self.program.body_rates(y[None])[0, 3:].tolist()
            sense: Sense = sensors.sample(t, (x, east, psi), (u, v, r), pull, rng)
            row = self.program.command_array(controller.step(sense, told.goal_at(t)))
            commands = np.tile(row, (period, 1))
            code.rollout(
                Model(body, p, on), self.program.plant(y, memory), commands, t, file.step, 1, out
            )
            if given is not None:
                given.append(commands)
            a, b = (out[-1, i] - out[-2, i] for i in (3, 4))  # over the last step
            c, s = np.cos(y[2]), np.sin(y[2])
            pull = ((c * a + s * b) / file.step, (c * b - s * a) / file.step)
            parts.append(out[1:].copy())
            t += period * file.step
        states = np.concatenate(parts)
        return np.asarray(file.step * np.arange(len(states)), float), states


def _over(until: Any, y: Array) -> bool:
    """Whether the run is at its end."""
    return bool(
        (until.starboard is not None and y[1] >= until.starboard)
        or (until.turned is not None and abs(y[2]) >= until.turned)
    )


def _links(program: Program) -> list[tuple[int, int]]:
    """Positions of parameters that are those of another effect: (copy, source)."""
    found, there = [], {e.name for e in program.effects}
    for effect in program.effects:
        for name in effect.filled:
            owner, _, key = type(effect).params()[name].follows.removesuffix("?").partition(".")
            if owner in there:
                found.append((program.index(effect.name, name), program.index(owner, key)))
    return found
