"""Checks the XML of a hull for content that MuJoCo cannot handle, or not in a short time.

MuJoCo uses the name of an undefined class as a format string, so that `%n` in one ends the process.
A hull is a rigid drawing: elements that move, measure or include other models are not part of it.
The number of elements is limited since MuJoCo's time to build a model grows with its square.
"""

import html
import re
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import NamedTuple

from boatsim.errors import BadInput

# comments, processing instructions and tags with attributes; every `<` begins one, closed or not,
# so that the search takes linear time
PARTS = re.compile(
    r"""<!--.*?(?:-->|\Z)|<\?.*?(?:\?>|\Z)|<(?:"[^"]*(?:"|\Z)|'[^']*(?:'|\Z)|[^"'>])*+(?:>|\Z)""",
    re.DOTALL,
)
NAME = re.compile(r"<\s*(/?)\s*([^\s<>/\"'=]*)")
ATTRIBUTE = re.compile(r"""([^\s<>/"'=]+)\s*=\s*("[^"]*"|'[^']*')""")
NAN = re.compile(r"""["'\s]nan["'\s]""", re.IGNORECASE)
COUNT = re.compile(r"\s*\d{1,9}\s*")
LARGEST = 1 << 24  # [bytes] of a drawing; meshes are separate files
# Elements of a drawing, repeated ones counted as often as they appear. MuJoCo builds 5,000 geoms in
# 0.2 s, 10,000 in 1.4 s, 30,000 in 17 s and 300,000 not at all. A detailed drawing has 100.
MOST_ELEMENTS = 5000
# Pixels of all textures and points of all height fields: two textures of 4096 by 4096
MOST_CELLS = 1 << 25
MOST_DIVISIONS = 256  # largest parameter of a mesh that MuJoCo generates, such as a plate of 8 by 8
SIDES = {"texture": ("width", "height"), "hfield": ("nrow", "ncol")}
CUBE = 6  # faces of a cube texture, whose height may be omitted
# Elements of a rigid drawing
ALLOWED = frozenset(
    """mujoco mujocoinclude include compiler option flag size statistic default custom numeric text
    tuple element visual global quality headlight map scale rgba asset mesh texture hfield material
    layer worldbody body frame replicate inertial geom site camera light contact pair
    exclude""".split()
)


class Tag(NamedTuple):
    """Opening or closing tag of an XML file.

    Attributes:
        name: Name of the element.
        attributes: Values of the attributes, without escapes.
        closing: Whether it is a closing tag.
        inside: Whether the element has content, which a closing tag ends.
        text: Text of the tag with escapes such as &lt; replaced.
    """

    name: str
    attributes: Mapping[str, str]
    closing: bool
    inside: bool
    text: str


class _Totals:
    """Sums over a drawing and all files that it includes."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self.size = 0  # [bytes]
        self.elements = 0
        self.cells = 0

    def add_bytes(self, file: Path, count: int) -> None:
        self.size += count
        if self.size > LARGEST:
            raise BadInput(
                f"{file}: more than {LARGEST} bytes; meshes of a hull lie in files of their own"
            )

    def add_elements(self, file: Path, count: int) -> None:
        self.elements += count
        if self.elements > MOST_ELEMENTS:
            raise BadInput(
                f"{file}: more than {MOST_ELEMENTS} elements, repeated ones included; a hull has "
                "at most so many"
            )

    def add_cells(self, file: Path, what: str, count: int) -> None:
        self.cells += count
        if self.cells > MOST_CELLS:
            raise BadInput(
                f"{file}: {what} has {count:.3g} cells; all textures and height fields of a hull "
                f"have at most {MOST_CELLS:.3g}"
            )


def check_hull_file(path: Path) -> None:
    """Check a hull drawing in MuJoCo's XML format, and the files that it includes.

    Args:
        path: The XML file.

    Raises:
        BadInput: If a file has content that MuJoCo cannot handle, or too much of it.
    """
    if not path.exists():
        return  # MuJoCo reports a missing file
    totals = _Totals(path)
    _check_file(path, 1, (), totals)


def check_hull_text(text: str, path: Path) -> None:
    """Check the text of a hull drawing in MuJoCo's XML format that comes from no file.

    Args:
        text: Drawing in MuJoCo's XML format.
        path: File that it would have; its name in messages.

    Raises:
        BadInput: If it has content that MuJoCo cannot handle, or too much of it.
    """
    totals = _Totals(path)
    totals.add_bytes(path, len(text))
    _check_tags(text, path, 1, (), totals)


def _check_file(file: Path, times: int, within: tuple[Path, ...], totals: _Totals) -> None:
    """Check a file that appears a number of times, within the files that include it."""
    if not file.is_file():
        raise BadInput(f"{file}: is no file; a hull is one in XML")
    totals.add_bytes(file, file.stat().st_size)
    text = file.read_bytes().decode("utf-8", "replace")
    _check_tags(text, file, times, (*within, file.resolve()), totals)


def _check_tags(
    text: str, file: Path, times: int, within: tuple[Path, ...], totals: _Totals
) -> None:
    open_elements: list[tuple[str, int]] = []  # name, and how often its content appears
    for tag in _tags(text, file):
        _check_text(tag, file)
        if tag.closing:
            if open_elements and open_elements[-1][0] == tag.name:
                times = open_elements.pop()[1]
            continue
        _check_element(tag, file)
        repeated = times * _repetitions(tag, file)
        totals.add_elements(file, repeated)
        _check_sizes(tag, file, totals)
        if tag.inside:
            open_elements.append((tag.name, times))
            times = repeated
        if tag.name == "include":
            name = tag.attributes.get("file", "")
            for included in sorted({folder / name for folder in (totals.path.parent, file.parent)}):
                if included.exists() and included.resolve() not in within:
                    _check_file(included, times, within, totals)


def _check_text(tag: Tag, file: Path) -> None:
    if "%" in tag.text:
        raise BadInput(f"{file}: has a % in {tag.text[:80]!r}; allowed are names without it")
    if NAN.search(tag.text):
        raise BadInput(f"{file}: has nan in {tag.text[:80]!r}; allowed are numbers")


def _check_element(tag: Tag, file: Path) -> None:
    """Check that an element belongs to a rigid drawing."""
    if tag.name not in ALLOWED:
        raise BadInput(
            f"{file}: has <{tag.name[:40]}>; a hull is a rigid drawing of geoms, sites, meshes and "
            "the like, without joints, keyframes, sensors or other models"
        )


def _repetitions(tag: Tag, file: Path) -> int:
    """Number of copies of its content that an element makes: 1 except for <replicate>."""
    if tag.name != "replicate":
        return 1
    count = tag.attributes.get("count", "1")
    if not COUNT.fullmatch(count):
        raise BadInput(f"{file}: replicate count = {count[:40]!r}; allowed are integers")
    return max(int(count), 1)


def _check_sizes(tag: Tag, file: Path, totals: _Totals) -> None:
    """Check the sizes of textures, height fields and meshes that MuJoCo generates."""
    if tag.name in SIDES:
        totals.add_cells(file, tag.name, _cells(tag, file))
    if tag.name == "mesh":
        for word in tag.attributes.get("params", "").split():
            if _size(tag, "params", word, file) > MOST_DIVISIONS:
                raise BadInput(
                    f"{file}: mesh params = {word[:40]}; allowed are numbers up to {MOST_DIVISIONS}"
                )


def _cells(tag: Tag, file: Path) -> int:
    """Number of pixels or points that the attributes of an element specify."""
    sides = []
    for key in SIDES[tag.name]:
        if key in tag.attributes:
            sides.append(_size(tag, key, tag.attributes[key], file))
    if len(sides) == 1:
        return int(CUBE * sides[0] * sides[0])
    if not sides:
        return 0
    return int(sides[0] * sides[1])


def _size(tag: Tag, key: str, word: str, file: Path) -> float:
    """The absolute value of a number in an attribute."""
    try:
        return min(abs(float(word)), 1e9)
    except ValueError:
        raise BadInput(f"{file}: {tag.name} {key} = {word[:40]!r}; allowed are numbers") from None


def _tags(text: str, file: Path) -> Iterator[Tag]:
    """Tags of a file as MuJoCo reads them, without comments."""
    for part in PARTS.finditer(text):
        if part[0].startswith(("<!--", "<?")):
            continue
        if part[0].startswith("<!"):  # quotes, `>` and comments have another meaning in these
            raise BadInput(f"{file}: has {part[0][:40]!r}; allowed are tags and comments")
        closing, name = NAME.match(part[0]).groups()  # type: ignore[union-attr]  # matches any `<`
        attributes = {}
        for key, value in ATTRIBUTE.findall(part[0]):
            attributes[key] = html.unescape(value[1:-1])
        inside = not part[0].endswith("/>")
        yield Tag(name, attributes, bool(closing), inside, html.unescape(part[0]))
