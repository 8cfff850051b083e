"""Signals that end the program: Ctrl-C, a kill, a terminal that closes. What is being written is finished first."""

import signal
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from threading import current_thread, main_thread
from types import FrameType
from typing import Any

from boatsim.quiet import SIGNALS

Handler = Callable[[int, FrameType | None], Any] | int | None  # as the signal module has it

AGAIN = 0.05  # [s] until one that was lost strikes again


class Stop:
    """Whether somebody wants what is done in a block of `noted` to end; it asks at every step."""

    def __init__(self) -> None:
        self.asked, self.over = struck(), False

    def __call__(self) -> bool:
        """Whether to end now."""
        return self.asked

    def note(self, *_: object) -> None:
        """A signal has come. A second one while the first waits, as for a controller that hangs, ends it by force."""
        global _struck
        _struck = True
        if self.asked and not self.over:
            raise KeyboardInterrupt
        self.asked = True


@contextmanager
def noted() -> Iterator[Stop]:
    """Signals are noted and do not strike: a run ends at its next step, and its files are written whatever comes.

    The block says `stop.over = True` once nothing waits for an answer; one within another is a part of it. Outside the
    main thread nothing changes.
    """
    global _block
    if _block is not None:
        yield _block
        return
    _block = Stop()
    try:
        with _handled(_block.note):
            yield _block
    finally:
        _block = None


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
        before = {
            s: signal.signal(s, how) for s in SIGNALS if signal.getsignal(s) != signal.SIG_IGN
        }
    try:
        yield
    finally:
        for s, handler in before.items():
            signal.signal(s, handler)


def heed() -> None:
    """From now each of them is a KeyboardInterrupt, as Ctrl-C is; what came before is answered."""
    global _struck
    _struck = False
    for s in SIGNALS:
        if signal.getsignal(s) != signal.SIG_IGN:
            signal.signal(s, _strike)
    sys.unraisablehook = _lost


def struck() -> bool:
    """Whether one of them has come. A KeyboardInterrupt may be lost where a library catches or replaces it."""
    return _struck


def _strike(number: int, frame: FrameType | None) -> None:
    global _struck
    _struck = True
    if _block is not None:
        _block.asked = True
        return
    raise KeyboardInterrupt


def _lost(what: "sys.UnraisableHookArgs") -> None:
    """One that struck in a callback of native code, such as the compiler's, goes no further: it strikes once more."""
    if not _struck or not issubclass(what.exc_type, KeyboardInterrupt):
        sys.__unraisablehook__(what)
    elif hasattr(signal, "setitimer"):
        signal.signal(signal.SIGALRM, _strike)
        signal.setitimer(signal.ITIMER_REAL, AGAIN)


_struck = False
_block: Stop | None = None
