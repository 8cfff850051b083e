"""The version of the program, as it was installed."""

from importlib.metadata import PackageNotFoundError
from importlib.metadata import version as installed


def version() -> str:
    """That of the package; "0+unknown" for a source tree that was never installed."""
    try:
        return installed("boatsim")
    except PackageNotFoundError:
        return "0+unknown"
