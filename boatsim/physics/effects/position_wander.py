"""Position wander: slowly varying error of position fixes and headings."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import DriftingMeasurement, InstrumentDrift, param


@njit(inline="always")
def instrument_drift(q: Any) -> InstrumentDrift:
    """Return the noise model of slowly varying errors of position fixes and headings.

    North and east errors are independent and have the same rms.

    Args:
        q: Parameters of the effect, with the names and units of its class.

    Returns:
        Rms of the position [m] and heading [rad] errors and their correlation time [s].
    """
    return InstrumentDrift(q.position, q.heading, q.time)


@dataclass(frozen=True)
class PositionWander(DriftingMeasurement):
    """First-order Gauss-Markov error of position and heading.

    e' = -e / time + white noise,  rms of e = `position` [m] or `heading` [rad]

    Causes are clocks, atmosphere and multipath of satellite navigation, and the card of a compass.
    """

    formula: ClassVar[str] = (
        r"\begin{aligned} \dot e &= -\frac{e}{\tau} + \sigma \sqrt{\frac{2}{\tau}} \, "
        r"w(t) \\ x_\mathrm{recorded} &= x + e_x, \quad y_\mathrm{recorded} = y + e_y, "
        r"\quad \psi_\mathrm{recorded} = \psi + e_\psi \end{aligned}"
    )
    symbols: ClassVar = {"position": r"\sigma", "time": r"\tau"}
    alone: ClassVar[bool] = True
    of_columns: ClassVar = ("x_m", "y_m")
    needs: ClassVar = ("surge", "sway")
    ruled_out_by: ClassVar = {"position_fix": ("camera", "tracking")}
    words: ClassVar[str] = "recorded positions have a slowly varying error (not physics)"
    shown_by: ClassVar[str] = "moored between two posts, at rest"
    source: ClassVar[str] = (
        "J. Rankin, An error model for sensor simulation: GPS and differential GPS, IEEE PLANS "
        "1994 (Gauss-Markov)"
    )
    instrument_drift: ClassVar = instrument_drift
    strength: ClassVar = ("position", "heading")
    starts: ClassVar = tuple(
        {"position": sd, "time": t} for sd in (4.0, 20.0) for t in (6.0, 20.0, 60.0)
    )

    # starts and spreads of both errors are relative to the noise of a single fix or heading
    position: float = param(
        0.0, low=0.0, high=100.0, unit="m", words="rms error north and east", fit=True, spread=10.0
    )
    heading: float = param(
        0.0, low=0.0, high=1.0, unit="rad", words="rms error of the heading", fit=True, spread=3.0
    )
    time: float = param(
        20.0,
        low=5.0,
        high=1000.0,
        unit="s",
        words="correlation time of the errors",
        fit=True,
        spread=20.0,
        inactive_value=20.0,
    )
