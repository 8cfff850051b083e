"""What makes short commands start faster: fewer garbage collections, no import of pandas."""

import gc
import sys
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
    """Finder of modules that makes an import of pandas fail."""

    def find_spec(
        self, fullname: str, path: Sequence[str] | None, target: ModuleType | None = None
    ) -> None:
        if fullname == "pandas":
            raise ModuleNotFoundError("pandas is not imported here", name=fullname)


def keep_arrow_from_importing_pandas() -> None:
    """Make pyarrow look for pandas once while it cannot be imported.

    At its first array pyarrow imports pandas, if it is installed, to recognise its series, which
    takes as long as a short run. A log is made of NumPy arrays. pandas itself can be imported
    afterwards, and `to_pandas` of pyarrow then looks for it again. Nothing happens in a process
    that has imported pandas.
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
