"""Push: external force on the hull, constant or sinusoidal, during a time interval."""

from dataclasses import dataclass
from math import cos, pi, sin
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import (
    UNSET,
    CoefficientRelease,
    Force,
    Wrench,
    param,
    preset_effect,
    shift_parameter,
    wrench,
)

EVER = 1e6  # [s]


@njit(inline="always")
def law(m: Any, q: Any) -> Wrench:
    """Return a specified external force on the hull that acts during a time interval.

    It consists of constant parts in body axes and a part along a bearing, which may oscillate. On a
    hull whose sway force accelerates it in roll, a sway force of this effect has the same lever.

    Args:
        m: Motion of the hull: velocities [m/s], rates [rad/s], position [m], attitude [rad].
        q: Parameters of the effect, with the names and units of its class.

    Returns:
        Force [N] and moment [N m] in body axes.
    """
    if not q.begin <= m.t < q.end:
        return wrench()
    force = q.mean
    if q.amplitude != 0.0:
        force += q.amplitude * sin(q.frequency * m.t + q.phase)
    ahead, abeam = force * cos(q.toward), force * sin(q.toward)
    if q.turns_with_hull == 0.0:
        ahead, abeam = m.cos_psi * ahead + m.sin_psi * abeam, m.cos_psi * abeam - m.sin_psi * ahead
    Y = q.sway + abeam
    return wrench(X=q.surge + ahead, Y=Y, K=q.roll + q.heel_arm * Y, N=q.yaw + q.arm * abeam)


@dataclass(frozen=True)
class Push(Force):
    """Disturbance of specified size and duration, independent of the motion of the hull.

    F = mean + amplitude sin(frequency t + phase)  along the bearing `toward`
    X = surge + F cos,  Y = sway + F sin,  K = roll + heel_arm Y,  N = yaw + arm F sin

    The bearing is one of the earth, or of the hull with `turns_with_hull` = 1.
    """

    formula: ClassVar[str] = (
        r"\begin{aligned} F &= F_0 + F_1 \sin(\omega t + \epsilon) \quad \text{for } t_1 "
        r"\le t < t_2 \\ X &= X_0 + F \cos(\gamma - \psi), \quad Y = Y_0 + F \sin(\gamma "
        r"- \psi) \\ K &= K_0 + l_h Y, \quad N = N_0 + l \, F \sin(\gamma - \psi) "
        r"\end{aligned}"
    )
    symbols: ClassVar = {
        "surge": "X_0",
        "sway": "Y_0",
        "roll": "K_0",
        "yaw": "N_0",
        "begin": "t_1",
        "end": "t_2",
        "mean": "F_0",
        "amplitude": "F_1",
        "frequency": r"\omega",
        "phase": r"\epsilon",
        "toward": r"\gamma",
        "arm": "l",
        "heel_arm": "l_h",
    }
    of_surroundings: ClassVar[bool] = True
    words: ClassVar[str] = "an external force acts on the hull during a time interval"
    shown_by: ClassVar[str] = "holding course and speed"
    law: ClassVar = law

    surge: float = param(0.0, low=-1e9, high=1e9, unit="N", words="ahead")
    sway: float = param(0.0, low=-1e9, high=1e9, unit="N", words="to starboard")
    roll: float = param(0.0, low=-1e12, high=1e12, unit="N m", words="starboard down", axis="roll")
    yaw: float = param(0.0, low=-1e13, high=1e13, unit="N m", words="clockwise")
    begin: float = param(0.0, low=-EVER, high=EVER, unit="s", words="begin of the force")
    end: float = param(EVER, low=-EVER, high=EVER, unit="s", words="end of the force")
    mean: float = param(0.0, low=-1e7, high=1e7, unit="N", words="constant force along the bearing")
    amplitude: float = param(
        0.0, low=0.0, high=1e7, unit="N", words="amplitude of the sine along the bearing"
    )
    frequency: float = param(
        0.4 * pi, low=0.0, high=100.0, unit="rad/s", words="angular frequency of the sine"
    )
    phase: float = param(
        0.0, low=-2 * pi, high=2 * pi, unit="rad", words="phase of the sine at t = 0"
    )
    toward: float = param(0.0, low=-2 * pi, high=2 * pi, unit="rad", words="bearing of the force")
    arm: float = param(
        0.0,
        low=-200.0,
        high=200.0,
        unit="m",
        words="lever of the force along the bearing, ahead of the origin",
    )
    turns_with_hull: float = param(
        0.0, low=0.0, high=1.0, unit="", words="1: the bearing is relative to the hull"
    )
    heel_arm: float = param(
        UNSET,
        low=-100.0,
        high=100.0,
        unit="m",
        words="roll moment per sway force; default: that of the vessel's linear_hull",
        follows="linear_hull.arm?",
    )


ALWAYS = {"begin": -EVER, "end": EVER}

SteadyForce = preset_effect(
    Push,
    "SteadyForce",
    formula=r"X = X_0, \quad Y = Y_0, \quad K = K_0, \quad N = N_0",
    symbols={"surge": "X_0", "sway": "Y_0", "roll": "K_0", "yaw": "N_0"},
    words="a constant force or moment acts on the hull, always in the same direction of the hull",
    shown_by="the same turn to port and to starboard",
    strength=("surge", "sway", "yaw", "roll"),
    frees={
        "surge": {"words": "positive ahead", "spread": 0.1, "axis": "surge"},
        "sway": {"words": "positive to starboard", "spread": 0.1, "axis": "sway"},
        "yaw": {"words": "positive to starboard", "spread": 0.04, "axis": "yaw"},
        "roll": {"words": "positive to starboard", "spread": 0.02, "axis": "roll"},
    },
    fixed=ALWAYS | dict.fromkeys(("mean", "amplitude", "arm", "heel_arm"), 0.0),
)

Gust = preset_effect(
    Push,
    "Gust",
    formula=(
        r"\begin{aligned} F &= F_0 + F_1 \sin(\omega t + \epsilon) \\ X &= F \cos(\gamma "
        r"- \psi), \quad Y = F \sin(\gamma - \psi), \quad K = l_h Y, \quad N = l \, Y "
        r"\end{aligned}"
    ),
    symbols={
        "mean": "F_0",
        "amplitude": "F_1",
        "frequency": r"\omega",
        "phase": r"\epsilon",
        "toward": r"\gamma",
        "arm": "l",
        "heel_arm": "l_h",
    },
    words="a sinusoidal force acts in one direction",
    shown_by="at rest without thrust",
    source="Y. Huang and Z. Ji, Autonomous boat dynamics, eq. 7",
    fixed=ALWAYS | dict.fromkeys(("surge", "sway", "roll", "yaw"), 0.0),
)


@dataclass(frozen=True)
class GustOffCentre(CoefficientRelease):
    """Yaw moment proportional to the side force of the vessel's own gust.

    A diagnosis tests with it whether a gust, modelled as a `push`, acts ahead of or behind the
    origin.
    """

    formula: ClassVar[str] = r"l = l^0 + \mathrm{arm}, \quad N = l \, Y_\mathrm{gust}"
    words: ClassVar[str] = (
        "the known disturbance also turns the boat: it acts away from the mass centre"
    )
    shown_by: ClassVar[str] = "the same manoeuvre with the disturbance from another side"
    source: ClassVar[str] = "Y. Huang and Z. Ji, Autonomous boat dynamics, eq. 7, with a lever"

    arm: float = shift_parameter(
        "gust.arm",
        words="lever that the model omits",
        unit="m",
        spread=0.1,
        low=-200.0,
        high=200.0,
        within=(-1.2, 1.2),
    )
