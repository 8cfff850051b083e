"""Run the commands of a documentation page and compare their output with what the page shows.

`python docs/_ext/page_commands.py` runs all tutorials; `python docs/_ext/page_commands.py
first_steps` runs one page. The exit code is 1 if an output differs from its page. A block that
takes longer than `SLOW` is reported with its time and is no error.

A shown line agrees with a printed one if the words are equal and the figures agree to one unit of
the last digit shown. A page may omit lines of the output; "..." is good style but not required.
"""

import os
import re
import subprocess
import sys
import tempfile
import time
import warnings
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).parents[2]
# Marks a page whose commands are run one after the other in an empty home folder.
MARK = "<!-- run when built -->"
NUMBER = re.compile(r"(?<![\w.])[-+]?\d+(?:\.\d+)?")
# A block of commands; before it the exit code if it is not 0, after it the output.
BLOCK = re.compile(
    r"(?:<!-- exit (?P<code>\d+) -->\n\n?)?```sh\n(?P<commands>(?:(?!```).)*)\n```"
    r"(?:\n\n```(?:text)?\n(?P<shown>(?:(?!```).)*)\n```)?",
    re.DOTALL,
)
TIMEOUT = 600  # [s] for one block
SLOW = 60.0  # [s] a reader who follows a tutorial waits longer than this only with good reason


@dataclass(frozen=True)
class Block:
    """A block of commands on a page.

    Attributes:
        line: Line of the page where the commands begin, from 1.
        commands: Text of the commands.
        code: Expected exit code.
        shown: Lines of the output that the page shows.
    """

    line: int
    commands: str
    code: int
    shown: tuple[str, ...]


def blocks(page: str) -> Iterator[Block]:
    """Yield every block of commands of a page."""
    for match in BLOCK.finditer(page):
        line = page.count("\n", 0, match.start("commands")) + 1
        shown = tuple((match["shown"] or "").splitlines())
        yield Block(line, match["commands"], int(match["code"] or 0), shown)


def figures(text: str) -> list[str]:
    """Return the numbers in a text as they are printed."""
    return NUMBER.findall(text)


def words_of(line: str) -> str:
    """Return a line with its numbers replaced and its white space collapsed."""
    return " ".join(NUMBER.sub("#", line).split())


def figures_agree(shown: str, printed: str) -> bool:
    """Check that two printed numbers agree to one unit of the last digit shown.

    If the shown number has more digits than the printed one, half a unit of the printed one is
    allowed in addition.
    """
    unit_shown = 10.0 ** -len(shown.partition(".")[2])
    unit_printed = 10.0 ** -len(printed.partition(".")[2])
    allowed = 1.01 * unit_shown
    if unit_printed > unit_shown:
        allowed += 0.5 * unit_printed
    return abs(float(shown) - float(printed)) <= allowed


def first_difference(shown: Sequence[str], printed: Sequence[str]) -> str:
    """Compare shown lines with printed ones, which must occur in the same order.

    Args:
        shown: Lines of the page.
        printed: Lines of the output.

    Returns:
        A description of the first shown line that was not printed, or an empty string.
    """
    position = 0
    for line in shown:
        if not re.search(r"\w", line):
            continue
        index = _index_of(line, printed, position)
        if index is None:
            return "\n".join((f"not printed: {line}", "printed:", *printed[position:]))
        differences = []
        for expected, actual in zip(figures(line), figures(printed[index]), strict=True):
            if not figures_agree(expected, actual):
                differences.append(f"{expected} is {actual}")
        if differences:
            return f"{line.strip()}: {'; '.join(differences)}"
        position = index + 1
    return ""


def _index_of(line: str, printed: Sequence[str], start: int) -> int | None:
    """Return the index of the first printed line with the same words, from `start` on."""
    for index in range(start, len(printed)):
        if words_of(printed[index]) == words_of(line):
            return index
    return None


def failures(page: str, home: Path, programs: Path | None = None) -> Iterator[tuple[int, str]]:
    """Run all commands of a page and yield what differs from the page.

    Args:
        page: Text of the page.
        home: Empty folder used as the home folder; `~/boatsim` in it is a link to the repository.
        programs: Folder whose programs are used in place of others of the same name.

    Yields:
        Line number and description of each difference; the run stops after a wrong exit code.

    Warns:
        UserWarning: If a block takes longer than `SLOW`.
    """
    (home / "boatsim").symlink_to(ROOT)
    working_folder = str(home)
    folder_file = home / ".working_folder"
    environment = environment_of_new_user(home)
    if programs is not None:
        environment["PATH"] = f"{programs}{os.pathsep}{environment['PATH']}"
    for block in blocks(page):
        script = f'cd "{working_folder}"\n{block.commands}\npwd > {folder_file}\n'
        begin = time.monotonic()
        result = subprocess.run(
            ["bash", "-euo", "pipefail", "-c", script],
            env=environment,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            timeout=TIMEOUT,
        )
        _warn_if_slow(block, time.monotonic() - begin)
        if result.returncode != block.code:
            message = f"exit code {result.returncode} instead of {block.code}:\n{result.stdout}"
            yield block.line, message
            return
        if message := first_difference(block.shown, result.stdout.splitlines()):
            yield block.line, message
        working_folder = folder_file.read_text().strip()


def _warn_if_slow(block: Block, seconds: float) -> None:
    """Issue a warning if a block of commands took longer than `SLOW`."""
    if seconds > SLOW:
        command = block.commands.splitlines()[0]
        warnings.warn(
            f"line {block.line} took {seconds:.0f} s, more than {SLOW:.0f} s: {command}",
            stacklevel=3,
        )


def environment_of_new_user(home: Path) -> dict[str, str]:
    """Return the environment of a new user who shares the builder's cache of compiled programs."""
    caches = Path(os.environ.get("XDG_CACHE_HOME", Path.home() / ".cache"))
    compiled = os.environ.get("BOATSIM_CACHE", str(caches / "boatsim"))
    changes = {
        "HOME": str(home),
        "PATH": f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}",
        "BOATSIM_CACHE": compiled,
        "COLUMNS": "120",
        "TERM": "dumb",
    }
    environment = os.environ | changes
    environment.pop("BOATSIM_DEBUG", None)  # set by docs/conf.py; a user's programs are compiled
    return environment


def run_tutorials(names: Sequence[str]) -> int:
    """Run the commands of tutorials and print the differences and the slow blocks.

    Args:
        names: Names of pages in `docs/` without suffix; empty for all pages with `MARK`.

    Returns:
        Number of differences.
    """
    files = [ROOT / "docs" / f"{name}.md" for name in names]
    different = 0
    for file in files or sorted((ROOT / "docs").glob("*.md")):
        page = file.read_text(encoding="utf-8")
        if MARK not in page:
            continue
        begin = time.monotonic()
        with tempfile.TemporaryDirectory() as home, warnings.catch_warnings(record=True) as slow:
            warnings.simplefilter("always", UserWarning)
            for line, message in failures(page, Path(home)):
                different += 1
                print(f"{file.name}:{line}: {message}", flush=True)
        for warning in slow:
            print(f"{file.name}: warning: {warning.message}", flush=True)
        print(f"{file.name}: {time.monotonic() - begin:.0f} s", flush=True)
    return different


if __name__ == "__main__":
    sys.exit(bool(run_tutorials(sys.argv[1:])))
