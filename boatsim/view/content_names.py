"""Names of content that may be given as the path of its file, as tables and pages show them."""

from collections.abc import Sequence
from pathlib import Path


def plain_name(name: str) -> str:
    """Return the name of content that may be given as the path of its file.

    Args:
        name: Name or path, such as "my/controllers/course.py" or "my/cases.toml:calm".
    """
    path, colon, case = name.rpartition(":")
    if colon and path.endswith(".toml"):
        return case
    if name.endswith((".py", ".onnx", ".toml")):
        return Path(name.replace("\\", "/")).stem
    return name


def plain_names(names: Sequence[str]) -> dict[str, str]:
    """Return the plain names of names or paths, or themselves where two names would be equal.

    Args:
        names: Names or paths.
    """
    labels = {name: plain_name(name) for name in names}
    if len(set(labels.values())) < len(labels):
        return {name: name for name in labels}
    return labels
