"""Where rerun's messages go: to a `.rrd`, to the viewer that listens on this machine or a new one, or to both.

The file is written here and not by rerun, whose own writer waits for ever at its end where the disk is full.
"""

import socket
import sys
import warnings
from collections.abc import Iterable, Iterator
from contextlib import suppress
from pathlib import Path
from struct import Struct

import rerun as rr

from boatsim.files import Growing

PORT = 9876  # where a viewer listens unless told otherwise
HEAD = 12  # bytes before the first message of a .rrd: RRF2, version, options
FRAME = Struct("<QQ")  # kind and length of a message
END = 0  # kind of the last one
PATIENCE = 10.0  # [s] for a viewer to take what is left at the end of a run


class Stream:
    """Messages to a file and a viewer; `heard` is False if there is neither, and then nothing is worth logging."""

    def __init__(self, name: str, path: Path | str | None, live: bool) -> None:
        """`path` is the `.rrd` to write (None: none). Raises OSError."""
        self._file = self._written = self._viewer = None
        self._begun = False
        if path is not None:
            Path(path).parent.mkdir(parents=True, exist_ok=True)
            self._file = Growing(Path(path).open("wb", buffering=0), Path(path))
            to_file = rr.RecordingStream(name, send_properties=False)
            self._written = rr.binary_stream(to_file)
        if live:
            self._viewer = _of_viewer(name)
        self._to = [*([to_file] if path is not None else []), *([self._viewer] if self._viewer else [])]
        self.heard = bool(self._to)

    def log(self, entity: str, what: rr.AsComponents, static: bool = False) -> None:
        """One thing; see rerun's own."""
        for stream in self._to:
            stream.log(entity, what, static=static)

    def send_columns(
        self, entity: str, indexes: Iterable[rr.TimeColumn], columns: Iterable[rr.ComponentColumn]
    ) -> None:
        """Many rows of one thing; see rerun's own."""
        indexes, columns = list(indexes), list(columns)
        for stream in self._to:
            stream.send_columns(entity, indexes, columns)

    def send_blueprint(self, layout: rr.blueprint.Blueprint) -> None:
        """How the viewer lays it out."""
        for stream in self._to:
            stream.send_blueprint(layout)

    def keep(self) -> None:
        """What was logged is in the file when this returns. Raises OSError, and then the file ends where it did."""
        if self._file and self._written and (new := self._written.read()):
            first, self._begun = not self._begun, True
            self._file.add(b"".join(_pieces(new, first)))

    def close(self) -> None:
        """Keep the rest; nothing more comes. Raises OSError."""
        try:
            self.keep()
        finally:
            if self._file:
                self._file.close()
            if self._viewer:
                _end(self._viewer)


def _pieces(whole: bytes, first: bool) -> Iterator[bytes]:
    """Of the bytes of a whole `.rrd` what appends to another: its messages, without its head unless it is the `first`.

    Each message has its kind and length in front. The last one, with what follows, is a table of places in the file,
    which a reader does not need.
    """
    if first:
        yield whole[:HEAD]
    at = HEAD
    while at + FRAME.size <= len(whole):
        kind, length = FRAME.unpack_from(whole, at)
        if kind == END:
            return
        yield whole[at : at + FRAME.size + length]
        at += FRAME.size + length


def _of_viewer(name: str) -> rr.RecordingStream | None:
    """A stream to the viewer; None, with a warning, if none could be started."""
    stream = rr.RecordingStream(name, send_properties=False)
    if not _listening():
        with suppress(RuntimeError):  # no viewer to start: said below
            rr.spawn(connect=False, recording=stream, executable_path=_viewer())
    if not _listening():
        warnings.warn("no rerun viewer could be started (is there a display?); the run goes on", stacklevel=4)
        return None
    stream.set_sinks(rr.GrpcSink(f"rerun+http://127.0.0.1:{PORT}/proxy"))
    return stream


def _viewer() -> str | None:
    """The viewer beside the running Python, which need not be on the path; None: wherever rerun finds it."""
    beside = Path(sys.executable).parent / "rerun"
    return str(beside) if beside.is_file() else None


def _end(stream: rr.RecordingStream) -> None:
    try:
        stream.flush(timeout_sec=PATIENCE)
    except (RuntimeError, TimeoutError, ValueError) as error:  # a viewer that was closed while the run went on
        warnings.warn(f"the viewer did not take all of the log ({error})", stacklevel=4)
    stream.disconnect()


def _listening() -> bool:
    """Whether somebody listens at the viewer's port."""
    try:
        socket.create_connection(("127.0.0.1", PORT), 1.0).close()
    except OSError:
        return False
    return True
