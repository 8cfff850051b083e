"""Checks the files of a hull's meshes, textures and height fields before MuJoCo reads them.

MuJoCo waits forever for a named pipe, and expands a small image to any size.
"""

import os
from pathlib import Path
from stat import S_ISREG
from struct import unpack

import mujoco

from boatsim.errors import BadInput
from boatsim.simulate.hull_xml_check import MOST_CELLS

# [bytes] of all files of a hull. MuJoCo builds a mesh of this size, an .obj, in 15 s.
LARGEST = 1 << 26
PNG = b"\x89PNG\r\n\x1a\n"
PNG_HEADER = 24  # bytes up to the end of width and height


def check_assets(drawing: mujoco.MjSpec, path: Path) -> None:
    """Check that the files which a hull drawing names are regular files of a sensible size.

    Args:
        drawing: The drawing, read but not compiled.
        path: Its file; relative paths start in the folder of that.

    Raises:
        BadInput: A file is a named pipe, a device or a folder, or too large.
    """
    total = 0
    cells = 0
    for name, is_image in _asset_names(drawing).items():
        for file in _places(name, drawing, path.parent):
            try:
                status = os.stat(file)
            except (OSError, ValueError):
                continue  # MuJoCo reports a file that is nowhere
            if not S_ISREG(status.st_mode):
                raise BadInput(f"{file}: is no regular file; a mesh or texture of a hull is one")
            total += status.st_size
            if is_image:
                cells += _pixels(file)
            if total > LARGEST or cells > MOST_CELLS:
                raise BadInput(
                    f"{file}: meshes and textures of {path.name} have more than "
                    f"{LARGEST >> 20} MiB or {MOST_CELLS:.3g} pixels; simplify them"
                )


def _asset_names(drawing: mujoco.MjSpec) -> dict[str, bool]:
    """Name of each file that a drawing uses, and whether it may be an image."""
    names: dict[str, bool] = {}
    for asset in (*drawing.meshes, *drawing.skins):
        names.setdefault(asset.file, False)
    for asset in (*drawing.hfields, *drawing.textures):
        names[asset.file] = True
    for texture in drawing.textures:
        names.update(dict.fromkeys(texture.cubefiles, True))
    names.pop("", None)
    return names


def _places(name: str, drawing: mujoco.MjSpec, folder: Path) -> set[str]:
    """All places in which MuJoCo may look for the file of an asset, also with `strippath`."""
    found = set()
    for inner in (drawing.meshdir, drawing.texturedir, ""):
        found.add(os.path.join(folder, inner, name))
        found.add(os.path.join(folder, inner, os.path.basename(name)))
    return found


def _pixels(file: str) -> int:
    """Number of pixels of a PNG image by its header; 0 for another file."""
    with open(file, "rb") as opened:
        begin = opened.read(PNG_HEADER)
    if not begin.startswith(PNG) or len(begin) < PNG_HEADER:
        return 0
    width, height = unpack(">II", begin[16:])
    return int(width * height)
