"""Loads that make a vessel move in waves as a table of response amplitude operators states."""

import numpy as np

from boatsim.control.linear_model import LinearModel
from boatsim.errors import BadInput
from boatsim.physics.base import AXES, Array
from boatsim.physics.particulars import GRAVITY
from boatsim.physics.vessel import Vessel
from boatsim.physics.waves.sea_parameters import SeaParameters
from boatsim.simulate.linearisation import linear_model
from boatsim.simulate.steady_motion import find_steady_motion
from boatsim.simulate.wave_response import Complex

POSES = dict(zip(AXES, ("x", "y", "z", "phi", "theta", "psi"), strict=True))
# [rad/s] times sqrt(L / g): the lowest frequency of encounter at which the response is taken. A
# vessel without springs in surge, sway or yaw has no response to a steady force.
LOWEST = 1e-6


def force_response(vessel: Vessel, frequency: Array, speed: float = 0.0) -> Complex:
    """Return the motion of a vessel per force on its hull, from its linear equations.

    The equations are those about the steady motion at the speed, with memory of radiated waves. The
    waves of the vessel are left out.

    Args:
        vessel: The vessel.
        frequency: Angular frequencies (...) of the force [rad/s].
        speed: Forward speed [m/s].

    Returns:
        Complex motion (..., D, D) of each degree of freedom per force in each, for the time
        dependence exp(i w t).

    Raises:
        BadInput: There is no steady motion.
    """
    model = _linear_model(vessel, speed)
    poses = [POSES[axis] for axis in vessel.dof]
    rows = [model.state(name) for name in poses]
    axes = {one.group: k for k, one in enumerate(model.forces)}
    columns = model.e[:, [axes[axis] for axis in vessel.dof]]
    scale = np.array([one.scale for one in model.states])
    a, e = model.a * scale / scale[:, None], columns / scale[:, None]
    flat = np.atleast_1d(frequency).ravel()
    pencil = 1j * flat[:, None, None] * np.eye(len(scale)) - a
    found = np.linalg.solve(pencil, np.broadcast_to(e, (len(flat), *e.shape)))
    motion = (found * scale[:, None])[:, rows]
    return np.asarray(motion.reshape(*np.shape(frequency), len(rows), len(rows)))


def _linear_model(vessel: Vessel, speed: float) -> LinearModel:
    for effect in vessel.effects:
        if isinstance(effect, SeaParameters):
            vessel = vessel.without_effect(effect.name)
    if speed > 0.0:
        steady = find_steady_motion(vessel, speed=speed)
    else:
        neutral = {name: channel.neutral for name, channel in vessel.commands.items()}
        rest = 0.0 if "surge" in vessel.dof else None
        steady = find_steady_motion(vessel, neutral, rest)
    return linear_model(vessel, steady, position=True)


def loads_of_motion(
    vessel: Vessel,
    frequency: Array,
    heading: Array,
    motion: Complex,
    number: Array,
    speed: float = 0.0,
) -> tuple[Complex, tuple[str, ...]]:
    """Return the loads that cause given motions of a vessel in regular waves.

    The vessel responds at the frequency of encounter w - k U cos(heading). In degrees of freedom
    whose motion is not given there is no load, and the vessel moves as its coupling requires.

    Args:
        vessel: The vessel.
        frequency: Frequencies of the waves (N,) [rad/s].
        heading: Directions to which the waves run (H,) [rad].
        motion: Complex motion (N, H, 6) per amplitude; nan in axes that are not given.
        number: Wave numbers (N,) [rad/m].
        speed: Forward speed U [m/s].

    Returns:
        Complex loads (N, H, 6) per amplitude [N/m, N], and the axes that have a load.

    Raises:
        BadInput: The vessel is free in none of the axes, or has no steady motion.
    """
    known = np.asarray(~np.isnan(motion).any(axis=(0, 1)))
    axes = [i for i, axis in enumerate(AXES) if known[i] and axis in vessel.dof]
    if not axes:
        given = [axis for i, axis in enumerate(AXES) if known[i]]
        raise BadInput(
            f"{vessel.name} is free in {', '.join(vessel.dof)}; the table has {', '.join(given)}"
        )
    encounter = frequency[:, None] - speed * np.outer(number, np.cos(heading))
    least = LOWEST * np.sqrt(GRAVITY / vessel.length)
    encounter = np.where(np.abs(encounter) < least, least, encounter)
    places = [vessel.dof.index(AXES[i]) for i in axes]
    response = force_response(vessel, encounter, speed)[..., places, :][..., places]
    loads = np.zeros(motion.shape, dtype=complex)
    loads[..., axes] = np.linalg.solve(response, motion[..., axes, None])[..., 0]
    return loads, tuple(AXES[i] for i in axes)
