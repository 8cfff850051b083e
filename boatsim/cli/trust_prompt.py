"""Permission to run Python files of a user: from command-line options, or asked on a terminal."""

import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

from boatsim.cli.progress import pause_progress
from boatsim.errors import escape_for_terminal


@contextmanager
def trusted_content(
    content: Sequence[Path] | None = None,
    trust: bool = False,
    arguments: Sequence[str | Path | None] = (),
) -> Iterator[None]:
    """Make the user's content folders available, and trust their Python files, within the block.

    For Python files in any other folder the user is asked once on a terminal; without a terminal
    they are refused.

    Args:
        content: Folders of the option --content.
        trust: Whether the folders of the files in `arguments` are trusted too (option --trust).
        arguments: Files, folders or names given on the command line.

    Raises:
        BadInput: A folder does not exist.
    """
    from boatsim.physics.trust import trust_folders

    allowed: list[Path] = []
    if trust:
        for argument in filter(None, map(str, filter(None, arguments))):
            allowed += _folders_of_argument(argument)
    ask = _ask_to_trust if _is_interactive() else None
    with trust_folders(*(content or ()), allowed=allowed, ask=ask):
        yield


def _folders_of_argument(argument: str) -> list[Path]:
    """The folder of a file or the folder itself; nothing for the name of an item."""
    file = argument
    if ".toml:" in argument:
        file = argument.rpartition(":")[0]
    path = Path(file)
    if path.is_dir():
        return [path]
    if path.is_file():
        return [path.resolve().parent]
    return []


def _is_interactive() -> bool:
    """Whether a question can be asked on a terminal."""
    return bool(sys.stdin and sys.stderr and sys.stdin.isatty() and sys.stderr.isatty())


def _ask_to_trust(folder: Path) -> bool:
    place = escape_for_terminal(str(folder))
    question = f"boatsim: a file names Python files in {place}. Run them? [y/N] "
    with pause_progress():
        print(question, end="", file=sys.stderr, flush=True)
        return sys.stdin.readline().strip().lower() in ("y", "yes")
