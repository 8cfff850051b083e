"""Builds C libraries and keeps them on disk, each with a digest of its content."""

import ctypes
import hashlib
import os
import platform
import shutil
import subprocess
import tempfile
import warnings
from collections.abc import Callable, Sequence
from contextlib import suppress
from functools import cache
from pathlib import Path

from boatsim.errors import BadInput, BoatsimWarning

# Loops over the small matrices of the filter are vectorised and unrolled, as -O3 does, which takes
# longer to compile for little more speed.
LOOPS = ("-fvect-cost-model", "-fpeel-loops")
PORTABLE = ("-std=gnu11", "-O2", *LOOPS, "-fPIC", "-shared", "-w")
FLAGS = (*PORTABLE, "-march=native")
# No fused multiplication and addition, so that the numbers are those of numba. The other two drop
# side effects of operations that nobody reads.
EXACT = ("-ffp-contract=off", "-fno-math-errno", "-fno-trapping-math")
LONGEST = 120.0  # [s] after which the compiler is given up: many times what a program takes


class NoCompiler(BadInput):
    """Raised where no C compiler can make a library."""


class RefusedSource(NoCompiler):
    """Raised where the C compiler runs but refuses a source."""


class CompilerSwitchedOff(NoCompiler):
    """Raised where the variable BOATSIM_NATIVE switches the C compiler off."""


class SlowCompilationWarning(BoatsimWarning):
    """Warning that numba compiles a vessel, which takes longer, because no C compiler can."""


def warn_of_slow_compilation(error: NoCompiler) -> None:
    """Warn once in a process that numba compiles vessels, unless this was asked for.

    Args:
        error: Why no C compiler is used.
    """
    if not isinstance(error, CompilerSwitchedOff):
        _warn_once(" ".join(str(error).split()))


@cache
def _warn_once(reason: str) -> None:
    warnings.warn(
        "numba compiles the vessel, which takes longer than a C compiler when it is first used: "
        f"{reason}; BOATSIM_NATIVE=0 asks for numba without this warning",
        SlowCompilationWarning,
        stacklevel=3,
    )


def compiler_path() -> str:
    """Return the path of the C compiler: that of the variable CC, else `cc`.

    Raises:
        NoCompiler: There is none, or the variable BOATSIM_NATIVE switches it off.
    """
    if os.environ.get("BOATSIM_NATIVE", "1") == "0":
        raise CompilerSwitchedOff("BOATSIM_NATIVE=0 switches the C compiler off")
    found = shutil.which(os.environ.get("CC") or "cc")
    if found is None:
        raise NoCompiler("no C compiler: neither the variable CC nor cc names one")
    return found


def load_library(folder: Path, name: str, source: Callable[[], str]) -> ctypes.CDLL:
    """Return a C library, which is built if it is not on disk.

    Args:
        folder: The folder in which it lies, named by all that the source depends on except the
            translator.
        name: Name of the library.
        source: Returns the C source; called only where the library is built.

    Raises:
        NoCompiler: There is no C compiler, or it fails.
        NotTranslatable: A law has no C form.
    """
    command = compiler_path()
    about = "\n".join([command, *FLAGS, *EXACT, processor_features(), _digest_of_translator()])
    path = folder / f"{name}_{hashlib.sha256(about.encode()).hexdigest()[:16]}.so"
    if not _is_sound(path):
        compile_library(source(), path, command)
    return ctypes.CDLL(str(path))


@cache
def processor_features() -> str:
    """Return what the processor can do: a library of one processor may not run on another."""
    with suppress(OSError):
        for line in Path("/proc/cpuinfo").read_text().splitlines():
            if line.startswith(("flags", "Features")):
                return platform.machine() + line
    return platform.machine() + platform.processor()


@cache
def _digest_of_translator() -> str:
    """Digest of the files of this package, on which the C source depends."""
    digest = hashlib.sha256()
    for path in sorted(Path(__file__).parent.glob("*.[pch]*")):
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
        run_compiler(command, FLAGS, text, new)
        sealed = place / "digest"
        sealed.write_text(hashlib.sha256(new.read_bytes()).hexdigest())
        with suppress(OSError):  # where it cannot be kept, the next process builds it again
            shutil.copy(text, path.with_suffix(".c"))
        new.replace(path)
        sealed.replace(_seal(path))


def run_compiler(command: str, flags: Sequence[str], source: Path, library: Path) -> None:
    """Compile a C file to a shared library.

    Args:
        command: Path of the C compiler.
        flags: Flags in addition to those that keep the numbers of numba.
        source: The C file.
        library: The library to write.

    Raises:
        NoCompiler: The compiler cannot be run.
        RefusedSource: It refuses the source.
    """
    given = [command, *flags, *EXACT, "-o", str(library), str(source), "-lm"]
    try:
        done = subprocess.run(given, capture_output=True, text=True, timeout=LONGEST)
    except (OSError, subprocess.TimeoutExpired) as error:
        raise NoCompiler(f"{command}: {error}") from None
    if done.returncode:
        raise RefusedSource(f"{command}: {done.stderr.strip()[:200]}")
