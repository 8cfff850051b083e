"""Keeps composed programs on disk, so that numba compiles each once.

What lies there is run: the folder is the user's alone, and a program that is not as it was written is written anew.

A program is a package of its own in the user's cache folder: the generated `laws.py` and `motion.py` beside copies of
the kernel's files, under a name made from their content and from the content of every file that a law can reach. Numba
watches each file's own content only; a law, a constant or a kernel edited since has another name.
"""

import atexit
import hashlib
import importlib.util
import os
import shutil
import stat
import sys
import tempfile
import time
from collections.abc import Iterable
from contextlib import suppress
from functools import cache
from inspect import getsourcefile
from pathlib import Path
from types import ModuleType

import numba

from boatsim.errors import BadInput
from boatsim.physics.dependency_hash import PACKAGE, content, reach
from boatsim.physics.kinds.effect import Effect

KERNEL = PACKAGE / "physics" / "kernel"
WRITTEN = ("laws.py", "motion.py")  # generated in place of the kernel's files of these names
SHARED = (
    "compiling.py",
    "correction.py",
    "matrices.py",
    "rotation.py",
)  # imported by every program, and compiled once for all
LEFT_OUT = ("algebra.py", "equations.py", "source.py", *SHARED)  # the first three write programs
EXPORTS = '''"""A vessel's program, composed by boatsim; not meant to be edited."""

from .batch import *
from .callback import *
from .filter import *
from .inertia import *
from .laws import *
from .motion import *
from .run import *
'''
KEPT = 90 * 86400.0  # [s] after its last use that a composed program stays in the cache


def module(written: dict[str, str], classes: Iterable[type[Effect]]) -> ModuleType:
    """The program whose generated files are `written`, compiled before if the same one was composed before."""
    files = {
        p.name: p.read_text(encoding="utf-8")
        for p in sorted(KERNEL.glob("*.py"))
        if p.name not in LEFT_OUT
    }
    files |= written | {"__init__.py": EXPORTS}
    return package(files, stamp_of(files, classes))


def package(files: dict[str, str], stamp: str) -> ModuleType:
    """The package of these files, kept on disk under a name that tells all it depends on."""
    folder = cache_folder()
    path = folder / f"program_{stamp}"
    if not _whole(files, path):
        shutil.rmtree(path, ignore_errors=True)
        _write(files, path)
        _prune(folder)
    with suppress(OSError):
        os.utime(path)  # it is in use
    return _imported(path, f"boatsim_program_{stamp}")


def stamp_of(files: dict[str, str], classes: Iterable[type[Effect]]) -> str:
    """Name of a composition: its text, all that its laws can reach, and what compiles it."""
    kinds, digest = (
        sorted(classes, key=lambda kind: (kind.__module__, kind.__qualname__)),
        hashlib.sha256(),
    )
    for name, text in sorted(files.items()):
        digest.update(f"{name}\n{text}".encode())
    for kind in kinds:
        digest.update(
            f"{kind.__module__}\n".encode()
        )  # tells a user's own file from what it was before an edit
    sources = {getsourcefile(kind) for kind in kinds} | {str(KERNEL / name) for name in SHARED}
    for path in sorted({file for source in sources if source for file in reach(Path(source))}):
        digest.update(content(path))
    digest.update(f"{numba.__version__} {sys.version}".encode())
    return digest.hexdigest()[:16]


def cache_folder() -> Path:
    """~/.cache/boatsim, or a private folder that goes with the process where home can not be written. Raises BadInput.

    Code that lies in it is run, so it must be the user's own, and nobody else may write to it.
    """
    wanted = (
        os.environ.get("BOATSIM_CACHE")
        or Path(os.environ.get("XDG_CACHE_HOME") or "~/.cache") / "boatsim"
    )
    try:
        folder = Path(wanted).expanduser()
        folder.mkdir(mode=0o700, parents=True, exist_ok=True)
        found = folder.stat()
    except (OSError, RuntimeError):  # not to be written; no home to be found
        return _fleeting()
    if found.st_uid != os.geteuid() or found.st_mode & stat.S_IWOTH:
        whose = (
            "everybody may write to it"
            if found.st_uid == os.geteuid()
            else "it belongs to somebody else"
        )
        raise BadInput(
            f"{folder}: no folder for compiled programs: {whose}; set BOATSIM_CACHE to one of your own"
        )
    if found.st_mode & 0o077:
        with suppress(OSError):
            folder.chmod(0o700)
    return folder if os.access(folder, os.W_OK | os.X_OK) else _fleeting()


@cache
def _fleeting() -> Path:
    """A folder of this process and those it starts, gone at its end."""
    try:
        folder = Path(
            tempfile.mkdtemp(prefix="boatsim-")
        )  # 0700, under a name that nobody can know before
    except OSError as error:
        raise BadInput(
            f"no folder for compiled programs ({error.strerror}); set BOATSIM_CACHE to one"
        ) from None
    os.environ["BOATSIM_CACHE"] = str(folder)
    atexit.register(shutil.rmtree, folder, ignore_errors=True)
    return folder


def _whole(files: dict[str, str], path: Path) -> bool:
    """Whether a program lies there as it was written."""
    try:
        return all((path / name).read_bytes() == text.encode() for name, text in files.items())
    except OSError:
        return False


def _write(files: dict[str, str], path: Path) -> None:
    """A program's folder, whole or not at all: another process may be as quick."""
    temporary = Path(tempfile.mkdtemp(dir=path.parent, prefix=".new_"))
    try:
        for name, text in files.items():
            (temporary / name).write_text(text, encoding="utf-8")
        with suppress(OSError):
            temporary.rename(path)
    finally:
        shutil.rmtree(temporary, ignore_errors=True)


def _imported(path: Path, name: str) -> ModuleType:
    """The package at a folder, once."""
    if name in sys.modules:
        return sys.modules[name]
    spec = importlib.util.spec_from_file_location(
        name, path / "__init__.py", submodule_search_locations=[str(path)]
    )
    assert spec is not None and spec.loader is not None
    found = importlib.util.module_from_spec(spec)
    sys.modules[name] = found
    try:
        spec.loader.exec_module(found)
    except BaseException:
        for known in [n for n in sys.modules if n == name or n.startswith(f"{name}.")]:
            del sys.modules[known]
        raise
    return found


def _prune(folder: Path) -> None:
    """Remove programs that nobody has used for long.

    Safe beside other processes: one that has loaded a program needs its files no more, one that finds them gone writes
    them anew.
    """
    for old in folder.glob("program_*"):
        with suppress(OSError):  # another process may be as quick
            if time.time() - old.stat().st_mtime > KEPT:
                if old.is_dir():
                    shutil.rmtree(old)
                else:
                    old.unlink()
