"""Fast closed-loop runs of the thesis' eight tests, as functions of effects its model may lack.

Scenarios, controllers, sensors, camera and metrics are those of `boatsim run`; only the walls and
the log are left out. The runs use the compiled engine.

At the rate of the published turns the thesis' program effectively runs in open loop: it steers
straight, and the noise of its sensors switches the port motor between 104 and 105 of 255. So the
commands of one turn can be replayed on boats that turn about as fast (`replayed`).
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from boatsim.control.base import Sense
from boatsim.physics.base import Array, CoefficientRelease
from boatsim.physics.content import load_class
from boatsim.physics.kernel.records import VesselNumbers
from boatsim.physics.program import Program
from boatsim.simulate import scenario
from boatsim.simulate.camera_metric import CameraFrames, CameraMetricSet
from boatsim.simulate.cases import read_scenario
from boatsim.simulate.scenario import Scenario
from validation.real.common import names_of

TESTS = ("sway_1", "sway_2", "sway_3", "sway_4", "yaw_1", "yaw_2", "yaw_3", "yaw_4")
WINDY = ("yaw_2", "yaw_4")  # T18


@dataclass(frozen=True)
class AdjustableStrength:
    """An adjustable strength: where it acts, its absent value, its prior sd and its bounds."""

    effect: str  # of the vessel, or "controller", "camera", "body"
    name: str
    unit: str
    mean: float  # value at which it has no effect
    sd: float
    low: float
    high: float
    how: str = "set"  # or "add" to the scenario's own value, or "times" it
    tests: tuple[str, ...] = TESTS

    @property
    def label(self) -> str:
        """Name for tables."""
        label = f"{self.effect}.{self.name}"
        if self.effect != "pwm_thrust":
            return label
        kinds = sorted({test.split("_")[0] for test in self.tests})
        return f"{label} ({' and '.join(kinds)})"

    def applied(self, own: float, x: float) -> float:
        """Return the value used in a run.

        Args:
            own: The scenario's own value.
            x: The strength.
        """
        return {"set": x, "add": own + x, "times": own * x}[self.how]


class ThesisTest:
    """A test of the thesis that runs with any knobs."""

    def __init__(
        self,
        name: str,
        extra: Sequence[Mapping[str, Any]] = (),
        nominal: Mapping[str, Any] | None = None,
        replayed: bool = False,
    ) -> None:
        """Load a scenario.

        Args:
            name: Name of the test, with the suffix `_as_published` for the thesis' controller.
            extra: Effects that replace the scenario's own of the same names.
            nominal: Tables `[set]` of the scenario.
            replayed: Every boat gets the commands that the scenario's own boat gets.
        """
        raw: dict[str, Any] = read_scenario(f"joystick_boat/{name}")[0]
        added = {effect["use"]: dict(effect) for effect in extra}
        kept = []
        for table in raw.get("effect", []):
            if table["use"] not in added:
                kept.append(table)
            elif table["use"] == "fan_wind":
                added["fan_wind"] = {**table, **added["fan_wind"]}
        settings = dict(raw.get("set", {}))
        for key, values in (nominal or {}).items():
            settings[key] = {**settings.get(key, {}), **values}
        over = {"tank": None, "effect": [*kept, *added.values()], "set": settings}
        self.scenario: Scenario = scenario.load(f"joystick_boat/{name}", over)
        assert isinstance(self.scenario.measure, CameraMetricSet)
        self.name = name
        self.measure = self.scenario.measure
        self.program = Program(self.scenario.vessel)
        self.published = {}
        for metric, targets in self.scenario.file.norms.items():
            if targets.published is not None:
                self.published[metric] = targets.published
        self._links = _inherited_places(self.program)
        self._released = {}
        for use in added:
            kind = load_class("effect", use)
            if issubclass(kind, CoefficientRelease):
                self._released[use] = kind().changes(self.scenario.vessel)
        self._own = None
        if replayed:
            self._own = ThesisTest(name)
        self._commands: dict[int, Array] = {}  # seed -> commands (N, C), one row a step

    def norms(
        self, knobs: Sequence[AdjustableStrength], values: Sequence[float], seeds: Sequence[int]
    ) -> dict[str, float]:
        """Return the metrics, averaged over seeds; empty if a run ends before they are defined."""
        by_metric: dict[str, list[float]] = {}
        for seed in seeds:
            found = self.measure.values_from_frames(self._film(knobs, values, seed))
            if not found:
                return {}
            for name, x in found.items():
                by_metric.setdefault(name, []).append(x)
        return {name: float(np.mean(samples)) for name, samples in by_metric.items()}

    def _film(
        self, knobs: Sequence[AdjustableStrength], values: Sequence[float], seed: int
    ) -> CameraFrames:
        """Return the frames of the camera during one run."""
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
                for change in self._released[knob.effect]:
                    if change.parameter == knob.name:
                        at = self.program.parameter_index(change.owner, change.key)
                        p[at] = change.changed_value(p[at], x)
            else:
                at = self.program.parameter_index(knob.effect, knob.name)
                p[at] = knob.applied(p[at], x)
        for copy, source in self._links:
            p[copy] = p[source]
        imu, marks = map(np.random.default_rng, np.random.SeedSequence(seed).spawn(2))
        if self._own is None:
            t, y = self._run(p, body, imu)
        else:
            if seed not in self._commands:
                self._commands[seed] = self._own.commands(imu)
            t, y = self._replay(p, body, self._commands[seed])
        for name, value in own.items():
            setattr(controller, name, value)
        every = round(camera.rate / self.measure.scored)
        frames = np.arange(0.0, t[-1] + 1e-9, 1.0 / camera.rate)
        noise = marks.standard_normal((len(frames), 2 * len(camera.marks)))[::every]
        frames = frames[::every]
        x, east, psi = (np.interp(frames, t, column) for column in y[:, :3].T)
        seen = camera.measured_mark_positions(x + 1j * east, psi, noise)
        points = {}
        for name, z in zip(camera.marks, seen.T, strict=True):
            points[name] = np.stack([z.real, z.imag], axis=-1)
        return CameraFrames(
            frames, camera.fit_pose(seen)[1], points, np.stack([x, east], axis=-1), psi
        )

    def commands(self, rng: np.random.Generator) -> Array:
        """Return the commands (N, C) of every step of the boat without knobs.

        The last ones are held until the duration is over.
        """
        parts: list[Array] = []
        self._run(self.program.values(), self.program.body, rng, parts)
        found, file = np.concatenate(parts), self.scenario.file
        missing = round(file.duration / file.step) - len(found)
        return np.concatenate([found, np.tile(found[-1], (missing, 1))])

    def _replay(self, p: Array, body: Array, commands: Array) -> tuple[Array, Array]:
        """Return times (N,) and states (N, 6) in earth axes of a run with given commands."""
        program, step = self.program, self.scenario.file.step
        code, on = program.simulation_functions, program.effect_switches()
        memory, out = np.zeros(program.memory_size), np.zeros((len(commands) + 1, 6))
        start = program.command_array(self.scenario.controller.initial_commands())
        code.settle_actuators(start, memory, p, on, np.zeros(program.actuator_signal_size))
        plant = program.vessel_state(np.zeros(6), memory)
        code.rollout(VesselNumbers(body, p, on), plant, commands, 0.0, step, 1, out)
        return np.asarray(step * np.arange(len(out)), float), np.asarray(out, float)

    def _run(
        self, p: Array, body: Array, rng: np.random.Generator, log: list[Array] | None = None
    ) -> tuple[Array, Array]:
        """Return times (N,) and states (N, 6) in earth axes of one run to its end.

        The commands of every step are appended to `log`.
        """
        program, file = self.program, self.scenario.file
        controller, sensors, code = (
            self.scenario.controller,
            self.scenario.sensors,
            program.simulation_functions,
        )
        controller.reset()
        period = round(controller.period / file.step)
        memory, act = np.zeros(program.memory_size), np.zeros(program.actuator_signal_size)
        on = program.effect_switches()
        code.settle_actuators(
            program.command_array(controller.initial_commands()), memory, p, on, act
        )
        y, out, pull = np.zeros(6), np.zeros((period + 1, 6)), (0.0, 0.0)
        parts, t = [np.zeros((1, 6))], 0.0
        while t < file.duration - 1e-9 and not _run_has_ended(file.until, y):
            x, east, psi, *_ = y.tolist()
            u, v, r = program.to_body_velocities(y[None])[0, 3:].tolist()
            sense: Sense = sensors.sample(t, (x, east, psi), (u, v, r), pull, rng)
            row = program.command_array(controller.step(sense, self.scenario.goal_at(t)))
            commands = np.tile(row, (period, 1))
            plant = program.vessel_state(y, memory)
            code.rollout(VesselNumbers(body, p, on), plant, commands, t, file.step, 1, out)
            if log is not None:
                log.append(commands)
            a, b = (out[-1] - out[-2])[3:5]  # over the last step
            c, s = np.cos(y[2]), np.sin(y[2])
            pull = ((c * a + s * b) / file.step, (c * b - s * a) / file.step)
            parts.append(out[1:].copy())
            t += period * file.step
        states = np.concatenate(parts)
        return np.asarray(file.step * np.arange(len(states)), float), states


def _run_has_ended(until: Any, y: Array) -> bool:
    """Whether the run is at its end."""
    arrived = until.starboard is not None and y[1] >= until.starboard
    return bool(arrived or (until.turned is not None and abs(y[2]) >= until.turned))


def _inherited_places(program: Program) -> list[tuple[int, int]]:
    """Return the positions of parameters that follow another effect: (copy, source)."""
    found = []
    owners = names_of(program.effects)
    for effect in program.effects:
        for name in effect.filled:
            owner, _, key = type(effect).params()[name].follows.removesuffix("?").partition(".")
            if owner in owners:
                found.append(
                    (
                        program.parameter_index(effect.name, name),
                        program.parameter_index(owner, key),
                    )
                )
    return found
