"""Limits on connections that do not drive, so that they cannot exhaust the file descriptors."""

import asyncio
import errno
import logging
import resource
from contextlib import suppress
from typing import Any

MOST_WAITING = 16  # connections without the socket of the driver; a browser opens at most 6
# At most this share of the file descriptors of the process: the files of the run need the others.
SHARE_OF_DESCRIPTORS = 1 / 8
NO_DESCRIPTORS = (errno.EMFILE, errno.ENFILE, errno.ENOBUFS, errno.ENOMEM)
HANDSHAKE_TIME = 2.0  # [s] for a request; a browser on the same machine needs milliseconds
# Messages of websockets about clients that do not speak its protocol; a driver cannot use them.
ABOUT_CLIENTS = ("opening handshake failed", "keepalive ping failed", "connection rejected")


class WaitingConnections:
    """Open connections except that of the driver, of which the oldest are closed if too many.

    A browser sends its request at once, so that the driver's page is served during a flood of
    connections that send nothing.

    Attributes:
        most: Largest number of connections.
        closed: Whether the server is being closed; asyncio may still try to accept connections
            then, which raises a ValueError that concerns nobody.
    """

    def __init__(self) -> None:
        """Set the limit by the number of file descriptors that the process may open."""
        descriptors, _ = resource.getrlimit(resource.RLIMIT_NOFILE)
        if descriptors == resource.RLIM_INFINITY:
            descriptors = 1 << 20
        self.most = max(2, min(MOST_WAITING, int(SHARE_OF_DESCRIPTORS * descriptors)))
        self.closed = False
        # Insertion order is age. The connections are of the package websockets.
        self._waiting: dict[Any, None] = {}

    def add(self, connection: Any) -> None:
        """Add a connection; close the oldest one if there are more than `most`.

        Args:
            connection: Connection of websockets that has a transport.
        """
        self._waiting[connection] = None
        while len(self._waiting) > self.most:
            self._close_oldest()

    def remove(self, connection: Any) -> None:
        """Remove a connection that was closed or that has become the driver's."""
        self._waiting.pop(connection, None)

    def close_all(self) -> None:
        """Close all waiting connections."""
        while self._waiting:
            self._close_oldest()

    def connection_class(self, base: type[Any]) -> type[Any]:
        """Return a class of connections that are counted here from their beginning to their end.

        Args:
            base: ServerConnection of websockets.
        """
        waiting = self

        class Counted(base):  # type: ignore[misc]
            """Connection that is counted while it is open."""

            def connection_made(self, transport: asyncio.BaseTransport) -> None:
                super().connection_made(transport)
                waiting.add(self)

            def connection_lost(self, exc: Exception | None) -> None:
                waiting.remove(self)
                super().connection_lost(exc)

        return Counted

    def handle_loop_error(self, loop: asyncio.AbstractEventLoop, context: dict[str, Any]) -> None:
        """Close all waiting connections if no file descriptor is left; print any other error.

        Args:
            loop: Event loop of the server.
            context: Description of the error by asyncio.
        """
        error = context.get("exception")
        if isinstance(error, OSError) and error.errno in NO_DESCRIPTORS:
            self.close_all()  # asyncio accepts connections again after 1 s
        elif not (isinstance(error, ValueError) and self.closed):
            loop.default_exception_handler(context)

    def _close_oldest(self) -> None:
        oldest = next(iter(self._waiting))
        del self._waiting[oldest]
        with suppress(OSError):
            oldest.transport.abort()


def server_logger() -> logging.Logger:
    """Return the log of the web server, without messages about the mistakes of clients."""
    logger = logging.getLogger("boatsim.drive")
    logger.addFilter(_is_own_defect)
    return logger


def _is_own_defect(record: logging.LogRecord) -> bool:
    return not record.getMessage().startswith(ABOUT_CLIENTS)
