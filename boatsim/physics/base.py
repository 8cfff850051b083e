"""Everything that the file of an effect imports: kinds, parameters, arguments of laws.

An effect is one physical effect in one file of `boatsim/physics/effects/`. Its law is a small
compiled function that the MuJoCo callback, the compiled engine and the diagnosis filter all call,
so that simulator and diagnosis always agree. Axes are SNAME: x forward, y starboard, z down,
heading and yaw rate clockwise seen from above.
"""

from math import cos, sin

from boatsim.physics.content import snake_case
from boatsim.physics.kinds.channel import Channel
from boatsim.physics.kinds.effect import Boat, Effect, Role
from boatsim.physics.kinds.flow import Flow
from boatsim.physics.kinds.force import Force
from boatsim.physics.kinds.inertia import Inertia
from boatsim.physics.kinds.measurement import Measurement
from boatsim.physics.kinds.reaction import Reaction
from boatsim.physics.kinds.recall import Recall
from boatsim.physics.kinds.release import Change, Release
from boatsim.physics.kinds.unsteady import Unsteady
from boatsim.physics.kinds.wandering import Wandering
from boatsim.physics.param import UNSET, Checked, Param, factor, number, param, shift
from boatsim.physics.presets import preset
from boatsim.physics.signals import (
    AXES,
    Array,
    Course,
    Mass,
    Motion,
    Shown,
    Swell,
    Wander,
    Wrench,
    course,
    followed,
    lagged,
    mass,
    mean_of,
    wrench,
)

__all__ = [
    "AXES",
    "UNSET",
    "Array",
    "Boat",
    "Change",
    "Channel",
    "Checked",
    "Course",
    "Effect",
    "Flow",
    "Force",
    "Inertia",
    "Mass",
    "Measurement",
    "Motion",
    "Param",
    "Reaction",
    "Recall",
    "Release",
    "Role",
    "Shown",
    "Swell",
    "Unsteady",
    "Wander",
    "Wandering",
    "Wrench",
    "course",
    "factor",
    "followed",
    "lagged",
    "mass",
    "mean_of",
    "motion",
    "number",
    "param",
    "preset",
    "shift",
    "snake_case",
    "wrench",
]


def motion(current: tuple[float, float] = (0.0, 0.0), **given: float) -> Motion:
    """Return a motion for tests and plots.

    Args:
        current: Velocity of the water, north and east [m/s]. It holds for level axes; for a hull
            that pitches give `ur`, `vr` and `wr` directly.
        given: Fields of `Motion`; the others are zero, or follow from these.
    """
    c, s = cos(given.get("psi", 0.0)), sin(given.get("psi", 0.0))
    full = dict.fromkeys(Motion._fields, 0.0)
    full |= {"cos_psi": c, "sin_psi": s, "wr": given.get("w", 0.0)}
    full["ur"] = given.get("u", 0.0) - (c * current[0] + s * current[1])
    full["vr"] = given.get("v", 0.0) - (c * current[1] - s * current[0])
    return Motion(**(full | given))
