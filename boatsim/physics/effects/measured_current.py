"""Measured current: velocity of the water over the ground from recorded columns."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import Role, WaterFlow, param
from boatsim.physics.waves.water_path import WaterPath


@njit(inline="always")
def water_velocity(q: Any, s: Any) -> tuple[float, float]:
    """Return the recorded velocity of the water over the ground.

    Args:
        q: Parameters of the effect, with the names and units of its class.
        s: Signals bound to the roles of the effect.

    Returns:
        Velocity of the water to north and east [m/s].
    """
    return q.scale * s.north, q.scale * s.east


@dataclass(frozen=True)
class MeasuredCurrent(WaterFlow):
    """Current whose velocity is recorded, aboard or ashore, in the place of an unknown current.

    All hydrodynamic forces act on the velocity relative to it. A log that measures the velocity
    through the water gives the current as the velocity over ground less that through the water, in
    directions of the earth. Its noise shakes the water of the model: filter it before. A diagnosis
    tests it for a vessel that names `current_north_mps` and `current_east_mps` in [measured], if
    they are recorded.

    A reading holds until the next one. The current is taken to change slowly: no force of its
    acceleration acts, and waves travel on still water. The acceleration of a current that is known
    as a function of time is included in `current_table`.
    """

    formula: ClassVar[str] = (
        r"\begin{aligned} u_r &= u - k \left(V_N \cos\psi + V_E \sin\psi\right) \\ v_r &= v "
        r"- k \left(V_E \cos\psi - V_N \sin\psi\right) \end{aligned}"
    )
    symbols: ClassVar = {"scale": "k"}
    ruled_out_by: ClassVar = {"still_water": (True,), "no_water": (True,)}
    needs: ClassVar = ("surge", "sway")
    of_surroundings: ClassVar[bool] = True
    words: ClassVar[str] = "the measured current carries the boat along"
    shown_by: ClassVar[str] = "drifting, and runs on opposite headings"
    source: ClassVar[str] = (
        "T. I. Fossen, Handbook of Marine Craft Hydrodynamics, 2nd ed. 2021, section 10.3"
    )
    roles: ClassVar = {
        "north": Role("m/s", "velocity of the water along x (north)"),
        "east": Role("m/s", "velocity of the water along y (east)"),
    }
    recorded_as: ClassVar = {"north": "current_north_mps", "east": "current_east_mps"}
    alone: ClassVar[bool] = True
    varies: ClassVar[bool] = True
    water_velocity: ClassVar = water_velocity

    scale: float = param(
        1.0,
        low=-10.0,
        high=10.0,
        unit="",
        words="velocity of the water over the recorded one",
        fit=True,
        spread=1.0,
        calibrates="current",
        in_per_cent="the current is {share} of the measured one",
    )

    def velocity_at(self, t: float, x: float, y: float) -> tuple[float, float]:
        """Return the velocity of the water over the ground, from Python.

        It is that of roles bound to numbers; a role bound to a channel counts as 0.

        Args:
            t: Time [s].
            x: Place north or ahead at the start [m].
            y: Place east or to starboard at the start [m].

        Returns:
            Velocity to north and east [m/s].
        """
        found = []
        for role in ("north", "east"):
            bound = self.on.get(role, 0.0) if isinstance(self.on, Mapping) else 0.0
            found.append(0.0 if isinstance(bound, str) else self.scale * float(bound))
        return found[0], found[1]

    def water_path(self) -> WaterPath:
        """Return the motion of the water on which waves travel: still water."""
        return WaterPath.steady(0.0, 0.0)
