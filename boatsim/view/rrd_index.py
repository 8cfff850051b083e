"""The index at the end of a `.rrd` file, with which rerun opens a part without reading the whole.

`Stream` writes messages one after the other, so that a killed run keeps its file; an index of all
of them can only be written when the last one is known. `rerun rrd verify` asks for it.
"""

import os
import subprocess
from pathlib import Path

from boatsim.files import replace_file
from boatsim.view.rerun_command import rerun_command

# [bytes] of a file that gets an index. rerun needs three times the size of the file in memory
# (measured with 135 MB), which a day's log of several GB should not cost at its end.
MAX_BYTES = 500_000_000
# [s] in which the index of the largest file is written; rerun took 1.6 s for 135 MB
INDEX_TIMEOUT = 120.0


def add_index(path: Path) -> bool:
    """Rewrite a complete `.rrd` file with an index at its end.

    rerun does this in a process of its own, because its writer may wait forever on a full disk. The
    file is replaced when the new one is complete; otherwise it stays as it was, and can be read.

    Args:
        path: The file, which no one writes any more.

    Returns:
        Whether the file has an index now.
    """
    if path.stat().st_size > MAX_BYTES:
        return False
    silent = subprocess.DEVNULL
    try:
        with replace_file(path) as temporary:
            command = [*rerun_command(), "rrd", "optimize", "--profile", "live"]
            subprocess.run(
                [*command, "-o", str(temporary), str(path)],
                stdin=silent,
                stdout=silent,
                stderr=silent,
                # rerun's command line keeps statistics of its use, but not where this is set
                env={**os.environ, "CI": "true"},
                start_new_session=True,  # Ctrl-C of the terminal does not end it
                timeout=INDEX_TIMEOUT,
                check=True,
            )
    except (OSError, subprocess.SubprocessError):
        return False
    return True
