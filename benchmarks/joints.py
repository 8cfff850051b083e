"""Print the order of convergence of MuJoCo's Runge-Kutta method: `python -m benchmarks.joints`.

A freely rotating body is integrated with a free joint and with three hinges. The result is the reason
why the hull of a vessel has slide and hinge joints.
"""

from math import log2

import mujoco
import numpy as np

from boatsim.physics.signals import Array

JOINTS = {  # joints of a body without forces, and its initial rates [rad/s]
    "free joint": ("<freejoint/>", (0.0, 0.0, 0.0, 0.3, 0.5, 0.4)),
    "three hinges": (
        '<joint axis="0 0 1"/><joint axis="0 1 0"/><joint axis="1 0 0"/>',
        (0.4, 0.5, 0.3),
    ),
}
MODEL = """<mujoco><option integrator="RK4" timestep="{step}" gravity="0 0 0"/><worldbody><body>{joints}
<inertial pos="0 0 0" mass="1" diaginertia="1 2 2.8"/></body></worldbody></mujoco>"""
STEPS = (0.08, 0.04, 0.02)  # [s]
FINE = 0.00125  # [s] step of the reference solution
DURATION = 2.0  # [s]


def final_attitude(joints: str, rates: tuple[float, ...], step: float) -> Array:
    """Return the rotation matrix (9,) of the body at the end of the run."""
    model = mujoco.MjModel.from_xml_string(MODEL.format(step=step, joints=joints))
    data = mujoco.MjData(model)
    data.qvel[:] = rates
    mujoco.mj_step(model, data, nstep=round(DURATION / step))
    mujoco.mj_kinematics(model, data)
    return np.array(data.xmat[1])


def attitude_errors(kind: str) -> list[float]:
    """Return the largest error of the rotation matrix after the run, for each of `STEPS`."""
    exact = final_attitude(*JOINTS[kind], FINE)
    return [float(np.abs(final_attitude(*JOINTS[kind], step) - exact).max()) for step in STEPS]


def main() -> None:
    """Print the errors for each step and the order of convergence."""
    for kind in JOINTS:
        found = attitude_errors(kind)
        listed = ", ".join(f"{e:.1e} at {s:g} s" for s, e in zip(STEPS, found, strict=True))
        print(f"{kind}: {listed}, order {log2(found[-2] / found[-1]):.2f}")


if __name__ == "__main__":
    main()
