"""Measured relative wind: the push of the air as an anemometer on board reads it: from the bow, way made included."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import Role, Wrench
from boatsim.physics.effects.fan_wind import pushed
from boatsim.physics.effects.measured_wind import MeasuredWind


@njit(inline="always")
def law(m: Any, q: Any, s: Any) -> Wrench:
    """Drag in the air's velocity past the hull, which is what is read."""
    return pushed(-s.speed * s.cos_comes_from, -s.speed * s.sin_comes_from, q.density, q, q.swing)


@dataclass(frozen=True)
class MeasuredRelativeWind(MeasuredWind):
    """The same with the reading of an anemometer on board that nobody has turned into true wind."""

    anchored: ClassVar[str] = ""  # the reading says it all, wherever water and air go
    law: ClassVar = law
    roles: ClassVar = {
        "speed": Role("m/s", "the speed of the air past the hull"),
        "comes_from": Role("rad", "where the air comes from, clockwise from the bow"),
    }
