"""Options of a run: seed, listeners, pace, source of the goals and conditions that end it."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TypeAlias

from boatsim.recordings.table import Recording
from boatsim.simulate.real_time_pace import Pace

Listener: TypeAlias = Callable[[Recording], None]
GoalSource: TypeAlias = Callable[[float], Mapping[str, float]]

# [s] of wall time between two deliveries to a listener: a killed process loses less than a second
REFRESH = 0.5
LIVE_REFRESH = 0.1  # [s] the same while a viewer shows the run


@dataclass(frozen=True)
class RunOptions:
    """Options of a run of a scenario: seed, listeners, pace, source of goals and stop conditions.

    Attributes:
        seed: Seed of parameters and sensor noise; None: the scenario's.
        listener: Receives the new rows of the log, without notes.
        camera_listener: Receives the new rows of the camera.
        folder: Folder for the temporary files that hold the log of a run of any length; None: the
            log is in memory.
        pace: Holds the run back to the pace of a clock; None: as fast as possible.
        refresh: Wall time between two deliveries to the listeners [s].
        log_changes: Whether the log also gets a row at each change of the commands.
        goal_source: Goals by time [s] in place of the scenario's.
        finish: Called after every step; True ends the run as complete.
        stop: True interrupts the run, which then is incomplete. Called before every step, or
            before each block of steps in open water.
        progress: Receives the simulated time [s] every 100 steps, or after each block.
    """

    seed: int | None = None
    listener: Listener | None = None
    camera_listener: Listener | None = None
    folder: Path | None = None
    pace: Pace | None = None
    refresh: float = REFRESH
    log_changes: bool = False
    goal_source: GoalSource | None = None
    finish: Callable[[], bool] = bool
    stop: Callable[[], bool] = bool
    progress: Callable[[float], None] | None = None
