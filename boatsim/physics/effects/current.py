"""Current: uniform, steady velocity of the water over the ground."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import WaterFlow, param


@njit(inline="always")
def water_velocity(q: Any) -> tuple[float, float]:
    """Return the velocity over the ground of a uniform, steady current.

    Args:
        q: Parameters of the effect, with the names and units of its class.

    Returns:
        Velocity of the water to north and east [m/s].
    """
    return q.north, q.east


@dataclass(frozen=True)
class Current(WaterFlow):
    """Uniform, steady current; all hydrodynamic forces act on the velocity relative to it."""

    formula: ClassVar[str] = (
        r"\begin{aligned} u_r &= u - \left(V_N \cos\psi + V_E \sin\psi\right) \\ v_r &= v "
        r"- \left(V_E \cos\psi - V_N \sin\psi\right) \end{aligned}"
    )
    symbols: ClassVar = {"north": "V_N", "east": "V_E"}
    ruled_out_by: ClassVar = {"still_water": (True,), "no_water": (True,)}
    needs: ClassVar = ("surge", "sway")
    of_surroundings: ClassVar[bool] = True
    exogenous: ClassVar = ("north", "east")
    words: ClassVar[str] = "the water moves over the ground and carries the boat along"
    shown_by: ClassVar[str] = "drifting, and runs on opposite headings"
    water_velocity: ClassVar = water_velocity

    north: float = param(
        0.0,
        low=-5.0,
        high=5.0,
        unit="m/s",
        words="velocity of the water along x (north)",
        fit=True,
        spread=0.06,
    )
    east: float = param(
        0.0,
        low=-5.0,
        high=5.0,
        unit="m/s",
        words="velocity of the water along y (east)",
        fit=True,
        spread=0.06,
    )
