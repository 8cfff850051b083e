"""A real Chromium without a window, spoken to by its DevTools protocol: opens pages, runs scripts,
takes pictures."""

import json
import re
import shutil
import subprocess
import tempfile
import time
from base64 import b64decode
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

PROGRAM = (
    shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
)
OPTIONS = (
    "--headless --no-sandbox --disable-gpu --no-first-run --disable-quic --disable-background-networking "
    "--disable-component-update --disable-sync --remote-debugging-port=0"
).split()
GAMEPAD = """
window.pad = {axes: [0, 0, 0, 0], buttons: [], connected: true, mapping: "standard", id: "a pad of the test", index: 0};
navigator.getGamepads = () => [window.pad];
window.push = (...axes) => { window.pad.axes = axes; return (performance.timeOrigin + performance.now()) / 1000; };
"""  # left stick right and down, right stick right and down; `push` returns when it was [s since 1970]


class Page:
    """One tab."""

    def __init__(self, socket: Any, session: str, target: str) -> None:
        self._socket, self._session, self._target, self._count = socket, session, target, 0

    def say(self, method: str, **params: object) -> dict[str, Any]:
        """One command of the protocol and its answer; what happens meanwhile is passed over."""
        self._count += 1
        where = {} if method.startswith("Target.") else {"sessionId": self._session}
        self._socket.send(
            json.dumps({"id": self._count, "method": method, "params": params, **where})
        )
        while True:
            answer = json.loads(self._socket.recv(20))
            if answer.get("id") == self._count:
                assert "error" not in answer, answer
                return dict(answer["result"])

    def run(self, script: str) -> Any:
        """Value of an expression in the page."""
        found = self.say(
            "Runtime.evaluate", expression=script, returnByValue=True, awaitPromise=True
        )
        assert "exceptionDetails" not in found, found
        return found["result"].get("value")

    def until(self, script: str, seconds: float = 30.0) -> Any:
        """Wait until an expression is true."""
        end = time.monotonic() + seconds
        while not (found := self.run(script)):
            assert time.monotonic() < end, script
            time.sleep(0.02)
        return found

    def resize(self, wide: int, high: int, mobile: bool = False) -> None:
        """Give it the screen of a computer, or of a phone."""
        self.say(
            "Emulation.setDeviceMetricsOverride",
            width=wide,
            height=high,
            deviceScaleFactor=1,
            mobile=mobile,
        )

    def picture(self, path: Path, wide: int, high: int, dark: bool = False) -> None:
        """What it looks like, as PNG."""
        self.resize(wide, high)
        scheme = [{"name": "prefers-color-scheme", "value": "dark" if dark else "light"}]
        self.say("Emulation.setEmulatedMedia", features=scheme)
        time.sleep(0.3)
        path.write_bytes(b64decode(self.say("Page.captureScreenshot", format="png")["data"]))

    def close(self) -> None:
        """As the cross of its tab does."""
        self.say("Target.closeTarget", targetId=self._target)


@contextmanager
def chromium(*more: str) -> Iterator[Any]:
    """A browser; what it yields opens a page at an address, with a script that runs before those of
    the page."""
    from websockets.sync.client import connect

    assert PROGRAM
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as home:
        command = [PROGRAM, *OPTIONS, *more, f"--user-data-dir={home}"]
        started = subprocess.Popen(
            command, stderr=subprocess.PIPE, stdout=subprocess.DEVNULL, text=True
        )
        assert started.stderr
        try:
            address = next(
                m[1]
                for line in started.stderr
                if (m := re.search(r"listening on (ws://\S+)", line))
            )
            with connect(address, max_size=None, compression=None) as socket:

                def opened(url: str, before: str = GAMEPAD) -> Page:
                    browser = Page(socket, "", "")
                    target = browser.say("Target.createTarget", url="about:blank")["targetId"]
                    session = browser.say("Target.attachToTarget", targetId=target, flatten=True)[
                        "sessionId"
                    ]
                    page = Page(socket, session, target)
                    page.say("Page.enable")
                    page.say("Page.addScriptToEvaluateOnNewDocument", source=before)
                    page.say("Page.navigate", url=url)
                    page.until(
                        f"location.href === {json.dumps(url)} && document.readyState === 'complete'"
                    )
                    return page

                yield opened
        finally:
            started.terminate()
            started.wait(10)
