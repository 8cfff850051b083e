"""Speed comparison with other simulators: `python -m benchmarks.peers [--rounds 5] [--mss FOLDER]`.

Each pair runs the same manoeuvre for the same simulated time alternately in one process, so that
other load slows both. The table has medians over the rounds and the median of the rounds' ratios.
Simulators that are not installed are marked. `pip install "boatsim[peers]"` installs those on
PyPI; the Python vehicle simulator and MSS come from their repositories. MSS runs in GNU Octave.
"""

import argparse
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial
from math import radians
from pathlib import Path
from statistics import median
from tempfile import mkdtemp
from time import perf_counter

import numpy as np

from benchmarks.engine import COMMANDS, SHAFTS, STEP
from boatsim.hydrodynamics.mss import read_mss
from boatsim.physics import vessel
from boatsim.physics.coefficients.table import WaveLoads
from boatsim.simulate.batch import Batch
from boatsim.simulate.engine import Engine, State
from boatsim.simulate.env import load as load_env
from validation.waves.peers import mcsimpython, mss
from validation.waves.peers.comparison import loads_at, sea_of_table, waves_of

RUDDER = {"delta_rad": radians(-35.0), "n_rps": 11.8516}
ELLIPSOID = """<mujoco>
  <option timestep="{step}" gravity="0 0 0" density="1000" viscosity="0.001" integrator="RK4"/>
  <worldbody><body>
    <joint type="slide" axis="1 0 0"/><joint type="slide" axis="0 1 0"/>
    <joint type="hinge" axis="0 0 1"/>
    <inertial pos="0 0 0" mass="4.6" diaginertia="0.3 1 1.05"/>
    <geom type="ellipsoid" size="0.6 0.15 0.06" fluidshape="ellipsoid" contype="0" conaffinity="0"/>
    <site name="hull" pos="-0.5 0 0"/>
  </body></worldbody>
  <actuator><motor site="hull" gear="1 0.1 0 0 0 0.02"/></actuator>
</mujoco>"""
DRILLSHIP_SEA = {"significant_height": 0.06, "modal_period": 2.2, "drift": 1.0}  # [m], [s]
Work = Callable[[], object]


class Seconds(float):
    """Computing time that a program measured itself [s]."""


@dataclass(frozen=True)
class Pair:
    """A manoeuvre in another simulator and in one or two modes of boatsim."""

    name: str
    theirs: Work
    ours: dict[str, Work]


def compare_fossen_otter() -> Pair:
    """Return the pair for Fossen's simulator.

    The Otter starts from rest with two constant shaft speeds; Euler steps as in its own loop.
    """
    from python_vehicle_simulator.lib.gnc import attitudeEuler  # type: ignore[import-not-found]
    from python_vehicle_simulator.vehicles import otter as make  # type: ignore[import-not-found]

    seconds = 60.0
    steps = round(seconds / STEP)

    def theirs() -> None:
        boat = make()
        eta, nu, n = np.zeros(6), np.zeros(6), np.zeros(2)
        for _ in range(steps):
            nu, n = boat.dynamics(eta, nu, n, np.array([80.0, 60.0]), STEP)
            eta = attitudeEuler(eta, nu, STEP)

    made = vessel.load_vessel("otter")
    return Pair(
        "Python vehicle simulator, Otter, 60 s",
        theirs,
        boatsim_runs(made, SHAFTS, [0.0] * 12, steps),
    )


def compare_shipmmg_tanker() -> Pair:
    """Return the pair for ShipMMG: turning circle of the KVLCC2 model.

    ShipMMG uses scipy's adaptive steps, boatsim steps of 0.1 s.
    """
    from shipmmg.mmg_3dof import (  # type: ignore[import-not-found]
        Mmg3DofBasicParams,
        Mmg3DofManeuveringParams,
        simulate_mmg_3dof,
    )

    length, draught, mass, rho, seconds = 7.0, 0.46, 3270.0, 1000.0, 200.0
    unit = 0.5 * rho * length**2 * draught  # [kg]
    hull = Mmg3DofBasicParams(
        L_pp=length,
        B=1.27,
        d=draught,
        x_G=0.25,
        D_p=0.216,
        m=mass,
        I_zG=mass * (0.25 * length) ** 2,
        A_R=0.0539,
        η=0.216 / 0.345,
        m_x=0.022 * unit,
        m_y=0.223 * unit,
        J_z=0.011 * unit * length**2,
        f_α=2.747,
        ε=1.09,
        t_R=0.387,
        x_R=-0.5 * length,
        a_H=0.312,
        x_H=-0.464 * length,
        γ_R_minus=0.395,
        γ_R_plus=0.640,
        l_R=-0.71,
        κ=0.50,
        t_P=0.22,
        w_P0=0.40,
        x_P=-0.48,
    )
    polynomials = Mmg3DofManeuveringParams(
        k_0=0.2931, k_1=-0.2753, k_2=-0.1385, R_0_dash=0.022,
        X_vv_dash=-0.040, X_vr_dash=0.002, X_rr_dash=0.011, X_vvvv_dash=0.771,
        Y_v_dash=-0.315, Y_r_dash=0.083, Y_vvv_dash=-1.607, Y_vvr_dash=0.379,
        Y_vrr_dash=-0.391, Y_rrr_dash=0.008, N_v_dash=-0.137, N_r_dash=-0.049,
        N_vvv_dash=-0.030, N_vvr_dash=-0.294, N_vrr_dash=0.055, N_rrr_dash=-0.013,
    )  # fmt: skip
    times = np.linspace(0.0, seconds, 2001)
    rudder = np.full(len(times), RUDDER["delta_rad"])
    propeller = np.full(len(times), RUDDER["n_rps"])

    def theirs() -> None:
        simulate_mmg_3dof(hull, polynomials, times, rudder, propeller, u0=1.179, ρ=rho)

    made, start = vessel.load_vessel("kvlcc2_mmg"), [0.0, 0.0, 0.0, 1.179, 0.0, 0.0]
    ours = boatsim_runs(made, RUDDER, start, round(seconds / 0.1), 0.1)
    return Pair("ShipMMG, KVLCC2 turning circle, 200 s", theirs, ours)


def compare_mujoco_fluid() -> Pair:
    """Return the pair for MuJoCo's ellipsoid fluid model, at the size of the joystick boat.

    It has no added mass in its inertia and no outboards.
    """
    import mujoco

    model = mujoco.MjModel.from_xml_string(ELLIPSOID.format(step=STEP))
    data = mujoco.MjData(model)
    steps = 20_000

    def theirs() -> None:
        mujoco.mj_resetData(model, data)
        data.ctrl[0] = 0.3
        mujoco.mj_step(model, data, nstep=steps)

    ours = boatsim_runs(vessel.load_vessel("joystick_boat"), COMMANDS, [0.0] * 6, steps)
    return Pair("MuJoCo's ellipsoid in fluid, RK4, 400 s", theirs, ours)


def compare_gymnasium_boat() -> Pair:
    """Return the pair for a motor boat of Gymnasium.

    It takes one Euler step per control step; boatsim runs through dm_env with four Runge-Kutta
    steps. It is timed for as many control steps, and for as many physics steps.
    """
    import gym_sailing  # type: ignore[import-not-found] # noqa: F401
    import gymnasium

    steps = 1000
    env = gymnasium.make("Motorboat-v0").unwrapped
    action = env.action_space.sample() * 0
    own = load_env("joystick_boat/sway_1")
    held = np.zeros(own.action_spec().shape)

    def theirs() -> None:
        env.reset(seed=0)
        for _ in range(steps):
            env.step(action)

    def ours(count: int) -> None:
        own.reset()
        for _ in range(count):
            if own.step(held).last():
                own.reset()

    per_control = round(own.control_timestep() / own.physics.timestep())
    works: dict[str, Work] = {
        "dm_env": lambda: ours(steps),
        "dm_env, equal physics steps": lambda: ours(steps // per_control),
    }
    return Pair(f"gym-sailing, motor boat, {steps} control steps", theirs, works)


def compare_mcsimpython_drillship() -> Pair:
    """Return the pair for MCSimPython: its drillship adrift in 100 waves, with slow drift.

    Euler steps with one evaluation of the loads there, Runge-Kutta steps with four here.
    """
    seconds, step = 60.0, 0.05
    path, work = mcsimpython.vessel_file(), Path(mkdtemp(prefix="boatsim_peers_"))
    sea = sea_of_table(work / "loads", mcsimpython.read_vessel(path), **DRILLSHIP_SEA)
    peer = mcsimpython.wave_load(path, waves_of(sea))
    table = f'\n[[effect]]\nuse = "panel_wave_loads"\ncoefficients = "{sea.coefficients}"\n'
    for key, value in (DRILLSHIP_SEA | {"components": sea.components}).items():
        table += f"{key} = {value}\n"
    made = mcsimpython.same_vessel(work / "vessel", table)
    return Pair(
        "MCSimPython, drillship in 100 waves, 60 s",
        mcsimpython.drifting_run(peer, seconds, step),
        boatsim_runs(made, {}, [0.0] * 12, round(seconds / step), step),
    )


def compare_mss_loads(folder: Path | None) -> Pair:
    """Return the pair for MSS in Octave: loads of 100 waves at 200 times on a ship that is held.

    The time of Octave is that of its loop, without its start. Ours calls the compiled law from
    Python.

    Args:
        folder: Folder of the toolbox.
    """
    toolbox = mss.check_installed(folder)
    table, work = toolbox / mss.TABLES["tanker"], Path(mkdtemp(prefix="boatsim_peers_"))
    found = read_mss(table, 0.0, 0.0, "load")
    loads = WaveLoads(found.source, 0.0, found.frequency, found.heading, found.values)
    sea = sea_of_table(work / "loads", loads, significant_height=5.0, modal_period=12.0)
    times, psi = np.arange(0.0, 300.0, 1.5), np.array([-0.7])

    def theirs() -> Seconds:
        done = mss.run_mss(toolbox, table, work, waves_of(sea), times, psi)
        return Seconds(done.seconds)

    return Pair(
        "MSS in Octave, loads of 100 waves, 200 times",
        theirs,
        {"law called from Python": lambda: loads_at(sea, times, -0.7)},
    )


def boatsim_runs(
    made: vessel.Vessel,
    commands: dict[str, float],
    start: list[float],
    steps: int,
    step: float = STEP,
) -> dict[str, Work]:
    """Return runs of the compiled engine and of the MuJoCo engine under constant commands."""
    compiled, engine = Batch(made, step=step), Engine(made, step=step, show=False)
    moving = State(u=start[len(start) // 2])

    def on_mujoco() -> None:
        engine.reset(moving, commands)
        engine.advance_without_actuators(steps)

    return {
        "twin": lambda: compiled.hold_commands(start, commands, steps),
        "engine": on_mujoco,
    }


PEERS: dict[str, Callable[[], Pair]] = {
    "Python vehicle simulator": compare_fossen_otter,
    "ShipMMG": compare_shipmmg_tanker,
    "MuJoCo's ellipsoid in fluid": compare_mujoco_fluid,
    "gym-sailing": compare_gymnasium_boat,
    "MCSimPython": compare_mcsimpython_drillship,
}


def wall_time(work: Work) -> float:
    """Return the wall time, or the computing time that the program measured itself [s]."""
    begin = perf_counter()
    done = work()
    if isinstance(done, Seconds):
        return done
    return perf_counter() - begin


def table_lines(pair: Pair, rounds: int) -> Iterator[str]:
    """Return the lines of the table: the other simulator, then each mode and its speed-up."""
    works = {"theirs": pair.theirs, **pair.ours}
    for work in works.values():
        work()  # import and compile before the time is measured
    seconds = {name: [wall_time(work)] for name, work in works.items()}
    for _ in range(rounds - 1):
        for name, work in works.items():
            seconds[name].append(wall_time(work))
    yield f"{pair.name:44}{1e3 * median(seconds['theirs']):12.3g}"
    for name in pair.ours:
        ratio = median(a / b for a, b in zip(seconds["theirs"], seconds[name], strict=True))
        yield f"{'  boatsim, ' + name:44}{1e3 * median(seconds[name]):12.3g}{ratio:12.3g}"


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--mss", type=Path, help="folder of the MSS toolbox")
    given = parser.parse_args()
    peers = PEERS | {"MSS": partial(compare_mss_loads, given.mss)}
    print(f"{'':44}{'[ms]':>12}{'times as':>12}\n{'':44}{'':12}{'fast':>12}")
    for name, made in peers.items():
        try:
            pair = made()
        except ImportError as missing:
            print(f"{name:44}not installed ({missing})")
            continue
        print("\n".join(table_lines(pair, given.rounds)), flush=True)


if __name__ == "__main__":
    main()
