"""Writes the files of a folder so that either all of them appear there or none."""

import os
import shutil
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from boatsim.errors import BadInput, BoatsimError
from boatsim.interruption import deferred_signals

PART = ".part-"  # in the name of a folder that is being filled


@contextmanager
def atomic_folder(folder: Path, keep: str | None = None) -> Iterator[Path]:
    """Write the files of a folder so that either all of them appear there or none.

    Yields a new folder `folder.part-...`, whose files move into `folder` when the block ends. The
    new folder remains if the process is killed.

    Args:
        folder: Where the files go; files that are already there are replaced.
        keep: File that is worth keeping if the disk is full: where it has content the new folder
            remains and the error names it.

    Yields:
        The new folder.

    Raises:
        BadInput: If `folder` or the path of one of the files is something else.
        BoatsimError: If the disk is full and `keep` was kept.
        OSError: If a file cannot be written.
    """
    if folder.exists() and not folder.is_dir():
        raise BadInput(f"{folder}: is a file; what is written needs a folder")
    if folder.is_symlink() and not folder.exists():
        raise BadInput(f"{folder}: is a link that leads nowhere; what is written needs a folder")
    folder.parent.mkdir(parents=True, exist_ok=True)
    new = Path(tempfile.mkdtemp(prefix=f"{folder.name}{PART}", dir=folder.parent))
    kept = False
    try:
        with deferred_signals():  # signals must not strike in a folder just made or half moved
            yield new
            _move_files(new, folder)
    except OSError as error:
        kept = keep is not None and (new / keep).is_file() and (new / keep).stat().st_size > 0
        if not kept:
            raise
        reason = f"{error.filename}: {error.strerror}"
        raise BoatsimError(f"{reason}; what was whole until then stays in {new}") from error
    finally:
        if not kept:
            shutil.rmtree(new, ignore_errors=True)


def _move_files(new: Path, folder: Path) -> None:
    """Move all files of one folder to another, in one step if that does not exist yet."""
    if not folder.exists():
        new.chmod(0o777 & ~_umask())  # temporary folders are private
        new.rename(folder)
        return
    files = sorted(new.iterdir())
    for file in files:
        if (folder / file.name).is_dir():
            raise BadInput(f"{folder / file.name}: is a folder; a file is to be written there")
    for file in files:
        os.replace(file, folder / file.name)


def _umask() -> int:
    """Permissions that new files of this process do not get; reading them requires setting them."""
    mask = os.umask(0o077)
    os.umask(mask)
    return mask
