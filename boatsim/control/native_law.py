"""The compiled law of a controller for a single boat, in C where there is a C compiler.

numba needs a second for a law, the C compiler a tenth of it, and both give the same numbers to the
last bit. Batches of boats, whose loop is numba's, call numba's law.
"""

import hashlib
import sys
from collections.abc import Callable, Sequence
from functools import cache, partial
from inspect import getsourcefile
from pathlib import Path
from types import CodeType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from boatsim.physics.cache_folder import cache_folder
from boatsim.physics.debugging import DEBUG, python_function
from boatsim.physics.dependency_hash import dependency_digest, file_content
from boatsim.physics.native.build import (
    NoCompiler,
    RefusedSource,
    load_library,
    warn_of_slow_compilation,
)
from boatsim.physics.native.calls import NativeFunction
from boatsim.physics.native.declarations import NotTranslatable
from boatsim.physics.native.entries import Entry
from boatsim.physics.native.exports import export_function
from boatsim.physics.native.kinds import ROWS, Kind, RecordArray, record_kind
from boatsim.physics.native.translate import Translation

NAME = "boatsim_law"  # of the function in its library
ONE = np.zeros(1, dtype=np.int64)  # row of the boat


def single_boat_law(law: Any, records: Sequence[NDArray[np.void]]) -> Callable[[], object]:
    """Return a function that computes the commands of the controller of one boat.

    Args:
        law: The compiled law of a controller, `CompiledController.law`.
        records: Arrays (1,) with settings, memory, sensor readings, goals and commands, which each
            call reads and changes.
    """
    native = _native_law(law, tuple(array.dtype for array in records))
    if native is None:
        return partial(law, ONE, *records)
    call: Callable[[], object] = native.partial(ONE, *records)
    return call


@cache
def _native_law(law: Any, types: tuple[np.dtype[np.void], ...]) -> NativeFunction | None:
    """The law in C for these types of records; None if only numba can compile it."""
    python = python_function(law)
    file = getsourcefile(python)
    # values of a closure are in no file, so that a library could not be named by them
    if DEBUG or file is None or python.__closure__:
        return None
    try:
        if not _is_unchanged(python, Path(file)):
            return None
        kinds: list[Kind] = [ROWS]
        for of in types:
            kinds.append(RecordArray(record_kind(of)))
        # two laws of one function that defines laws differ in their lines only
        place = f"{python.__qualname__} {python.__code__.co_firstlineno}"
        stamp = f"{dependency_digest(Path(file))} {place} {kinds}"
        digest = hashlib.sha256(stamp.encode()).hexdigest()[:16]
        name = f"law_{python.__module__.rpartition('.')[2]}_{digest}"
        folder = cache_folder() / "laws"
        folder.mkdir(exist_ok=True)
        library = load_library(folder, name, partial(_translate_law, law, kinds))
    except (TypeError, ValueError, SyntaxError, NotTranslatable, RefusedSource, OSError):
        return None
    except NoCompiler as error:
        warn_of_slow_compilation(error)
        return None
    return NativeFunction(getattr(library, NAME), Entry(kinds))


def _translate_law(law: Any, kinds: Sequence[Kind]) -> str:
    """C source of a law and of all functions that it calls. Raises NotTranslatable."""
    program = Translation(wrap_indices=True)
    try:
        export_function(program, NAME, law, kinds)
    except NotTranslatable:
        raise
    except Exception as error:  # numba takes more than the translator knows of
        raise NotTranslatable(f"{type(error).__name__}: {error}") from error
    return program.source_text


def _is_unchanged(function: Callable[..., Any], file: Path) -> bool:
    """Whether a file has the text from which a function was loaded.

    C is made of the present text. The whole text counts where its loader keeps it, else the code of
    the function.
    """
    present = file.read_bytes()
    if present != file_content(file):  # by which the library is named
        return False
    loader = getattr(sys.modules.get(function.__module__), "__loader__", None)
    loaded = getattr(loader, "text", None)
    if loaded is not None:
        return bool(loaded == present)
    code = function.__code__
    ahead = [compile(present, str(file), "exec", dont_inherit=True)]
    while ahead:
        for part in ahead.pop().co_consts:
            if not isinstance(part, CodeType):
                continue
            ahead.append(part)
            same_place = part.co_firstlineno == code.co_firstlineno
            if same_place and part.co_qualname == code.co_qualname:
                return part.co_code == code.co_code and part.co_consts == code.co_consts
    return False
