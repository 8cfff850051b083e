"""The driver's page: markup, style and a shared script, with a second one that moves the boat."""

from dataclasses import dataclass
from pathlib import Path
from re import DOTALL, search

from boatsim.view.html_page import content_source

HERE = Path(__file__).parent
SCRIPT = HERE / "page.js"  # what the page of a server and the offline page have in common
SOCKET = HERE / "socket.js"
OFFLINE = HERE / "offline.js"
POLICY, DATA = "<!-- policy -->\n", "<!-- data -->\n"  # places in page.html


@dataclass(frozen=True)
class DrivePage:
    """The driver's page.

    Attributes:
        template: Text of page.html.
        script: Its script.
    """

    template: str
    script: str

    def policy(self, scripts: str = "") -> str:
        """Return a content security policy that allows the page's own script and style only.

        Args:
            scripts: Further sources of scripts, each after a blank.
        """
        found = search(r"<style>(.*?)</style>", self.template, DOTALL)
        assert found
        return (
            f"default-src 'none'; script-src {content_source(self.script)}{scripts}; "
            f"style-src {content_source(found[1])}; img-src data:; base-uri 'none'; "
            "form-action 'none'"
        )

    def text(self, policy: str = "", data: str = "") -> str:
        """Return the page as HTML.

        Args:
            policy: Content security policy in the page; "" where the server sends it.
            data: Elements with the data of the script.
        """
        if policy:
            policy = f'<meta http-equiv="Content-Security-Policy" content="{policy}">\n'
        page = self.template.replace(POLICY, policy).replace(DATA, data)
        return page.replace("<script></script>", f"<script>{self.script}</script>")


def drive_page(*scripts: Path) -> DrivePage:
    """Return the driver's page with scripts.

    Args:
        scripts: Files of the scripts, which become one.
    """
    text = "".join(script.read_text(encoding="utf-8") for script in scripts)
    return DrivePage((HERE / "page.html").read_text(encoding="utf-8"), text)
