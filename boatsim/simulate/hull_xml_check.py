"""What MuJoCo does not bear in the text of a hull is refused before it reads it.

It prints by the name of a class that nobody defined, so that `%n` in one ends the process, and of nan it warns itself.
"""

import html
import re
from collections.abc import Iterator
from pathlib import Path

from boatsim.errors import BadInput

# comments, instructions, tags with their attributes; every `<` begins one, closed or not: none is
# looked at twice
PARTS = re.compile(
    r"""<!--.*?(?:-->|\Z)|<\?.*?(?:\?>|\Z)|<(?:"[^"]*(?:"|\Z)|'[^']*(?:'|\Z)|[^"'>])*+(?:>|\Z)""",
    re.DOTALL,
)
INCLUDED = re.compile(r"""<include\b.*?\bfile\s*=\s*(?:"([^"]*)"|'([^']*)')""", re.DOTALL)
NAN = re.compile(r"""["'\s]nan["'\s]""", re.IGNORECASE)
LARGEST = 1 << 24  # bytes; meshes lie in files of their own


def check_text(path: Path) -> None:
    """Raises BadInput for a hull, or a file that it includes, which MuJoCo does not bear."""
    waiting, seen = [path], set[Path]()
    while waiting:
        file = waiting.pop()
        if not file.exists() or (real := file.resolve()) in seen:
            continue  # MuJoCo says so
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
    """Tags of a file as MuJoCo reads them, comments left out."""
    if not file.is_file():
        raise BadInput(f"{file}: is no file; a hull is one in XML")
    if file.stat().st_size > LARGEST:
        raise BadInput(
            f"{file}: more than {LARGEST} bytes; meshes of a hull lie in files of their own"
        )
    for part in PARTS.finditer(file.read_bytes().decode("utf-8", "replace")):
        if part[0].startswith("<!--"):
            continue
        if part[0].startswith("<!"):  # in these a quote, a `>` or a comment is none
            raise BadInput(f"{file}: has {part[0][:40]!r}; allowed are tags and comments")
        yield html.unescape(part[0])
