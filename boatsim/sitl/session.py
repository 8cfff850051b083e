"""One run of a vessel that an autopilot controls frame by frame."""

from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field
from math import ceil
from typing import ClassVar

from boatsim.control.base import Controller, Sense
from boatsim.physics.base import param
from boatsim.simulate.engine import Engine
from boatsim.simulate.open_water import OpenWater
from boatsim.simulate.run_end import TIME_TOLERANCE
from boatsim.simulate.run_options import REFRESH, Listener
from boatsim.simulate.vessel_scenario import REPEATED
from boatsim.sitl.link import AutopilotLink, ReceivedFrame
from boatsim.sitl.motion_sample import MotionSample, inertial_reading, sample_motion
from boatsim.sitl.sensor_message import sensor_message
from boatsim.sitl.servo_map import ServoMap
from boatsim.sitl.servo_packet import ServoFrame
from boatsim.sitl.task import SitlTask
from boatsim.sitl.true_wind import TrueWind

ROUNDING = 1e-9  # by which a frame may exceed a whole number of steps


@dataclass
class AutopilotCommands(Controller):
    """Controller whose commands are those of an autopilot in another process.

    It acts after every step of the physics, since the autopilot sets the length of a frame.
    """

    words: ClassVar[str] = "passes on the servo outputs of an autopilot"

    period: float = param(0.0, low=0.0, high=0.0, unit="s", words="it acts after every step")
    next_commands: Callable[[], dict[str, float]] = field(default=dict)

    def step(self, sense: Sense, goal: Mapping[str, float]) -> dict[str, float]:
        """Return the autopilot's commands for the next step.

        Args:
            sense: Not used; the autopilot has its own sensors.
            goal: Not used.
        """
        return self.next_commands()


class AutopilotSession:
    """One run that an autopilot controls: answers each frame after it has been simulated.

    It is the `Steering` of a run. The run ends at its duration, when the autopilot is restarted or
    silent, or by an interruption.

    Attributes:
        link: Link to the autopilot.
        pace: None; the autopilot sets the pace.
        refresh: Wall time between two deliveries of log rows to listeners [s].
        restart: First frame of a restarted autopilot, with which the next run begins; None if the
            run has ended otherwise.
        silent: Whether the run has ended because the autopilot was silent.
    """

    def __init__(
        self, task: SitlTask, servos: ServoMap, link: AutopilotLink, first: ReceivedFrame
    ) -> None:
        """Prepare a run.

        Args:
            task: Vessel and surroundings.
            servos: Mapping of the servo outputs.
            link: Link to the autopilot.
            first: First frame of the run.
        """
        self.link = link
        self.pace = None
        self.refresh = REFRESH
        self.restart: ReceivedFrame | None = None
        self.silent = False
        self._task, self._servos = task, servos
        self._next: ReceivedFrame | None = first
        self._commands: dict[str, float] = {}
        self._changes: list[tuple[float, Mapping[str, float]]] = []
        self._rates: set[int] = set()
        self._steps_left = 0  # of the present frame, after the next one
        self._begin: MotionSample | None = None  # of the present frame
        self._end = 0.0  # [s] time that the run has reached
        self._frames = 0
        self._before = self._counters()

    def prepare_run(self, engine: Engine | OpenWater, stop: Callable[[], bool]) -> None:
        """Take the engine of the run, whose step becomes that of each frame.

        Args:
            engine: Engine that simulates the vessel.
            stop: Returns whether the run is interrupted.
        """
        self._engine, self._stop = engine, stop
        self._wind = TrueWind(engine.vessel)

    def goal_at(self, t: float) -> Mapping[str, float]:
        """Return no goals: those of the autopilot are not known."""
        return {}

    def is_finished(self) -> bool:
        """Return whether the autopilot has ended the run, by silence or by a restart."""
        return self.silent or self.restart is not None

    @contextmanager
    def wrap_listener(self, listen: Listener) -> Iterator[Listener]:
        """Yield the listener itself: the autopilot waits while files are written."""
        yield listen

    def next_commands(self) -> dict[str, float]:
        """Return the commands of the next step of physics.

        At the end of a frame the autopilot receives its answer, and its next frame is awaited.
        """
        if self._steps_left:
            self._steps_left -= 1
            return self._commands
        now = sample_motion(self._engine)
        self._end = now.t
        if self._begin is not None:
            inertial = inertial_reading(self._begin, now)
            self.link.answer(sensor_message(now, inertial, self._wind.velocity(now.t)))
        if now.t < self._task.scenario.file.duration - TIME_TOLERANCE:
            self._await_frame(now)
        return self._commands

    def _await_frame(self, now: MotionSample) -> None:
        """Wait for the next frame and begin it; nothing changes if none arrives."""
        received = self._next
        if received is None:
            received = self.link.next_frame(self._stop)
            if received is None:
                self.silent = not self._stop()
                return
            if received.restarted:
                self.restart = received
                return
        self._next = None
        self._begin = now
        self._begin_frame(received.frame, now.t)

    def _begin_frame(self, frame: ServoFrame, t: float) -> None:
        duration = 1.0 / frame.rate
        steps = ceil(duration / self._task.scenario.file.step - ROUNDING)
        self._engine.step = duration / steps
        self._steps_left = steps - 1
        self._rates.add(frame.rate)
        self._frames += 1
        commands = self._servos.commands(frame.pulses)
        if commands != self._commands or not self._changes:
            self._changes.append((t, commands))
        self._commands = commands

    def recording_facts(self) -> Mapping[str, object]:
        """Return facts about the run for recording.toml: autopilot, frame rates and packets."""
        counted: dict[str, object] = {}
        for name, count in self._counters().items():
            counted[name] = count - self._before[name]
        return {
            "autopilot": "ardupilot",
            "servo_outputs": self._servos.describe(),
            "frame_rates_hz": sorted(self._rates),
            "frames": self._frames,
            **counted,
        }

    def extra_files(self) -> Mapping[str, str]:
        """Return the scenario that repeats the commands of the run so far: file name -> text."""
        end = self._end or self._task.scenario.file.duration
        longest = self._task.scenario.file.step
        if self._rates:
            longest = 1.0 / max(self._rates)
        return {REPEATED: self._task.repeating_scenario(self._changes, end, longest)}

    def _counters(self) -> dict[str, int]:
        link = self.link
        return {
            "repeated_frames": link.repeated,
            "missed_frames": link.missed,
            "malformed_packets": link.malformed,
            "foreign_packets": link.foreign,
        }
