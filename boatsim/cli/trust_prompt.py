"""Whose Python files a command may run: what its options say, else whoever sits at the terminal."""

import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

from boatsim.cli.progress import set_aside
from boatsim.errors import printable


@contextmanager
def asking(
    content: Sequence[Path] | None = None,
    trust: bool = False,
    given: Sequence[str | Path | None] = (),
) -> Iterator[None]:
    """Trust the folders of `--content`, and with `--trust` those in which the files lie that the command line names.

    Anything else is asked for once on a terminal, and refused where there is none. Raises BadInput.
    """
    from boatsim.physics.trust import trusting

    beside = [folder for name in given if name and trust for folder in _folder_of(str(name))]
    with trusting(*(content or ()), allowed=beside, ask=_asked if _there() else None):
        yield


def _folder_of(given: str) -> list[Path]:
    """Folder of a file of the command line, or the folder that it names; none for the name of something."""
    path = Path(given.rpartition(":")[0] if ".toml:" in given else given)
    if path.is_dir():
        return [path]
    return [path.resolve().parent] if path.is_file() else []


def _there() -> bool:
    """Whether somebody reads the question and can answer it."""
    return bool(sys.stdin and sys.stderr and sys.stdin.isatty() and sys.stderr.isatty())


def _asked(folder: Path) -> bool:
    question = f"boatsim: data name Python files in {printable(str(folder))}. Run them? [y/N] "
    with set_aside():
        print(question, end="", file=sys.stderr, flush=True)
        return sys.stdin.readline().strip().lower() in ("y", "yes")
