"""Web server of the page: local only, with a token in the address, for one driver at a time."""

import asyncio
import hmac
import json
import os
import secrets
import threading
import time
from collections.abc import Mapping
from concurrent.futures import Future
from contextlib import suppress
from typing import Any

from boatsim.drive.connections import HANDSHAKE_TIME, WaitingConnections, server_logger
from boatsim.drive.driver_input import DriverInput
from boatsim.drive.messages import Movement, parse_message
from boatsim.drive.page import SCRIPT, SOCKET, drive_page
from boatsim.errors import BoatsimError

HERE = "127.0.0.1"
LARGEST = 1024  # bytes of a message from the page; its messages have less than 200
# [s] without any page, after one was open, from which the driver counts as gone: reloading a page
# and reconnecting after a lost connection take a few seconds.
ABANDONED = 10.0
FAREWELL = 2.0  # [s] for the page to receive the result of the run
# Close codes of the socket: another page drives already; a message is not one of this page.
TAKEN, STRANGE = 4001, 4002
NEEDED = 'driving needs the package websockets: pip install "boatsim[drive]"'


class Server:
    """Web server of the page on which a driver steers a run, within a `with` block.

    Attributes:
        hands: Receives the stick positions.
        ended: Whether the driver has ended the run.
        port: Port of the page, within the block.
    """

    def __init__(self, hands: DriverInput, port: int = 0) -> None:
        """Create a server; its block raises BoatsimError if the port cannot be used.

        Args:
            hands: Receives the stick positions.
            port: Port on this machine; 0 for any free port.

        Raises:
            BoatsimError: The package websockets is not installed.
        """
        try:
            import websockets.asyncio.server as sockets
        except ImportError:
            raise BoatsimError(NEEDED) from None
        self.hands, self.ended = hands, False
        self._sockets, self._wanted = sockets, port
        self._token = secrets.token_urlsafe(24)
        self._page = drive_page(SCRIPT, SOCKET)
        self._hello = self._frame = self._last = ""
        self._driver: Any = None
        self._left_at: float | None = None  # when the last page was closed, if none is open
        self._waiting = WaitingConnections()
        self._up: Future[int] = Future()
        self._loop = asyncio.new_event_loop()
        self._thread = threading.Thread(target=self._run_event_loop, name="page", daemon=True)

    def __enter__(self) -> "Server":
        self._thread.start()
        try:
            self.port = self._up.result()
        except OSError as error:
            raise BoatsimError(
                f"port {self._wanted}: {os.strerror(error.errno or 0)}; omit --port for a free one"
            ) from None
        return self

    def __exit__(self, kind: object, error: BaseException | None, trace: object) -> None:
        if error is not None:
            message = "the terminal shows the error"
            if isinstance(error, BoatsimError):
                message = str(error)
            self.send_result({"wrong": message})
        self._loop.call_soon_threadsafe(self._over.set)
        self._thread.join(FAREWELL + 1.0)

    @property
    def is_abandoned(self) -> bool:
        """Whether the driver's page was closed some seconds ago and no page has come back."""
        left = self._left_at
        return left is not None and time.monotonic() - left > ABANDONED

    @property
    def address(self) -> str:
        """Address of the page on which the driver steers."""
        return f"http://{HERE}:{self.port}/{self._token}/"

    def send_initial_data(self, hello: Mapping[str, object]) -> None:
        """Send the data that do not change during the run to the driver's page.

        Args:
            hello: Vessel, basin and dials.
        """
        self._hello = json.dumps({"hello": hello})
        self._notify_sender()

    def send_frame(self, frame: Mapping[str, object]) -> None:
        """Send the latest state of the vessel to the driver's page.

        A slow page receives only some of the states.

        Args:
            frame: The state.
        """
        self._frame = json.dumps({"frame": frame})
        self._notify_sender()

    def send_result(self, last: Mapping[str, object]) -> None:
        """Send the result of the run to the driver's page.

        Args:
            last: Output folder, or the error.
        """
        self._last = json.dumps({"over": last})
        self._notify_sender()

    # Methods below run in the thread of the server.

    def _notify_sender(self) -> None:
        with suppress(RuntimeError):  # The loop is closed.
            self._loop.call_soon_threadsafe(lambda: self._news.set())

    def _run_event_loop(self) -> None:
        asyncio.set_event_loop(self._loop)
        self._loop.set_exception_handler(self._waiting.handle_loop_error)
        try:
            self._loop.run_until_complete(self._serve_until_closed())
        except BaseException as error:
            if not self._up.done():
                self._up.set_exception(error)
        finally:
            self._loop.close()

    async def _serve_until_closed(self) -> None:
        self._over, self._news = asyncio.Event(), asyncio.Event()
        async with self._sockets.serve(
            self._serve_page,
            HERE,
            self._wanted,
            process_request=self._respond,
            create_connection=self._waiting.connection_class(self._sockets.ServerConnection),
            logger=server_logger(),
            open_timeout=HANDSHAKE_TIME,
            backlog=self._waiting.most,
            max_size=LARGEST,
            compression=None,
            server_header=None,
            ping_interval=1.0,
            ping_timeout=2.0,
            close_timeout=1.0,
        ) as server:
            self._up.set_result(next(iter(server.sockets)).getsockname()[1])
            await self._over.wait()
            self._waiting.closed = True
            if self._driver is not None and self._last:
                with suppress(TimeoutError):
                    await asyncio.wait_for(self._driver.wait_closed(), FAREWELL)

    def _respond(self, connection: Any, request: Any) -> Any:
        """Response to a request: the page, an error, or None to open the socket."""
        own = f"{HERE}:{self._up.result()}"
        place, _, rest = request.path.removeprefix("/").partition("/")
        # Another host name may belong to a foreign page that was rebound to this address.
        if request.headers.get_all("Host") != [own]:
            return connection.respond(421, f"this is http://{own}\n")
        if not hmac.compare_digest(place.encode(), self._token.encode()):
            return connection.respond(
                403, "the address lacks its token; boatsim drive prints the full address\n"
            )
        if rest == "socket":
            if request.headers.get_all("Origin") == [f"http://{own}"]:
                return None
            return connection.respond(403, "this request is not from the page of this server\n")
        if rest or request.headers.get("Upgrade"):
            return connection.respond(404, "there is only the page\n")
        return self._page_response(connection.respond(200, self._page.text()), own)

    def _page_response(self, answer: Any, own: str) -> Any:
        """The page with a policy that allows its own script, style and socket only."""
        policy = f"{self._page.policy()}; connect-src ws://{own}; frame-ancestors 'none'"
        del answer.headers["Content-Type"]
        for name, value in {
            "Content-Type": "text/html; charset=utf-8",
            "Content-Security-Policy": policy,
            "Cache-Control": "no-store",
            "Referrer-Policy": "no-referrer",
            "X-Content-Type-Options": "nosniff",
            "Cross-Origin-Resource-Policy": "same-origin",
        }.items():
            answer.headers[name] = value
        return answer

    async def _serve_page(self, socket: Any) -> None:
        """Serve one page from its opening to its closing."""
        if self._driver is not None:
            await socket.close(TAKEN, "another page drives this boat already")
            return
        self._driver, self._left_at = socket, None
        self._waiting.remove(socket)
        sending = asyncio.ensure_future(self._send_updates(socket))
        try:
            async for message in socket:
                if not self._process_message(message):
                    await socket.close(STRANGE, "not a message of this page")
        except Exception as error:  # A lost connection raises one of several errors.
            if type(error).__module__.partition(".")[0] != "websockets":
                raise
        finally:
            self.hands.release("page closed")
            self._driver, self._left_at = None, time.monotonic()
            sending.cancel()

    def _process_message(self, message: str | bytes) -> bool:
        """Process a message; return whether it has the form of the page's messages."""
        parsed = parse_message(message)
        if isinstance(parsed, Movement):
            self.hands.store_sticks(parsed.sticks, parsed.moved)
        elif parsed == "end":
            self.ended = True
        elif parsed == "hidden":
            self.hands.release("page hidden")
        return parsed is not None

    async def _send_updates(self, socket: Any) -> None:
        """Send the greeting, then the latest frame whenever it has changed."""
        greeted = sent = ""
        while not self._last:
            if greeted != self._hello:
                greeted = self._hello
                await socket.send(greeted)
            if sent != self._frame:
                sent = self._frame
                await socket.send(sent)
            self._news.clear()
            await self._news.wait()
        await socket.send(self._last)
        await socket.close()
