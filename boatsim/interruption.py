"""Handling of signals that end the program: Ctrl-C, kill, a closed terminal.

Files in progress are completed first.
"""

import signal
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from threading import current_thread, main_thread
from types import FrameType
from typing import Any

from boatsim.quiet import SIGNALS

# As in the signal module
Handler = Callable[[int, FrameType | None], Any] | int | None

RETRY_DELAY = 0.05  # [s] until a KeyboardInterrupt lost in native code is raised again


class Stop:
    """Shows whether a signal such as Ctrl-C has asked the program to stop.

    A block of `deferred_signals` calls the object at every step; True is a request to stop.

    Attributes:
        requested: Whether a signal has arrived.
    """

    def __init__(self) -> None:
        self.requested = signal_received()
        self._finishing = False

    def __call__(self) -> bool:
        """Return whether the block should stop."""
        return self.requested

    def finish(self) -> None:
        """Let further signals wait until the block exits, since from now on it only writes files.

        The block no longer calls the object afterwards.
        """
        self._finishing = True

    def record_signal(self, *_: object) -> None:
        """Record that a signal to stop the program has arrived.

        Raises:
            KeyboardInterrupt: On a second signal, if the block did not react to the first, as with
                a hanging controller.
        """
        global _received
        _received = True
        if self.requested and not self._finishing:
            raise KeyboardInterrupt
        self.requested = True


@contextmanager
def deferred_signals() -> Iterator[Stop]:
    """Defer Ctrl-C and kill signals until the block exits; a run then stops after a complete step.

    The block calls `stop.finish()` when it stops calling `stop`. A nested block is a part of
    the outer one. Outside the main thread nothing changes.

    Yields:
        The `Stop` that the block calls at every step.
    """
    global _block
    if _block is not None:
        yield _block
        return
    _block = Stop()
    try:
        with _install_handler(_block.record_signal):
            yield _block
    finally:
        _block = None


@contextmanager
def ignored_signals() -> Iterator[None]:
    """Ignore Ctrl-C and kill signals within the block; processes started there inherit that."""
    with _install_handler(signal.SIG_IGN):
        yield


@contextmanager
def _install_handler(handler: Handler) -> Iterator[None]:
    before = {}
    if current_thread() is main_thread():
        for number in SIGNALS:
            # A signal that is ignored stays ignored: nohup and shells that run jobs in the
            # background rely on it
            if signal.getsignal(number) != signal.SIG_IGN:
                before[number] = signal.signal(number, handler)
    try:
        yield
    finally:
        for number, previous in before.items():
            signal.signal(number, previous)


def raise_on_signals() -> None:
    """Raise KeyboardInterrupt on each Ctrl-C or kill signal from now on; forget earlier ones."""
    global _received
    _received = False
    for number in SIGNALS:
        if signal.getsignal(number) != signal.SIG_IGN:
            signal.signal(number, _raise_interrupt)
    sys.unraisablehook = _raise_lost_interrupt


def signal_received() -> bool:
    """Return whether Ctrl-C or a kill signal has arrived, even if a library caught it."""
    return _received


def _raise_interrupt(number: int, frame: FrameType | None) -> None:
    global _received
    _received = True
    if _block is not None:
        _block.requested = True
        return
    raise KeyboardInterrupt


def _raise_lost_interrupt(unraisable: "sys.UnraisableHookArgs") -> None:
    """Raise a KeyboardInterrupt again that was lost in a callback of native code."""
    if not _received or not issubclass(unraisable.exc_type, KeyboardInterrupt):
        sys.__unraisablehook__(unraisable)
    elif hasattr(signal, "setitimer"):
        signal.signal(signal.SIGALRM, _raise_interrupt)
        signal.setitimer(signal.ITIMER_REAL, RETRY_DELAY)


_received = False
_block: Stop | None = None
