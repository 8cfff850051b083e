"""boatsim: small-boat motion and control on MuJoCo, and what a simulation of a real boat has left out.

`load_vessel`, `run`, `sweep`, `read`, `diagnose` and `replay` are what the command line does, for Python: see
`boatsim.api`. `Batch` and `Fleet` step many boats at once.
"""

import sys
from importlib import import_module
from types import ModuleType
from typing import TYPE_CHECKING

if TYPE_CHECKING:  # all is imported when somebody asks: the first thing the program imports should be quick
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
    "Batch", "Diagnosis", "Fleet", "Parameter", "Run", "Sweep", "__version__", "diagnose", "load_vessel", "read",
    "replay", "run", "sweep",
]  # fmt: skip
FOLDERS = ("diagnose", "sweep")  # functions that a folder of ours is called like

__version__: str


def __getattr__(name: str) -> object:
    """What the package offers, looked up at first use."""
    if name == "__version__":
        return import_module("boatsim.version").version()
    if name == "diagnose":  # two folders of ours are called so too
        return import_module("boatsim.diagnose")
    if name == "sweep":
        return import_module("boatsim.sweep")
    if name in __all__:
        return getattr(import_module("boatsim.api"), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})


class _Folder(ModuleType):
    """A folder called like a function: `boatsim.diagnose(...)` is that of boatsim.api."""

    def __call__(self, *given: object, **named: object) -> object:
        return getattr(import_module("boatsim.api"), self.__name__.rpartition(".")[2])(*given, **named)


class _Package(ModuleType):
    """This package; Python hangs a folder's module on it once one of the folder's files was imported."""

    def __setattr__(self, name: str, value: object) -> None:
        if name in FOLDERS and isinstance(value, ModuleType):
            value.__class__ = _Folder
        super().__setattr__(name, value)


sys.modules[__name__].__class__ = _Package
