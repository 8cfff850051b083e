"""Current from a table: velocity of the water that varies with time, place and depth."""

from dataclasses import dataclass, field
from typing import Any, ClassVar

from numba import njit

from boatsim.errors import BadInput
from boatsim.physics.base import UNSET, Array, Boat, WaterFlow, param
from boatsim.physics.current_file import read_current
from boatsim.physics.current_grid import (
    EMPTY,
    current_grid,
    grid_change,
    grid_displacement,
    grid_velocity,
    mean_path,
)
from boatsim.physics.waves.water_path import WaterPath

# [s] by which clocks of engines differ through rounding: where a step ends at a point of the table,
# the velocity changes as after that point in all of them
CLOCKS = 1e-9


@njit
def water_velocity(
    t: float, x: float, y: float, q: Any, p: Array, first: Any
) -> tuple[float, float]:
    """Return the velocity of the water over the ground at a time and place.

    Args:
        t: Time [s].
        x: Place north or ahead at the start [m].
        y: Place east or to starboard at the start [m].
        q: Parameters of the effect, with the names and units of its class.
        p: Parameters and tables of all effects.
        first: Index of the effect's table.

    Returns:
        Velocity of the water to north and east [m/s].
    """
    north, east = grid_velocity(t + q.start, x, y, p, first)
    return q.scale * north, q.scale * east


@njit
def water_change(
    t: float, x: float, y: float, q: Any, p: Array, first: Any
) -> tuple[float, float, float, float, float, float]:
    """Return the derivatives of the velocity of the water by time and place.

    Args:
        t: Time [s].
        x: Place north or ahead at the start [m].
        y: Place east or to starboard at the start [m].
        q: Parameters of the effect, with the names and units of its class.
        p: Parameters and tables of all effects.
        first: Index of the effect's table.

    Returns:
        Derivatives of the velocity to north by time [m/s^2], x and y [1/s], then of that to east.
    """
    a, b, c, d, e, f = grid_change(t + q.start + CLOCKS, x, y, p, first)
    return q.scale * a, q.scale * b, q.scale * c, q.scale * d, q.scale * e, q.scale * f


@njit
def water_displacement(t: float, q: Any, p: Array, first: Any) -> tuple[float, float]:
    """Return how far the water on which waves travel has moved since t = 0.

    It moves with the mean current over all places of the table.

    Args:
        t: Time [s].
        q: Parameters of the effect, with the names and units of its class.
        p: Parameters and tables of all effects.
        first: Index of the effect's table.

    Returns:
        Displacement to north and east [m].
    """
    north, east = grid_displacement(t + q.start, p, first)
    before_north, before_east = grid_displacement(q.start, p, first)
    return q.scale * (north - before_north), q.scale * (east - before_east)


@dataclass(frozen=True)
class CurrentTable(WaterFlow):
    """Current that varies with time, place and depth, from a table.

    `file` is a CSV file with the columns `north_mps` and `east_mps`, the velocity of the water, and
    any of `t_s`, `x_m`, `y_m` and `depth_m`. Its points form a grid, sorted by these columns.
    Between the points the velocity V is linear in each variable, outside them it is that of the
    edge. With a depth it is the mean from the surface to the draught.

    All hydrodynamic forces act on the velocity relative to the water at the origin of motion. Where
    the current varies, the force of its acceleration is added: on the added mass M_A that of the
    water along the path of the hull, on the mass m that of the water itself, which follows its own
    path.
    """

    formula: ClassVar[str] = (
        r"\begin{aligned} V &= k \, V_\text{table}(t_0 + t, x, y), \quad "
        r"\nu_r = \nu - R^\mathsf{T} V \\ \tau &= M_A R^\mathsf{T} "
        r"\left(\frac{\partial V}{\partial t} + (\dot p \cdot \nabla) V\right) "
        r"+ m R^\mathsf{T} \left(\frac{\partial V}{\partial t} + (V \cdot \nabla) V\right) "
        r"\end{aligned}"
    )
    symbols: ClassVar = {"scale": "k", "start": "t_0"}
    ruled_out_by: ClassVar = {"still_water": (True,), "no_water": (True,)}
    needs: ClassVar = ("surge", "sway")
    of_surroundings: ClassVar[bool] = True
    words: ClassVar[str] = "the water moves over the ground as a table says and carries the boat"
    shown_by: ClassVar[str] = "drifting, and runs on opposite headings"
    source: ClassVar[str] = (
        "T. I. Fossen, Handbook of Marine Craft Hydrodynamics, 2nd ed. 2021, section 10.3; "
        "acceleration: M. J. Lighthill, J. Fluid Mech. 9, 1960; T. R. Auton, J. C. R. Hunt and "
        "M. Prud'homme, J. Fluid Mech. 197, 1988"
    )
    sees_table: ClassVar[bool] = True
    paths: ClassVar = ("file",)
    varies: ClassVar[bool] = True
    water_velocity: ClassVar = water_velocity
    water_change: ClassVar = water_change
    water_displacement: ClassVar = water_displacement

    scale: float = param(
        1.0,
        low=-10.0,
        high=10.0,
        unit="",
        words="velocity of the water over that of the table",
        fit=True,
        spread=1.0,
        calibrates="current",
        in_per_cent="the current is {share} of that of its table",
    )
    start: float = param(
        0.0, low=-1e10, high=1e10, unit="s", words="time of the table at t = 0 of the run"
    )
    draught: float = param(
        UNSET,
        low=0.0,
        high=1e3,
        unit="m",
        words="depth over which the velocity is averaged; default: the draught of the vessel",
        follows="vessel.draught",
    )
    file: str = field(default="")  # CSV file of the table

    def table(self) -> tuple[float, ...]:
        """Return the velocity of the water on a grid of time and place."""
        if not self.file:
            return EMPTY
        return current_grid(read_current(self.file), self._depth_of_mean())

    def _depth_of_mean(self) -> float:
        """Depth over which the velocity is averaged [m]; 0 while it has no value."""
        if not self.has_value("draught"):
            return 0.0
        return self.draught

    def water_path(self) -> WaterPath:
        """Return the motion of the water on which waves travel; the effect has all parameters."""
        path = mean_path(read_current(self.file), self._depth_of_mean(), self.start)
        return path.scaled(self.scale)

    def with_all_parameters(self, vessel: Boat) -> "CurrentTable":
        """Return a copy of the effect in which every parameter has a value.

        Args:
            vessel: Vessel on which the effect acts.

        Raises:
            BadInput: No table is given, or it cannot be used.
        """
        if not self.file:
            raise BadInput(
                f"{vessel.name}: {self.name} needs file = a CSV file with the columns north_mps "
                "and east_mps"
            )
        own = super().with_all_parameters(vessel)
        own.table()  # a table that cannot be used is refused when the vessel is loaded
        return own
