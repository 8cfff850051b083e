"""Kernels of a batch, with one thread for each boat.

The text is in Warp's language; `boatsim.warp.program` writes it to a file.
"""

HEAD = '''"""A vessel's program for Warp, translated by boatsim; not meant to be edited."""

import warp as wp

wp.set_module_options({"enable_backward": False, "max_unroll": 1, "fast_math": False})
T = wp.{real}


@wp.func
def hypotenuse_(a: T, b: T):
    return wp.sqrt(a * a + b * b)


@wp.func
def with_sign_(size: T, of: T):
    return wp.abs(size) if of >= T(0.0) else -wp.abs(size)


@wp.func
def sign_of_(x: T):
    return wp.where(x > T(0.0), T(1.0), wp.where(x < T(0.0), T(-1.0), T(0.0)))


@wp.func
def remainder_(a: int, b: int):
    return ((a % b) + b) % b


@wp.func
def quotient_(a: int, b: int):
    return (a - remainder_(a, b)) / b


@wp.func
def power_2_(x: T):
    return x * x


@wp.func
def power_3_(x: T):
    return x * x * x


@wp.func
def power_4_(x: T):
    return (x * x) * (x * x)


@wp.func
def bits_(a: int, b: int, c: int, d: int):
    base = wp.uint64(65536)
    return ((wp.uint64(a) * base + wp.uint64(b)) * base + wp.uint64(c)) * base + wp.uint64(d)
'''

FORCES = '''
@wp.kernel
def add_forces(
    t: wp.array(dtype=wp.float64), part: wp.array(dtype=T), share: T, at: int,
    q: wp.array2d(dtype=T),
    qd: wp.array2d(dtype=T), act: wp.array2d(dtype=T), p: wp.array2d(dtype=T),
    k: wp.array2d(dtype=T),
    force: wp.array2d(dtype=T), M: wp.array2d(dtype=T),
):
    """Add forces and the added mass at one stage of a Runge-Kutta step."""
    i = wp.tid()
    motion_add_force_and_inertia_to_mujoco(
        T(t[i]) + share * part[i], q[i], qd[i], act[i], at,
        p[i % p.shape[0]], k[i % k.shape[0]], force[i], M[i]
    )
'''

PARTS = '''
@wp.kernel
def begin_part(
    commands: wp.array2d(dtype=T), dt: T, p: wp.array2d(dtype=T), t: wp.array(dtype=wp.float64),
    part: wp.array(dtype=T), ahead: wp.array(dtype=int), left: wp.array(dtype=T),
    least: wp.array(dtype=T),
    before: wp.array(dtype=T), memory: wp.array2d(dtype=T), act: wp.array2d(dtype=T),
):
    """Begin the next part of each boat's step, which ends where a signal jumps or bends."""
    i = wp.tid()
    t[i] = t[i] + wp.float64(part[i])
    part[i] = T(0.0)
    if left[i] <= T({enough}) and ahead[i] > 0:
        ahead[i] = ahead[i] - 1
        left[i] = dt
        least[i] = T({shortest})
        before[i] = T(0.0)
    own = i % p.shape[0]
    if left[i] > T({enough}):
        length = run_substep_length(commands[i], memory[i], left[i], least[i], p[own])
        least[i] = run_minimum_substep(length, before[i], least[i])
        before[i] = length
        run_advance_actuators(commands[i], memory[i], length, p[own], act[i])
        left[i] = left[i] - length
        part[i] = length


@wp.kernel
def rest(part: wp.array(dtype=T)):
    """Set the lengths of the parts to zero, so that the clock does not count them twice."""
    part[wp.tid()] = T(0.0)


@wp.kernel
def find_unfinished(
    ahead: wp.array(dtype=int), left: wp.array(dtype=T), unfinished: wp.array(dtype=int)
):
    """Set `unfinished` if any boat has steps left."""
    i = wp.tid()
    if left[i] > T({enough}) or ahead[i] > 0:
        unfinished[0] = 1
'''

ALONE = '''
@wp.kernel
def run_on(
    commands: wp.array2d(dtype=T), step: wp.float64, steps: int, p: wp.array2d(dtype=T),
    k: wp.array2d(dtype=T),
    none: wp.array(dtype=T), t: wp.array(dtype=wp.float64), y: wp.array2d(dtype=T),
    memory: wp.array2d(dtype=T),
    act: wp.array2d(dtype=T),
):
    """Integrate many steps without MuJoCo, as the compiled engine does."""
    i = wp.tid()
    own, mass = i % p.shape[0], i % k.shape[0]
    for j in range(steps):
        now = t[i] + wp.float64(j) * step
        dt = T(step)
        left, least, before = T(dt), T({shortest}), T(0.0)
        while left > T({enough}):
            part = run_substep_length(commands[i], memory[i], left, least, p[own])
            least = run_minimum_substep(part, before, least)
            before = T(part)
            run_advance_actuators(commands[i], memory[i], part, p[own], act[i])
            motion_step_in_place(T(now), y[i], part, act[i], p[own], k[mass], none)
            now = now + wp.float64(part)
            left = left - part
'''
