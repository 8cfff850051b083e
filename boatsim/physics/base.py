"""Everything that the file of an effect imports: kinds, parameters, arguments of laws.

An effect is one physical effect in one file of `boatsim/physics/effects/`. Its law is a small
compiled function that the MuJoCo callback, the compiled engine and the diagnosis filter all call,
so that simulator and diagnosis always agree. Axes are SNAME: x forward, y starboard, z down,
heading and yaw rate clockwise seen from above.
"""

from math import cos, sin

from boatsim.physics.content import snake_case
from boatsim.physics.kinds.channel import ChannelEffect
from boatsim.physics.kinds.effect import Boat, Effect, Role
from boatsim.physics.kinds.filtered import FilteredSignal
from boatsim.physics.kinds.flow import WaterFlow
from boatsim.physics.kinds.force import Force
from boatsim.physics.kinds.inertia import Inertia
from boatsim.physics.kinds.measurement import Measurement
from boatsim.physics.kinds.motion_memory import MotionMemory
from boatsim.physics.kinds.reaction import Reaction
from boatsim.physics.kinds.recall import SignalHistory
from boatsim.physics.kinds.release import CoefficientChange, CoefficientRelease
from boatsim.physics.kinds.unsteady import RandomForce
from boatsim.physics.kinds.wandering import DriftingMeasurement
from boatsim.physics.param import (
    UNSET,
    CheckedParameters,
    Param,
    factor_parameter,
    param,
    replacement_parameter,
    shift_parameter,
)
from boatsim.physics.presets import ParameterChanges, preset_effect
from boatsim.physics.signals import (
    AXES,
    Array,
    InstrumentDrift,
    MassMatrix,
    MeasuredMotion,
    Motion,
    OscillatingForce,
    SignalSegment,
    Wrench,
    first_order_lag,
    longest_lag_step,
    mass_matrix,
    segment_mean,
    segment_with_mean,
    wrench,
)

__all__ = [
    "AXES",
    "UNSET",
    "Array",
    "Boat",
    "CoefficientChange",
    "ChannelEffect",
    "CheckedParameters",
    "SignalSegment",
    "Effect",
    "FilteredSignal",
    "WaterFlow",
    "Force",
    "Inertia",
    "MassMatrix",
    "Measurement",
    "Motion",
    "MotionMemory",
    "Param",
    "Reaction",
    "SignalHistory",
    "CoefficientRelease",
    "Role",
    "MeasuredMotion",
    "OscillatingForce",
    "RandomForce",
    "InstrumentDrift",
    "DriftingMeasurement",
    "Wrench",
    "segment_with_mean",
    "factor_parameter",
    "longest_lag_step",
    "first_order_lag",
    "mass_matrix",
    "segment_mean",
    "make_motion",
    "replacement_parameter",
    "param",
    "ParameterChanges",
    "preset_effect",
    "shift_parameter",
    "snake_case",
    "wrench",
]


def make_motion(current: tuple[float, float] = (0.0, 0.0), **given: float) -> Motion:
    """Return a `Motion` of the hull (position, attitude, velocities) from the given fields.

    Args:
        current: Velocity of the water, north and east [m/s]. It holds for level axes; for a hull
            that pitches give `ur`, `vr` and `wr` directly.
        given: Fields of `Motion`; the others are zero, or follow from these.
    """
    c, s = cos(given.get("psi", 0.0)), sin(given.get("psi", 0.0))
    full = dict.fromkeys(Motion._fields, 0.0)
    full |= {"cos_psi": c, "sin_psi": s, "wr": given.get("w", 0.0)}
    full |= {"water_north": current[0], "water_east": current[1]}
    t = given.get("t", 0.0)
    full |= {"carried_north": current[0] * t, "carried_east": current[1] * t}
    full["ur"] = given.get("u", 0.0) - (c * current[0] + s * current[1])
    full["vr"] = given.get("v", 0.0) - (c * current[1] - s * current[0])
    return Motion(**(full | given))
