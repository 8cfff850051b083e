"""The ways in which numba compiles a vessel's program; all divide as IEEE does instead of raising errors."""

from functools import cache
from typing import Any

from numba import njit

# Called by people or from several functions, kept on disk.
compiled = njit(error_model="numpy", cache=True)
# The same for what allocates no arrays, nor do the laws in it: numba counts no references then, which it does with
# locked instructions at every assignment of an array, for longer than the laws themselves take.
lean = njit(error_model="numpy", cache=True, _nrt=False)
# A part that few boats ever call: called as it stands, so that it lengthens none of the programs it is in.
apart: Any = njit(error_model="numpy", _nrt=False)
# A small part of another function, or a part of one or two: numba analyses it anew in each of them.
inlined = njit(error_model="numpy", inline="always")
# A large part of many functions: analysed once, and inlined by LLVM, which takes out of loops what does not change.
merged = njit(error_model="numpy", forceinline=True, _nrt=False)


@cache
def shared(law: Any) -> Any:
    """An effect's law for programs to call: analysed once in a process however many call it, and inlined by LLVM."""
    return merged(law.py_func)
