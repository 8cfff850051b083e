"""Save a picture of a log in rerun's viewer, without a display.

    python -m benchmarks.screenshot RUN.rrd OUT.png [SECONDS]

It needs a Vulkan driver, such as Mesa's software driver (Debian and Ubuntu: mesa-vulkan-drivers).
"""

import os
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from glob import glob
from pathlib import Path

from rerun.experimental import ViewerClient

from boatsim.files import replace_file
from boatsim.recordings.readers.rrd import TIMELINE, last_time

SOFTWARE = "/usr/share/vulkan/icd.d/lvp_icd*.json"  # Mesa's lavapipe
SIZE = "1600x900"


def screenshot(rrd: Path, png: Path, at: float | None = None, settle: float = 4.0) -> None:
    """Open a log in a viewer without a window and save what it shows.

    Args:
        rrd: The log.
        png: The picture to write.
        at: Time of the log to show [s]; its end by default.
        settle: Time that the viewer gets to load and draw [s].

    Raises:
        RuntimeError: No viewer starts.
    """
    with _viewer() as viewer:
        viewer.open(str(rrd.resolve()))
        time.sleep(settle)
        viewer.set_time(
            TIMELINE, duration=last_time(rrd) if at is None else at, play_state="paused"
        )
        time.sleep(settle)
        with replace_file(png) as temporary:
            temporary.write_bytes(viewer.take_screenshot())


@contextmanager
def _viewer(patience: float = 30.0) -> Iterator[ViewerClient]:
    """Start a viewer; ViewerClient.spawn would do the same but cannot set the window size."""
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    drivers = glob(SOFTWARE)
    environment = {**os.environ, "VK_ICD_FILENAMES": drivers[0]} if drivers else None
    command = [
        sys.executable,
        "-m",
        "rerun",
        "--headless",
        "--window-size",
        SIZE,
        "--port",
        str(port),
        "--hide-welcome-screen",
    ]
    process = subprocess.Popen(
        command, env=environment, stderr=subprocess.PIPE, start_new_session=True
    )
    try:
        yield _connected(process, port, time.monotonic() + patience)
    finally:
        os.killpg(process.pid, signal.SIGTERM)  # the command is a wrapper; the viewer is its child
        process.wait(10)


def _connected(process: "subprocess.Popen[bytes]", port: int, until: float) -> ViewerClient:
    while process.poll() is None and time.monotonic() < until:
        try:
            socket.create_connection(("127.0.0.1", port), 1.0).close()
            return ViewerClient.connect(f"rerun+http://127.0.0.1:{port}/proxy")
        except OSError:
            time.sleep(0.2)
    output = ""
    if process.poll() is not None and process.stderr:
        output = process.stderr.read().decode(errors="replace")
    raise RuntimeError(f"no viewer started; is a Vulkan driver installed? {output[-500:]}")


if __name__ == "__main__":
    if len(sys.argv) not in (3, 4):
        sys.exit(__doc__)
    screenshot(
        Path(sys.argv[1]), Path(sys.argv[2]), float(sys.argv[3]) if len(sys.argv) == 4 else None
    )
