"""Linear models of Martin's fishing vessels, their seas, and MuJoCo's error.

Run `python -m benchmarks.martin_vessels`. It prints the coefficients of every condition, the rms
response of the ships to the thesis' seas, the largest difference of MuJoCo from the exact step of
the linear model, and processor time per simulated time. It takes about ten seconds once the vessels
are compiled.
"""

from math import degrees, pi, radians, sqrt
from time import process_time

import numpy as np
from rich.console import Console
from rich.table import Table
from scipy.linalg import expm

from boatsim.physics import vessel
from boatsim.physics.base import AXES, Array, Force, Wrench, make_motion
from boatsim.physics.effects.irregular_sea import IrregularSea
from boatsim.physics.vessel import Vessel
from boatsim.simulate.engine import Engine, State

PERIOD = 0.5  # [s] of the autopilots
REALISATIONS = 2000
# condition, angle of encounter [deg], significant height [m] (0: by resonance), modal period [s]
SEAS = (
    (4, 90, 0.0, 0.0), (3, 45, 0.88, 7.5), (1, 60, 0.88, 7.5), (2, 30, 1.88, 8.8),
)  # fmt: skip
WAVES = ("yaw", "sway", "roll")  # dof in which they act


def mass_matrix(boat: Vessel) -> Array:
    """Return the mass matrix (3, 3) over (yaw, sway, roll), with added mass."""
    body, water = boat.body, boat.effect("added_mass")
    at = [AXES.index(axis) for axis in WAVES]
    hull = np.diag([body.yaw_inertia, body.mass, body.roll_inertia])
    return np.asarray(hull + water.matrix()[np.ix_(at, at)])  # type: ignore[union-attr]


def figures() -> dict[str, float]:
    """Return the rudder area of Eastward Ho over its length squared, by condition of loading."""
    found = {}
    for condition in (1, 3):
        boat = vessel.load_vessel("eastward_ho", [f"condition_{condition}"])
        rudder = boat.effect("rudder")
        area = rudder.values()[list(type(rudder).params()).index("area")]
        found[f"rudder area over length squared, condition {condition}"] = area / boat.length**2
    return found


def speed_of(boat: Vessel) -> float:
    """Return the speed that the vessel holds [m/s]."""
    return float(boat.effect("speed_hold").speed)  # type: ignore[union-attr]


def force_at_approach_speed(boat: Vessel, **moved: float) -> Array:
    """Return yaw moment, sway force and roll moment at the approach speed.

    The hull's own Coriolis force is included.
    """
    angle = {"angle": moved.pop("rudder", 0.0)}
    m = make_motion(**{"u": speed_of(boat), **moved})
    forces = []
    for e in boat.effects:
        if isinstance(e, Force):
            forces.append(e.wrench(m, **(angle if type(e).roles else {})))
    w = Wrench(*np.sum(forces, axis=0))
    return np.array([w.N, w.Y - boat.body.mass * speed_of(boat) * m.r, w.K])


def linear_model(boat: Vessel) -> tuple[Array, Array, Array]:
    """Return the continuous linear model.

    Returns:
        A (5, 5) over (psi, r, v, phi, p), B (5,) of the rudder, and K (5, 3) of waves as (yaw,
        sway, roll).
    """
    rates = {}
    for n in ("r", "v", "phi", "p", "rudder"):
        rates[n] = np.linalg.solve(mass_matrix(boat), force_at_approach_speed(boat, **{n: 1.0}))
    A, K, mass = np.zeros((5, 5)), np.zeros((5, 3)), mass_matrix(boat).diagonal()
    A[0, 1] = A[3, 4] = K[1, 0] = K[2, 1] = K[4, 2] = 1.0
    A[np.ix_([1, 2, 4], [1, 2, 3, 4])] = np.column_stack([rates[n] for n in ("r", "v", "phi", "p")])
    K[4, 1] = boat.effect("linear_hull").arm * mass[1] / mass[2]  # type: ignore[union-attr]
    return A, np.array([0, *rates["rudder"][:2], 0, rates["rudder"][2]]), K


def discretise(A: Array, B: Array, period: float = PERIOD) -> tuple[Array, Array]:
    """Return A and B (5, n) over a period [s] with the inputs held."""
    n = B.shape[1]
    block = np.zeros((5 + n, 5 + n))
    block[:5, :5], block[:5, 5:] = A, B
    whole = expm(period * block)
    return whole[:5, :5], whole[:5, 5:]


def simulate_zigzag(boat: Vessel, waves: Array) -> tuple[Array, Array]:
    """Return states (N + 1, 5) and rudder angles (N,) of a 10/10 zig-zag by exact steps.

    The wave accelerations (N, 3) are held over each step.
    """
    A, B, K = linear_model(boat)
    step, drive = discretise(A, np.column_stack([B, K]))
    x, side, states, rudder = np.zeros(5), radians(10.0), [np.zeros(5)], []
    for w in waves:
        if abs(x[0]) > radians(10.0):
            side = -radians(10.0) * float(np.sign(x[0]))
        rudder.append(side)
        x = step @ x + drive @ [side, *w]
        states.append(x)
    return np.array(states), np.array(rudder)


def random_waves() -> Array:
    """Sample accelerations (N, 3) in yaw, sway, roll for 120 s, new every period.

    Units: rad/s^2, m/s^2, rad/s^2.
    """
    return np.radians([1.0, 5.0, 2.0]) * np.random.default_rng(1).standard_normal((240, 3))


def simulate_on_mujoco(boat: Vessel, rudder: Array, waves: Array, step: float = 0.02) -> Array:
    """Return the states (N + 1, 5) of the same run in MuJoCo."""
    engine, mass = Engine(boat, step=step), mass_matrix(boat).diagonal()
    engine.reset(State(u=speed_of(boat)))
    at, rows = [engine.program.parameter_index("push", n) for n in WAVES], [[0.0] * 5]
    for angle, wave in zip(rudder, waves, strict=True):
        engine._values[at] = wave * mass
        engine._write_userdata()
        engine.command({"rudder_rad": float(angle)})
        engine.advance(round(PERIOD / step))
        s = engine.state
        rows.append([s.psi, s.r, s.v, s.phi, s.p])
    return np.array(rows)


def rms_accelerations(boat: Vessel, sea: IrregularSea) -> tuple[list[float], float]:
    """Return rms accelerations over realisations, and rms slope [deg].

    The accelerations are yaw, sway and direct roll [deg/s^2].
    """
    m = make_motion()
    w = Wrench(*np.array([sea.with_seed(i).wrench(m) for i in range(REALISATIONS)]).T)
    direct = w.K - sea.arm * w.Y
    parts = zip((w.N, w.Y, direct), mass_matrix(boat).diagonal(), strict=True)
    slope = direct.std() / (sea.stiffness * abs(np.sin(sea.toward)))
    return [degrees(a.std() / b) for a, b in parts], degrees(slope)


def sea_for_condition(boat: Vessel, angle: float, height: float, period: float) -> IrregularSea:
    """Return the thesis' sea for a condition.

    The beam sea has the roll period, and a height of a hundredth of its length.
    """
    A = linear_model(boat)[0]
    period = period or 2 * pi / sqrt(-A[4, 3])
    height = height or 0.01 * 9.81 * period**2 / (2 * pi)
    own = boat.effect("irregular_sea")
    assert isinstance(own, IrregularSea)
    return own.with_values(
        {
            "significant_height": height,
            "modal_period": period,
            "toward": radians(angle),
            "flat": float(angle == 90),
        }
    )


def coefficient_table() -> Table:
    """Return the table of the linear model of every condition."""
    names = (
        "a_rr",
        "a_rv",
        "a_rphi",
        "a_vr",
        "a_vv",
        "a_pr",
        "a_pv",
        "a_pphi",
        "b_r",
        "b_v",
        "b_p",
    )
    table = Table("vessel", "V [m/s]", *names, "T_phi [s]", "zeta", title="rates of (r, v, p)")
    for name, condition in ((n, c) for n in ("kynoc", "eastward_ho") for c in range(1, 5)):
        boat = vessel.load_vessel(name, [f"condition_{condition}"])
        A, B, _ = linear_model(boat)
        rows = [*A[1, 1:4], *A[2, 1:3], *A[4, 1:4], B[1], B[2], B[4]]
        w = sqrt(-A[4, 3])
        last = (f"{2 * pi / w:.2f}", f"{-A[4, 4] / (2 * w):.3f}")
        table.add_row(
            f"{name} {condition}", f"{speed_of(boat):.3f}", *(f"{a:.4f}" for a in rows), *last
        )
    return table


def sea_response_table() -> Table:
    """Return the table of the response of the ships to the thesis' seas."""
    table = Table(
        "vessel", "encounter", "yaw", "sway", "direct roll", "slope [deg]", title="rms [deg/s^2]"
    )
    for name in ("kynoc", "eastward_ho"):
        for condition, angle, height, period in SEAS:
            boat = vessel.load_vessel(name, [f"condition_{condition}"])
            found, slope = rms_accelerations(boat, sea_for_condition(boat, angle, height, period))
            table.add_row(
                f"{name} {condition}", f"{angle} deg", *(f"{a:.2f}" for a in found), f"{slope:.2f}"
            )
    return table


def main() -> None:
    """Print all results."""
    console = Console(width=150)
    console.print(coefficient_table(), sea_response_table())
    boat = vessel.load_vessel("eastward_ho", ["condition_3"])
    truth, rudder = simulate_zigzag(boat, random_waves())
    for step in (0.02, 0.1):
        off = np.degrees(
            np.abs(simulate_on_mujoco(boat, rudder, random_waves(), step) - truth).max(axis=0)
        )
        console.print(
            f"120 s zig-zag in random waves, RK4 at {step} s: yaw {off[0]:.1e} deg, roll "
            f"{off[3]:.1e} deg"
        )
    engine = Engine(
        vessel.load_vessel(
            "eastward_ho", ["condition_3"], {"irregular_sea": {"significant_height": 0.88}}
        ),
        step=0.1,
    )
    engine.reset(State(u=6.68777))
    start = process_time()
    engine.advance(6000)
    console.print(
        f"600 s in 160 waves, steps of 0.1 s: {process_time() - start:.2f} s of processor time"
    )


if __name__ == "__main__":
    main()
