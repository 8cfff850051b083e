"""Axes along which an identified effect acts, on which another force could take its place."""

import numpy as np

from boatsim.diagnosis.filter import MappedRecording, dof_in_state_order
from boatsim.diagnosis.locate.nominal_forces import actuator_states, body_forces
from boatsim.diagnosis.locate.smoothing import latent_force
from boatsim.diagnosis.problem import Fit, Problem
from boatsim.physics.base import Array, CoefficientRelease, Effect, Inertia

# Numbers of a vessel whose change acts with the acceleration, which the forces along a given motion
# do not contain
NUMBERS_OF_MASS = ("inertia", "added_mass", "mass_centre")


def effect_axes(problem: Problem, fit: Fit, name: str) -> tuple[str, ...]:
    """Return the axes along which an effect acts clearly; all axes if that is not known.

    The rms of its force along an axis counts relative to the level of the latent force there. An
    error of an instrument and a stochastic force exert none along a given motion, and an effect
    that changes the mass acts with the acceleration.

    Args:
        problem: The estimation problem: recordings, vessel model, candidate effects and priors.
        fit: Fit of the vessel model with the effect.
        name: Name of the effect.
    """
    axes = dof_in_state_order(problem.program.vessel)
    if _changes_mass(problem.candidates[name]):
        return tuple(axes)
    squares = np.zeros(len(axes))
    for mapped in problem.recordings:
        squares += np.sum(_force_of_effect(problem, fit, mapped, name) ** 2, axis=0)
    sizes = np.sqrt(squares) / fit.levels.force
    largest = float(np.max(sizes))
    if not largest > 0.0:
        return tuple(axes)
    least = problem.config.decide.least_axis_share * largest
    return tuple(axis for axis, size in zip(axes, sizes, strict=True) if size >= least)


def _changes_mass(effect: Effect) -> bool:
    """Whether an effect adds a mass, or changes a number of the vessel that acts as one."""
    if isinstance(effect, CoefficientRelease):
        return effect.refines in NUMBERS_OF_MASS
    return isinstance(effect, Inertia)


def _force_of_effect(problem: Problem, fit: Fit, mapped: MappedRecording, name: str) -> Array:
    """(N, axes) force of an effect along the smoothed motion of a recording [N, N m]."""
    states = np.ascontiguousarray(latent_force(problem, fit, mapped, fit.levels).states)
    values = problem.parameter_vector(mapped, fit.free, fit.theta)
    others = tuple(effect for effect in fit.effects if effect != name)
    forces = []
    for effects in (fit.effects, others):
        held = actuator_states(mapped, effects, values)
        forces.append(body_forces(mapped, states, held, values, effects))
    return np.asarray(forces[0] - forces[1])
