"""Numbers that files may set: bounds, unit, words, checked on construction."""

import math
from collections.abc import Mapping
from dataclasses import field, fields
from typing import NamedTuple, Self, TypeVar

from boatsim.errors import BadInput, unknown_name

N = TypeVar("N", bound=float)  # int or float
UNSET = (
    math.nan
)  # a parameter that nobody stated: filled in on a vessel by `follows` or `Effect.rules`, else 0


class Param(NamedTuple):
    """What is known of a parameter before any data: bounds, unit, words, and whether a diagnosis may fit it."""

    low: float
    high: float
    unit: str
    words: str
    fit: bool = False
    # prior sd when fitted, in the unit, for a 1.2 m boat of 4.6 kg; scaled by Froude's law
    spread: float = 0.0
    axis: str = ""  # freedom it belongs to ("roll", ...); fitted only on vessels that have it
    absent: float = 0.0  # value at which the effect is not there
    # "damping", "thrust", ...: a coefficient of the nominal that is never known exactly
    calibrates: str = ""
    # left unset: the vessel's "linear_damping.surge" or "vessel.body.mass"; "?" ends an optional
    # one
    follows: str = ""
    releases: tuple[
        str, ...
    ] = ()  # "linear_damping.surge", "body.mass": numbers of the vessel that may be off,
    how: str = "sets"  # or "scales" or "shifts": what a released number undergoes
    within: tuple[float, float] = (
        -math.inf,
        math.inf,
    )  # beyond which no fit believes it, stated as the spread is


def param(
    nominal: N,
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
    releases: tuple[str, ...] = (),
    how: str = "sets",
    within: tuple[float, float] = (-math.inf, math.inf),
) -> N:
    """Dataclass field of a checked number; `nominal` may be UNSET.

    `unit` is "" for a ratio; `spread` is the prior sd of a fitted parameter. Raises ValueError for one without.
    """
    if fit and not spread > 0.0:
        raise ValueError(f"a parameter with fit=True needs a spread, its prior sd ({words})")
    about = Param(
        low,
        high,
        unit,
        words,
        fit,
        spread,
        axis,
        absent,
        calibrates,
        follows,
        releases,
        how,
        within,
    )
    return field(default=nominal, metadata={"param": about})


def factor(
    *releases: str,
    words: str,
    spread: float = 0.4,
    axis: str = "",
    low: float = 0.1,
    high: float = 5.0,
) -> float:
    """Field of a `Release`: numbers of the vessel that may be off by one factor."""
    return param(
        1.0,
        low=low,
        high=high,
        unit="",
        words=words,
        fit=True,
        spread=spread,
        axis=axis,
        absent=1.0,
        releases=releases,
        how="scales",
    )


def shift(
    *releases: str,
    words: str,
    unit: str,
    spread: float,
    low: float,
    high: float,
    axis: str = "",
    within: tuple[float, float] = (-math.inf, math.inf),
) -> float:
    """Field of a `Release`: numbers of the vessel that may be off by one addend."""
    return param(
        0.0,
        low=low,
        high=high,
        unit=unit,
        words=words,
        fit=True,
        spread=spread,
        axis=axis,
        releases=releases,
        how="shifts",
        within=within,
    )


def number(
    *releases: str,
    words: str,
    unit: str,
    spread: float,
    low: float,
    high: float,
    absent: float,
    axis: str = "",
) -> float:
    """Field of a `Release`: a number of the vessel that is not what is stated, but this; `absent` is the stated one."""
    return param(
        absent,
        low=low,
        high=high,
        unit=unit,
        words=words,
        fit=True,
        spread=spread,
        axis=axis,
        absent=absent,
        releases=releases,
    )


def code(words: str) -> float:
    """Field of a number by which a program knows a word of a file: `Effect.rules` give it, no file states it."""
    about = Param(-1e9, 1e9, "", words)
    return field(default=UNSET, kw_only=True, repr=False, metadata={"param": about, "ours": True})


class Checked:
    """Mixin of dataclasses whose `param` fields are checked on construction and whose unknown settings are named."""

    @classmethod
    def params(cls) -> dict[str, Param]:
        """Name -> `Param` of every checked field, in order of declaration."""
        return {f.name: f.metadata["param"] for f in fields(cls) if "param" in f.metadata}  # type: ignore[arg-type]

    @classmethod
    def from_settings(cls, settings: Mapping[str, object]) -> Self:
        """Build from a file's table; raises BadInput with the nearest valid name for a setting that does not exist."""
        names = [f.name for f in fields(cls) if f.init and "ours" not in f.metadata]  # type: ignore[arg-type]
        for key in settings:
            if key not in names:
                raise BadInput(unknown_name(f"{cls.__name__}: setting", key, names))
        return cls(**settings)

    def __post_init__(self) -> None:
        for name, about in type(self).params().items():
            value = getattr(self, name)
            if value is UNSET:
                continue
            if (
                isinstance(value, bool)
                or not isinstance(value, int | float)
                or not math.isfinite(value)
            ):
                raise BadInput(
                    f"{type(self).__name__}.{name} = {value!r}; allowed is a number ({about.words})"
                )
            if not about.low <= value <= about.high:
                raise BadInput(
                    f"{type(self).__name__}.{name} = {value:g} {about.unit}; allowed {about.low:g} to "
                    f"{about.high:g} {about.unit} ({about.words})"
                )
