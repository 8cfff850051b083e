"""Version of the installed package."""

from importlib.metadata import PackageNotFoundError
from importlib.metadata import version as installed


def version() -> str:
    """Return the version of the installed package boatsim; "0+unknown" for a source tree."""
    try:
        return installed("boatsim")
    except PackageNotFoundError:
        return "0+unknown"
