"""Which files of ours a file can reach by its imports: what compiled code depends on."""

import ast
import hashlib
from functools import cache
from pathlib import Path

PACKAGE = Path(__file__).parents[1]


@cache
def stamp(path: Path) -> str:
    """Digest of a file and of all that it can reach."""
    digest = hashlib.sha256()
    for file in sorted(reach(path)):
        digest.update(content(file))
    return digest.hexdigest()


@cache
def content(path: Path) -> bytes:
    """What a file held when it was first asked for: what is imported does not change with the file."""
    return path.read_bytes()


@cache
def reach(path: Path) -> frozenset[Path]:
    """A file and all of ours that it imports, by whatever way."""
    found, ahead = {path}, [path]
    while ahead:
        for file in _imports(ahead.pop()) - found:
            found.add(file)
            ahead.append(file)
    return frozenset(found)


@cache
def _imports(path: Path) -> frozenset[Path]:
    """Files of ours that a file imports."""
    found = set()
    for node in ast.walk(ast.parse(content(path))):
        names = [alias.name for alias in node.names] if isinstance(node, ast.Import) else []
        if isinstance(node, ast.ImportFrom):
            module = ".".join([*_above(path, node.level), *([node.module] if node.module else [])])
            names = [module, *(f"{module}.{alias.name}" for alias in node.names)]
        for name in names:
            if name.partition(".")[0] == "boatsim" and (file := _file_of(name)) is not None:
                found.add(file)
    return frozenset(found)


def _above(path: Path, level: int) -> tuple[str, ...]:
    """The package that a relative import of so many dots starts from; nothing for an absolute one, or a user's file."""
    if not level or not path.is_relative_to(PACKAGE):
        return ()
    return path.parents[level - 1].relative_to(PACKAGE.parent).parts


def _file_of(name: str) -> Path | None:
    """File of one of our modules; None for what is a name inside one."""
    below = PACKAGE.joinpath(*name.split(".")[1:])
    return next((p for p in (below.with_suffix(".py"), below / "__init__.py") if p.is_file()), None)
