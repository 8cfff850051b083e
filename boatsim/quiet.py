"""Signals while the program starts and exits, when no data can be lost.

The module imports only the standard library.
"""

import os
import signal

# Sent by users, supervisors and closed terminals; some systems lack some of them
SIGNALS = tuple(
    getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, name)
)
CODE = 130  # exit code of an interrupted program by the convention of shells: 128 + SIGINT


def exit_on_signals() -> None:
    """End the program without a message on Ctrl-C and similar signals from now on."""
    for number in SIGNALS:
        # A signal that is ignored stays ignored: nohup and shells that run jobs in the background
        # rely on it
        if signal.getsignal(number) != signal.SIG_IGN:
            signal.signal(number, lambda *_: os._exit(CODE))
