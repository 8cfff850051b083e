"""The viewer that shows a run while it goes: one that listens here, a new one on the display, or rerun's in a browser.

All of them listen on this machine alone.
"""

import os
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import NoReturn
from urllib.parse import quote

from boatsim.errors import BoatsimError

PORT, PAGE = (
    9876,
    9090,
)  # where a viewer listens, and the web viewer's page is, unless these are taken
HERE = "127.0.0.1"
PATIENCE = 15.0  # [s] for a viewer to start
SETTLED = 0.3  # [s] after which it has all its ports, or has ended because one is taken


@dataclass(frozen=True)
class Viewer:
    """Where messages go, and where a browser looks."""

    to: str
    page: str = ""


@contextmanager
def shown(serve: bool) -> Iterator[Viewer | None]:
    """A viewer for the block: with `serve` rerun's own for browsers, which ends with it, otherwise one with a window.

    None where there is no display to show a window on. Raises BoatsimError where the web viewer does not start.
    """
    if serve:
        with _served() as viewer:
            yield viewer
    else:
        yield Viewer(_address(PORT)) if _listening(PORT) or (display() and _opened()) else None


def display() -> bool:
    """Whether there is a screen to open a window on."""
    return sys.platform in ("darwin", "win32") or bool(
        os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY")
    )


def _opened() -> bool:
    """A viewer with a window, which stays when the run is over; whether it came up."""
    started = _rerun("--bind", HERE, "--port", str(PORT), "--expect-data-soon")
    try:
        if _up(started, PORT):
            return True
    except BaseException:
        _end(started)
        raise
    _end(started)
    return False


@contextmanager
def _served() -> Iterator[Viewer]:
    """The web viewer of rerun and what feeds it, in a process of its own that ends with the block."""
    started, viewer = _serving(_free(PAGE)) or _serving(_free(0)) or _gone()
    try:
        yield viewer
    finally:
        _end(started)


def _serving(page: int) -> "tuple[subprocess.Popen[bytes], Viewer] | None":
    """A web viewer on a port; None if it does not start there, as where another one was quicker."""
    to = _free(0)
    started = _rerun(
        "--serve-web", "--bind", HERE, "--port", str(to), "--web-viewer-port", str(page)
    )
    try:
        if _up(started, to, page) and not _ends(started, SETTLED):
            return started, Viewer(
                _address(to), f"http://{HERE}:{page}/?url={quote(_address(to), safe='')}"
            )
    except BaseException:
        _end(started)
        raise
    _end(started)
    return None


def _gone() -> NoReturn:
    raise BoatsimError("rerun's web viewer does not start on this machine")


def _end(started: "subprocess.Popen[bytes]") -> None:
    """The command is a wrapper; the viewer is its child. One that does not listen is killed."""
    for number in (signal.SIGTERM, signal.SIGKILL):
        with suppress(ProcessLookupError):
            os.killpg(started.pid, number)
        if _ends(started, PATIENCE):
            return


def _ends(started: "subprocess.Popen[bytes]", seconds: float) -> bool:
    """Whether it ends within so long."""
    try:
        started.wait(seconds)
    except subprocess.TimeoutExpired:
        return False
    return True


def _rerun(*options: str) -> "subprocess.Popen[bytes]":
    """The viewer's program, beside the running Python if it is there; signals of the terminal do not reach it."""
    beside = Path(sys.executable).parent / "rerun"
    command = [str(beside)] if beside.is_file() else [sys.executable, "-m", "rerun"]
    silent = subprocess.DEVNULL
    return subprocess.Popen(
        [*command, *options], stdin=silent, stdout=silent, stderr=silent, start_new_session=True
    )


def _up(started: "subprocess.Popen[bytes]", *ports: int) -> bool:
    """Wait until all ports are listened at; whether they are."""
    until = time.monotonic() + PATIENCE
    while not all(map(_listening, ports)):
        if started.poll() is not None or time.monotonic() > until:
            return False
        time.sleep(0.05)
    return True


def _address(port: int) -> str:
    return f"rerun+http://{HERE}:{port}/proxy"


def _free(wanted: int) -> int:
    """The port if nobody has it, else one that is free."""
    for port in (wanted, 0):
        with socket.socket() as tried, suppress(OSError):
            tried.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
            tried.bind((HERE, port))
            return int(tried.getsockname()[1])
    raise BoatsimError("no port of this machine is free")


def _listening(port: int) -> bool:
    """Whether somebody listens at a port of this machine."""
    try:
        socket.create_connection((HERE, port), 1.0).close()
    except OSError:
        return False
    return True
