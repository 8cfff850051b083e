"""The folder in which compiled code is kept between runs; the code in it is executed."""

import atexit
import os
import shutil
import stat
import tempfile
from contextlib import suppress
from functools import cache
from pathlib import Path

import platformdirs

from boatsim.errors import BadInput


def cache_folder() -> Path:
    """Return the folder that holds compiled programs between runs.

    It is the user's cache folder, or a temporary folder of this process if that cannot be written.

    Raises:
        BadInput: Another user owns the folder or may write to it; the code in it is executed.
    """
    wanted = os.environ.get("BOATSIM_CACHE") or platformdirs.user_cache_dir("boatsim", False)
    try:
        folder = Path(wanted).expanduser()
        folder.mkdir(mode=0o700, parents=True, exist_ok=True)
        found = folder.stat()
    except (OSError, RuntimeError):  # not writable; no home folder
        return _temporary_folder()
    reason = ""
    if found.st_uid != os.geteuid():
        reason = "it belongs to another user"
    elif found.st_mode & stat.S_IWOTH:
        reason = "every user may write to it"
    if reason:
        raise BadInput(
            f"{folder} cannot hold compiled programs: {reason}; "
            "set BOATSIM_CACHE to a folder of your own"
        )
    if found.st_mode & 0o077:
        with suppress(OSError):
            folder.chmod(0o700)
    if not os.access(folder, os.W_OK | os.X_OK):
        return _temporary_folder()
    return folder


@cache
def _temporary_folder() -> Path:
    """A folder of this process and of those that it starts, removed at its end."""
    try:
        folder = Path(tempfile.mkdtemp(prefix="boatsim-"))  # 0700, with a random name
    except OSError as error:
        raise BadInput(
            f"no folder for compiled programs ({error.strerror}); set BOATSIM_CACHE to one"
        ) from None
    os.environ["BOATSIM_CACHE"] = str(folder)
    atexit.register(shutil.rmtree, folder, ignore_errors=True)
    return folder
