"""Presets: several effects that share one law."""

import sys
from collections.abc import Mapping
from dataclasses import dataclass, field, fields
from types import new_class
from typing import TypedDict, TypeVar

from boatsim.physics.kinds.effect import Effect

E = TypeVar("E", bound=Effect)


class ParameterChanges(TypedDict, total=False):
    """Attributes of an effect's parameter that a special case of the effect redefines."""

    low: float
    high: float
    unit: str
    words: str
    spread: float
    axis: str
    inactive_value: float
    calibrates: str
    usual: float
    in_per_cent: str


def preset_effect(
    law: type[E],
    name: str,
    *,
    frees: Mapping[str, ParameterChanges] | None = None,
    fixed: Mapping[str, float] | None = None,
    otherwise: Mapping[str, float] | None = None,
    **about: object,
) -> type[E]:
    """Define an effect as a special case of another one: same law, other free parameters.

    Args:
        law: The effect whose law the special case has.
        name: Name of the new class.
        frees: Parameters that a diagnosis may fit, with the attributes that differ from those of
            `law`.
        fixed: Parameters with a fixed value.
        otherwise: Other default values of the remaining parameters.
        about: Class attributes: words, shown_by, source, starts and so on.
    """
    frees, fixed, otherwise = frees or {}, fixed or {}, otherwise or {}
    types: dict[str, type] = {}
    # the module of the caller, from which programs are composed; it may be a user's file
    module = sys._getframe(1).f_globals["__name__"]
    namespace: dict[str, object] = {**about, "__doc__": about["words"], "__module__": module}
    namespace["__annotations__"] = types
    defaults = {f.name: f.default for f in fields(law)}
    codes = {f.name for f in fields(law) if "ours" in f.metadata}
    for key, known in law.params().items():
        if key in codes:  # set by the effect, and not by files
            continue
        nominal = defaults[key]
        if key in frees:
            changes: ParameterChanges = {"calibrates": "", **frees[key]}
            known = known._replace(fit=True, **changes)
            nominal = known.inactive_value
        elif key in fixed:
            nominal = fixed[key]
            known = known._replace(low=nominal, high=nominal, fit=False, calibrates="", follows="")
        else:
            nominal = otherwise.get(key, nominal)
            known = known._replace(fit=False)
        namespace[key] = field(default=nominal, metadata={"param": known})
        types[key] = float
    kind = new_class(name, (law,), exec_body=lambda body: body.update(namespace))
    found: type[E] = dataclass(frozen=True)(kind)
    return found
