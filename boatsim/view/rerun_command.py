"""The command line of rerun, which is installed together with its library."""

import sys
from pathlib import Path


def rerun_command() -> list[str]:
    """Return the beginning of a command line that starts rerun."""
    script = Path(sys.executable).parent / "rerun"
    if script.is_file():
        return [str(script)]
    return [sys.executable, "-m", "rerun"]
