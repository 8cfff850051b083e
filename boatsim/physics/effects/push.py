"""Push: a force on the hull that nothing it does changes, steady or swelling as a sine, always or for a while."""

from dataclasses import dataclass
from math import cos, pi, sin
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import UNSET, Force, Release, Wrench, param, preset, shift, wrench

EVER = 1e6  # [s]


@njit(inline="always")
def law(m: Any, q: Any) -> Wrench:
    """Steady part in body axes, and one towards a bearing of the world or of the hull, between two instants.

    On a hull whose sway accelerates it in roll, a sway force does so too.
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
    """A disturbance of stated size and duration."""

    words: ClassVar[str] = "something pushes the hull for a while"
    shown_by: ClassVar[str] = "holding course and speed"
    law: ClassVar = law

    surge: float = param(0.0, low=-1e9, high=1e9, unit="N", words="ahead")
    sway: float = param(0.0, low=-1e9, high=1e9, unit="N", words="to starboard")
    roll: float = param(0.0, low=-1e12, high=1e12, unit="N m", words="starboard down", axis="roll")
    yaw: float = param(0.0, low=-1e13, high=1e13, unit="N m", words="clockwise")
    begin: float = param(0.0, low=-EVER, high=EVER, unit="s", words="it begins")
    end: float = param(EVER, low=-EVER, high=EVER, unit="s", words="it ends")
    mean: float = param(0.0, low=-1e7, high=1e7, unit="N", words="steady part towards a bearing")
    amplitude: float = param(0.0, low=0.0, high=1e7, unit="N", words="of the sine towards it")
    frequency: float = param(0.4 * pi, low=0.0, high=100.0, unit="rad/s", words="of the sine")
    phase: float = param(0.0, low=-2 * pi, high=2 * pi, unit="rad", words="of the sine at t = 0")
    toward: float = param(0.0, low=-2 * pi, high=2 * pi, unit="rad", words="where it pushes to")
    arm: float = param(
        0.0, low=-200.0, high=200.0, unit="m", words="its side force acts this far forward"
    )
    turns_with_hull: float = param(
        0.0, low=0.0, high=1.0, unit="", words="1: the bearing is one of the hull"
    )
    heel_arm: float = param(
        UNSET,
        low=-100.0,
        high=100.0,
        unit="m",
        words="roll moment per sway force; if not given, the vessel's own",
        follows="linear_hull.arm?",
    )


ALWAYS = {"begin": -EVER, "end": EVER}

SteadyForce = preset(
    Push,
    "SteadyForce",
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

Gust = preset(
    Push,
    "Gust",
    words="a force that comes and goes as a sine pushes in one direction",
    shown_by="lying still without thrust",
    source="Y. Huang and Z. Ji, Autonomous boat dynamics, eq. 7",
    fixed=ALWAYS | dict.fromkeys(("surge", "sway", "roll", "yaw"), 0.0),
)


@dataclass(frozen=True)
class GustOffCentre(Release):
    """A yaw moment in proportion to the side force of the vessel's own gust."""

    words: ClassVar[str] = (
        "the known disturbance also turns the boat: it acts away from the mass centre"
    )
    shown_by: ClassVar[str] = "the same manoeuvre with the disturbance from another side"
    source: ClassVar[str] = "Y. Huang and Z. Ji, Autonomous boat dynamics, eq. 7, with a lever"

    arm: float = shift(
        "gust.arm",
        words="lever that is missing",
        unit="m",
        spread=0.1,
        low=-200.0,
        high=200.0,
        within=(-1.2, 1.2),
    )
