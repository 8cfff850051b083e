"""boatsim: small-boat motion and control on MuJoCo, and diagnosis of simulations against recordings.

`load_vessel`, `run`, `sweep`, `read`, `diagnose` and `replay` are the Python equivalents of the commands; `Batch` and
`Fleet` step many boats together. They are defined in `boatsim.api`, which is imported at first use.
"""

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from boatsim.api import (
        Batch,
        Diagnosis,
        Fleet,
        Parameter,
        Run,
        Sweep,
        diagnose,
        load_vessel,
        read,
        replay,
        run,
        sweep,
    )

__all__ = [
    "Batch",
    "Diagnosis",
    "Fleet",
    "Parameter",
    "Run",
    "Sweep",
    "__version__",
    "diagnose",
    "load_vessel",
    "read",
    "replay",
    "run",
    "sweep",
]

__version__: str


def __getattr__(name: str) -> object:
    """Import a public name at first use, so that `import boatsim` stays fast."""
    if name == "__version__":
        return import_module("boatsim.version").version()
    if name in __all__:
        return getattr(import_module("boatsim.api"), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__() -> list[str]:
    """Return the public interface only."""
    return sorted(__all__)
