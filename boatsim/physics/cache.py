"""Keeps compiled programs on disk, so that numba compiles each of them once.

A program is a package in the user's cache folder: the generated `laws.py` and `motion.py` with
copies of the files of the kernel. Its name is a digest of their content and of every file that a
law can reach by imports, because numba itself looks at the content of a function's own file only.
The code in the folder is run. The folder therefore belongs to the user alone, and a program whose
files differ from what was written is written again.

The folder is that of `platformdirs` for caches (`~/.cache/boatsim` on Linux), or the environment
variable `BOATSIM_CACHE`. With `BOATSIM_DEBUG=1` (`boatsim.physics.debugging`) the files of the
kernel are imported from the repository instead of being copied.
"""

import hashlib
import importlib.util
import os
import shutil
import sys
import tempfile
import time
from collections.abc import Iterable, Mapping
from contextlib import suppress
from functools import cache
from inspect import getsourcefile
from pathlib import Path
from types import ModuleType

import numba

from boatsim.physics.cache_folder import cache_folder
from boatsim.physics.debugging import DEBUG
from boatsim.physics.dependency_hash import PACKAGE, file_content, imported_files
from boatsim.physics.kinds.effect import Effect

KERNEL = PACKAGE / "physics" / "kernel"
WRITTEN = ("laws.py", "motion.py")  # generated for each vessel instead of the kernel's own files
# Imported by every program, and compiled once for all of them
SHARED = ("compiling.py", "correction.py", "matrices.py", "records.py", "rotation.py")
GENERATORS = ("algebra.py", "equations.py", "source.py")  # they write programs
EXPORTS = '''"""A vessel's program, composed by boatsim; not meant to be edited."""

from .batch import *
from .callback import *
from .filter import *
from .inertia import *
from .laws import *
from .motion import *
from .recording import *
from .run import *
'''
KEPT = 90 * 86400.0  # [s] time after the last use of a program until it is removed


def import_program(written: Mapping[str, str], classes: Iterable[type[Effect]]) -> ModuleType:
    """Import a vessel's compiled program; numba's results of an earlier equal program are reused.

    Args:
        written: Text of each generated file of the program, by file name.
        classes: Classes of the effects whose laws the program calls.
    """
    program, folder = _import_program(tuple(sorted(written.items())), frozenset(classes))
    _mark_as_used(folder)
    return program


@cache
def _import_program(
    written: tuple[tuple[str, str], ...], classes: frozenset[type[Effect]]
) -> tuple[ModuleType, Path]:
    """The program of these files and its folder; each is looked up once in a process."""
    copied = {}
    for path in sorted(KERNEL.glob("*.py")):
        if path.name not in (*SHARED, *GENERATORS, *WRITTEN):
            copied[path.name] = path.read_text(encoding="utf-8")
    own = {**dict(written), "__init__.py": EXPORTS}
    stamp = program_digest(copied | own, classes)
    if DEBUG:
        stamp = f"{stamp}_debug"
        program = import_cached_package(own, stamp, KERNEL)
    else:
        program = import_cached_package(copied | own, stamp)
    return program, _program_folder(stamp)


def import_cached_package(files: Mapping[str, str], stamp: str, *further: Path) -> ModuleType:
    """Write a generated Python package to the cache folder, if it is not there, and import it.

    Args:
        files: Text of each file of the package, by file name.
        stamp: Name that identifies the content and all that it depends on.
        further: Folders in which the package finds its other modules.
    """
    folder, path = cache_folder(), _program_folder(stamp)
    if not _is_complete(files, path):
        shutil.rmtree(path, ignore_errors=True)
        _write(files, path)
        _remove_unused_programs(folder)
    _mark_as_used(path)
    return _import_package((path, *further), f"boatsim_program_{stamp}")


def program_digest(files: Mapping[str, str], classes: Iterable[type[Effect]]) -> str:
    """Return a hash of a vessel's generated program, which names it in the cache.

    It covers the generated text, the source files on which the program depends, and the versions of
    numba and Python.

    Args:
        files: Text of each file of the program, by file name.
        classes: Classes of the effects whose laws the program calls.
    """
    kinds = sorted(classes, key=lambda kind: (kind.__module__, kind.__qualname__))
    digest = hashlib.sha256()
    for name, text in sorted(files.items()):
        digest.update(f"{name}\n{text}".encode())
    reached = set[Path]()
    for kind in kinds:
        # The name of the module distinguishes versions of a user's file within one process.
        digest.update(f"{kind.__module__}\n".encode())
        if source := getsourcefile(kind):
            reached |= imported_files(Path(source))
    for name in SHARED:
        reached |= imported_files(KERNEL / name)
    for path in sorted(reached):
        digest.update(file_content(path))
    digest.update(f"{numba.__version__} {sys.version}".encode())
    return digest.hexdigest()[:16]


def _is_complete(files: Mapping[str, str], path: Path) -> bool:
    """Whether a folder holds these files."""
    try:
        return all((path / name).read_bytes() == text.encode() for name, text in files.items())
    except OSError:
        return False


def _write(files: Mapping[str, str], path: Path) -> None:
    """Create a folder with these files in one step, as other processes may do the same."""
    temporary = Path(tempfile.mkdtemp(dir=path.parent, prefix=".new_"))
    try:
        for name, text in files.items():
            (temporary / name).write_text(text, encoding="utf-8")
        with suppress(OSError):
            temporary.rename(path)
    finally:
        shutil.rmtree(temporary, ignore_errors=True)


def _import_package(folders: tuple[Path, ...], name: str) -> ModuleType:
    """The package in the first of these folders; its modules are searched in all of them."""
    if name in sys.modules:
        return sys.modules[name]
    spec = importlib.util.spec_from_file_location(
        name,
        folders[0] / "__init__.py",
        submodule_search_locations=[str(folder) for folder in folders],
    )
    assert spec is not None and spec.loader is not None
    found = importlib.util.module_from_spec(spec)
    sys.modules[name] = found
    try:
        spec.loader.exec_module(found)
    except BaseException:
        for known in list(sys.modules):
            if known == name or known.startswith(f"{name}."):
                del sys.modules[known]
        raise
    return found


def _program_folder(stamp: str) -> Path:
    return cache_folder() / f"program_{stamp}"


def _mark_as_used(program: Path) -> None:
    with suppress(OSError):
        os.utime(program)


def _remove_unused_programs(folder: Path) -> None:
    """Remove programs that have not been used for a long time.

    Other processes are not disturbed: one that has loaded a program no longer needs its files, and
    one that does not find them writes them again.
    """
    for old in folder.glob("program_*"):
        with suppress(OSError):  # another process may remove it at the same time
            if time.time() - old.stat().st_mtime > KEPT:
                if old.is_dir():
                    shutil.rmtree(old)
                else:
                    old.unlink()
