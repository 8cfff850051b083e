"""Rectangular water with or without walls, in which a vessel is simulated and drawn."""

from dataclasses import dataclass

from boatsim.errors import BadInput

SMALLEST, LARGEST = 1e-3, 1e6  # [m] of a tank


@dataclass(frozen=True)
class Tank:
    """Rectangular water in which a vessel is simulated and drawn, in start axes, SNAME.

    `length` is along x, `width` along y.
    """

    length: float  # [m]
    width: float  # [m]
    depth: float = 1.0  # [m]
    walls: bool = True
    centre: tuple[float, float] = (0.0, 0.0)  # [m]

    def __post_init__(self) -> None:
        for name in ("length", "width", "depth"):
            value = getattr(self, name)
            if not SMALLEST <= value <= LARGEST:
                raise BadInput(
                    f"tank.{name} = {value:g} m; allowed is {SMALLEST:g} to {LARGEST:g} m"
                )
