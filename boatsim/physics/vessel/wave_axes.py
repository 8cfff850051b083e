"""Warning about degrees of freedom of a vessel in which its waves exert no force."""

import warnings
from collections.abc import Iterable, Sequence

from boatsim.errors import BoatsimWarning
from boatsim.physics.kinds.effect import Effect


class UnforcedAxesWarning(BoatsimWarning):
    """Warning that waves act on a vessel, but not in all of its degrees of freedom."""


def warn_of_unforced_axes(name: str, dof: Sequence[str], effects: Iterable[Effect]) -> None:
    """Warn if waves act on a vessel that none of its effects lets act in some degree of freedom.

    There is no warning for calm water. Effects complement each other: one may act in sway and
    another one in heave.

    Args:
        name: Name of the vessel.
        dof: Degrees of freedom of the vessel.
        effects: Its effects, completed.
    """
    sources: list[str] = []
    forced: set[str] = set()
    for effect in effects:
        axes = effect.wave_axes()
        if axes:
            sources.append(effect.name)
            forced.update(axes)
    unforced = [axis for axis in dof if axis not in forced]
    if sources and unforced:
        warnings.warn(
            f"{name}: the waves of {_listed(sources)} exert no force in {_listed(unforced)}",
            UnforcedAxesWarning,
            stacklevel=2,
        )


def _listed(names: Sequence[str]) -> str:
    """Names in a sentence: "surge, heave and pitch"."""
    if len(names) == 1:
        return names[0]
    return f"{', '.join(names[:-1])} and {names[-1]}"
