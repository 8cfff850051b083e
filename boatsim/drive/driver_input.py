"""Stick positions from the page, and whether a driver holds the sticks."""

import time
from collections.abc import Callable
from typing import NamedTuple

# Silence after which the driver counts as absent [s]; the page sends every 50 ms.
PATIENCE = 0.3
DEAD = 0.08  # half-width of the dead zone about the middle; sticks do not return exactly to it
STEPS = 100  # resolution of a stick to one side, so that a hand at rest keeps its goals constant


class Sticks(NamedTuple):
    """Deflections of a driver's joysticks, each from -1 to 1.

    Attributes:
        surge: Positive ahead.
        sway: Positive to starboard.
        yaw: Positive clockwise.
    """

    surge: float = 0.0
    sway: float = 0.0
    yaw: float = 0.0


class _Message(NamedTuple):
    """The latest message of the page."""

    sticks: Sticks = Sticks()
    moved: float = (
        -1.0
    )  # time at which the sticks were last moved, clock of the page [s since 1970]
    received: float = 0.0  # time of arrival, clock of this object [s]


class DriverInput:
    """Latest stick positions of a driver, shared by the web server's thread and the simulation.

    Sticks that were released count again only after they have been in the middle, so that no boat
    starts unexpectedly.
    """

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        """Create the state without a driver.

        Args:
            clock: Returns the time [s].
        """
        self._clock = clock
        self._message = _Message()
        self._away = "no driver has taken the sticks"

    def store_sticks(self, sticks: Sticks, moved: float) -> None:
        """Store stick deflections that the web page has sent.

        Args:
            sticks: Stick deflections.
            moved: Time at which the sticks came to these deflections [s since 1970].
        """
        self._message = _Message(sticks, moved, self._clock())
        if max(map(abs, sticks)) <= DEAD:
            self._away = ""

    def release(self, why: str) -> None:
        """Record that the driver has released the sticks, and why.

        Args:
            why: The reason; a reason given earlier is kept.
        """
        self._away = self._away or why

    @property
    def release_reason(self) -> str:
        """Reason why no driver holds the sticks; "" while one does."""
        if not self._away and self._clock() - self._message.received > PATIENCE:
            self.release(f"no message for {PATIENCE:g} s")
        return self._away

    @property
    def last_moved_time(self) -> float:
        """Time at which the driver last moved the sticks, by the page's clock [s since 1970]."""
        return self._message.moved

    def sticks(self) -> Sticks | None:
        """Return the stick deflections beyond the dead zone; None if no driver holds the sticks."""
        if self.release_reason:
            return None
        return Sticks(*map(apply_dead_zone, self._message.sticks))


def apply_dead_zone(deflection: float) -> float:
    """Return a stick deflection measured from the end of the dead zone, rounded to STEPS.

    Args:
        deflection: Deflection from -1 to 1.
    """
    beyond = max(abs(deflection) - DEAD, 0.0) / (1.0 - DEAD)
    sign = 1.0 if deflection > 0.0 else -1.0
    return round(STEPS * min(beyond, 1.0)) / STEPS * sign
