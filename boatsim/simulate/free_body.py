"""A floating body free in all six ways on MuJoCo, with exact added mass; everything else is a force of the caller's.

Poses and velocities are SNAME: z down, Euler angles roll, pitch, yaw; MuJoCo's model is z up, which is half a turn
about x. The vessels of `boatsim.simulate.engine` have no use for heave and pitch and take their laws compiled.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import mujoco
import numpy as np

from boatsim.errors import BadPhysics
from boatsim.physics.base import Array
from boatsim.simulate.engine import installed, no_callback

DOWN = np.diag([1.0, -1.0, -1.0])  # z up to z down and back
LOWER = np.tril_indices(6)  # how MuJoCo keeps the mass matrix

Law = Callable[[float, Array, Array], Array]  # t [s], pose (6,), velocity (6,) in body axes -> force (6,) at the origin


@dataclass(frozen=True)
class Solid:
    """What moves: a rigid body and the water with it, about an origin fixed in the body."""

    mass: float  # [kg]
    centre: Array  # (3,) m, of mass
    inertia: Array  # (3,) kg m^2, about the mass centre along x, y, z
    added: Array  # (6, 6) kg, kg m, kg m^2


class FreeBody:
    """Steps a body from rest at the origin, or from where `put` has it."""

    def __init__(self, solid: Solid, law: Law, step: float = 0.02) -> None:
        """`step` [s] of the fourth-order Runge-Kutta method. Raises BadPhysics for a mass matrix that is not full."""
        self.solid, self.law = solid, law
        with no_callback():
            self.model = _model(solid, step)
        if list(self.model.M_rownnz) != [1, 2, 3, 4, 5, 6]:
            raise BadPhysics("free body: its mass centre must not be its origin, or MuJoCo keeps only the diagonal")
        self.data = mujoco.MjData(self.model)

    def put(self, pose: Array, velocity: Array) -> None:
        """Pose (x, y, z, roll, pitch, yaw) and velocity (u, v, w, p, q, r) now."""
        turn = DOWN @ rotation(pose[3:]) @ DOWN
        self.data.qpos[:3] = DOWN @ pose[:3]
        mujoco.mju_mat2Quat(self.data.qpos[3:], turn.flatten())
        self.data.qvel[:3], self.data.qvel[3:] = turn @ DOWN @ velocity[:3], DOWN @ velocity[3:]

    def advance(self, steps: int = 1) -> None:
        """Step forward. Raises BadPhysics if the motion is no longer finite."""
        with installed(self._passive):
            mujoco.mj_step(self.model, self.data, nstep=steps)
        if not np.isfinite(self.data.qpos).all():
            raise BadPhysics(f"free body: the motion is no longer finite at t = {self.data.time:g} s")

    @property
    def pose(self) -> Array:
        """(6,) x, y, z [m], roll, pitch, yaw [rad]."""
        return _pose(self.data)

    @property
    def velocity(self) -> Array:
        """(6,) u, v, w [m/s], p, q, r [rad/s]."""
        return np.asarray(_jacobian(self.data) @ self.data.qvel)

    def _passive(self, model: Any, data: Any) -> None:
        """Add J^T M J to MuJoCo's inertia; force, less what the added mass needs besides its acceleration, to its own.

        With nu = J q', M nu' + C(nu) nu = f is J^T M J q'' = J^T (f - C(nu) nu - M (dJ/dt) q').
        """
        J = _jacobian(data)
        nu, M = J @ data.qvel, self.solid.added
        turning = np.array([*cross(nu[3:], nu[:3]), 0.0, 0.0, 0.0])  # less the change of J times q'
        data.qfrc_passive += J.T @ (self.law(data.time, _pose(data), nu) - coriolis(M @ nu, nu) + M @ turning)
        data.M += (J.T @ M @ J)[LOWER]
        mujoco.mj_factorM(model, data)


def coriolis(momentum: Array, nu: Array) -> Array:
    """C(nu) nu (6,) of an inertia with that momentum M nu (Fossen 2021, eq. 3.46)."""
    a, b, v, w = momentum[:3], momentum[3:], nu[:3], nu[3:]
    return np.concatenate([cross(w, a), cross(v, a) + cross(w, b)])


def cross(a: Array, b: Array) -> Array:
    """Vector product; numpy's own takes ten times as long for three numbers."""
    return np.array([a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]])


def rotation(euler: Array) -> Array:
    """Body axes to earth axes of roll, pitch, yaw."""
    (cf, ct, cp), (sf, st, sp) = np.cos(euler), np.sin(euler)
    return np.array(
        [
            [cp * ct, cp * st * sf - sp * cf, sp * sf + cp * st * cf],
            [sp * ct, cp * cf + sp * st * sf, sp * st * cf - cp * sf],
            [-st, ct * sf, ct * cf],
        ]
    )


def angles(turn: Array) -> Array:
    """Roll, pitch, yaw (3,) of a rotation, the inverse of `rotation`."""
    return np.array([np.arctan2(turn[2, 1], turn[2, 2]), -np.arcsin(turn[2, 0]), np.arctan2(turn[1, 0], turn[0, 0])])


def _pose(data: Any) -> Array:
    """(6,) z down."""
    return np.concatenate([DOWN @ data.qpos[:3], angles(DOWN @ _turn(data) @ DOWN)])


def _turn(data: Any) -> Array:
    """(3, 3) body to world axes, z up, of the present quaternion."""
    out = np.empty(9)
    mujoco.mju_quat2Mat(out, data.qpos[3:] / np.linalg.norm(data.qpos[3:]))
    return out.reshape(3, 3)


def _jacobian(data: Any) -> Array:
    """(6, 6) body velocity, z down, per MuJoCo's rates: translation in world axes, rotation in body axes, z up."""
    J = np.zeros((6, 6))
    J[:3, :3], J[3:, 3:] = DOWN @ _turn(data).T, DOWN
    return J


def _model(solid: Solid, step: float) -> Any:
    """One body on a free joint, without gravity: buoyancy is the caller's."""
    spec = mujoco.MjSpec()
    spec.option.timestep, spec.option.gravity = step, (0, 0, 0)
    spec.option.integrator = mujoco.mjtIntegrator.mjINT_RK4
    spec.option.disableflags |= mujoco.mjtDisableBit.mjDSBL_AUTORESET
    body = spec.worldbody.add_body(name="body")
    body.add_freejoint()
    body.explicitinertial = True
    body.mass, body.ipos, body.inertia = solid.mass, DOWN @ solid.centre, solid.inertia
    return spec.compile()
