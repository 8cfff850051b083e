"""Stick positions from the page, and whether a driver holds the sticks."""

import time
from collections.abc import Callable
from typing import NamedTuple

# Silence after which the driver counts as absent [s]; the page sends every 50 ms.
PATIENCE = 0.3
DEAD = 0.08  # half-width of the dead zone about the middle; sticks do not return exactly to it
STEPS = 100  # resolution of a stick to one side, so that a hand at rest keeps its goals constant


class Sticks(NamedTuple):
    """Stick deflections from -1 to 1.

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
    """The latest stick positions, written by the thread of the server and read by the simulation.

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
        """Store a message of the page.

        Args:
            sticks: Stick deflections.
            moved: Time at which the sticks came to these deflections [s since 1970].
        """
        self._message = _Message(sticks, moved, self._clock())
        if max(map(abs, sticks)) <= DEAD:
            self._away = ""

    def release(self, why: str) -> None:
        """Note that the driver has released the sticks.

        Args:
            why: The reason; a reason deferred_signals earlier is kept.
        """
        self._away = self._away or why

    @property
    def release_reason(self) -> str:
        """Why no driver holds the sticks; "" while one does."""
        if not self._away and self._clock() - self._message.received > PATIENCE:
            self.release(f"no message for {PATIENCE:g} s")
        return self._away

    @property
    def last_moved_time(self) -> float:
        """Time at which the sticks were last moved, by the clock of the page [s since 1970]."""
        return self._message.moved

    def sticks(self) -> Sticks | None:
        """Return the deflections beyond the dead zone; None while no driver holds the sticks."""
        if self.release_reason:
            return None
        return Sticks(*map(beyond_dead_zone, self._message.sticks))


def beyond_dead_zone(deflection: float) -> float:
    """Return a deflection measured from the end of the dead zone, rounded to STEPS.

    Args:
        deflection: Deflection from -1 to 1.
    """
    beyond = max(abs(deflection) - DEAD, 0.0) / (1.0 - DEAD)
    sign = 1.0 if deflection > 0.0 else -1.0
    return round(STEPS * min(beyond, 1.0)) / STEPS * sign
