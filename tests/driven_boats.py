"""Recordings of shipped vessels whose drives do something else with their orders.

A shipped vessel is sailed with the thrust that a function of this file's callers makes of the
orders, so that the recordings share no law of an actuator with the effect that is to be found."""

from collections.abc import Callable, Mapping, Sequence

import numpy as np

from boatsim.diagnosis.candidates import candidate_library
from boatsim.diagnosis.prior_noise import prior_noise_levels
from boatsim.diagnosis.problem import Problem
from boatsim.diagnosis.recording_mapping import map_recording
from boatsim.diagnosis.search.ranking import Ranking, select_and_rank_candidates
from boatsim.physics.base import Array
from boatsim.physics.program import Program
from boatsim.physics.vessel import Vessel, load_vessel
from boatsim.recordings.table import Notes, Recording
from boatsim.simulate.open_water import OpenWater

STEP = 0.02  # [s] of the simulation and of what the drives do
PER_ROW = 10  # steps a row: 5 Hz
TRIAL_CHANNELS = ("thrust_port_N", "thrust_starboard_N", "steer_port_rad", "steer_starboard_rad")
LARGEST = (0.9, 0.9, 0.5, 0.5)  # [N], [rad] orders to these channels
NOISE = {"x_m": 0.005, "y_m": 0.005, "psi_rad": 0.005}  # [m], [m], [rad] of a recorded pose

Drive = Callable[[Array], Array]  # orders (T, C), one each step -> what the drives give (T, C)


def random_orders(
    rng: np.random.Generator, largest: Sequence[float], holds: int, rows: int
) -> Array:
    """Random orders (holds * rows, C) up to the largest ones, each held for some rows."""
    limits = np.array(largest)
    return np.repeat(rng.uniform(-limits, limits, (holds, len(limits))), rows, axis=0)


def paused(orders: Array, pause: float) -> Array:
    """Orders (T, C) of drives that stand still where an order of the other sign is less old."""
    out = orders.copy()
    window = round(pause / STEP)
    for row in range(len(orders)):
        recent = orders[max(row - window, 0) : row]
        out[row, (recent * orders[row] < 0.0).any(axis=0)] = 0.0
    return out


def played(orders: Array, width: float) -> Array:
    """Orders (T, C) behind a play, from its middle: the last extreme decides."""
    out = orders.copy()
    for row in range(1, len(orders)):
        out[row] = np.clip(out[row - 1], orders[row] - 0.5 * width, orders[row] + 0.5 * width)
    return out


def driven(
    boat: Vessel,
    orders: Mapping[str, Array],
    drive: Drive,
    seed: int,
    noise: Mapping[str, float] = NOISE,
) -> Recording:
    """A recording of a vessel under orders, one for each row, of which its drives make their own.

    Args:
        boat: Vessel.
        orders: Channel -> orders (N,) in the unit of the channel.
        drive: What the drives give for the orders of all channels, in their order.
        seed: Of the noise.
        noise: Recorded column -> sd of its noise, in SI units.
    """
    rng = np.random.default_rng(seed)
    channels = list(orders)
    given = np.column_stack([orders[name] for name in channels])
    done = drive(np.repeat(given, PER_ROW, axis=0))
    engine = OpenWater(boat, STEP)
    engine.reset(commands=dict(zip(channels, done[0].tolist(), strict=True)))
    rows: list[list[float]] = []
    for step, sent in enumerate(done):
        if step % PER_ROW == 0:
            rows.append([getattr(engine.state, name.rpartition("_")[0]) for name in noise])
        engine.command(dict(zip(channels, sent.tolist(), strict=True)))
        engine.advance()
    seen = np.array(rows) + rng.standard_normal((len(rows), len(noise))) * list(noise.values())
    signals = dict(zip(noise, seen.T, strict=True)) | dict(orders)
    return Recording(f"run_{seed}", np.arange(len(rows)) * STEP * PER_ROW, signals, Notes())


def trial_boat_runs(drive: Drive) -> list[Recording]:
    """Three recordings of the trial boat under random orders to `TRIAL_CHANNELS`."""
    found = []
    for seed in (1, 2, 3):
        orders = random_orders(np.random.default_rng(seed), LARGEST, 30, 10)
        columns = dict(zip(TRIAL_CHANNELS, orders.T, strict=True))
        found.append(driven(load_vessel("trial_boat"), columns, drive, seed))
    return found


def ranked(
    boat: Vessel, tested: Sequence[str], *recordings: Recording, requested: Sequence[str] = ()
) -> Ranking:
    """What the recordings say of some candidates of a vessel, usual ones and requested ones."""
    effects = [e for e in candidate_library(boat, requested).entries if e.name in tested]
    program = Program(boat, effects)
    mapped = [map_recording(recording, program) for recording in recordings]
    problem = Problem(mapped, prior_noise_levels(boat, recordings), {"thrust": 0.05})
    return select_and_rank_candidates(problem, tuple(e.name for e in effects))


def platform_of_three_drives(measured: Mapping[str, object] | None = None) -> Vessel:
    """A platform with a fixed drive athwart its bow and two at its stern, all ahead and astern."""
    places = {"bow": (0.6, 0.0, 1.5708), "port": (-0.6, -0.3, 0.0), "starboard": (-0.6, 0.3, 0.0)}
    effects: list[dict[str, object]] = [
        {"use": "linear_damping", "surge": 6.0, "sway": 15.0, "yaw": 6.0}
    ]
    for drive, (x, y, angle) in places.items():
        on = {"thrust": f"{drive}_N", "angle": angle}
        effects.append({"use": "thruster", "name": drive, "on": on, "x": x, "y": y})
    channels = {f"{drive}_N": {"low": -8.0, "high": 8.0} for drive in places}
    return _platform(effects, channels, measured)


def platform_of_turning_drives(turning: Sequence[str] = ("bow", "port", "starboard")) -> Vessel:
    """A platform with three drives that push ahead; those of `turning` turn, the others are fixed."""
    places = {"bow": (0.6, 0.0), "port": (-0.6, -0.3), "starboard": (-0.6, 0.3)}
    channels: dict[str, object] = {}
    effects: list[dict[str, object]] = [
        {"use": "linear_damping", "surge": 6.0, "sway": 15.0, "yaw": 6.0}
    ]
    for drive, (x, y) in places.items():
        on: dict[str, object] = {"thrust": f"{drive}_N"}
        channels[f"{drive}_N"] = {"low": 0.0, "high": 8.0}
        if drive in turning:
            on["angle"] = f"{drive}_rad"
            channels[f"{drive}_rad"] = {"low": -3.1416, "high": 3.1416}
        effects.append({"use": "thruster", "name": drive, "on": on, "x": x, "y": y})
    return _platform(effects, channels)


def _platform(
    effects: Sequence[Mapping[str, object]],
    channels: Mapping[str, object],
    measured: Mapping[str, object] | None = None,
) -> Vessel:
    """A platform of 30 kg in a basin, which its drives move in surge, sway and yaw."""
    return Vessel.from_effects(
        name="platform",
        dof=("surge", "sway", "yaw"),
        length=1.5,
        beam=0.9,
        draught=0.1,
        body={"mass": 30.0, "roll_inertia": 2.0, "yaw_inertia": 4.0},
        effects=effects,
        channels=channels,
        measured=measured or {},
        diagnosis={"facts": {"still_water": True, "indoors": True}},
    )
