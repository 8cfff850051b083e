"""Dragged propeller: thrust against the motion replaces the drag of the idle propeller."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import Force, Wrench, param
from boatsim.physics.effects.thruster import speed_of_advance, thrust_wrench_at_mount


@njit(inline="always")
def thrust_deficit(thrust: float, speed: float, drag: float) -> float:
    """Return the thrust that a propeller lacks when it works against the motion [N].

    It lacks the drag D u |u| of the idle propeller, which is part of the hull's resistance and ends
    when the propeller reverses, but at most its whole thrust.

    Args:
        thrust: Thrust of the propeller [N].
        speed: Speed of its mount along its axis [m/s].
        drag: Drag coefficient of the idle propeller [N s^2/m^2].
    """
    if thrust * speed >= 0.0:
        return 0.0
    idle = drag * speed * abs(speed)
    return idle if abs(idle) < abs(thrust) else -thrust


@njit(inline="always")
def law(m: Any, q: Any, s: Any, t: Any) -> Wrench:
    """Return the thrust that one thruster lacks when it pushes against the motion of its mount.

    Args:
        m: Motion of the hull: velocities [m/s], rates [rad/s], position [m], attitude [rad].
        q: Parameters of the effect, with the names and units of its class.
        s: Signals of the thruster on which the effect acts.
        t: Parameters of that thruster.

    Returns:
        Force [N] and moment [N m] in body axes.
    """
    speed = speed_of_advance(m, s, t)
    return thrust_wrench_at_mount(thrust_deficit(t.gain * s.thrust, speed, q.drag), s, t)


@dataclass(frozen=True)
class DraggedPropeller(Force):
    """Loss of thrust against the direction of motion by the drag of the idle propeller.

    dT = D u_a |u_a|  if T u_a < 0 and D u_a^2 < |T|,  dT = -T  if T u_a < 0 otherwise,  else 0

    u_a is the speed of the mount along the axis of the thruster, D = `drag` = 0.5 rho A C_D [N
    s^2/m^2].
    """

    formula: ClassVar[str] = (
        r"\begin{aligned} \Delta T &= \begin{cases} D \, u_a |u_a| & T u_a < 0 \text{ and "
        r"} D u_a^2 < |T| \\ -T & T u_a < 0 \text{ otherwise} \\ 0 & T u_a \ge 0 "
        r"\end{cases} \\ u_a &= (u_r - y r) \cos\alpha + (v_r + x r) \sin\alpha "
        r"\end{aligned}"
    )
    symbols: ClassVar = {"drag": "D"}
    ruled_out_by: ClassVar = {"no_water": (True,)}
    words: ClassVar[str] = (
        "a propeller that works against the motion adds only the thrust beyond the drag it has "
        "when idle"
    )
    shown_by: ClassVar[str] = "one thruster astern at speed, and from rest"
    source: ClassVar[str] = "drag of a disc across the flow, 0.5 rho A C_D u^2"
    per_instance_of: ClassVar[str] = "thruster"
    law: ClassVar = law

    drag: float = param(
        0.0,
        low=0.0,
        high=1e6,
        unit="N s^2/m^2",
        words="drag coefficient of one idle propeller",
        fit=True,
        spread=1.0,
    )
