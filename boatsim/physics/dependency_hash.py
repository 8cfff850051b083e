"""Files of boatsim that a file imports, directly or indirectly."""

import ast
import hashlib
import re
import textwrap
from collections.abc import Iterator
from functools import cache
from pathlib import Path

PACKAGE = Path(__file__).parents[1]
# What may be an import statement: only these lines are parsed, because every command that loads
# compiled code waits for this
IMPORT = re.compile(r"^[ \t]*(?:from[ \t]+\S+[ \t]+)?import[ \t]+(?:\([^)]*\)|.*)", re.MULTILINE)


@cache
def dependency_digest(path: Path) -> str:
    """Return a hash of a Python file and of all boatsim files that it imports, also indirectly.

    Args:
        path: A Python file.
    """
    digest = hashlib.sha256()
    for file in sorted(imported_files(path)):
        digest.update(file_content(file))
    return digest.hexdigest()


@cache
def file_content(path: Path) -> bytes:
    """Return the content of a file as it was when this process first asked for it.

    So the content agrees with the imported module even if the file has changed since.

    Args:
        path: The file.
    """
    return path.read_bytes()


@cache
def imported_files(path: Path) -> frozenset[Path]:
    """Return the paths of a Python file and of all boatsim files that it imports, also indirectly.

    Args:
        path: A Python file, of boatsim or of a user.
    """
    found, ahead = {path}, [path]
    while ahead:
        new = _imports(ahead.pop()) - found
        found |= new
        ahead += new
    return frozenset(found)


@cache
def _imports(path: Path) -> frozenset[Path]:
    """Files of boatsim that a file imports."""
    found = set()
    for node in _import_statements(file_content(path).decode("utf-8")):
        names = []
        if isinstance(node, ast.Import):
            names = [alias.name for alias in node.names]
        if isinstance(node, ast.ImportFrom):
            parts = _package(path, node.level)
            if node.module:
                parts = (*parts, node.module)
            module = ".".join(parts)
            names = [module, *(f"{module}.{alias.name}" for alias in node.names)]
        for name in names:
            if name.partition(".")[0] == "boatsim" and (file := _file_of(name)) is not None:
                found.add(file)
    return frozenset(found)


def _import_statements(text: str) -> Iterator[ast.stmt]:
    """Yield the import statements of a Python file; text that looks like one is skipped."""
    for found in IMPORT.finditer(text):
        try:
            yield from ast.parse(textwrap.dedent(found.group())).body
        except SyntaxError:  # a line of a text
            continue


def _package(path: Path, level: int) -> tuple[str, ...]:
    """Package from which a relative import of `level` dots starts.

    Empty for an absolute one or a user's file.
    """
    if not level or not path.is_relative_to(PACKAGE):
        return ()
    return path.parents[level - 1].relative_to(PACKAGE.parent).parts


def _file_of(name: str) -> Path | None:
    """File of a module of boatsim; None for a name inside a module."""
    below = PACKAGE.joinpath(*name.split(".")[1:])
    for file in (below.with_suffix(".py"), below / "__init__.py"):
        if file.is_file():
            return file
    return None
