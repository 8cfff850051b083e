"""boatsim: small-boat motion and control on MuJoCo, and diagnosis of models from recordings.

`load_vessel`, `load_scenario`, `run`, `sweep`, `read`, `diagnose`, `replay` and `export` are the
Python equivalents of the commands; `wave_field` gives the waves of a scenario, `linearise` the
linear model of a vessel. `Vessel`, `Scenario`, `Recording`, `Diagnosis`, `Run`, `Sweep`,
`WaveField` and `LinearModel` are arguments and results; `Batch` and `Fleet` simulate many vessels
together. All are defined or exported by `boatsim.api`, which is imported at first use.
"""

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from boatsim.api import (
        Batch,
        Body,
        CommandChannel,
        Diagnosis,
        Fleet,
        LinearModel,
        Parameter,
        Recording,
        Run,
        Scenario,
        Sweep,
        Vessel,
        WaveField,
        diagnose,
        export,
        linearise,
        load_scenario,
        load_vessel,
        read,
        replay,
        run,
        sweep,
        wave_field,
    )

__all__ = [
    "Batch",
    "Body",
    "CommandChannel",
    "Diagnosis",
    "Fleet",
    "LinearModel",
    "Parameter",
    "Recording",
    "Run",
    "Scenario",
    "Sweep",
    "Vessel",
    "WaveField",
    "__version__",
    "diagnose",
    "export",
    "linearise",
    "load_scenario",
    "load_vessel",
    "read",
    "replay",
    "run",
    "sweep",
    "wave_field",
]

__version__: str


def __getattr__(name: str) -> object:
    """Import a public name at first use, so that `import boatsim` is fast."""
    if name == "__version__":
        return import_module("boatsim.version").version()
    if name in __all__:
        return getattr(import_module("boatsim.api"), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__() -> list[str]:
    """Return the names of the public interface only."""
    return sorted(__all__)
