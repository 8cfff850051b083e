"""Thrust fade: the thrust of the drives decreases with the time since the begin of a run."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import Force, Wrench, param, preset_effect
from boatsim.physics.effects.thruster import thrust_wrench_at_mount

# Share of the thrust that is lost when the linear decrease ends and a hyperbola of the same slope
# continues it, so that the thrust stays positive at any time.
LINEAR = 0.5


@njit(inline="always")
def lost_share(decrease: float) -> float:
    """Return the share of the thrust that is lost.

    Args:
        decrease: Rate of the decrease times the time since the begin of the run.
    """
    if decrease <= LINEAR:
        return decrease
    return 1.0 - (1.0 - LINEAR) * LINEAR / decrease


@njit(inline="always")
def law(m: Any, q: Any, s: Any, t: Any) -> Wrench:
    """Return the change of thrust of one thruster with the time since the begin of the run.

    Args:
        m: Motion of the hull: velocities [m/s], rates [rad/s], position [m], attitude [rad].
        q: Parameters of the effect, with the names and units of its class.
        s: Signals of the thruster on which the effect acts.
        t: Parameters of that thruster.

    Returns:
        Force [N] and moment [N m] in body axes.
    """
    return thrust_wrench_at_mount(-t.gain * s.thrust * lost_share(q.rate * m.t), s, t)


@dataclass(frozen=True)
class ThrustFade(Force):
    """Thrust that decreases with the time t since the first row of a run.

    dT = -rate t T  up to half of the thrust, then  dT = -(1 - 1 / (4 rate t)) T

    It describes a battery that empties or a motor that warms up. Each run begins with the full
    thrust: a time common to several runs, or to the parts of a recording with a hole, is not known.
    """

    formula: ClassVar[str] = (
        r"\Delta T = -g \, T \begin{cases} a \, t & a \, t \le \tfrac{1}{2} \\ "
        r"1 - \frac{1}{4 a \, t} & a \, t > \tfrac{1}{2} \end{cases}"
    )
    symbols: ClassVar = {"rate": "a"}
    words: ClassVar[str] = "the thrust decreases in the course of a run"
    shown_by: ClassVar[str] = "the same manoeuvre at the begin and at the end of a long run"
    source: ClassVar[str] = (
        "an empirical form, linear in the time, of the voltage of a battery that empties and of a "
        "motor that warms up"
    )
    per_instance_of: ClassVar[str] = "thruster"
    law: ClassVar = law

    rate: float = param(
        0.0,
        low=0.0,
        high=0.1,
        unit="1/s",
        words="share of the thrust that is lost in a second",
        fit=True,
        spread=0.002,
    )


DriveFade = preset_effect(
    ThrustFade,
    "DriveFade",
    words="the thrust of one drive decreases in the course of a run",
    shown_by="the same commands of this drive at the begin and at the end of a long run",
    once_per="thruster",
    of_all=("thrust_fade",),
    frees={
        "rate": {
            "words": "share of the thrust of this drive that is lost in a second",
        },
    },
)
