"""One run under somebody's hands: what they ask for at every instant, what the page is shown, what is kept of it."""

import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path

from boatsim.drive.background_tasks import aside
from boatsim.drive.clock import Clock
from boatsim.drive.server import Server
from boatsim.drive.task import FILE, Task
from boatsim.drive.telemetry import Painter
from boatsim.recordings.table import Recording
from boatsim.simulate.engine import Engine
from boatsim.simulate.open_water import OpenWater
from boatsim.simulate.run_options import LIVE_REFRESH, REFRESH, Listener
from boatsim.simulate.scenario import OFF
from boatsim.simulate.tracking_errors import Tally

FRAME = 0.04  # [s] between two pictures
WAIT = 0.05  # [s] between two looks whether somebody is there

NOBODY: Mapping[str, float] = {OFF: 1.0}


class Session:
    """Steers a run by what the page says, and shows it there."""

    def __init__(
        self, task: Task, server: Server, told: Callable[[str], None], watched: bool = False
    ) -> None:
        """`told` gets a line when the sticks are let go or taken; `watched`: a viewer wants rows more often."""
        self.task, self.server, self.hands = task, server, server.hands
        self.clock = self.pace = Clock(task.scenario.controller.period)
        self.refresh = FRAME
        self._told = told
        self._every = LIVE_REFRESH if watched else REFRESH
        self._tally = Tally()
        self._goals: list[tuple[float, Mapping[str, float] | None]] = []
        self._goal: Mapping[str, float] = NOBODY
        self._at, self._heading, self._end = -1.0, task.scenario.file.start.psi, 0.0
        self._away: list[str] = []  # when the sticks were let go, and why
        self._moved = -1.0
        self.again = True  # whether its file holds all goals
        self.latencies: list[float] = []  # [s] from a stick to the log

    # What a run asks of it
    # ------------------------------------------------------------------------------------------

    def start(self, engine: Engine | OpenWater, stop: Callable[[], bool]) -> None:
        """Show the vessel and wait until a driver has taken the sticks.

        Args:
            engine: The engine of the run.
            stop: Whether to give up.

        Raises:
            KeyboardInterrupt: If `stop` returns True.
        """
        self._painter = Painter(engine, self.task.dials, self.task.scenario)
        self.server.greet(self._painter.hello())
        while self.hands.away and not self.server.ended and not stop():
            time.sleep(WAIT)
        if stop():  # nothing has begun
            raise KeyboardInterrupt

    def finished(self) -> bool:
        """Return whether the driver has ended the run."""
        return self.server.ended

    def goal_at(self, t: float) -> Mapping[str, float]:
        """What the hands ask for at time t [s]; the same for whoever asks again."""
        if t > self._at:
            dt, self._at = t - max(self._at, 0.0), t
            self._ask(t, dt)
        return self._goal

    @contextmanager
    def listening(self, listen: Listener) -> Iterator[Listener]:
        """A listener that shows the rows and hands them on, without waiting for the files."""
        with aside(listen, self._every) as files:

            def seen(rows: Recording) -> None:
                self._tally.add(rows)
                self._heading, self._end = float(rows["psi_rad"][-1]), float(rows.t[-1])
                self.server.show(
                    self._painter.frame(
                        rows, self._tally.norms(), self.clock, self.hands, self.latency
                    )
                )
                files(rows)

            yield seen

    def facts(self) -> Mapping[str, object]:
        """For recording.toml: what nobody can tell from the log."""
        return {
            "driven": True,
            "sticks_let_go": self._away,
            "periods": self.clock.periods,
            "late_periods": self.clock.late,
            "latest_ms": round(1e3 * self.clock.worst, 1),
            "latency_ms": [round(1e3 * x, 1) for x in self.latencies],
            "began_unix_s": self.clock.began or 0.0,
        }

    def files(self) -> Mapping[str, str]:
        """The scenario by which the run goes again, as far as it has come."""
        end = self._end or self.task.scenario.file.duration
        whole = self.task.toml(self._goals, end)
        self.again = whole is not None
        return {FILE: whole or self.task.toml([], end) or ""}

    # ----------------------------------------------------------------------------------------------------------------

    @property
    def latency(self) -> float | None:
        """Of the last stick [s]."""
        return self.latencies[-1] if self.latencies else None

    def _ask(self, t: float, dt: float) -> None:
        sticks, moved = self.hands.sticks(), self.hands.moved
        if sticks is None:
            self.task.dials.let_go()
        goal = NOBODY if sticks is None else self.task.dials.goal(sticks, dt, self._heading)
        if goal != self._goal or not self._goals:
            self._note(t, goal, moved)

    def _note(self, t: float, goal: Mapping[str, float], moved: float) -> None:
        """Another goal than before: it will be in the log and in the scenario's file."""
        if goal is NOBODY:
            self._away.append(f"{t:.2f} s: {self.hands.away}")
            self._told(f"t = {t:.2f} s: {self.hands.away}; commands are neutral")
        elif self._goal is NOBODY and self._away:
            self._told(f"t = {t:.2f} s: the sticks are taken again")
        if moved > self._moved and NOBODY not in (goal, self._goal):
            self.latencies.append(time.time() - moved)
        self._goal, self._moved = goal, moved
        self._goals.append((t, None if goal is NOBODY else goal))


def folder_name(vessel: str, now: float) -> Path:
    """Where a run goes that can not be driven again by hand: a folder of its own, by the clock."""
    return Path("out") / vessel / time.strftime("drive-%Y%m%d-%H%M%S", time.localtime(now))
