"""What may run: the library, and Python files in folders that the user named or trusts. Data run nothing by themselves.

What is trusted holds for a block of `trusting`, and in the processes that the block starts if they are handed `now()`.
"""

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass, field, replace
from pathlib import Path

from boatsim.errors import BadInput


@dataclass(frozen=True)
class Trust:
    """The folders of a user's own content, in which names resolve too, and those that he but allows to run."""

    content: tuple[Path, ...] = ()
    allowed: tuple[Path, ...] = ()
    # whether the Python files of a folder may run; None: nobody is there
    ask: Callable[[Path], bool] | None = None
    answers: dict[Path, bool] = field(default_factory=dict)  # each folder is asked for once

    def holds(self, path: Path) -> bool:
        """Whether a file lies in a trusted folder or below one, by its real place."""
        return any(path.is_relative_to(folder) for folder in (*self.content, *self.allowed))


_now: ContextVar[Trust] = ContextVar("trust")


def now() -> Trust:
    """What is trusted here, to be handed to another process, which has nobody to ask."""
    return replace(_now.get(Trust()), ask=None, answers={})


def content() -> tuple[Path, ...]:
    """Folders of the user's own content."""
    return _now.get(Trust()).content


@contextmanager
def trusting(
    *content: Path | str,
    allowed: Sequence[Path | str] = (),
    ask: Callable[[Path], bool] | None = None,
) -> Iterator[None]:
    """Trust these folders, all below them too, on top of what is trusted already.

    Names resolve in those of `content` as in the library: in DIR/effects, DIR/models and so on, and in DIR itself.
    Raises BadInput for a folder that does not exist.
    """
    before = _now.get(Trust())
    mine, others = (tuple(_folder(f) for f in given) for given in (content, allowed))
    inner = Trust(
        (*before.content, *mine), (*before.allowed, *others), ask or before.ask, before.answers
    )
    token = _now.set(inner)
    try:
        yield
    finally:
        _now.reset(token)


def adopt(trust: Trust) -> None:
    """Trust what another process does, for as long as this one lives."""
    _now.set(trust)


def check(path: Path) -> None:
    """Raises BadInput for a Python file that nobody vouches for."""
    real, trust = path.resolve(), _now.get(Trust())
    if trust.holds(real):
        return
    if trust.ask and real.parent not in trust.answers:
        trust.answers[real.parent] = trust.ask(real.parent)
    if not trust.answers.get(real.parent):
        raise BadInput(
            f"{path} is not run: only data name this Python file; --trust (those beside the files given) or "
            "--content FOLDER allows it"
        )


def _folder(given: Path | str) -> Path:
    try:
        folder = Path(given).expanduser().resolve()
        there = folder.is_dir()
    except (OSError, RuntimeError, ValueError) as error:  # a ring of links, no home, a nul
        raise BadInput(f"{given}: no folder of content ({error})") from None
    if not there:
        raise BadInput(f"{given}: there is no such folder of content")
    return folder
