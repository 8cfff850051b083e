"""Programs of this installation, as a user can type them."""

import shlex
import shutil
import sys
from pathlib import Path


def typed_program(name: str) -> str:
    """Return a program of this installation as it can be typed in the current folder.

    Args:
        name: Name of the program, such as "boatsim".

    Returns:
        The name alone if the shell finds the program, otherwise its path: relative if it lies below
        the current folder.
    """
    path = Path(sys.executable).parent / name
    if shutil.which(name) or not path.exists():
        return name
    if path.is_relative_to(Path.cwd()):
        path = path.relative_to(Path.cwd())
    return shlex.quote(str(path))
