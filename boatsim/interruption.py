"""Signals that end the program: Ctrl-C, a kill, a terminal that closes. What is being written is finished first."""

import os
import signal
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from threading import current_thread, main_thread
from types import FrameType
from typing import Any

# what a user, a supervisor and a terminal that closes send; there is no SIGHUP on every system
SIGNALS = tuple(getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, name))
Handler = Callable[[int, FrameType | None], Any] | int | None  # as the signal module has it
CODE = 130  # exit code of what was interrupted: 128 + SIGINT, as shells have it


class Stop:
    """Whether somebody wants a run to end; the run asks it at every step."""

    def __init__(self) -> None:
        self.asked = self.over = False

    def __call__(self) -> bool:
        """Whether to end now."""
        return self.asked

    def note(self, *_: object) -> None:
        """A signal has come. A second one while the first waits, as for a controller that hangs, ends it by force."""
        if self.asked and not self.over:
            raise KeyboardInterrupt
        self.asked = True


@contextmanager
def noted() -> Iterator[Stop]:
    """Signals are noted and do not strike: a run ends at its next step, and its files are written whatever comes.

    The block says `stop.over = True` once nothing waits for an answer. Outside the main thread nothing changes.
    """
    stop = Stop()
    with _handled(stop.note):
        yield stop


@contextmanager
def ignored() -> Iterator[None]:
    """Signals do nothing; a process that starts inherits that."""
    with _handled(signal.SIG_IGN):
        yield


@contextmanager
def _handled(how: Handler) -> Iterator[None]:
    before = {}
    if current_thread() is main_thread():
        # one that is ignored stays so: nohup, and a shell that runs us in the background, mean it
        before = {s: signal.signal(s, how) for s in SIGNALS if signal.getsignal(s) != signal.SIG_IGN}
    try:
        yield
    finally:
        for s, handler in before.items():
            signal.signal(s, handler)


def heed() -> None:
    """From now every one of them is a KeyboardInterrupt, as Ctrl-C is."""
    _handle(_strike)


def leave_quietly() -> None:
    """From now every one of them ends the program without a word: nothing was begun yet, or all is done."""
    _handle(lambda *_: os._exit(CODE))


def _handle(how: Handler) -> None:
    for s in SIGNALS:
        if signal.getsignal(s) != signal.SIG_IGN:
            signal.signal(s, how)


def _strike(number: int, frame: FrameType | None) -> None:
    raise KeyboardInterrupt
