"""Checks the XML of a hull for content that MuJoCo can not handle.

MuJoCo uses the name of an undefined class as a format string, so that `%n` in one ends the process,
and it prints warnings about nan itself.
"""

import html
import re
from collections.abc import Iterator
from pathlib import Path

from boatsim.errors import BadInput

# comments, processing instructions and tags with attributes; every `<` begins one, closed or not,
# so that the search takes linear time
PARTS = re.compile(
    r"""<!--.*?(?:-->|\Z)|<\?.*?(?:\?>|\Z)|<(?:"[^"]*(?:"|\Z)|'[^']*(?:'|\Z)|[^"'>])*+(?:>|\Z)""",
    re.DOTALL,
)
INCLUDED = re.compile(r"""<include\b.*?\bfile\s*=\s*(?:"([^"]*)"|'([^']*)')""", re.DOTALL)
NAN = re.compile(r"""["'\s]nan["'\s]""", re.IGNORECASE)
LARGEST = 1 << 24  # [bytes] of a file; meshes are separate files


def check_hull_file(path: Path) -> None:
    """Check a hull drawing in MuJoCo's XML format, and the files that it includes.

    Args:
        path: The XML file.

    Raises:
        BadInput: If a file has content that MuJoCo can not handle.
    """
    waiting, seen = [path], set[Path]()
    while waiting:
        file = waiting.pop()
        if not file.exists() or (real := file.resolve()) in seen:
            continue  # MuJoCo reports a missing file
        seen.add(real)
        for tag in _tags(file):
            if "%" in tag:
                raise BadInput(f"{file}: has a % in {tag[:80]!r}; allowed are names without it")
            if NAN.search(tag):
                raise BadInput(f"{file}: has nan in {tag[:80]!r}; allowed are numbers")
            if found := INCLUDED.match(tag):
                name = found[1] or found[2] or ""
                waiting += [folder / name for folder in {path.parent, file.parent}]


def _tags(file: Path) -> Iterator[str]:
    """Tags of a file as MuJoCo reads them, without comments."""
    if not file.is_file():
        raise BadInput(f"{file}: is no file; a hull is one in XML")
    if file.stat().st_size > LARGEST:
        raise BadInput(
            f"{file}: more than {LARGEST} bytes; meshes of a hull lie in files of their own"
        )
    for part in PARTS.finditer(file.read_bytes().decode("utf-8", "replace")):
        if part[0].startswith("<!--"):
            continue
        if part[0].startswith("<!"):  # quotes, `>` and comments have another meaning in these
            raise BadInput(f"{file}: has {part[0][:40]!r}; allowed are tags and comments")
        yield html.unescape(part[0])
