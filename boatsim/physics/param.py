"""Numbers that files may set: bounds, unit, words, checked on construction."""

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass, field, fields
from typing import Any, Self

from boatsim.errors import BadInput, unknown_name


@dataclass(frozen=True)
class Param:
    """What is known of a parameter before any data: bounds, unit, words, and whether a diagnosis may fit it."""

    low: float
    high: float
    unit: str
    words: str
    fit: bool = False
    spread: float = 0.0  # prior sd when fitted, in the unit, for a 1.2 m boat of 4.6 kg; scaled by Froude's law
    axis: str = ""  # freedom it belongs to ("roll", ...); fitted only on vessels that have it
    absent: float = 0.0  # value at which the effect is not there
    calibrates: str = ""  # "damping", "thrust", ...: a coefficient of the nominal that is never known exactly
    follows: str = ""  # "linear_damping.surge" of the vessel, or "vessel.body.mass" where none is given
    scales: str = ""  # "linear_damping.surge": the vessel's coefficient that this factor multiplies


def param(
    nominal: float,
    *,
    low: float,
    high: float,
    unit: str,
    words: str,
    fit: bool = False,
    spread: float = 0.0,
    axis: str = "",
    absent: float = 0.0,
    calibrates: str = "",
    follows: str = "",
    scales: str = "",
) -> Any:
    """Dataclass field of a checked number. `unit` is "" for a ratio; `spread` is the prior sd of a fitted parameter."""
    about = Param(low, high, unit, words, fit, spread, axis, absent, calibrates, follows, scales)
    return field(default=nominal, metadata={"param": about})


class Checked:
    """Mixin of dataclasses whose `param` fields are checked on construction and whose unknown settings are named."""

    @classmethod
    def params(cls) -> dict[str, Param]:
        """Name -> `Param` of every checked field, in order of declaration."""
        return {f.name: f.metadata["param"] for f in fields(cls) if "param" in f.metadata}  # type: ignore[arg-type]

    @classmethod
    def from_settings(cls, settings: Mapping[str, Any]) -> Self:
        """Build from a file's table; raises BadInput with the nearest valid name for a setting that does not exist."""
        names = [f.name for f in fields(cls) if f.init]  # type: ignore[arg-type]
        for key in settings:
            if key not in names:
                raise BadInput(unknown_name(f"{cls.__name__}: setting", key, names))
        return cls(**settings)

    def __post_init__(self) -> None:
        for name, about in type(self).params().items():
            value = getattr(self, name)
            if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value):
                raise BadInput(f"{type(self).__name__}.{name} = {value!r}; allowed is a number ({about.words})")
            if not about.low <= value <= about.high:
                raise BadInput(
                    f"{type(self).__name__}.{name} = {value:g} {about.unit}; allowed {about.low:g} to "
                    f"{about.high:g} {about.unit} ({about.words})"
                )


def snake_case(name: str) -> str:
    """FanWind -> fan_wind: the name of an effect or controller is its file's name."""
    return re.sub(r"(?<!^)(?=[A-Z])", "_", name).lower()
