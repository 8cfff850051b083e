"""Which Python files may run: those of boatsim and of folders that the user trusts.

Data files alone never cause Python code to run. Trust holds in a `trust_folders` block, and in the
processes that the block starts if they are given `trusted_folder_list()`.
"""

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass, field, replace
from pathlib import Path

from boatsim.errors import BadInput


@dataclass(frozen=True)
class TrustedFolders:
    """Folders whose Python files may run, because the user trusts them.

    Attributes:
        content: Folders of the user's own content; names of effects, vessels and so on are searched
            in them.
        allowed: Further folders whose Python files may run.
        ask: Asks the user whether the Python files of a folder may run; None: there is no user to
            ask.
        answers: The user's answers; each folder is asked for once.
    """

    content: tuple[Path, ...] = ()
    allowed: tuple[Path, ...] = ()
    ask: Callable[[Path], bool] | None = None
    answers: dict[Path, bool] = field(default_factory=dict)

    def contains(self, path: Path) -> bool:
        """Return whether a file lies in a trusted folder or in a folder below one.

        Args:
            path: The file, without symbolic links.
        """
        return any(path.is_relative_to(folder) for folder in (*self.content, *self.allowed))


_now: ContextVar[TrustedFolders] = ContextVar("trust")


def trusted_folder_list() -> TrustedFolders:
    """Return the folders trusted in this process, for another process that cannot ask the user."""
    return replace(_now.get(TrustedFolders()), ask=None, answers={})


def user_content_folders() -> tuple[Path, ...]:
    """Return the folders in which the user keeps own vessels, effects and other content."""
    return _now.get(TrustedFolders()).content


@contextmanager
def trust_folders(
    *content: Path | str,
    allowed: Sequence[Path | str] = (),
    ask: Callable[[Path], bool] | None = None,
) -> Iterator[None]:
    """Within a `with` block, trust further folders, with all folders below them.

    Python files in them may run. Folders that are trusted already remain so.

    Args:
        content: Folders of the user's own content. Names are searched in them as in the library: in
            DIR/effects, DIR/models and so on, and in DIR itself.
        allowed: Further folders whose Python files may run.
        ask: Asks the user whether the Python files of a folder may run.

    Raises:
        BadInput: A folder does not exist.
    """
    before = _now.get(TrustedFolders())
    inner = TrustedFolders(
        (*before.content, *map(_folder, content)),
        (*before.allowed, *map(_folder, allowed)),
        ask or before.ask,
        before.answers,
    )
    token = _now.set(inner)
    try:
        yield
    finally:
        _now.reset(token)


def adopt_trust(trust: TrustedFolders) -> None:
    """Trust the folders that another process trusts, until this process ends.

    Args:
        trust: `trusted_folder_list()` of the other process.
    """
    _now.set(trust)


def check_trusted(path: Path) -> None:
    """Check that a Python file may run; ask the user if its folder is not trusted yet.

    Args:
        path: The file.

    Raises:
        BadInput: The file is not trusted.
    """
    real, trust = path.resolve(), _now.get(TrustedFolders())
    if trust.contains(real):
        return
    if trust.ask and real.parent not in trust.answers:
        trust.answers[real.parent] = trust.ask(real.parent)
    if not trust.answers.get(real.parent):
        raise BadInput(
            f"{path} is not run: only a data file refers to this Python file; "
            "--trust (the folders of the given files) or --content FOLDER allows it"
        )


def _folder(given: Path | str) -> Path:
    try:
        folder = Path(given).expanduser().resolve()
        exists = folder.is_dir()
    except (OSError, RuntimeError, ValueError) as error:  # circular links, no home, a null byte
        raise BadInput(f"{given}: no folder of content ({error})") from None
    if not exists:
        raise BadInput(f"{given}: this folder of content does not exist")
    return folder
