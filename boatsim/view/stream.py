"""Where rerun's messages go: to a `.rrd`, to a viewer, or to both.

The file is written here and not by rerun, whose own writer waits for ever at its end where the disk is full.
"""

import warnings
from collections.abc import Iterable, Iterator
from pathlib import Path
from struct import Struct

import rerun as rr

from boatsim.files import AppendedFile

HEAD = 12  # bytes before the first message of a .rrd: RRF2, version, options
FRAME = Struct("<QQ")  # kind and length of a message
END = 0  # kind of the last one
PATIENCE = 10.0  # [s] for a viewer to take what is left at the end of a run


class Stream:
    """Messages to a file and a viewer; `heard` is False if there is neither, and then nothing is worth logging."""

    def __init__(self, name: str, path: Path | str | None, viewer: str | None = None) -> None:
        """`path` is the `.rrd` to write, `viewer` the address of one (None: none). Raises OSError."""
        self._file = self._written = self._viewer = None
        self._begun = False
        if path is not None:
            Path(path).parent.mkdir(parents=True, exist_ok=True)
            self._file = AppendedFile(Path(path).open("wb", buffering=0), Path(path))
            to_file = rr.RecordingStream(name, send_properties=False)
            self._written = rr.binary_stream(to_file)
        if viewer is not None:
            self._viewer = rr.RecordingStream(name, send_properties=False)
            self._viewer.set_sinks(rr.GrpcSink(viewer))
        self._to = [
            *([to_file] if path is not None else []),
            *([self._viewer] if self._viewer else []),
        ]
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


def _end(stream: rr.RecordingStream) -> None:
    try:
        stream.flush(timeout_sec=PATIENCE)
    except (
        RuntimeError,
        TimeoutError,
        ValueError,
    ) as error:  # a viewer that was closed while the run went on
        warnings.warn(f"the viewer did not take all of the log ({error})", stacklevel=4)
    stream.disconnect()
