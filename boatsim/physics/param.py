"""Numbers that files may set: bounds, unit and description, checked on construction."""

import math
import sys
from collections.abc import Mapping, Sequence
from dataclasses import field, fields
from functools import cache
from typing import NamedTuple, Self, TypeVar

from boatsim.arguments import short_repr
from boatsim.errors import BadInput, unknown_name_message

N = TypeVar("N", bound=float)  # int or float
# A parameter without a value. For a vessel it is set by `follows`, by `Effect.derived_parameters`
# or to 0.
UNSET = math.nan
LARGEST_FLOAT = sys.float_info.max


class Param(NamedTuple):
    """Declaration of an effect's parameter: bounds, unit, description, and how it may be fitted."""

    low: float
    high: float
    unit: str
    words: str  # description
    fit: bool = False  # whether a diagnosis may fit it
    # prior sd when fitted, in the unit, for a 1.2 m boat of 4.6 kg; scaled by Froude's law
    spread: float = 0.0
    # degree of freedom that it belongs to ("roll", ...); fitted only on vessels that have it
    axis: str = ""
    inactive_value: float = 0.0  # value at which the effect has no influence
    # "damping", "thrust", ...: a coefficient of the nominal model that is never known exactly
    calibrates: str = ""
    # value of an unset parameter: that of "linear_damping.surge" or "vessel.body.mass" of the
    # vessel; a "?" at the end if the vessel need not have it
    follows: str = ""
    # numbers of the vessel that may have another value: "linear_damping.surge", "body.mass"
    releases: tuple[str, ...] = ()
    how: str = "sets"  # or "scales" or "shifts": how the parameter changes the released numbers
    # plausible range of a fit, in the unit of `spread`
    within: tuple[float, float] = (-math.inf, math.inf)
    # value about which a fit expects the parameter, in the unit of `spread`; None: without effect
    usual: float | None = None
    # sentence on a fitted ratio in per cent, "astern thrust is {share} of the commanded thrust":
    # {share} is the ratio, {more} and {larger} the change from `inactive_value` ("8 % (± 1.2)
    # less", "... smaller"), and {opposite} the other way ("more")
    in_per_cent: str = ""

    @property
    def prior_mean(self) -> float:
        """Prior mean of a fit, for a 1.2 m boat of 4.6 kg; scaled by Froude's law."""
        if self.usual is None:
            return self.inactive_value
        return self.usual


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
    inactive_value: float = 0.0,
    calibrates: str = "",
    follows: str = "",
    releases: tuple[str, ...] = (),
    how: str = "sets",
    within: tuple[float, float] = (-math.inf, math.inf),
    in_per_cent: str = "",
) -> N:
    """Declare a parameter of an effect, as a dataclass field with bounds, unit and description.

    Args:
        nominal: Default value; it may be UNSET.
        low: Lower bound.
        high: Upper bound.
        unit: Unit, "" for a ratio.
        words: Description.
        fit: Whether a diagnosis may fit it.
        spread: Prior sd of a fitted parameter, in its unit.
        axis: Degree of freedom that it belongs to.
        inactive_value: Value at which the effect has no influence.
        calibrates: Kind of coefficient of the nominal model, "damping" for example.
        follows: Number of the vessel that an unset parameter has, "linear_damping.surge" for
            example.
        releases: Numbers of the vessel that it changes.
        how: How it changes them: "sets", "scales" or "shifts".
        within: Plausible range of a fit.
        in_per_cent: Sentence on a fitted ratio, see `Param`.

    Raises:
        ValueError: A parameter with `fit` has no spread.
    """
    if fit and not spread > 0.0:
        raise ValueError(f"a parameter with fit=True needs a spread, its prior sd ({words})")
    about = Param(low, high, unit, words, fit, spread, axis, inactive_value, calibrates, follows)
    about = about._replace(releases=releases, how=how, within=within, in_per_cent=in_per_cent)
    return field(default=nominal, metadata={"param": about})


def factor_parameter(
    *releases: str,
    words: str,
    spread: float = 0.4,
    axis: str = "",
    low: float = 0.1,
    high: float = 5.0,
    in_per_cent: str = "",
) -> float:
    """Declare a parameter that multiplies numbers of the vessel, such as a damping coefficient.

    It belongs to a `CoefficientRelease`, the hypothesis that these numbers are wrong.

    Args:
        releases: The numbers, "linear_damping.surge" for example.
        words: Description.
        spread: Prior sd.
        axis: Degree of freedom that the parameter belongs to.
        low: Lower bound.
        high: Upper bound.
        in_per_cent: Sentence on a fitted value, see `Param`.
    """
    return param(
        1.0,
        low=low,
        high=high,
        unit="",
        words=words,
        fit=True,
        spread=spread,
        axis=axis,
        inactive_value=1.0,
        releases=releases,
        how="scales",
        in_per_cent=in_per_cent,
    )


def shift_parameter(
    *releases: str,
    words: str,
    unit: str,
    spread: float,
    low: float,
    high: float,
    axis: str = "",
    within: tuple[float, float] = (-math.inf, math.inf),
    in_per_cent: str = "",
) -> float:
    """Declare a parameter that is added to numbers of the vessel, such as a lever arm.

    It belongs to a `CoefficientRelease`, the hypothesis that these numbers are wrong.

    Args:
        releases: The numbers, "body.centre" for example.
        words: Description.
        unit: Unit.
        spread: Prior sd.
        low: Lower bound.
        high: Upper bound.
        axis: Degree of freedom that the parameter belongs to.
        within: Plausible range of a fit.
        in_per_cent: Sentence on a fitted value, see `Param`.
    """
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
        in_per_cent=in_per_cent,
    )


def replacement_parameter(
    *releases: str,
    words: str,
    unit: str,
    spread: float,
    low: float,
    high: float,
    inactive_value: float,
    axis: str = "",
) -> float:
    """Declare a parameter that replaces a number of the vessel, such as its mass.

    It belongs to a `CoefficientRelease`, the hypothesis that this number is wrong.

    Args:
        releases: The number, "body.mass" for example.
        words: Description.
        unit: Unit.
        spread: Prior sd.
        low: Lower bound.
        high: Upper bound.
        inactive_value: Value in the vessel file.
        axis: Degree of freedom that it belongs to.
    """
    return param(
        inactive_value,
        low=low,
        high=high,
        unit=unit,
        words=words,
        fit=True,
        spread=spread,
        axis=axis,
        inactive_value=inactive_value,
        releases=releases,
    )


def name_code_parameter(words: str) -> float:
    """Declare an internal parameter of an effect: a number that stands for a name.

    A compiled law needs numbers, for example for an axis or a channel. `Effect.derived_parameters`
    sets it, files cannot.

    Args:
        words: Description.
    """
    about = Param(-1e9, 1e9, "", words)
    return field(default=UNSET, kw_only=True, repr=False, metadata={"param": about, "ours": True})


def _wrong_type(value: object, declared: object) -> str:
    """Words for the declared type of a value of a file; "" if it has that type.

    Numbers are checked with their bounds, and other types by the class that declares them.
    """
    if declared in (str, "str") and not isinstance(value, str):
        return "a text"
    if declared in (bool, "bool") and not isinstance(value, bool):
        return "true or false"
    if declared == Sequence[str] and not _is_text_or_texts(value):
        return "a name or a list of names"
    if declared == dict[str, float] and not _is_table_of_numbers(value):
        return "a table of numbers"
    if declared == Sequence[Sequence[float]] and not _is_list_of_points(value):
        return "a list of points, each a list of numbers"
    return ""


def _is_text_or_texts(value: object) -> bool:
    if isinstance(value, list | tuple):
        return all(isinstance(one, str) for one in value)
    return isinstance(value, str)


def _is_table_of_numbers(value: object) -> bool:
    if not isinstance(value, Mapping):
        return False
    return all(type(one) in (int, float) and abs(one) <= LARGEST_FLOAT for one in value.values())


def _is_list_of_points(value: object) -> bool:
    if not isinstance(value, list | tuple):
        return False
    for point in value:
        if not isinstance(point, list | tuple):
            return False
        if not all(type(one) in (int, float) and abs(one) <= LARGEST_FLOAT for one in point):
            return False
    return True


@cache
def _declared_parameters(cls: type) -> dict[str, Param]:
    """Declarations of the checked parameters of a class by name, in order."""
    params = {}
    for declared in fields(cls):
        if "param" in declared.metadata:
            params[declared.name] = declared.metadata["param"]
    return params


class CheckedParameters:
    """Base class of settings that checks the bounds of `param` fields.

    Unknown settings are reported.
    """

    @classmethod
    def params(cls) -> dict[str, Param]:
        """Return the declaration (`Param`) of every checked parameter by name, in order."""
        declaring: type = cls
        return dict(_declared_parameters(declaring))

    @classmethod
    def from_settings(cls, settings: Mapping[str, object]) -> Self:
        """Return an instance of an effect or other class with the settings of a file, checked.

        Args:
            settings: Values of the parameters by name.

        Raises:
            BadInput: A setting does not exist (the message contains the nearest valid name), or a
                value is not allowed.
        """
        types: dict[str, object] = {}
        for declared in fields(cls):  # type: ignore[arg-type]
            if declared.init and "ours" not in declared.metadata:
                types[declared.name] = declared.type
        for key, value in settings.items():
            if key not in types:
                raise BadInput(unknown_name_message(f"{cls.__name__}: setting", str(key), types))
            allowed = _wrong_type(value, types[key])
            if allowed:
                raise BadInput(f"{cls.__name__}: {key} = {short_repr(value)}; allowed is {allowed}")
        return cls(**settings)

    def __post_init__(self) -> None:
        for name, about in type(self).params().items():
            value = getattr(self, name)
            if value is UNSET:
                continue
            is_number = isinstance(value, int | float) and not isinstance(value, bool)
            if not is_number or not abs(value) <= LARGEST_FLOAT:  # nan, or an integer beyond it
                raise BadInput(
                    f"{type(self).__name__}.{name} = {short_repr(value)}; "
                    f"allowed is a number ({about.words})"
                )
            if not about.low <= value <= about.high:
                raise BadInput(
                    f"{type(self).__name__}.{name} = {value:g} {about.unit}; "
                    f"allowed {about.low:g} to {about.high:g} {about.unit} ({about.words})"
                )
