"""The C library of a vessel's program: translated, compiled, kept on disk and called from Python.

A C compiler makes the program of a diagnosis in about a tenth of the time that numba needs
(`python -m benchmarks.native`). Both compute the same numbers to the last bit. The library has the
functions of `entries`, which take long to compile; the others, which compiled code calls or which
are called thousands of times a second, remain numba's. So does the whole program where there is no
C compiler, where a law has no C form, and with `BOATSIM_NATIVE=0`.
"""

import ctypes
import hashlib
import os
import platform
import shutil
import subprocess
import tempfile
from collections.abc import Callable, Sequence
from contextlib import suppress
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

from boatsim.errors import BadInput
from boatsim.physics.native.entries import ENTRIES, RECORDS, Entry
from boatsim.physics.native.exports import export_function
from boatsim.physics.native.kinds import (
    REAL,
    TRUTH,
    WHOLE,
    ArrayKind,
    Kind,
    Scalar,
    Struct,
    leaves,
)
from boatsim.physics.native.translate import Translation

PREFIX = "boatsim_"  # of the functions of a library
FLAGS = ("-std=gnu11", "-O2", "-fPIC", "-shared", "-w")
# No fused multiplication and addition, so that the numbers are those of numba. The other two drop
# side effects of operations that nobody reads.
EXACT = ("-ffp-contract=off", "-fno-math-errno", "-fno-trapping-math")
LONGEST = 120.0  # [s] after which the compiler is given up: many times what a program takes
MOST_RESULTS = 16  # numbers that a function returns
C_TYPES = {REAL: ctypes.c_double, TRUTH: ctypes.c_bool, WHOLE: ctypes.c_int64}
ITEMS = {REAL: np.dtype(np.float64), WHOLE: np.dtype(np.int64)}


class NoCompiler(BadInput):
    """Raised where no C compiler can make a library."""


def compiler() -> str:
    """Return the path of the C compiler: that of the variable CC, else `cc`.

    Raises:
        NoCompiler: There is none, or the variable BOATSIM_NATIVE switches it off.
    """
    if os.environ.get("BOATSIM_NATIVE", "1") == "0":
        raise NoCompiler("BOATSIM_NATIVE=0 switches the C compiler off")
    found = shutil.which(os.environ.get("CC") or "cc")
    if found is None:
        raise NoCompiler("no C compiler: neither the variable CC nor cc names one")
    return found


def program_source(module: Any) -> str:
    """Translate the functions of a program that Python calls, and all that they call, to C.

    Args:
        module: The program's package.

    Raises:
        NotTranslatable: A law has no C form.
    """
    program = Translation()
    for name, entry in ENTRIES.items():
        kinds = _argument_kinds(program, entry)
        export_function(program, PREFIX + name, getattr(module, name), kinds)
    return program.text


def _argument_kinds(program: Translation, entry: Entry) -> list[Kind]:
    kinds: list[Kind] = []
    for one in entry.arguments:
        kind = one
        if one in RECORDS:
            kind = program.struct(one, RECORDS[one])
        kinds.append(kind)
    return kinds


# Libraries on disk
# ------------------------------------------------------------------------------------------------


def load_library(module: Any) -> ctypes.CDLL:
    """Return the C library of a program, which is built if it is not on disk.

    It lies in the folder of the program, whose name covers everything that the program depends on.

    Args:
        module: The program's package.

    Raises:
        NoCompiler: There is no C compiler, or it fails.
        NotTranslatable: A law has no C form.
    """
    command = compiler()
    about = "\n".join([command, *FLAGS, *EXACT, platform.machine(), _digest_of_translator()])
    name = f"native_{hashlib.sha256(about.encode()).hexdigest()[:16]}"
    path = Path(module.__file__).parent / f"{name}.so"
    if not _is_sound(path):
        compile_library(program_source(module), path, command)
    return ctypes.CDLL(str(path))


@cache
def _digest_of_translator() -> str:
    """Digest of the files of this package, on which the C source depends."""
    digest = hashlib.sha256()
    for path in sorted(Path(__file__).parent.glob("*.py")):
        digest.update(path.read_bytes())
    return digest.hexdigest()


def _seal(path: Path) -> Path:
    """The file with the digest of a library."""
    return path.with_suffix(".sha256")


def _is_sound(path: Path) -> bool:
    """Whether a library exists and has the content of which the digest was stored."""
    try:
        return _seal(path).read_text() == hashlib.sha256(path.read_bytes()).hexdigest()
    except (OSError, UnicodeDecodeError):
        return False


def compile_library(source: str, path: Path, command: str) -> None:
    """Compile C source to a library in one step, as other processes may do the same.

    The source and the digest of the library are stored beside it.

    Args:
        source: The C source.
        path: The library to write.
        command: Path of the C compiler.

    Raises:
        NoCompiler: The compiler cannot be run, or refuses the source.
    """
    with tempfile.TemporaryDirectory(dir=path.parent, prefix=".new_") as folder:
        place = Path(folder)
        text, new = place / "program.c", place / "program.so"
        text.write_text(source, encoding="utf-8")
        given = [command, *FLAGS, *EXACT, "-o", str(new), str(text), "-lm"]
        try:
            done = subprocess.run(given, capture_output=True, text=True, timeout=LONGEST)
        except (OSError, subprocess.TimeoutExpired) as error:
            raise NoCompiler(f"{command}: {error}") from None
        if done.returncode:
            raise NoCompiler(f"{command}: {done.stderr.strip()[:200]}")
        sealed = place / "digest"
        sealed.write_text(hashlib.sha256(new.read_bytes()).hexdigest())
        with suppress(OSError):  # where it cannot be kept, the next process builds it again
            shutil.copy(text, path.with_suffix(".c"))
        new.replace(path)
        sealed.replace(_seal(path))


# Calls
# ------------------------------------------------------------------------------------------------


class NativeProgram:
    """A program whose functions come from its C library where that has them, else from numba."""

    def __init__(self, module: Any) -> None:
        """Load or build the library.

        Args:
            module: The program's package, for constants and all other functions.

        Raises:
            NoCompiler: There is no C compiler, or it fails.
            NotTranslatable: A law has no C form.
        """
        self._module, library = module, load_library(module)
        for name, entry in ENTRIES.items():
            setattr(self, name, bind_function(getattr(library, PREFIX + name), entry))

    def __getattr__(self, name: str) -> Any:
        """Return what the library does not have from the program's package."""
        return getattr(self._module, name)


def bind_function(function: Any, entry: Entry) -> Callable[..., Any]:
    """Return a function of a library as a Python function of arrays, numbers and tuples of these.

    Args:
        function: The function, as ctypes loads it.
        entry: Its arguments and result.
    """
    kinds = _argument_kinds(Translation(), entry)
    types: list[Any] = []
    for kind in kinds:
        for leaf in leaves(kind):
            types += _c_types(leaf)
    function.argtypes, function.restype = [*types, ctypes.c_void_p], ctypes.c_int

    def call(*given: Any) -> Any:
        flat: list[Any] = []
        for kind, value in zip(kinds, given, strict=True):
            _flatten(kind, value, flat)
        if entry.result is None:
            function(*flat, None)
            return None
        results = np.empty(MOST_RESULTS)
        count = function(*flat, results.ctypes.data)
        return entry.result(*results[:count].tolist())

    return call


def _c_types(leaf: Scalar | ArrayKind) -> Sequence[Any]:
    """Types of ctypes of a number, or of an array's address and sizes."""
    if isinstance(leaf, ArrayKind):
        return [ctypes.c_void_p, *[ctypes.c_int64] * leaf.dimensions]
    return [C_TYPES[leaf]]


def _flatten(kind: Kind, value: Any, out: list[Any]) -> None:
    """Append a number, an array's address and sizes, or all of these of a tuple."""
    if isinstance(kind, Struct):
        for part, one in zip(kind.kinds, value, strict=True):
            _flatten(part, one, out)
    elif isinstance(kind, ArrayKind):
        if (
            value.dtype != ITEMS[kind.item]
            or value.ndim != kind.dimensions
            or not value.flags.c_contiguous
        ):
            raise TypeError(
                f"an array of {value.dtype} with {value.ndim} dimensions; allowed is a contiguous "
                f"one of {ITEMS[kind.item]} with {kind.dimensions}"
            )
        out.append(value.ctypes.data)
        out += value.shape
    else:
        out.append(value)
