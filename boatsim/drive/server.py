"""The page and its socket, on this machine alone: a token in the address, one driver at a time, in a thread."""

import asyncio
import hmac
import json
import os
import secrets
import threading
from base64 import b64encode
from collections.abc import Mapping
from concurrent.futures import Future
from contextlib import suppress
from hashlib import sha256
from importlib.resources import files
from math import isfinite
from re import DOTALL, search
from typing import Any

from boatsim.drive.driver_input import Hands, Sticks
from boatsim.errors import BoatsimError

HERE = "127.0.0.1"
LARGEST = 1024  # bytes of a message from the page
FAREWELL = 2.0  # [s] for the page to hear how it ended
TAKEN, STRANGE = (
    4001,
    4002,
)  # codes of a socket that is closed: somebody drives already; not a message of our page
NEEDED = 'driving needs the package websockets: pip install "boatsim[drive]"'


class Server:
    """Serves the page for the block; what it hears goes to `hands`."""

    def __init__(self, hands: Hands, port: int = 0) -> None:
        """At a port of this machine, 0: any that is free; its block raises BoatsimError for one that can not be had.

        Raises BoatsimError where the package is missing that it is made of.
        """
        try:
            import websockets.asyncio.server as sockets
        except ImportError:
            raise BoatsimError(NEEDED) from None
        self.hands, self.ended = hands, False
        self._sockets, self._wanted = sockets, port
        self._token = secrets.token_urlsafe(24)
        self._page = files("boatsim.drive").joinpath("page.html").read_text("utf-8")
        self._hello = self._frame = self._last = ""
        self._driver: Any = None
        self._up: Future[int] = Future()
        self._loop = asyncio.new_event_loop()
        self._thread = threading.Thread(target=self._work, name="page", daemon=True)

    def __enter__(self) -> "Server":
        self._thread.start()
        try:
            self.port = self._up.result()
        except OSError as error:
            raise BoatsimError(
                f"port {self._wanted}: {os.strerror(error.errno or 0)}; without --port one is found"
            ) from None
        return self

    def __exit__(self, kind: object, error: BaseException | None, trace: object) -> None:
        if error is not None:
            self.farewell(
                {
                    "wrong": str(error)
                    if isinstance(error, BoatsimError)
                    else "the terminal says why"
                }
            )
        self._loop.call_soon_threadsafe(self._over.set)
        self._thread.join(FAREWELL + 1.0)

    @property
    def address(self) -> str:
        """Where a browser looks."""
        return f"http://{HERE}:{self.port}/{self._token}/"

    def greet(self, hello: Mapping[str, object]) -> None:
        """What does not change: the boat, its water, its dials."""
        self._hello = json.dumps({"hello": hello})
        self._wake()

    def show(self, frame: Mapping[str, object]) -> None:
        """The latest state; a page that is slow misses some."""
        self._frame = json.dumps({"frame": frame})
        self._wake()

    def farewell(self, last: Mapping[str, object]) -> None:
        """How it ended."""
        self._last = json.dumps({"over": last})
        self._wake()

    # In the server's thread
    # -----------------------------------------------------------------------------------------

    def _wake(self) -> None:
        with suppress(RuntimeError):  # a loop that is closed
            self._loop.call_soon_threadsafe(lambda: self._news.set())

    def _work(self) -> None:
        asyncio.set_event_loop(self._loop)
        try:
            self._loop.run_until_complete(self._serve())
        except BaseException as error:
            if not self._up.done():
                self._up.set_exception(error)
        finally:
            self._loop.close()

    async def _serve(self) -> None:
        self._over, self._news = asyncio.Event(), asyncio.Event()
        async with self._sockets.serve(
            self._drive,
            HERE,
            self._wanted,
            process_request=self._asked,
            max_size=LARGEST,
            compression=None,
            server_header=None,
            ping_interval=1.0,
            ping_timeout=2.0,
            close_timeout=1.0,
        ) as server:
            self._up.set_result(next(iter(server.sockets)).getsockname()[1])
            await self._over.wait()
            if self._driver is not None and self._last:
                with suppress(TimeoutError):
                    await asyncio.wait_for(self._driver.wait_closed(), FAREWELL)

    def _asked(self, connection: Any, request: Any) -> Any:
        """Answer of a request: the page, nothing here, or None where the socket is let in."""
        own = f"{HERE}:{self._up.result()}"
        place, _, rest = request.path.removeprefix("/").partition("/")
        if request.headers.get_all("Host") != [
            own
        ]:  # another name for this machine: a page of somebody's, rebound
            return connection.respond(421, f"this is http://{own}\n")
        if not hmac.compare_digest(place.encode(), self._token.encode()):
            return connection.respond(
                403, "the address lacks its token; it is printed where boatsim drive runs\n"
            )
        if rest == "socket":
            mine = request.headers.get_all("Origin") == [f"http://{own}"]
            return None if mine else connection.respond(403, "not from the page of this server\n")
        if rest or request.headers.get("Upgrade"):
            return connection.respond(404, "only the page is here\n")
        return self._served(connection.respond(200, self._page), own)

    def _served(self, answer: Any, own: str) -> Any:
        """The page with what it is allowed: its own script and style, its own socket, nothing else."""
        policy = f"default-src 'none'; script-src {_hash(self._page, 'script')}; style-src {_hash(self._page, 'style')}"
        policy += f"; connect-src ws://{own}; img-src data:; base-uri 'none'; form-action 'none'"
        del answer.headers["Content-Type"]
        for name, value in {
            "Content-Type": "text/html; charset=utf-8",
            "Content-Security-Policy": f"{policy}; frame-ancestors 'none'",
            "Cache-Control": "no-store",
            "Referrer-Policy": "no-referrer",
            "X-Content-Type-Options": "nosniff",
            "Cross-Origin-Resource-Policy": "same-origin",
        }.items():
            answer.headers[name] = value
        return answer

    async def _drive(self, socket: Any) -> None:
        """One page from its opening to its end."""
        if self._driver is not None:
            await socket.close(TAKEN, "somebody drives already, in another page")
            return
        self._driver = socket
        speaking = asyncio.ensure_future(self._speak(socket))
        try:
            async for message in socket:
                if not self._hear(message):
                    await socket.close(STRANGE, "not a message of this page")
        except Exception as error:  # a connection that is lost has many names
            if type(error).__module__.partition(".")[0] != "websockets":
                raise
        finally:
            self.hands.let_go("page closed")
            self._driver = None
            speaking.cancel()

    def _hear(self, message: str | bytes) -> bool:
        """Take a message; whether it is one of the page's."""
        try:
            said = json.loads(message)
            if said == {"end": True}:
                self.ended = True
            elif said == {"hidden": True}:
                self.hands.let_go("page hidden")
            else:
                surge, sway, yaw = map(float, said["sticks"])
                sticks, moved = Sticks(surge, sway, yaw), float(said["moved"])
                if not all(isfinite(x) and abs(x) <= 1.0 for x in sticks) or not isfinite(moved):
                    return False
                self.hands.move(sticks, moved)
        except (ValueError, TypeError, KeyError, RecursionError):
            return False
        return True

    async def _speak(self, socket: Any) -> None:
        """Greet it, then send the latest frame whenever there is one."""
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


def _hash(page: str, part: str) -> str:
    """What the policy calls the page's own script or style."""
    found = search(rf"<{part}>(.*?)</{part}>", page, DOTALL)
    assert found, part
    return f"'sha256-{b64encode(sha256(found[1].encode()).digest()).decode()}'"
