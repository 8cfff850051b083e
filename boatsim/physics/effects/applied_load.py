"""Applied load: force or moment on the hull that was measured or that a machine reports."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import (
    CoefficientRelease,
    Force,
    Role,
    Wrench,
    factor_parameter,
    param,
    shift_parameter,
    wrench,
)


@njit(inline="always")
def law(m: Any, q: Any, s: Any) -> Wrench:
    """Return the measured force at its point and the measured moment, corrected for the sensor.

    Args:
        m: Motion of the hull: velocities [m/s], rates [rad/s], position [m], attitude [rad].
        q: Parameters of the effect, with the names and units of its class.
        s: Signals bound to the roles of the effect.

    Returns:
        Force [N] and moment [N m] in body axes.
    """
    force = q.gain * (s.force + q.force_offset)
    moment = q.gain * (s.moment + q.moment_offset)
    X, Y, Z = q.surge * force, q.sway * force, q.heave * force
    return wrench(
        X=X,
        Y=Y,
        Z=Z,
        K=q.roll * moment + q.y * Z - q.z * Y,
        M=q.pitch * moment + q.z * X - q.x * Z,
        N=q.yaw * moment + q.x * Y - q.y * X,
    )


def direction_parameter(axis: str) -> float:
    """Declare one component of the direction in which a measured load acts as a parameter."""
    return param(
        0.0,
        low=-1.0,
        high=1.0,
        unit="",
        words=f"component of the direction along {axis}",
        axis=axis,
    )


@dataclass(frozen=True)
class AppliedLoad(Force):
    """Force or moment of a motor, a winch or a carriage, from a channel of the recording.

    (X, Y, Z) = gain (F + force_offset) e at (x, y, z),  (K, M, N) += gain (Q + moment_offset) n

    e has the components `surge`, `sway` and `heave`, n has `roll`, `pitch` and `yaw`. The channels
    are bound to the roles `force` [N] and `moment` [N m]. `gain` is the load that acts over the
    load that was recorded. It is no coefficient that a diagnosis refits, because the load was
    measured; an error of it is the effect `load_gain_error`.
    """

    formula: ClassVar[str] = (
        r"\begin{aligned} (X, Y, Z) &= \mathbf{f} = g \, (F + F_0) \, \mathbf{e} \\ "
        r"(K, M, N) &= g \, (Q + Q_0) \, \mathbf{n} + \mathbf{r} \times \mathbf{f} \end{aligned}"
    )
    symbols: ClassVar = {
        "surge": "e_x",
        "sway": "e_y",
        "heave": "e_z",
        "roll": "n_x",
        "pitch": "n_y",
        "yaw": "n_z",
        "x": "r_x",
        "y": "r_y",
        "z": "r_z",
        "gain": "g",
        "force_offset": "F_0",
        "moment_offset": "Q_0",
    }
    words: ClassVar[str] = "a measured force or moment acts on the hull"
    shown_by: ClassVar[str] = "any motion under the load"
    source: ClassVar[str] = (
        "T. I. Fossen, Handbook of Marine Craft Hydrodynamics, 2nd ed. 2021, section 3.3 "
        "(generalized force of a force at a point)"
    )
    roles: ClassVar = {
        "force": Role("N", "the measured force", fixed=0.0),
        "moment": Role("N m", "the measured moment", fixed=0.0),
    }
    law: ClassVar = law

    surge: float = direction_parameter("surge")
    sway: float = direction_parameter("sway")
    heave: float = direction_parameter("heave")
    roll: float = direction_parameter("roll")
    pitch: float = direction_parameter("pitch")
    yaw: float = direction_parameter("yaw")
    x: float = param(
        0.0, low=-500.0, high=500.0, unit="m", words="point of the force, ahead of the origin"
    )
    y: float = param(
        0.0, low=-100.0, high=100.0, unit="m", words="point of the force, to starboard"
    )
    z: float = param(0.0, low=-100.0, high=100.0, unit="m", words="point of the force, below")
    gain: float = param(
        1.0, low=0.05, high=20.0, unit="", words="load that acts over the recorded load"
    )
    force_offset: float = param(
        0.0, low=-1e9, high=1e9, unit="N", words="force that the sensor does not record"
    )
    moment_offset: float = param(
        0.0, low=-1e12, high=1e12, unit="N m", words="moment that the sensor does not record"
    )


@dataclass(frozen=True)
class LoadGainError(CoefficientRelease):
    """Scale error of the sensor of a measured force or moment, or a loss between it and the hull.

    It differs from a wrong mass, because it leaves the natural period unchanged.
    """

    formula: ClassVar[str] = r"g = k \, g^0"
    symbols: ClassVar = {"factor": "k"}
    kind: ClassVar[str] = "measurement"
    words: ClassVar[str] = (
        "the recorded force or moment differs from the one that acts by a constant factor"
    )
    refines: ClassVar[str] = "thrust"
    shown_by: ClassVar[str] = "holding the hull at a known inclination, and a free oscillation"
    source: ClassVar[str] = (
        "JCGM 200:2012, International vocabulary of metrology, 4.12 (sensitivity)"
    )

    factor: float = factor_parameter(
        "applied_load.gain",
        words="load that acts over the recorded load, relative to the vessel file",
        spread=0.3,
        low=0.1,
        high=5.0,
        in_per_cent="the load that acts is {share} of the recorded one",
    )


@dataclass(frozen=True)
class LoadOffset(CoefficientRelease):
    """Zero error of the sensor of a measured force or moment.

    A constant force on the hull (`steady_force`) has the same effect on the motion.
    """

    formula: ClassVar[str] = r"F_0 = F_0^0 + \Delta F, \quad Q_0 = Q_0^0 + \Delta Q"
    symbols: ClassVar = {"force": r"\Delta F", "moment": r"\Delta Q"}
    kind: ClassVar[str] = "measurement"
    confounded_with: ClassVar = ("steady_force",)
    words: ClassVar[str] = "the sensor of the force or moment has a zero error"
    shown_by: ClassVar[str] = "the hull at rest without load"
    source: ClassVar[str] = (
        "JCGM 200:2012, International vocabulary of metrology, 4.28 (datum error)"
    )

    force: float = shift_parameter(
        "applied_load.force_offset",
        words="force that the sensor does not record",
        unit="N",
        spread=0.5,
        low=-1e9,
        high=1e9,
    )
    moment: float = shift_parameter(
        "applied_load.moment_offset",
        words="moment that the sensor does not record",
        unit="N m",
        spread=0.3,
        low=-1e12,
        high=1e12,
    )
