"""The first and the last moments of the program, in which there is nothing to keep; imports next to nothing itself."""

import os
import signal

# what a user, a supervisor and a terminal that closes send; not every system has all of them
SIGNALS = tuple(
    getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, name)
)
CODE = 130  # exit code of what was interrupted: 128 + SIGINT, as shells have it


def leave_quietly() -> None:
    """From now each of SIGNALS ends the program without a word."""
    for s in SIGNALS:
        if (
            signal.getsignal(s) != signal.SIG_IGN
        ):  # nohup, and a shell that runs us in the background, mean it
            signal.signal(s, lambda *_: os._exit(CODE))
