"""Runs a scenario: every period sensors, controller, commands; every step actuators and physics; all of it logged."""

import traceback
from collections import Counter
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from inspect import getsourcefile
from math import inf, nan
from operator import attrgetter
from pathlib import Path
from time import monotonic
from warnings import catch_warnings, simplefilter

import numpy as np

from boatsim.control.base import Controller, Sense
from boatsim.errors import BadInput, BoatsimError, unknown_name
from boatsim.physics.base import Force, motion
from boatsim.physics.signals import AXES, COMPONENTS, signals_of
from boatsim.physics.vessel import Vessel
from boatsim.recordings.table import NoSignal, Notes, Recording
from boatsim.simulate.camera import Frame
from boatsim.simulate.engine import Engine, State
from boatsim.simulate.multi_period_step import Leap
from boatsim.simulate.open_water import OpenWater
from boatsim.simulate.real_time_pace import Pace
from boatsim.simulate.run_log import FiledLog, Log
from boatsim.simulate.scenario import OFF, Scenario
from boatsim.simulate.sensing import sensed
from boatsim.simulate.world import Tank

SENSED = ("psi_rad", "r_radps", "ax_mps2", "ay_mps2", "u_mps", "x_m", "y_m")
FELT_OF = attrgetter("psi", "r", "ax", "ay", "u", "x", "y")  # of Sense, in the same order
SEEN = ("x_m", "y_m", "psi_rad")  # the pose that a camera frame gives
SHORTEST = 1e-6  # [s] of a part of a step
CHUNK = 500  # [rows] handed to a listener at a time
OFTEN = 0.5  # [s] after which it gets fewer: a process that is killed loses no more than a second
LIVE = 0.1  # [s] the same where somebody watches
STILL = 50  # rows of a boat that stays as it is, by which a measure is asked what it reads
Listener = Callable[[Recording], None]


@dataclass(frozen=True)
class Run:
    """What a run left: the log at every step, what the camera measured, and whether it ran to its end."""

    scenario: Scenario
    seed: int
    recording: Recording
    camera: Recording
    complete: bool
    steps: int = 0  # of physics
    # channel -> steps in which more was sent than it takes
    saturated: Mapping[str, int] = field(default_factory=dict)


class Runner:
    """One run in progress. `listen` gets new rows of the log, `watch` those of the camera: every 500, or every second.

    The log lies in memory, or where `folder` says in a file there, and then a run may be of any length.
    """

    def __init__(
        self, scenario: Scenario, seed: int | None = None, listen: Listener | None = None
    ) -> None:
        """Build the engine; raises BadInput or BadPhysics."""
        file = scenario.file
        self.scenario, self.listen = scenario, listen
        self.watch: Listener | None = None
        self.folder: Path | None = None
        self.pace: Pace | None = None  # somebody watches: then the listeners get rows more often
        self.often = LIVE  # [s] how often, then
        self.goal_at: Callable[[float], Mapping[str, float]] = (
            scenario.goal_at
        )  # or what somebody's hands ask for
        # whether they have had enough: the run is over, and whole
        self.enough: Callable[[], bool] = bool
        self.seed = file.seed if seed is None else seed
        vessel = replace(
            scenario.vessel, effects=tuple(e.seeded(self.seed) for e in scenario.vessel.effects)
        )
        self.engine = stepper(scenario, vessel)
        self._marks = [f"camera_{mark}_{axis}_m" for mark in scenario.camera.marks for axis in "xy"]
        seeds = np.random.SeedSequence(self.seed).spawn(2 + len(scenario.aboard))
        self._imu, self._shaking, *self._noise = (np.random.default_rng(s) for s in seeds)
        self._signals = signals_of(vessel.dof)
        self._axes = [axis in vessel.dof for axis in AXES]
        self._motion_of = attrgetter(*(signal.symbol for signal in self._signals))
        self._read = {
            name: column
            for sensor in scenario.aboard
            for name, column in type(sensor).columns.items()
        }
        self._sent_channels = list(type(scenario.controller).commands or vessel.commands)
        self._sent_places = [list(vessel.commands).index(name) for name in self._sent_channels]
        self._actuators = vessel.actuators
        self._goals = [
            key for key in scenario.goal_keys if key not in vessel.commands
        ]  # those are in `sent_` columns
        self._around = {n: m.neutral for n, m in vessel.measured.items()}
        self._winds = [e for e in vessel.effects if isinstance(e, Force) and type(e).of_air]
        self._sent: dict[str, float] = {}  # by the controller; what acts of it is the engine's
        self._beyond: list[str] = []
        self._saturated: Counter[str] = Counter()
        self._steps = 0
        self._sense: Sense | None = None
        self._frame = 0
        self._frames: list[Frame] = []
        self._due = 0.0
        self._early = inf  # [s] when the controller wants to act within its period
        self._row_due = 0.0
        self._shown = self._watched = 0  # rows the listeners have
        self._told = monotonic()  # when they last had any

    def run(
        self, progress: Callable[[float], None] | None = None, stop: Callable[[], bool] = bool
    ) -> Run:
        """Run to the end, or to an interruption, which keeps what was logged; `stop` is asked every step for one.

        `progress` gets the time reached [s].
        """
        complete, told = False, 0
        self._start()  # an interruption in here has nothing to keep
        self._check_measured()
        try:
            while not (complete := self._finished()) and not stop():
                if (
                    self.pace
                ):  # before the step: what is sensed and asked for at its end is that of its time
                    self.pace.wait(self._state.t + self.engine.step, stop)
                elif self._leaping:
                    self._leap(self._leaping)
                self._advance()
                if progress and self._steps >= told + 100:
                    progress(self._state.t)
                    told = self._steps
        except KeyboardInterrupt:
            pass
        self._show(over=True)
        return self.so_far(complete)

    def so_far(self, complete: bool = False) -> Run:
        """What there is by now; a listener may ask for it."""
        notes = self.notes()
        name = self.scenario.name.replace("/", "_")
        log, film = self.log.recording(name, notes), self._film.recording("camera", notes)
        return Run(
            self.scenario, self.seed, log, film, complete, self._steps, dict(self._saturated)
        )

    def _start(self) -> None:
        start = self.scenario.file.start
        state = State(**start.motion())
        self._state = state
        with self._asked() as controller:
            controller.reset()
            self._send(
                {**controller.initial_commands(), **start.commands},
                lambda sent: self.engine.reset(state, sent),
            )
        self._leaping = Leap.possible(self.scenario, self.engine, self._imu)
        # the log's columns are known once the controller has stepped: which estimates it has
        self._control()
        with self._asked() as controller:
            self._estimates = list(controller.estimates())
        duration = self.scenario.file.duration
        between = max(self.scenario.file.log, self.scenario.file.step)
        self.log = self._table(self._columns(), duration / between)
        self._film = self._table(
            ["t_s", *SEEN, *self._marks, *self._sent_channels], duration * self.scenario.camera.rate
        )
        self._average: list[
            tuple[list[float], float]
        ] = []  # commands in force, and for how long [s]
        self._frames = self._shoot(state, state)
        self._write_row()

    def _table(self, names: list[str], rows: float) -> Log:
        return FiledLog(names, self.folder) if self.folder else Log(names, round(rows) + 3)

    def _check_measured(self) -> None:
        """Raises NoSignal before the run for what its measure or a check wants and the log lacks.

        The measure is asked for the values of a boat that stays as it is: what it can not tell of that is no matter.
        """
        first = self.log.recording(self.scenario.name, Notes())
        for check in self.scenario.file.check:
            if check.signal not in first.signals:
                raise BadInput(unknown_name("[[check]] signal", check.signal, first.signals))
        if self.scenario.measure is None:
            return
        t = np.linspace(first.t[0], first.t[0] + self.scenario.file.duration, STILL)
        still = Recording(
            first.name, t, {n: np.full(STILL, x[0]) for n, x in first.signals.items()}
        )
        try:
            with np.errstate(all="ignore"), catch_warnings():
                simplefilter("ignore")
                self.scenario.measure.values(still)
        except NoSignal:
            raise
        except Exception:
            return

    def _columns(self) -> list[str]:
        """Beside motion and the commands that act: `sent_` what the controller sent before a range limited it.

        `goal_` is what it was to reach, nan where no goal says it; `actual_` is an actuator, `sensed_` and `camera_`
        were measured, `force_` is all laws, `wind_` those of the air.
        """
        limits = [f"{name}{end}" for name in self._adaptive() for end in ("", "_low", "_high")]
        references = [n for n in self._estimates if n.startswith("reference_")]
        force, wind = ([f"{what}_{c}" for c in self._components()] for what in ("force", "wind"))
        return [
            "t_s",
            *(s.column for s in self._signals),
            *self._sent_channels,
            *self._around,
            *(f"sent_{n}" for n in self._sent_channels),
            *(f"actual_{n}" for n in self._actuators),
            *(f"sensed_{n}" for n in (*SENSED, *self._read.values())),
            *self._marks,
            *(f"camera_{n}" for n in SEEN),
            *force,
            *(wind if self._winds else ()),
            "contacts",
            *(f"estimate_{n}" for n in limits),
            *references,
            *(f"goal_{n}" for n in self._goals),
        ]

    def _components(self) -> list[str]:
        """Force components of the vessel's freedoms."""
        return [COMPONENTS[axis] for axis in AXES if axis in self.scenario.vessel.dof]

    def _adaptive(self) -> list[str]:
        return [n for n in self._estimates if not n.startswith("reference_")]

    def _advance(self) -> None:
        """One step of physics from the commands in force, then control at its end and a row, if they are due.

        It is cut where the controller wants to act within it, and what it then changes is a row too.
        """
        before, end = self._state, self._state.t + self.engine.step
        self._steps += 1
        self._saturated.update(self._beyond)
        while self._early < end - SHORTEST:
            self._move(max(self._early - self._state.t, SHORTEST))
            held = self._sent
            self._ask()
            if self._sent != held:
                self._write_row()
        self._move(end - self._state.t if self._state.t > before.t else self.engine.step)
        self._frames += self._shoot(before, self._state)
        self._control()
        if self._state.t >= self._row_due - 1e-9 or self._finished():
            self._write_row()

    def _leap(self, leap: Leap) -> None:
        """On to the last step before a row, a frame or the end, if a period has just begun."""
        t = self._state.t
        due = min(
            self._row_due, self._frame / self.scenario.camera.rate, self.scenario.file.duration
        )
        periods = leap.periods(t, due)
        if not periods or abs(self._due - t - leap.period) > 1e-9:
            return
        with self._asked():
            done = leap.leap(t, periods, self.goal_at)
        self._steps += done.steps
        self._saturated.update(done.saturated)
        self._average.append(([done.mean[n] for n in self._sent_channels], done.seconds))
        self._state = self.engine.state
        self._due += done.seconds
        self._note_sent()

    def _move(self, seconds: float) -> None:
        """Physics alone, for so long."""
        self._average.append((self._in_force(), seconds))
        self.engine.advance(length=seconds)
        self._state = self.engine.state

    def _control(self) -> None:
        """Sensors and controller, once a period."""
        if self._state.t >= self._due - 1e-9:
            self._due += self.scenario.controller.period
            self._ask()

    def _ask(self) -> None:
        """Sensors and controller, now."""
        state = self._state
        usual = self.scenario.sensors.feel(
            state.t,
            (state.x, state.y, state.psi),
            (state.u, state.v, state.r),
            self.engine.acceleration(),
            self._imu,
            (state.phi, state.p),
        )
        sense = self._sense = sensed(usual, self.scenario.aboard, self.engine, self._noise)
        goal = self.goal_at(state.t)
        with self._asked() as controller:
            if goal.get(OFF):
                controller.reset()
                self._send({}, self.engine.command)
                self._early = inf
                return
            self._send(controller.step(sense, goal), self.engine.command)
            self._early = state.t + controller.early(sense)

    def _send(self, commands: dict[str, float], to: Callable[[dict[str, float]], None]) -> None:
        """Commands on their way; kept as they are sent, for the log."""
        to(commands)
        self._note_sent()

    def _note_sent(self) -> None:
        self._sent = dict(zip(self.scenario.vessel.commands, self.engine.sent, strict=False))
        self._beyond = self.engine.beyond

    @contextmanager
    def _asked(self) -> Iterator[Controller]:
        """The controller at work: whatever goes wrong in there is a line that names it and the time."""
        try:
            yield self.scenario.controller
        except Exception as error:
            called = f"controller {self.scenario.file.controller['use']} at t = {self._state.t:g} s"
            raise BadInput(
                f"{called}: {what_went_wrong(error, self.scenario.controller)}"
            ) from error

    def _shoot(self, before: State, after: State) -> list[Frame]:
        """Camera frames since the last step. A frame carries the mean command from it to the next one."""
        if not self.scenario.camera.due(self._frame, after.t):
            return []
        frames = list(
            self.scenario.camera.film(
                before.t,
                (before.x, before.y, before.psi),
                after.t,
                (after.x, after.y, after.psi),
                self._frame,
                self._shaking,
            )
        )
        for f in frames:
            self._close_frame()
            self._film.add([f.t, f.x, f.y, f.psi, *f.marks, *self._in_force()])
        self._frame += len(frames)
        return frames

    def _close_frame(self) -> None:
        """Give the last camera row the mean of the commands in force since."""
        if self._film.count and self._average:
            commands, seconds = zip(*self._average, strict=True)
            first = 1 + len(SEEN) + len(self._marks)
            self._film.amend(first, np.average(commands, 0, seconds))
        self._average.clear()

    def _write_row(self) -> None:
        s, engine, sense, frames = self._state, self.engine, self._sense, self._frames
        self._frames = []
        if s.t >= self._row_due - 1e-9:
            self._row_due += self.scenario.file.log
        assert sense is not None
        with self._asked() as controller:
            estimates = controller.estimates()
        goal = self.goal_at(s.t)
        self.log.add(
            [
                s.t,
                *self._motion_of(s),
                *self._in_force(),
                *self._around.values(),
                *(self._sent[n] for n in self._sent_channels),
                *engine.actuators.values(),
                *FELT_OF(sense),
                *(sense.more[n] for n in self._read),
                *(
                    (*frames[-1].marks, *frames[-1][1:4])
                    if frames
                    else [nan] * (len(self._marks) + len(SEEN))
                ),
                *(f for f, there in zip(engine.wrench(), self._axes, strict=True) if there),
                *(
                    (f for f, there in zip(self._wind(s), self._axes, strict=True) if there)
                    if self._winds
                    else ()
                ),
                engine.contacts,
                *(value for name in self._adaptive() for value in estimates[name]),
                *(estimates[n].value for n in self._estimates if n.startswith("reference_")),
                *(goal.get(n, nan) for n in self._goals),
            ]
        )
        self._show()

    def _in_force(self) -> list[float]:
        """Commands that act, of the channels the controller sets."""
        commands = self.engine.in_force()
        return [commands[i] for i in self._sent_places]

    def _wind(self, s: State) -> list[float]:
        """Force of the air (X, Y, Z, K, M, N) in body axes [N, N m]."""
        total = [0.0] * len(AXES)
        for effect in self._winds:
            law = type(effect).law.py_func  # type: ignore[attr-defined]  # one call needs no compiling
            bound = self.scenario.vessel.specified_bindings(effect).items()
            read = {role: self._around[c] if isinstance(c, str) else c for role, c in bound}
            signals = (type(effect).signals(**read),) if type(effect).roles else ()
            w = law(motion(**s._asdict()), effect.values(), *signals)
            total = [a + b for a, b in zip(total, w, strict=True)]
        return total

    def _show(self, over: bool = False) -> None:
        """New rows to the listeners, if there are enough or it is time; a frame once its commands are known."""
        now, often = monotonic(), self.often if self.pace else OFTEN
        if not over and self.log.count - self._shown < CHUNK and now - self._told < often:
            return
        self._told = now
        if self.listen and self.log.count > self._shown:
            self.listen(self.log.recording(self.scenario.name, Notes(), self._shown))
        ready = self._film.count if over else max(self._film.count - 1, 0)
        if self.watch and (ready > self._watched or not self._watched):
            self.watch(self._film.recording("camera", Notes(), self._watched, ready))
        self._shown, self._watched = self.log.count, ready

    def _finished(self) -> bool:
        file, s = self.scenario.file, self._state
        if s.t >= file.duration - 1e-9 or self.scenario.controller.done or self.enough():
            return True
        if file.until.starboard is None and file.until.turned is None:
            return False
        c, n = np.cos(file.start.psi), np.sin(file.start.psi)
        starboard = c * (s.y - file.start.y) - n * (s.x - file.start.x)
        out = file.until.starboard is not None and starboard >= file.until.starboard
        return bool(
            out
            or (file.until.turned is not None and abs(s.psi - file.start.psi) >= file.until.turned)
        )

    def notes(self) -> Notes:
        """What a diagnosis of this run may know: vessel, load, values set, noise of the camera."""
        file, noise = self.scenario.file, self.scenario.camera.noise()
        return Notes(
            vessel=file.vessel, load=tuple(file.load), settings=dict(file.set), noise=noise
        )


def stepper(scenario: Scenario, vessel: Vessel) -> Engine | OpenWater:
    """What steps the vessel of a scenario, as its `engine` says."""
    file = scenario.file
    if file.engine == "twin":
        return OpenWater(vessel, file.step)
    return Engine(vessel, Tank(**file.tank.model_dump()) if file.tank else None, file.step)


def run(
    scenario: Scenario,
    seed: int | None = None,
    listen: Listener | None = None,
    progress: Callable[[float], None] | None = None,
) -> Run:
    """Run a scenario; the same scenario and seed give the same numbers. Raises BadInput or BadPhysics."""
    return Runner(scenario, seed, listen).run(progress)


def what_went_wrong(error: Exception, controller: Controller) -> str:
    """An error on purpose in its own words; any other with its kind, and the controller's line it came from."""
    if isinstance(error, BoatsimError):
        return str(error)
    if isinstance(error, KeyError) and error.args[0] in type(controller).goals:
        return f"no [[goal]] in force says {error.args[0]}; it takes {', '.join(type(controller).goals)}"
    file = getsourcefile(type(controller))
    lines = [f.lineno for f in traceback.extract_tb(error.__traceback__) if f.filename == file]
    return f"{type(error).__name__}: {error}" + (f" ({file}, line {lines[-1]})" if lines else "")
