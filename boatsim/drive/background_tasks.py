"""What takes its time, such as files, goes on beside a run and never holds it up."""

import threading
from collections.abc import Iterator
from contextlib import contextmanager
from queue import Empty, SimpleQueue

from boatsim.recordings.table import Recording, joined
from boatsim.simulate.run_options import Listener


@contextmanager
def aside(listen: Listener, every: float) -> Iterator[Listener]:
    """A listener that hands rows over to this one, in a thread of its own, every so many seconds; all by the end.

    What goes wrong there is raised where the next rows come from, or at the end.
    """
    rows: SimpleQueue[Recording] = SimpleQueue()
    over = threading.Event()
    wrong: list[BaseException] = []

    def work() -> None:
        try:
            while not over.wait(every):
                _hand_over(rows, listen)
            _hand_over(rows, listen)
        except BaseException as error:
            wrong.append(error)

    def put(more: Recording) -> None:
        if wrong:
            raise wrong.pop()
        rows.put(more)

    thread = threading.Thread(target=work, name="files")
    thread.start()
    try:
        yield put
    finally:
        over.set()
        thread.join()
    if wrong:
        raise wrong.pop()


def _hand_over(rows: SimpleQueue[Recording], listen: Listener) -> None:
    """All that is there by now, as one piece."""
    pieces: list[Recording] = []
    try:
        while True:
            pieces.append(rows.get_nowait())
    except Empty:
        if pieces:
            listen(joined(pieces))
