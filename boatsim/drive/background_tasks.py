"""Hands log rows to a slow consumer in a thread, so that writing files never delays a run."""

import threading
from collections.abc import Iterator
from contextlib import contextmanager
from queue import Empty, SimpleQueue

from boatsim.recordings.table import Recording, join_recordings
from boatsim.simulate.run_options import Listener


@contextmanager
def background_listener(listen: Listener, interval: float) -> Iterator[Listener]:
    """Call a listener of log rows in a thread at intervals, the last time at the end of the block.

    Rows that arrive in between are joined. An error of the listener is raised when the next rows
    arrive, or at the end of the block.

    Args:
        listen: Listener that is called in the thread.
        interval: Time between two calls [s].

    Yields:
        Listener that returns immediately.
    """
    rows: SimpleQueue[Recording] = SimpleQueue()
    finished = threading.Event()
    errors: list[BaseException] = []

    def pass_rows_at_intervals() -> None:
        try:
            while not finished.wait(interval):
                _pass_waiting_rows(rows, listen)
            _pass_waiting_rows(rows, listen)
        except BaseException as error:
            errors.append(error)

    def queue_rows(more: Recording) -> None:
        if errors:
            raise errors.pop()
        rows.put(more)

    thread = threading.Thread(target=pass_rows_at_intervals, name="files")
    thread.start()
    try:
        yield queue_rows
    finally:
        finished.set()
        thread.join()
    if errors:
        raise errors.pop()


def _pass_waiting_rows(rows: SimpleQueue[Recording], listen: Listener) -> None:
    """Pass all waiting rows to the listener as one recording."""
    pieces: list[Recording] = []
    try:
        while True:
            pieces.append(rows.get_nowait())
    except Empty:
        if pieces:
            listen(join_recordings(pieces))
