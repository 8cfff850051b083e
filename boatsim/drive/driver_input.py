"""Whose hands are on the sticks: what they ask for, and when nobody's are."""

import time
from collections.abc import Callable
from typing import NamedTuple

PATIENCE = 0.3  # [s] without a message after which nobody holds the sticks
DEAD = 0.08  # share of a stick's way about its middle that counts as none
STEPS = 100  # of a stick's way to one side: a hand that is still leaves the goals still


class Sticks(NamedTuple):
    """How far the sticks are pushed, -1 to 1."""

    surge: float = 0.0  # ahead
    sway: float = 0.0  # to starboard
    yaw: float = 0.0  # clockwise


class Hands:
    """The latest word from the page, written by the server's thread and read by that of the physics.

    Sticks that were let go count again once they have been in the middle: nothing starts up by itself.
    """

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        self._clock = clock
        self._word = (
            Sticks(),
            -1.0,
            0.0,
        )  # sticks, when they were last moved by the page's clock [s], when we heard it
        self._away = "nobody has taken the sticks"  # why; "" while somebody holds them

    def move(self, sticks: Sticks, moved: float) -> None:
        """A message from the page; `moved` [s since 1970] is when the sticks came to where they are."""
        self._word = sticks, moved, self._clock()
        if all(abs(x) <= DEAD for x in sticks):
            self._away = ""

    def let_go(self, why: str) -> None:
        """Nobody holds them from now on."""
        self._away = self._away or why

    @property
    def away(self) -> str:
        """Why nobody holds the sticks, "" while somebody does."""
        if not self._away and self._clock() - self._word[2] > PATIENCE:
            self.let_go(f"no message for {PATIENCE:g} s")
        return self._away

    @property
    def moved(self) -> float:
        """When the sticks came to where they are [s since 1970], by the page's clock."""
        return self._word[1]

    def sticks(self) -> Sticks | None:
        """Where they are, without the dead zone about the middle; None: nobody holds them."""
        return None if self.away else Sticks(*map(live, self._word[0]))


def live(way: float) -> float:
    """A stick's way from the end of its dead zone, in steps."""
    beyond = max(abs(way) - DEAD, 0.0) / (1.0 - DEAD)
    return round(STEPS * min(beyond, 1.0)) / STEPS * (1.0 if way > 0.0 else -1.0)
