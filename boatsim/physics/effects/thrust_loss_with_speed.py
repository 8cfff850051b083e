"""Thrust loss with speed: the thrust of a propeller decreases with the speed of advance."""

from dataclasses import dataclass
from math import sqrt
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import Force, Wrench, param, preset_effect
from boatsim.physics.effects.thruster import speed_of_advance, thrust_wrench_at_mount

# Share of the full thrust below which the loss of a propeller falls to zero with the thrust itself,
# and not with its square root, whose slope at zero is infinite. At ten times this share, a tenth of
# full revolutions, the loss is 5 % too small.
ROUNDED = 1e-3


@njit(inline="always")
def loss_reference_thrust(thrust: float, full: float) -> float:
    """Return the reference thrust to which the loss with the speed of advance is proportional.

    The thrust of a propeller at rest grows with the square of its revolutions, its loss with the
    revolutions. The loss is therefore proportional to the square root of the thrust.

    Args:
        thrust: Thrust at rest [N].
        full: Full thrust at rest in this direction [N]; 0: proportional to the thrust.

    Returns:
        The reference thrust [N], positive; at full thrust, nearly the full thrust.
    """
    size = abs(thrust)
    if full > 0.0:
        return size * sqrt(full / (size + ROUNDED * full))
    return size


@njit(inline="always")
def law(m: Any, q: Any, s: Any, t: Any) -> Wrench:
    """Return the change of thrust of one thruster with the speed of advance.

    Thrust decreases when it drives its place on the hull on and increases when it brakes it.

    Args:
        m: Motion of the hull: velocities [m/s], rates [rad/s], position [m], attitude [rad].
        q: Parameters of the effect, with the names and units of its class.
        s: Signals of the thruster on which the effect acts.
        t: Parameters of that thruster.

    Returns:
        Force [N] and moment [N m] in body axes.
    """
    full = q.full_ahead if s.thrust > 0.0 else q.full_astern
    reference = loss_reference_thrust(s.thrust, full)
    speed = speed_of_advance(m, s, t)
    loss = (q.loss + q.curve * abs(speed)) * speed * reference
    return thrust_wrench_at_mount(-t.gain * loss, s, t)


@dataclass(frozen=True)
class ThrustLossWithSpeed(Force):
    """Thrust of a constant command that decreases with the speed of advance.

    dT = -(loss u_a + curve u_a |u_a|) |T|, or sqrt(|T| T_full) in the place of |T|: with the full
    thrust specified, the loss grows with the revolutions n of the propeller, T = a n |n| - b |n| u.
    The speed of advance is u_a = (u_r - r y) cos a + (v_r + r x) sin a, at the mount (x, y) along
    the axis at the angle a.
    """

    formula: ClassVar[str] = (
        r"\begin{aligned} \Delta T &= -g \left(l \, u_a + c \, u_a |u_a|\right) S \\ u_a &= "
        r"\left(u_r - r y\right) \cos\alpha + \left(v_r + r x\right) \sin\alpha \\ S &= "
        r"\begin{cases} |T| & T_f = 0 \\ |T| \sqrt{\frac{T_f}{|T| + 0.001 \, T_f}} \approx "
        r"\sqrt{|T| \, T_f} & T_f > 0 \end{cases}, \quad T_f = \begin{cases} T_{f+} & T > 0 \\ "
        r"T_{f-} & T \le 0 \end{cases} \end{aligned}"
    )
    symbols: ClassVar = {
        "loss": "l",
        "curve": "c",
        "full_ahead": "T_{f+}",
        "full_astern": "T_{f-}",
    }
    words: ClassVar[str] = "the thrust of the propellers decreases with the speed of the boat"
    refines: ClassVar[str] = "thrust"
    shown_by: ClassVar[str] = "the same thrust command from rest and at full speed"
    source: ClassVar[str] = (
        "T. I. Fossen, Handbook of Marine Craft Hydrodynamics, 2nd ed. 2021, section 9.3: K_T(J)"
    )
    per_instance_of: ClassVar[str] = "thruster"
    law: ClassVar = law

    loss: float = param(
        0.0,
        low=0.0,
        high=50.0,
        unit="s/m",
        words="share of the (full) thrust lost per speed",
        fit=True,
        spread=0.5,
        calibrates="thrust",
    )
    curve: float = param(
        0.0,
        low=-20.0,
        high=20.0,
        unit="s^2/m^2",
        words="share of the thrust lost per speed squared",
        fit=True,
        spread=0.1,
    )
    full_ahead: float = param(
        0.0,
        low=0.0,
        high=1e8,
        unit="N",
        words="full thrust ahead at rest; 0: the loss is proportional to the thrust",
    )
    full_astern: float = param(
        0.0, low=0.0, high=1e8, unit="N", words="full thrust astern at rest; 0: as above"
    )


DriveLossWithSpeed = preset_effect(
    ThrustLossWithSpeed,
    "DriveLossWithSpeed",
    words="the thrust of one drive decreases with the speed of the boat, unlike that of the others",
    shown_by="the same command of this drive alone from rest and at full speed",
    once_per="thruster",
    of_all=("thrust_loss_with_speed",),
    frees={
        "loss": {
            "low": -50.0,  # where all drives of the vessel's file lose more than this one
            "words": "share of the thrust of this drive lost per speed, beyond that of the "
            "vessel's file",
            "spread": 0.5,
        },
    },
)
