"""Commands of a page with what it shows below them: found, run, and compared with what is printed.

A line is as it was printed if its words are the same and its figures agree to one unit of the last digit shown. What a
page leaves out between its lines need not be marked, though "..." reads better.
"""

import os
import re
import subprocess
import sys
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).parents[2]
# in a page all of whose commands are run, one after the other, in an empty home
MARK = "<!-- run when built -->"
NUMBER = re.compile(r"(?<![\w.])[-+]?\d+(?:\.\d+)?")
# commands, after them what they print; before them the exit code, where it is not 0
BLOCK = re.compile(
    r"(?:<!-- exit (?P<code>\d+) -->\n\n?)?```sh\n(?P<commands>(?:(?!```).)*)\n```"
    r"(?:\n\n```(?:text)?\n(?P<shown>(?:(?!```).)*)\n```)?",
    re.DOTALL,
)


@dataclass(frozen=True)
class Block:
    """Commands of a page."""

    line: int  # of the page, where they begin
    commands: str
    code: int  # the exit code they should leave
    shown: tuple[str, ...]  # what the page shows of their output


def blocks(page: str) -> Iterator[Block]:
    """Every block of commands of a page."""
    for found in BLOCK.finditer(page):
        line = page.count("\n", 0, found.start("commands")) + 1
        shown = tuple((found["shown"] or "").splitlines())
        yield Block(line, found["commands"], int(found["code"] or 0), shown)


def numbers(text: str) -> list[str]:
    """Figures of a text as they are printed."""
    return NUMBER.findall(text)


def pattern(line: str) -> str:
    """A line without its figures and without the white space between its words."""
    return " ".join(NUMBER.sub("#", line).split())


def same(shown: str, printed: str) -> bool:
    """Whether two figures agree to one unit of the last digit shown, and half of one of the other's."""
    units = [10.0 ** -len(text.partition(".")[2]) for text in (shown, printed)]
    return abs(float(shown) - float(printed)) <= 1.01 * units[0] + (
        0.5 * units[1] if units[1] > units[0] else 0.0
    )


def difference(shown: Sequence[str], printed: Sequence[str]) -> str:
    """The first line that is shown and was not printed after those before it; "" where all were."""
    at = 0
    for line in (line for line in shown if re.search(r"\w", line)):
        rest = [i for i in range(at, len(printed)) if pattern(printed[i]) == pattern(line)]
        if not rest:
            return "\n".join((f"not printed: {line}", "printed:", *printed[at:]))
        found = printed[rest[0]]
        wrong = [
            f"{a} is {b}"
            for a, b in zip(numbers(line), numbers(found), strict=True)
            if not same(a, b)
        ]
        if wrong:
            return f"{line.strip()}: {'; '.join(wrong)}"
        at = rest[0] + 1
    return ""


def wrong(page: str, home: Path) -> Iterator[tuple[int, str]]:
    """Run all commands of a page in a home of its own, in which ~/boatsim is the repository: line, what is wrong."""
    (home / "boatsim").symlink_to(ROOT)
    here, place = str(home), home / ".place"
    for block in blocks(page):
        script = f'cd "{here}"\n{block.commands}\npwd > {place}\n'
        done = subprocess.run(
            ["bash", "-euo", "pipefail", "-c", script],
            env=_environment(home),
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            timeout=600,
        )
        if done.returncode != block.code:
            yield block.line, f"exit code {done.returncode} instead of {block.code}:\n{done.stdout}"
            return
        if said := difference(block.shown, done.stdout.splitlines()):
            yield block.line, said
        here = place.read_text().strip()


def _environment(home: Path) -> dict[str, str]:
    """That of a new user, but for compiled programs, which are those of whoever builds the pages."""
    caches = Path(os.environ.get("XDG_CACHE_HOME", Path.home() / ".cache"))
    compiled = os.environ.get("BOATSIM_CACHE", str(caches / "boatsim"))
    path = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
    own = {
        "HOME": str(home),
        "PATH": path,
        "BOATSIM_CACHE": compiled,
        "COLUMNS": "120",
        "TERM": "dumb",
    }
    return os.environ | own
