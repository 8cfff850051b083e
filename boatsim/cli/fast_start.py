"""What makes short commands start faster: fewer garbage collections, no import of pandas."""

import gc
import sys
import threading
from collections.abc import Sequence
from importlib.abc import MetaPathFinder
from types import ModuleType

# New objects until garbage is collected. A run imports some hundred thousand objects, which are no
# garbage: with the default of 700, the search for it takes a tenth of the time of a short run.
GARBAGE_THRESHOLD = 200_000


def collect_garbage_rarely() -> None:
    """Make Python search for cyclic garbage less often in this process."""
    gc.set_threshold(GARBAGE_THRESHOLD)


class _NoPandas(MetaPathFinder):
    """Finder of modules that makes an import of pandas fail in the thread that created it."""

    def __init__(self) -> None:
        self._thread = threading.get_ident()

    def find_spec(
        self, fullname: str, path: Sequence[str] | None, target: ModuleType | None = None
    ) -> None:
        if fullname == "pandas" and threading.get_ident() == self._thread:
            raise ModuleNotFoundError("pandas is not imported here", name=fullname)


def keep_arrow_from_importing_pandas() -> None:
    """Make pyarrow look for pandas once while it cannot be imported.

    At its first array pyarrow imports pandas, if it is installed, to recognise its series, which
    takes as long as a short run. A log is made of NumPy arrays. pandas itself can be imported
    afterwards, but pyarrow takes its series for plain sequences until it looks for pandas again: in
    `to_pandas`, and after the import of a user's Python file (`boatsim/physics/content.py`). Other
    threads can import pandas meanwhile. Nothing happens in a process that has imported pandas.
    """
    if "pandas" in sys.modules:
        return
    import numpy as np
    import pyarrow

    finder = _NoPandas()
    sys.meta_path.insert(0, finder)
    try:
        pyarrow.array(np.zeros(1))
    finally:
        sys.meta_path.remove(finder)
