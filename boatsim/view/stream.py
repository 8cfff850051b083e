"""Sends rerun's messages to a `.rrd` file, a viewer or both.

The file is not written by rerun, whose writer never returns if the disk is full.
"""

import warnings
from collections.abc import Iterable, Iterator
from pathlib import Path
from struct import Struct

import rerun as rr

from boatsim.files import AppendedFile
from boatsim.view.rrd_index import add_index

HEAD = 12  # [bytes] before the first message of a .rrd: RRF2, version, options
FRAME = Struct("<QQ")  # kind and length of a message
END = 0  # kind of the last message
PATIENCE = 10.0  # [s] for a viewer to receive the rest at the end of a run


class Stream:
    """Sends the messages of a rerun log to a file, to a viewer or to both.

    Attributes:
        has_receiver: False if there is neither; then nothing needs to be logged.
    """

    def __init__(self, name: str, path: Path | str | None, viewer: str | None = None) -> None:
        """Open the file and connect to the viewer.

        Args:
            name: Name of the application.
            path: The `.rrd` file; None: none.
            viewer: Address of a viewer; None: none.

        Raises:
            OSError: If the file cannot be written.
        """
        self._streams: list[rr.RecordingStream] = []
        self._file = self._written = self._viewer = None
        self._path: Path | None = None
        self._has_header = False
        if path is not None:
            self._path = Path(path)
            self._path.parent.mkdir(parents=True, exist_ok=True)
            self._file = AppendedFile(self._path.open("wb", buffering=0), self._path)
            to_file = rr.RecordingStream(name, send_properties=False)
            self._written = rr.binary_stream(to_file)
            self._streams.append(to_file)
        if viewer is not None:
            self._viewer = rr.RecordingStream(name, send_properties=False)
            self._viewer.set_sinks(rr.GrpcSink(viewer))
            self._streams.append(self._viewer)
        self.has_receiver = bool(self._streams)

    def log(self, entity: str, what: rr.AsComponents, static: bool = False) -> None:
        """Log an entity to file and viewer; see `rerun.RecordingStream.log`."""
        for stream in self._streams:
            stream.log(entity, what, static=static)

    def send_columns(
        self, entity: str, indexes: Iterable[rr.TimeColumn], columns: Iterable[rr.ComponentColumn]
    ) -> None:
        """Log rows of an entity to file and viewer; see `rerun.RecordingStream.send_columns`."""
        indexes, columns = list(indexes), list(columns)
        for stream in self._streams:
            stream.send_columns(entity, indexes, columns)

    def send_blueprint(self, layout: rr.blueprint.Blueprint) -> None:
        """Set the layout of rerun's viewer for this log."""
        for stream in self._streams:
            stream.send_blueprint(layout)

    def flush(self) -> None:
        """Write all messages that were logged so far to the file.

        Raises:
            OSError: If the disk is full; then the file is as it was before.
        """
        if self._file and self._written and (new := self._written.read()):
            self._file.append(b"".join(_split_messages(new, not self._has_header)))
            self._has_header = True

    def close(self) -> None:
        """Write the remaining messages and the index of the file, and disconnect from the viewer.

        Raises:
            OSError: If the disk is full.
        """
        try:
            self.flush()
        finally:
            if self._file:
                self._file.close()
            if self._viewer:
                _close_stream(self._viewer)
        if self._path:
            add_index(self._path)


def _split_messages(whole: bytes, first: bool) -> Iterator[bytes]:
    """Messages of a whole `.rrd` for appending to a file, with the header only if `first`.

    A message begins with its kind and length. The last one and what follows are an index of this
    part; `add_index` writes that of the whole file.
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


def _close_stream(stream: rr.RecordingStream) -> None:
    try:
        stream.flush(timeout_sec=PATIENCE)
    # the viewer may have been closed during the run
    except (RuntimeError, TimeoutError, ValueError) as error:
        warnings.warn(f"the viewer did not take all of the log ({error})", stacklevel=4)
    stream.disconnect()
