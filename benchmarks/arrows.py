"""Imports between boatsim's modules, read from the source text; docs/arrows.svg shows them.

python -m benchmarks.arrows           draw docs/arrows.svg
python -m benchmarks.arrows --check   check whether it is up to date; exit 1 if not

A folder of plug-ins (effects, kinds, measures, readers: one idea per file, found by name) counts as
one module, so that a further file in it with the same imports leaves the picture unchanged.
"""

import argparse
import ast
import sys
from collections import Counter
from collections.abc import Iterator, Mapping
from functools import cache
from pathlib import Path
from xml.sax.saxutils import escape

from boatsim.physics.cache import KERNEL, WRITTEN
from boatsim.physics.content import PACKAGES

HOME = Path(__file__).parents[1]
OUT = HOME / "docs" / "arrows.svg"
LAYERS = (  # a module may import from its own folder and from those in the lines above it
    "errors arguments files quiet interruption version progress atomic_folder",
    "physics",
    "recordings control",
    "simulate",
    "learn",
    "metrics warp fmu sitl webassembly hydrodynamics",
    "view",
    "drive",
    "diagnosis",
    "sweeps",
    "newboat",
    "api",
    "cli __main__ __init__",
)
ABOUT = {  # captions of the folders in the picture
    "physics": "what a boat is",
    "recordings": "what was logged",
    "control": "blocks of controllers",
    "simulate": "what a run is",
    "learn": "tasks for learners",
    "metrics": "metrics of a run",
    "warp": "boats on a GPU",
    "fmu": "boats elsewhere",
    "sitl": "autopilots in the loop",
    "webassembly": "boats in a browser",
    "hydrodynamics": "coefficients in waves",
    "view": "rerun and pages",
    "drive": "hands on the sticks",
    "diagnosis": "what was left out",
    "sweeps": "many runs",
    "newboat": "from particulars",
    "cli": "commands",
}
DYNAMIC = (
    "import_module",
    "__import__",
    "spec_from_file_location",
    "exec_module",
    "run_path",
    "run_module",
)
OURS = {  # "physics.effects.fan_wind" -> its file; "physics.effects" is the package itself
    ".".join(path.relative_to(HOME / "boatsim").with_suffix("").parts).removesuffix(
        ".__init__"
    ): path
    for path in sorted((HOME / "boatsim").rglob("*.py"))
}

# What modules import
# ------------------------------------------------------------------------------------------------


@cache
def imported_modules(path: Path) -> frozenset[str]:
    """Return the full names of all imports of a file.

    Imports inside functions and calls of `import_module("name")` are included.

    Raises:
        ValueError: for a name that is not written in full.
    """
    names = set[str]()
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            names |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and node.level:
            if path.parent != KERNEL:
                raise ValueError(
                    f"{path}:{node.lineno}: write the full name, so that it can be seen "
                    "where it points"
                )
            names.add(
                "boatsim.physics.kernel"
                + ("" if f"{node.module}.py" in WRITTEN else f".{node.module}")
            )
        elif isinstance(node, ast.ImportFrom):
            names |= {f"{node.module}.{alias.name}" for alias in node.names}
        elif (name := _by_name(node)) is not None:
            names.add(name)
    return frozenset(names)


def _by_name(node: ast.AST) -> str | None:
    """Return the name that a call imports.

    It is "" if the name is only known at run time, and None if the call imports nothing by name.
    """
    if not isinstance(node, ast.Call) or ast.unparse(node.func).split(".")[-1] not in DYNAMIC:
        return None
    first = node.args[0] if node.args else None
    if isinstance(first, ast.Constant) and isinstance(first.value, str):
        return first.value
    return ""


def modules_of_boatsim(path: Path) -> set[str]:
    """Return boatsim's modules among the names.

    boatsim.physics.effects.fan_wind.law becomes `physics.effects.fan_wind`.
    """
    names = [
        name.split(".")[1:] for name in imported_modules(path) if name.split(".")[0] == "boatsim"
    ]
    parts = [[".".join(name[:n]) for n in range(len(name), 0, -1)] for name in names]
    return {
        next((part for part in longest_first if part in OURS), "__init__")
        for longest_first in parts
    }


def layer_of(name: str) -> int:
    """Return the layer of a module, counted from the left.

    Raises:
        ValueError: if no layer contains it.
    """
    first = name.split(".")[0]
    found = next((i for i, names in enumerate(LAYERS) if first in names.split()), None)
    if found is None:
        raise ValueError(
            f"boatsim/{first} stands in no layer: add it to LAYERS in benchmarks/arrows.py"
        )
    return found


def module_or_plugin_folder(name: str) -> str:
    """Return a module's name, or that of its plug-in folder."""
    return next((shelf for shelf in PACKAGES.values() if name.startswith(f"{shelf}.")), name)


def count_imports() -> Counter[tuple[str, str]]:
    """Return the number of imports by (importing, imported) folder."""
    modules = {
        (module_or_plugin_folder(name), module_or_plugin_folder(other))
        for name, path in OURS.items()
        for other in modules_of_boatsim(path)
    }
    pairs = ((a.partition(".")[0], b.partition(".")[0]) for a, b in modules)
    return Counter((a, b) for a, b in pairs if a != b)


# The picture
# -----------------------------------------------------------------------------

WIDE, HIGH, GAP, EDGE = 132, 46, 14, 12  # [px] box width and height, gap between boxes, margin
LANE, FIRST = 27, 40  # [px] distance of lanes, distance of the first from the boxes
TAP, TAPS = 15, 44  # [px] distance of the lines of a box, offset of the first
COLOURS = (
    "#3b7dc4",
    "#a06c14",
    "#9659bd",
    "#1c8a7a",
    "#c04d4d",
    "#4d6bc0",
    "#648729",
    "#7074dc",
    "#b4632c",
    "#b0588f",
    "#1f7f9c",
    "#768290",
    "#a3722f",
    "#5c8a4a",
    "#8a5a7a",
    "#2f6f5b",
    "#4a7f5f",
)  # of a folder
STYLE = (
    "text{font-family:system-ui,Helvetica,Arial,sans-serif;text-anchor:middle;fill:#fff}"
    ".name{font-size:17px;font-weight:600}.about{font-size:11.5px}.count{font-size:12px;font-weight:600}"
    ".note{font-size:13px;text-anchor:start;fill:#59636e}path{fill:none;stroke-width:2}"
    "@media(prefers-color-scheme:dark){.note{fill:#a8b1bb}}"
)


def draw_imports(found: Mapping[tuple[str, str], int]) -> str:
    """Draw the folders from left to right and one lane below for each imported folder.

    A line connects each importing folder to the lane.
    """
    folders = [name for names in LAYERS[1:] for name in names.split() if name in ABOUT]
    lanes = [b for b in reversed(folders) if any((a, b) in found for a in folders)]
    width = 2 * EDGE + len(folders) * (WIDE + GAP) - GAP
    height = EDGE + HIGH + FIRST + LANE * len(lanes) + 34
    return "\n".join(
        [
            f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}">',
            "<title>Imports between the folders of boatsim</title>",
            f"<style>{STYLE}</style>",
            *(
                line
                for depth, lane in enumerate(lanes)
                for line in _lane(lane, depth, lanes, folders, found)
            ),
            *(line for i, name in enumerate(folders) for line in _box(name, i)),
            *_notes(found, height),
            "</svg>",
            "",
        ]
    )


def _left_edge(i: int) -> int:
    """Return the left edge of a box."""
    return EDGE + i * (WIDE + GAP)


def _box(name: str, i: int) -> Iterator[str]:
    """Draw a folder and its caption."""
    middle = _left_edge(i) + WIDE // 2
    yield (
        f'<rect x="{_left_edge(i)}" y="{EDGE}" width="{WIDE}" height="{HIGH}" rx="7" '
        f'fill="{COLOURS[i]}"/>'
    )
    yield f'<text class="name" x="{middle}" y="{EDGE + 20}">{name}</text>'
    yield f'<text class="about" x="{middle}" y="{EDGE + 37}">{escape(ABOUT[name])}</text>'


def _lane(
    lane: str,
    depth: int,
    lanes: list[str],
    folders: list[str],
    found: Mapping[tuple[str, str], int],
) -> Iterator[str]:
    """Draw the imports of one folder: from each importing folder down, left, and up to it."""
    place, bottom = folders.index(lane), EDGE + HIGH
    y, x, colour = bottom + FIRST + depth * LANE, _left_edge(place) + 20, COLOURS[place]
    taps = []
    for i, a in enumerate(folders):
        if (a, lane) in found:
            taps.append((_left_edge(i) + _line_offset(a, depth, lanes, found), found[a, lane]))
    far = max(at for at, _ in taps)
    yield f'<path stroke="{colour}" d="M{far} {y}H{x}V{bottom + 7}"/>'
    yield (
        f'<path style="fill:{colour}" d="M{x - 6} {bottom + 11}L{x} {bottom}L{x + 6} '
        f'{bottom + 11}z"/>'
    )
    for at, number in taps:
        yield f'<path stroke="{colour}" d="M{at} {bottom}V{y}"/>'
        yield f'<rect x="{at - 11}" y="{y - 8}" width="22" height="16" rx="8" fill="{colour}"/>'
        yield f'<text class="count" x="{at}" y="{y + 4}">{number}</text>'


def _line_offset(
    importer: str, depth: int, lanes: list[str], found: Mapping[tuple[str, str], int]
) -> int:
    """Return the offset in a box at which its line to a lane begins.

    Lines to deeper lanes begin further right, so that they do not cross.
    """
    return TAPS + TAP * sum((importer, lane) in found for lane in lanes[:depth])


def _notes(found: Mapping[tuple[str, str], int], height: int) -> Iterator[str]:
    """Explain the arrows and list the imports that are not drawn."""
    ground = sum(n for (a, b), n in found.items() if b in LAYERS[0].split() and a in ABOUT)
    text = (
        "Data go from left to right. An arrow goes from the folder that imports to the "
        "one imported, with the number "
        f"of imports. Not drawn: {ground} of the files that lie in no folder (errors.py, "
        "files.py, ...)."
    )
    yield f'<text class="note" x="{EDGE}" y="{height - 12}">{escape(text)}</text>'


def main(arguments: list[str] | None = None) -> int:
    """Return 0 if the picture is drawn or up to date, 1 if it is out of date."""
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks.arrows",
        description="Draw the imports between boatsim's folders.",
    )
    parser.add_argument(
        "--check", action="store_true", help="only check whether docs/arrows.svg is up to date"
    )
    text = draw_imports(count_imports())
    if not parser.parse_args(arguments).check:
        OUT.write_text(text, encoding="utf-8")
    same = OUT.is_file() and OUT.read_text(encoding="utf-8") == text
    print(
        "docs/arrows.svg is up to date"
        if same
        else "docs/arrows.svg is out of date: python -m benchmarks.arrows"
    )
    return int(not same)


if __name__ == "__main__":
    sys.exit(main())
