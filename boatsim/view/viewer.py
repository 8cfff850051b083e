"""Rerun viewers that show a run while it goes: a running one, a new window, or one in a browser.

All of them listen on this machine only.
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
from typing import NoReturn
from urllib.parse import quote

from boatsim.errors import BoatsimError
from boatsim.view.rerun_command import rerun_command

PORT = 9876  # where a viewer listens, unless the port is in use
PAGE = 9090  # port of the web viewer's page, unless it is in use
HERE = "127.0.0.1"
PATIENCE = 15.0  # [s] for a viewer to start
SETTLED = 0.3  # [s] after which a viewer has all its ports, or has ended because one is in use


@dataclass(frozen=True)
class Viewer:
    """A running rerun viewer to which runs can be sent.

    Attributes:
        address: Address to which messages are sent.
        page: Address of its page; "" for a viewer with a window.
    """

    address: str
    page: str = ""


@contextmanager
def start_or_find_viewer(serve: bool) -> Iterator[Viewer | None]:
    """Start or find a rerun viewer for a block.

    Args:
        serve: Whether to start rerun's web viewer, which ends with the block, instead of a window.

    Yields:
        The viewer; None where there is no display for a window.

    Raises:
        BoatsimError: If the web viewer does not start.
    """
    if serve:
        with _run_web_viewer() as viewer:
            yield viewer
    elif _is_listening(PORT) or (has_display() and _open_window()):
        yield Viewer(_viewer_address(PORT))
    else:
        yield None


def has_display() -> bool:
    """Return whether the computer has a display on which a window can be opened."""
    if sys.platform in ("darwin", "win32"):
        return True
    return bool(os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY"))


def _open_window() -> bool:
    """Start a viewer with a window, which stays open after the run; return whether it started."""
    started = _start_rerun("--bind", HERE, "--port", str(PORT), "--expect-data-soon")
    try:
        if _wait_for(started, PORT):
            return True
    except BaseException:
        _stop_viewer(started)
        raise
    _stop_viewer(started)
    return False


@contextmanager
def _run_web_viewer() -> Iterator[Viewer]:
    """Rerun's web viewer in a process that ends with the block."""
    started, viewer = (
        _start_web_viewer(_find_free_port(PAGE))
        or _start_web_viewer(_find_free_port(0))
        or _raise_not_started()
    )
    try:
        yield viewer
    finally:
        _stop_viewer(started)


def _start_web_viewer(page: int) -> "tuple[subprocess.Popen[bytes], Viewer] | None":
    """Start a web viewer on a port; None if it does not start, as when the port is in use."""
    port = _find_free_port(0)
    started = _start_rerun(
        "--serve-web", "--bind", HERE, "--port", str(port), "--web-viewer-port", str(page)
    )
    try:
        if _wait_for(started, port, page) and not _ends_within(started, SETTLED):
            address = _viewer_address(port)
            url = f"http://{HERE}:{page}/?url={quote(address, safe='')}"
            return started, Viewer(address, url)
    except BaseException:
        _stop_viewer(started)
        raise
    _stop_viewer(started)
    return None


def _raise_not_started() -> NoReturn:
    raise BoatsimError("rerun's web viewer does not start on this machine")


def _stop_viewer(started: "subprocess.Popen[bytes]") -> None:
    """End a viewer; its process group is used, because the command is a wrapper of the viewer."""
    for number in (signal.SIGTERM, signal.SIGKILL):
        with suppress(ProcessLookupError):
            os.killpg(started.pid, number)
        if _ends_within(started, PATIENCE):
            return


def _ends_within(started: "subprocess.Popen[bytes]", seconds: float) -> bool:
    """Whether a process ends within so many seconds."""
    try:
        started.wait(seconds)
    except subprocess.TimeoutExpired:
        return False
    return True


def _start_rerun(*options: str) -> "subprocess.Popen[bytes]":
    """Start rerun's viewer in a new session, which signals of the terminal do not reach."""
    silent = subprocess.DEVNULL
    command = [*rerun_command(), *options]
    return subprocess.Popen(
        command, stdin=silent, stdout=silent, stderr=silent, start_new_session=True
    )


def _wait_for(started: "subprocess.Popen[bytes]", *ports: int) -> bool:
    """Wait until a viewer listens at all ports; return whether it does."""
    until = time.monotonic() + PATIENCE
    while not all(map(_is_listening, ports)):
        if started.poll() is not None or time.monotonic() > until:
            return False
        time.sleep(0.05)
    return True


def _viewer_address(port: int) -> str:
    return f"rerun+http://{HERE}:{port}/proxy"


def _find_free_port(wanted: int) -> int:
    """The port if it is free, else another one."""
    for port in (wanted, 0):
        with socket.socket() as tried, suppress(OSError):
            tried.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
            tried.bind((HERE, port))
            return int(tried.getsockname()[1])
    raise BoatsimError("no port of this machine is free")


def _is_listening(port: int) -> bool:
    """Whether a program listens at a port of this machine."""
    try:
        socket.create_connection((HERE, port), 1.0).close()
    except OSError:
        return False
    return True
