"""One run steered by a driver: goals from the sticks, frames for the page, facts for the files."""

import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path

from boatsim.drive.background_tasks import background_listener
from boatsim.drive.clock import Clock
from boatsim.drive.server import Server
from boatsim.drive.task import FILE, DriveTask
from boatsim.drive.telemetry import PageData
from boatsim.errors import BoatsimError
from boatsim.recordings.table import Recording
from boatsim.simulate import world
from boatsim.simulate.engine import Engine
from boatsim.simulate.open_water import OpenWater
from boatsim.simulate.run_options import LIVE_REFRESH, REFRESH, Listener
from boatsim.simulate.scenario import OFF, Scenario
from boatsim.simulate.tank import Tank
from boatsim.simulate.tracking_errors import TrackingErrorSums
from boatsim.view.scene import Scene, scene_from_model

FRAME = 0.04  # [s] between two frames of the page: 25 a second look smooth
WAIT = 0.05  # [s] between two checks whether a driver has taken the sticks
NO_DRIVER: Mapping[str, float] = {OFF: 1.0}  # goal while no driver holds the sticks


class NothingDriven(BoatsimError):
    """Raised if the page is closed before its driver has moved the sticks: no run is kept."""

    def __init__(self) -> None:
        super().__init__("the page was closed before the sticks were moved; nothing is saved")


class Session:
    """One run that a driver steers from a web page: goals from the sticks, states to the page.

    Attributes:
        task: The task.
        server: Server of the page.
        hands: Stick positions.
        clock: Real-time clock.
        replayable: Whether the scenario file of the run holds all goals.
        latencies: Delays from a stick to the log [s].
    """

    def __init__(
        self, task: DriveTask, server: Server, notify: Callable[[str], None], watched: bool = False
    ) -> None:
        """Create a session.

        Args:
            task: The task.
            server: Server of the page.
            notify: Function to call with a line when the sticks are released or taken.
            watched: Whether a viewer also shows the run and needs rows more often.
        """
        self.task, self.server, self.hands = task, server, server.hands
        self.clock = self.pace = Clock(task.scenario.controller.period)
        self.refresh = FRAME
        self._notify = notify
        self._interval = LIVE_REFRESH if watched else REFRESH
        self._tally = TrackingErrorSums()
        self._goals: list[tuple[float, Mapping[str, float] | None]] = []
        self._goal: Mapping[str, float] = NO_DRIVER
        self._at = -1.0
        self._heading = task.scenario.file.start.psi
        self._end = 0.0
        self._away: list[str] = []  # time and reason of each release of the sticks
        self._moved = -1.0
        self._driven = False  # whether the sticks have left the middle
        self._painter = PageData(scene_of(task.scenario), task.dials, task.scenario)
        self.replayable = True
        self.latencies: list[float] = []

    def show_preparation(self) -> None:
        """Show the vessel on the page while its equations are being compiled."""
        self.server.send_initial_data(self._painter.initial_data(ready=False))

    def prepare_run(self, engine: Engine | OpenWater, stop: Callable[[], bool]) -> None:
        """Tell the web page that the vessel is ready and wait until somebody drives it from there.

        Args:
            engine: Engine that simulates the vessel.
            stop: Returns whether the run is interrupted.

        Raises:
            KeyboardInterrupt: The run is interrupted.
            NothingDriven: The page was closed.
        """
        self.server.send_initial_data(self._painter.initial_data(ready=True))
        while self.hands.release_reason and not self.server.ended and not stop():
            if self.server.is_abandoned:
                raise NothingDriven
            time.sleep(WAIT)
        if stop():  # The run has not started.
            raise KeyboardInterrupt

    def is_finished(self) -> bool:
        """Return whether the driver has ended the run, on the page or by closing it.

        Raises:
            NothingDriven: The page was closed before the sticks were moved.
        """
        if self.server.is_abandoned and not self._driven:
            raise NothingDriven
        return self.server.ended or self.server.is_abandoned

    def goal_at(self, t: float) -> Mapping[str, float]:
        """Advance the controller's goals by the driver's sticks up to a time, and return them.

        A time that is not after the last one returns the same goals.

        Args:
            t: Simulated time [s].
        """
        if t > self._at:
            dt, self._at = t - max(self._at, 0.0), t
            self._update_goal(t, dt)
        return self._goal

    @contextmanager
    def wrap_listener(self, listen: Listener) -> Iterator[Listener]:
        """Show log rows on the driver's page and pass them to a slow listener in a thread.

        Args:
            listen: Listener that writes files.

        Yields:
            Listener that returns immediately.
        """
        with background_listener(listen, self._interval) as files:

            def show_rows_on_page(rows: Recording) -> None:
                self._tally.add_rows(rows)
                self._heading = float(rows["psi_rad"][-1])
                self._end = float(rows.t[-1])
                metrics = self._tally.metrics()
                frame = self._painter.frame_data(
                    rows, metrics, self.clock, self.hands, self.latency
                )
                self.server.send_frame(frame)
                files(rows)

            yield show_rows_on_page

    def recording_facts(self) -> Mapping[str, object]:
        """Return facts about the driven run for recording.toml, such as delays and late periods."""
        return {
            "driven": True,
            "sticks_let_go": self._away,
            "periods": self.clock.periods,
            "late_periods": self.clock.late,
            "latest_ms": round(1e3 * self.clock.worst, 1),
            "latency_ms": [round(1e3 * x, 1) for x in self.latencies],
            "began_unix_s": self.clock.began or 0.0,
        }

    def extra_files(self) -> Mapping[str, str]:
        """Return files that repeat the run so far without a driver: file name -> text."""
        end = self._end or self.task.scenario.file.duration
        whole = self.task.scenario_toml(self._goals, end)
        self.replayable = whole is not None
        return {FILE: whole or self.task.scenario_toml([], end) or ""}

    @property
    def latency(self) -> float | None:
        """Delay from the driver's last stick movement to the log [s]; None before the first."""
        if not self.latencies:
            return None
        return self.latencies[-1]

    def _update_goal(self, t: float, dt: float) -> None:
        sticks, moved = self.hands.sticks(), self.hands.last_moved_time
        goal = NO_DRIVER
        if sticks is None:
            self.task.dials.reset_heading()
        else:
            self._driven = self._driven or any(sticks)
            goal = self.task.dials.goal_from_sticks(sticks, dt, self._heading)
        if goal != self._goal or not self._goals:
            self._store_goal(t, goal, moved)

    def _store_goal(self, t: float, goal: Mapping[str, float], moved: float) -> None:
        """Store a new goal for the log and for the scenario file."""
        if goal is NO_DRIVER:
            self._away.append(f"{t:.2f} s: {self.hands.release_reason}")
            self._notify(f"t = {t:.2f} s: {self.hands.release_reason}; commands are neutral")
        elif self._goal is NO_DRIVER and self._away:
            self._notify(f"t = {t:.2f} s: a driver has taken the sticks again")
        if moved > self._moved and NO_DRIVER not in (goal, self._goal):
            self.latencies.append(time.time() - moved)
        self._goal, self._moved = goal, moved
        logged = None if goal is NO_DRIVER else goal
        self._goals.append((t, logged))


def scene_of(scenario: Scenario) -> Scene:
    """Return the shapes of vessel and water of a scenario, for which nothing has to be compiled.

    Args:
        scenario: The scenario.
    """
    file, vessel = scenario.file, scenario.vessel
    tank = world.open_water(vessel)
    if file.tank and not file.is_compiled:
        tank = Tank(**file.tank.model_dump())
    return scene_from_model(world.build_model(vessel, tank, file.step), vessel, tank)


def output_folder_name(vessel: str, now: float) -> Path:
    """Return the output folder of a driven run, named after the local time to be unique.

    Args:
        vessel: Name of the vessel.
        now: Unix time [s].
    """
    return Path("out") / vessel / time.strftime("drive-%Y%m%d-%H%M%S", time.localtime(now))
