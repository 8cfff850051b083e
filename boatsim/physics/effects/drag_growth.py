"""Drag growth: resistance of the hull in surge that increases with time."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import Force, Wrench, param, wrench
from boatsim.physics.facts import BEGIN


@njit(inline="always")
def law(m: Any, q: Any) -> Wrench:
    """Return the additional resistance in surge, which grows in proportion to the time.

    Args:
        m: Motion of the hull: velocities [m/s], rates [rad/s], position [m], attitude [rad].
        q: Parameters of the effect, with the names and units of its class.

    Returns:
        Force [N] in body axes.
    """
    return wrench(X=-q.rate * max(m.t - q.start, 0.0) * abs(m.ur) * m.ur)


@dataclass(frozen=True)
class DragGrowth(Force):
    """Quadratic resistance in surge that grows at a constant rate, as by weed that collects.

    X = -rate max(t - start, 0) |u_r| u_r

    It is the simplest form with a growth: linear in time, and zero at first. Causes are weed and
    nets that the boat collects, fouling of the hull and water that it takes aboard. Roughness of
    the hull increases its friction, which acts along it; the cross-flow drag of sway and yaw comes
    from separation and stays the same.

    A diagnosis counts the time from the first row of all recordings. What differs between days is
    a difference between groups of recordings instead: it is found as damping of one group.
    """

    formula: ClassVar[str] = r"X = -k \, \max(t - t_0, \, 0) \, |u_r| u_r"
    symbols: ClassVar = {"rate": "k", "start": "t_0"}
    needs: ClassVar = ("surge",)
    ruled_out_by: ClassVar = {"no_water": (True,)}
    words: ClassVar[str] = "the resistance of the hull grows with time"
    shown_by: ClassVar[str] = "the same straight run at the begin and at the end"
    source: ClassVar[str] = (
        "simple empirical form; roughness increases the friction of the hull: R. L. Townsin, "
        "Biofouling 19, supplement, 2003"
    )
    law: ClassVar = law
    strength: ClassVar = ("rate",)
    facts: ClassVar = {BEGIN: ("start",)}

    rate: float = param(
        0.0,
        low=0.0,
        high=1e9,
        unit="N s/m^2",
        words="rate at which the drag coefficient grows",
        fit=True,
        spread=0.1,  # in 40 s as much as the spread of quadratic damping
        axis="surge",
    )
    start: float = param(
        0.0, low=-1e10, high=1e10, unit="s", words="time at which the growth starts"
    )
