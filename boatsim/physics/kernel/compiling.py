"""The ways in which numba compiles a vessel's program; all divide as IEEE does instead of raising errors."""

import pickle
from collections.abc import Callable
from contextlib import suppress
from functools import cache
from hashlib import sha256
from pathlib import Path
from typing import Any

from numba import njit
from numba.core.caching import FunctionCache, IndexDataCacheFile

from boatsim.physics.dependency_hash import stamp

SEAL = sha256().digest_size  # bytes in front of what is kept


class Sealed(IndexDataCacheFile):
    """What numba keeps of a function on disk, by its digest: what is damaged there is as if it were not there.

    Numba itself looks at a function's own file alone; here what that imports of ours counts too.
    """

    source: Path

    @property
    def _source_stamp(self) -> str:
        if self.source.parent.name.startswith("program_"):
            return ""  # composed programs lie in folders that are named by their content
        return stamp(self.source)

    def load(self, key: Any) -> Any:
        """The kept code, or None."""
        with suppress(Exception):  # a broken pickle may raise any
            return super().load(key)
        return None

    def save(self, key: Any, data: Any) -> None:
        """Keep code; where that can not be, it is compiled again another time."""
        try:
            super().save(key, data)
        except Exception:  # of an index that can not be read: begin another
            with suppress(Exception):
                self.flush()
                super().save(key, data)

    def _save_data(self, name: str, data: Any) -> None:
        content = self._dump(data)
        with self._open_for_write(self._data_path(name)) as file:
            file.write(sha256(content).digest() + content)

    def _load_data(self, name: str) -> Any:
        whole = Path(self._data_path(name)).read_bytes()
        if sha256(whole[SEAL:]).digest() != whole[:SEAL]:
            raise OSError(f"{name} is damaged")
        return pickle.loads(whole[SEAL:])


def on_disk(compiled: Any, function: Callable[..., Any]) -> Any:
    """What numba makes of a function, kept on disk under a seal."""
    compiled._cache = FunctionCache(function)
    compiled._cache._cache_file.__class__ = Sealed
    compiled._cache._cache_file.source = Path(function.__code__.co_filename)
    return compiled


def kept(**options: Any) -> Callable[[Any], Any]:
    """As njit, kept on disk."""
    return lambda function: on_disk(njit(error_model="numpy", **options)(function), function)


# Called by people or from several functions, kept on disk.
compiled = kept()
# The same for what allocates no arrays, nor do the laws in it: numba counts no references then,
# which it does with
# locked instructions at every assignment of an array, for longer than the laws themselves take.
lean = kept(_nrt=False)
# The same, and other threads may run beside it.
unlocked = kept(_nrt=False, nogil=True)
# A part that few boats ever call: called as it stands, so that it lengthens none of the programs it
# is in.
apart: Any = njit(error_model="numpy", _nrt=False)
# A small part of another function, or a part of one or two: numba analyses it anew in each of them.
inlined = njit(error_model="numpy", inline="always")
# A large part of many functions: analysed once, and inlined by LLVM, which takes out of loops what
# does not change.
merged = njit(error_model="numpy", forceinline=True, _nrt=False)


@cache
def shared(law: Any) -> Any:
    """An effect's law for programs to call: analysed once in a process however many call it, and inlined by LLVM."""
    return merged(law.py_func)
