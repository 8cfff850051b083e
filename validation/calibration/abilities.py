"""False names with further abilities: `python -m validation.calibration.abilities --out DIR`.

The campaign of `validation.calibration` has planar boats with poses and commands. The candidates
that need groups of recordings, a craft without water, more than two drives, recorded velocities or
a measured wave are not tested there. Each trial here is one of three bodies with two fitted runs
and a held-out one. Nothing is missing in its vessel file: only ambient forces, noise, and damping
and thrust that differ within the stated uncertainty. Every name is therefore a false one.

The motion is integrated from formulas in earth-fixed and body axes, without boatsim. Each trial
writes one JSON file; an interrupted campaign goes on where it stopped.
"""

import argparse
import json
import tempfile
import time
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import tomlkit
from numpy.typing import NDArray
from scipy.signal import lfilter

from boatsim.diagnosis import pipeline
from boatsim.diagnosis.answer.schema import Answer
from boatsim.errors import BadInput
from boatsim.physics.vessel import Vessel
from boatsim.recordings.table import Recording, write_csv
from validation.calibration.table import share

Array = NDArray[np.float64]
Rng = np.random.Generator
GRAVITY = 9.81  # [m/s^2]
AMBIENT = 2.2e-4  # rms of the ambient force, in weights, as in the practice set
AMBIENT_TIME = 1.0  # [s] its correlation time on a hull of 1.2 m
LEVER = 0.25  # [lengths] of the ambient moment
CALIBRATION = 0.03  # relative sd of damping and thrust about the vessel file
SUBSTEPS = 4  # Runge-Kutta steps in one row
RUNS = 3
POSE = ("x_m", "y_m", "psi_rad")

# places ahead and to starboard [m] and directions [rad] of fans that push one way only
FANS = {
    "a1": (0.044, 0.015, 0.5 * np.pi),
    "a2": (0.044, -0.015, -0.5 * np.pi),
    "b1": (-0.009, -0.045, -np.pi / 6),
    "b2": (-0.035, -0.03, 5 * np.pi / 6),
    "c1": (-0.035, 0.03, -5 * np.pi / 6),
    "c2": (-0.009, 0.045, np.pi / 6),
}
OPPOSITE = [1, 0, 3, 2, 5, 4]  # fan that pushes against each one
# of four thrusters that push both ways
CORNERS = {
    "port_bow": (0.5, -0.2, 0.5),
    "starboard_bow": (0.5, 0.2, -0.5),
    "port_stern": (-0.5, -0.2, -0.5),
    "starboard_stern": (-0.5, 0.2, 0.5),
}


@dataclass(frozen=True)
class Body:
    """A body: its vessel file, the times of a run, and how a run is simulated.

    Attributes:
        vessel: The vessel, without anything missing.
        times: Times (N,) of the rows [s].
        noise: Standard deviation of the instruments, by their names in recording.toml.
        run: Returns the signals of one run from a random generator and factors of the
            coefficients of damping and thrust.
        coefficients: Number of those factors.
    """

    vessel: Vessel
    times: Array
    noise: Mapping[str, float]
    run: Callable[[Rng, Array], dict[str, Array]]
    coefficients: int


def ambient(rng: Rng, times: Array, mass: float, length: float, arms: Sequence[float]) -> Array:
    """Return ambient forces (N, len(arms)): a first-order process in each axis.

    Args:
        rng: Random generator.
        times: Times (N,) [s].
        mass: Mass of the body [kg].
        length: Length of the body [m], which scales the correlation time.
        arms: Lever of each axis [m]; 1 for forces.
    """
    keep = np.exp(-(times[1] - times[0]) / (AMBIENT_TIME * np.sqrt(length / 1.2)))
    white = rng.standard_normal((len(times), len(arms))) * np.sqrt(1.0 - keep**2)
    white[0] /= np.sqrt(1.0 - keep**2)
    size = AMBIENT * mass * GRAVITY * np.array(arms)
    return np.asarray(lfilter([1.0], [1.0, -keep], white, axis=0) * size)


def integrate(rates: Callable[[Array, int], Array], start: Array, times: Array) -> Array:
    """Return the states (N, S) at given times, by Runge-Kutta steps of fourth order.

    Args:
        rates: Returns the rates of the state (S,) during row i.
        start: State (S,) at the first time.
        times: Times (N,) [s].
    """
    states = [start]
    h = (times[1] - times[0]) / SUBSTEPS
    for i in range(len(times) - 1):
        s = states[-1]
        for _ in range(SUBSTEPS):
            k1 = rates(s, i)
            k2 = rates(s + 0.5 * h * k1, i)
            k3 = rates(s + 0.5 * h * k2, i)
            k4 = rates(s + h * k3, i)
            s = s + h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4)
        states.append(s)
    return np.array(states)


def steps(rng: Rng, times: Array, seconds: float, low: float, high: float, count: int) -> Array:
    """Return commands (N, count) that are constant for some seconds."""
    at = (times / seconds).astype(int)
    return np.asarray(rng.uniform(low, high, (at[-1] + 1, count))[at])


def planar_forces(places: Mapping[str, tuple[float, float, float]], thrust: Array) -> Array:
    """Return surge force, sway force and yaw moment (N, 3) of fixed thrusters."""
    x, y, angle = np.array(list(places.values())).T
    X, Y = np.cos(angle), np.sin(angle)
    return np.asarray(thrust @ np.column_stack([X, Y, x * Y - y * X]))


def thrusters(places: Mapping[str, tuple[float, float, float]]) -> list[dict[str, object]]:
    """Return the tables of fixed thrusters."""
    found: list[dict[str, object]] = []
    for name, (x, y, angle) in places.items():
        on = {"thrust": f"{name}_N", "angle": float(angle)}
        found.append({"use": "thruster", "name": name, "on": on, "x": x, "y": y})
    return found


def hovercraft() -> Body:
    """A craft without water and damping, six fans that push one way, poses only."""
    mass, inertia, length = 0.14, 5e-4, 0.12
    times = np.arange(0.0, 22.5, 0.025)
    noise = {"position_sd_m": 3e-4, "heading_sd_rad": 2e-3}
    facts = {"no_water": True, "indoors": True, "moored": False, "position_fix": "tracking"}
    vessel = Vessel.from_effects(
        name="trial_hovercraft",
        dof=("surge", "sway", "yaw"),
        length=length,
        beam=0.12,
        draught=0.01,
        body={"mass": mass, "roll_inertia": 3e-4, "yaw_inertia": inertia},
        effects=thrusters(FANS),
        channels={f"{fan}_N": {"low": 0.0, "high": 0.7} for fan in FANS},
        diagnosis={"facts": facts},
    )

    def run(rng: Rng, factors: Array) -> dict[str, Array]:
        commands = steps(rng, times, 0.25, 0.0, 0.25, len(FANS))
        braking = np.roll(commands[:, OPPOSITE], 10, axis=0)  # the step before, reversed
        second = (times / 0.25).astype(int) % 2 == 1
        commands = np.where(second[:, None], braking, commands)
        forces = factors[0] * planar_forces(FANS, commands)
        forces += ambient(rng, times, mass, length, (1.0, 1.0, LEVER * length))

        def rates(s: Array, i: int) -> Array:
            X, Y, N = forces[i]
            c, k = np.cos(s[2]), np.sin(s[2])
            north, east = (X * c - Y * k) / mass, (X * k + Y * c) / mass
            return np.array([s[3], s[4], s[5], north, east, N / inertia])

        pose = integrate(rates, np.zeros(6), times)[:, :3]
        pose += rng.standard_normal(pose.shape) * [3e-4, 3e-4, 2e-3]
        signals = dict(zip(POSE, pose.T, strict=True))
        return signals | {f"{fan}_N": commands[:, i] for i, fan in enumerate(FANS)}

    return Body(vessel, times, noise, run, 1)


def boat() -> Body:
    """A boat with four thrusters, and with recorded velocities."""
    mass, inertia, length = 20.0, 4.0, 1.4
    added = np.array([1.5, 15.0, 2.0])
    damping = np.array([12.0, 40.0, 6.0])
    times = np.arange(0.0, 120.0, 0.2)
    noise = {"position_sd_m": 0.02, "heading_sd_rad": 0.01}
    noise |= {"speed_sd_mps": 0.01, "yaw_rate_sd_radps": 0.005}
    vessel = Vessel.from_effects(
        name="trial_four_thrusters",
        dof=("surge", "sway", "yaw"),
        length=length,
        beam=0.6,
        draught=0.1,
        body={"mass": mass, "roll_inertia": 0.7, "yaw_inertia": inertia},
        effects=[
            {"use": "added_mass", "surge": added[0], "sway": added[1], "yaw": added[2]},
            {"use": "linear_damping", **dict(zip(("surge", "sway", "yaw"), damping, strict=True))},
            *thrusters(CORNERS),
        ],
        channels={f"{name}_N": {"low": -4.0, "high": 4.0} for name in CORNERS},
        diagnosis={"facts": {"position_fix": "gnss"}},
    )
    M = np.array([mass, mass, inertia]) + added

    def run(rng: Rng, factors: Array) -> dict[str, Array]:
        commands = steps(rng, times, 6.0, -2.0, 4.0, len(CORNERS))
        forces = factors[3] * planar_forces(CORNERS, commands)
        forces += ambient(rng, times, mass, length, (1.0, 1.0, LEVER * length))

        def rates(s: Array, i: int) -> Array:
            u, v, r = s[3:]
            c, k = np.cos(s[2]), np.sin(s[2])
            turning = np.array([M[1] * v * r, -M[0] * u * r, (M[0] - M[1]) * u * v])
            speeds = (forces[i] + turning - factors[:3] * damping * s[3:]) / M
            return np.array([u * c - v * k, u * k + v * c, r, *speeds])

        states = integrate(rates, np.zeros(6), times)
        states += rng.standard_normal(states.shape) * [0.02, 0.02, 0.01, 0.01, 0.01, 0.005]
        names = (*POSE, "u_mps", "v_mps", "r_radps")
        signals = dict(zip(names, states.T, strict=True))
        return signals | {f"{name}_N": commands[:, i] for i, name in enumerate(CORNERS)}

    return Body(vessel, times, noise, run, 4)


def section() -> Body:
    """A guided section that heaves, rolls and sways freely beside a small measured wave."""
    mass, inertia, length = 46.8, 0.97, 0.6
    added = np.array([37.0, 33.0, 0.19])  # sway, heave, roll
    damping = np.array([24.0, 4.3, 0.035])  # so small that it still moves at the end
    stiffness = np.array([0.0, 2299.0, 28.9])
    times = np.arange(0.0, 40.0, 0.1)
    noise = {"position_sd_m": 5e-4, "heave_sd_m": 5e-4, "roll_sd_rad": 2e-3}
    axes = ("sway", "heave", "roll")
    facts = {"guided": True, "indoors": True, "forward_speed_mps": 0.0}
    vessel = Vessel.from_effects(
        name="trial_section",
        dof=axes,
        length=length,
        beam=0.4,
        draught=0.2,
        body={"mass": mass, "roll_inertia": inertia, "yaw_inertia": 1.35},
        effects=[
            {"use": "added_mass", "surge": 0.0, "yaw": 0.0, **dict(zip(axes, added, strict=True))},
            {"use": "hydrostatics", "heave": 2299.0, "roll": 28.9, "vertical": 1.0},
            {"use": "linear_damping", **dict(zip(axes, damping, strict=True))},
        ],
        channels={},
        measured={"wave_in_m": {"about": "elevation at its place"}},
        diagnosis={"facts": facts, "rate": 10.0, "reasons": {"rate": "short waves"}},
    )
    M = np.array([mass, mass, inertia]) + added

    def run(rng: Rng, factors: Array) -> dict[str, Array]:
        forces = ambient(rng, times, mass, length, (1.0, 1.0, 0.2))

        def rates(s: Array, i: int) -> Array:
            v, w, p = s[3:]
            c, k = np.cos(s[2]), np.sin(s[2])
            up = -stiffness[1] * s[1]  # vertical, in body axes below
            own = np.array([up * k, up * c, -stiffness[2] * k])
            turning = np.array([M[1] * w * p, -M[0] * v * p, (M[0] - M[1]) * v * w])
            speeds = (forces[i] + own + turning - factors * damping * s[3:]) / M
            return np.array([v * c - w * k, v * k + w * c, p, *speeds])

        start = np.array([0.0, 0.02 * rng.standard_normal(), 0.05 * rng.standard_normal()])
        states = integrate(rates, np.append(start, np.zeros(3)), times)[:, :3]
        states += rng.standard_normal(states.shape) * [5e-4, 5e-4, 2e-3]
        wave = 0.001 * np.sin(2.0 * np.pi * rng.uniform(0.6, 1.2) * times + rng.uniform(0.0, 6.0))
        signals = dict(zip(("y_m", "z_m", "phi_rad"), states.T, strict=True))
        return signals | {"wave_in_m": wave}

    return Body(vessel, times, noise, run, 3)


BODIES = {"hovercraft": hovercraft, "boat": boat, "section": section}


def write_trial(body: Body, rng: Rng, folder: Path) -> list[Path]:
    """Write the runs of a trial with their notes, and return their files.

    The first run belongs to another group, such as a day, than the others.
    """
    vessel = body.vessel.save(folder / body.vessel.name).file
    factors = 1.0 + CALIBRATION * rng.standard_normal(body.coefficients)
    files = []
    runs: dict[str, object] = {}
    for i in range(RUNS):
        name = f"run_{i + 1}"
        files.append(folder / f"{name}.csv")
        write_csv(Recording(name, body.times, body.run(rng, factors)), files[-1])
        runs[name] = {"group": ["first" if i == 0 else "second"]}
    kinds = sorted(pipeline_kinds(body.vessel))
    notes: dict[str, object] = {"vessel": str(vessel), "noise": dict(body.noise)}
    notes["coefficient_uncertainty"] = dict.fromkeys(kinds, CALIBRATION)
    notes["runs"] = runs
    (folder / "recording.toml").write_text(tomlkit.dumps(notes), encoding="utf-8")
    return files


def pipeline_kinds(vessel: Vessel) -> set[str]:
    """Return the kinds of coefficients that differ from the file: damping and thrust."""
    kinds = set()
    for effect in vessel.effects:
        for param in type(effect).params().values():
            if param.calibrates in ("damping", "thrust"):
                kinds.add(param.calibrates)
    return kinds


def record(out: Path, seed: int, number: int) -> None:
    """Make a trial, diagnose it, and write its record."""
    file = out / f"S{seed}_T{number:05d}.json"
    if file.is_file():
        return
    kind = list(BODIES)[number % len(BODIES)]
    rng = np.random.default_rng([seed, number])
    start = time.process_time()
    with tempfile.TemporaryDirectory() as name:
        files = write_trial(BODIES[kind](), rng, Path(name))
        try:
            diagnosis = pipeline.diagnose(files[:2], files[2:])
            found = answer_record(diagnosis.findings.answer)
        except BadInput as error:
            found = {"refused": str(error)}
    found |= {"kind": kind, "cpu_s": time.process_time() - start}
    part = file.with_suffix(".part")
    part.write_text(json.dumps(found), encoding="utf-8")
    part.replace(file)


def answer_record(answer: Answer) -> dict[str, object]:
    """Return what is kept of an answer."""
    return {
        "candidates": len(answer["tried"]),
        "effects": [[e["name"], e["probability"]] for e in answer["effects"]],
        "possible": [[e["name"], e["probability"]] for e in answer["also_possible"]],
        "unknown": answer["unknown"]["flag"],
        "log": [[entry["run"], entry["name"]] for entry in answer["log"]],
    }


def print_rates(out: Path) -> None:
    """Print the shares of logs that were refused, or got a name, an unknown cause, or a finding."""
    by_kind: dict[str, list[dict[str, object]]] = {}
    for file in sorted(out.glob("S*_T*.json")):
        found = json.loads(file.read_text(encoding="utf-8"))
        by_kind.setdefault(found["kind"], []).append(found)
    everything = [found for some in by_kind.values() for found in some]
    for kind, some in (*by_kind.items(), ("all", everything)):
        read = [found for found in some if "refused" not in found]
        print(f"{kind}: {len(some)} trials, {len(some) - len(read)} of them refused")
        some = read
        print(f"  with a name       {share([bool(found['effects']) for found in some])}")
        print(f"  called unknown    {share([bool(found['unknown']) for found in some])}")
        print(f"  a finding of the log {share([bool(found['log']) for found in some])}")
    names = Counter[str]()
    for found in everything:
        effects = found.get("effects", [])
        assert isinstance(effects, list)
        names.update(name for name, _ in effects)
    for name, count in names.most_common():
        print(f"  {count} times: {name}")


def main() -> None:
    """Command line."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--out", type=Path, required=True, help="folder of the records")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--trials", type=int, default=1000)
    parser.add_argument("--tables", action="store_true", help="only print the rates")
    given = parser.parse_args()
    given.out.mkdir(parents=True, exist_ok=True)
    if not given.tables:
        for number in range(given.trials):
            record(given.out, given.seed, number)
    print_rates(given.out)


if __name__ == "__main__":
    main()
