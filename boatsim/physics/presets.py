"""Presets: several entries of the library over one law."""

import sys
from collections.abc import Mapping
from dataclasses import dataclass, field, fields
from types import new_class
from typing import TypedDict, TypeVar

from boatsim.physics.kinds.effect import Effect

E = TypeVar("E", bound=Effect)


class Freed(TypedDict, total=False):
    """What is otherwise known of a parameter that a diagnosis may fit, as in `Param`."""

    low: float
    high: float
    unit: str
    words: str
    spread: float
    axis: str
    absent: float


def preset(
    law: type[E],
    name: str,
    *,
    frees: Mapping[str, Freed] | None = None,
    fixed: Mapping[str, float] | None = None,
    otherwise: Mapping[str, float] | None = None,
    **about: object,
) -> type[E]:
    """Another entry over the same law, under a name of its own; `about` is its words, shown_by, source, starts ...

    `frees` are the parameters that a diagnosis may fit, with what is otherwise known of them; `fixed` are
    those that make the entry what it is. The rest stays open to a file, with `otherwise` as its other nominal values.
    """
    types: dict[str, type] = {}
    module = sys._getframe(1).f_globals[
        "__name__"
    ]  # the file that a program is composed from, maybe a user's own
    namespace: dict[str, object] = {**about, "__doc__": about["words"], "__module__": module}
    namespace["__annotations__"] = types
    for key, known in law.params().items():
        nominal = next(f.default for f in fields(law) if f.name == key)
        if key in (frees or {}):
            known = known._replace(fit=True, calibrates="", **(frees or {})[key])
            nominal = known.absent
        elif key in (fixed or {}):
            nominal = (fixed or {})[key]
            known = known._replace(low=nominal, high=nominal, fit=False, calibrates="", follows="")
        else:
            nominal = (otherwise or {}).get(key, nominal)
            known = known._replace(fit=False)
        namespace[key] = field(default=nominal, metadata={"param": known})
        types[key] = float
    made: type[E] = dataclass(frozen=True)(
        new_class(name, (law,), exec_body=lambda body: body.update(namespace))
    )
    return made
