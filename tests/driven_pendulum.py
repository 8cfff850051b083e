"""The vessel `pendulum` as it might really be, integrated by scipy from its equation of motion.

The integration shares no code with boatsim. A motor drives the pendulum with a recorded torque; the
usual one turns it over the top.
"""

from dataclasses import dataclass
from math import exp, sin, tanh
from pathlib import Path
from typing import Any

import numpy as np
from scipy.integrate import solve_ivp

from boatsim.diagnosis import pipeline
from boatsim.diagnosis.loading import LoadedRecordings
from boatsim.physics import vessel
from boatsim.physics.base import Array
from boatsim.recordings.table import Recording

INERTIA, MOMENT = 0.147, 3.0  # [kg m^2], [N m] of the vessel file
PUSH = (11.0, 11.5, 2.5)  # [s], [s], [N m] of a hand that no channel records
FILE = Path("rig.csv")
OMEGA = (1.1, 2.9, 4.3, 6.1)  # [rad/s] of the torque
STICKS, STRIBECK = 0.005, 0.1  # [rad/s] below which it sticks, over which stiction fades
RATE = 31.0  # [Hz] of the thinned recordings


@dataclass(frozen=True)
class Pendulum:
    """The real pendulum, its motor and its sensors."""

    moment: float = MOMENT  # [N m] restoring moment: times sin h + second sin 2h + third sin 3h
    second: float = 0.0
    third: float = 0.0
    damping: float = 0.013  # [N m s]
    friction: float = 0.0  # [N m] of sliding
    static_ratio: float = 1.0  # friction at rest over that of sliding
    gain: float = 1.0  # torque over the recorded one
    amplitude: float = 0.9  # [N m] of each sine of the torque
    torque_sd: float = 0.03  # [N m] noise of the recorded torque
    pushed: bool = False  # by the hand of `PUSH`


def torque(t: float, seed: int, amplitude: float) -> float:
    """Recorded torque [N m] without noise: four sines with random phases."""
    phases = np.random.default_rng(seed).uniform(0.0, 6.0, 4)
    return float(sum(amplitude * sin(w * t + a) for w, a in zip(OMEGA, phases, strict=True)))


def acceleration(t: float, phi: float, p: float, seed: int, real: Pendulum) -> float:
    """Angular acceleration [rad/s^2] of the real pendulum."""
    moment = real.gain * torque(t, seed, real.amplitude) - real.damping * p
    moment -= real.moment * (sin(phi) + real.second * sin(2.0 * phi) + real.third * sin(3.0 * phi))
    stiction = (real.static_ratio - 1.0) * exp(-((p / STRIBECK) ** 2))
    moment -= real.friction * (1.0 + stiction) * tanh(p / STICKS)
    if real.pushed and PUSH[0] < t < PUSH[1]:
        moment += PUSH[2]
    return moment / INERTIA


def recording(seed: int, seconds: float, real: Pendulum) -> Recording:
    """A run from rest at 200 Hz with noise of the encoder and of the torque, thinned to `RATE`."""

    def rates(t: float, y: Array) -> tuple[float, float]:
        return y[1], acceleration(t, y[0], y[1], seed, real)

    t = np.arange(0.0, seconds, 0.005)
    run = solve_ivp(rates, (0.0, seconds), (0.0, 0.0), "LSODA", t, rtol=1e-7, max_step=0.01)
    rng = np.random.default_rng(100 + seed)
    recorded = np.array([torque(one, seed, real.amplitude) for one in t])
    recorded += real.torque_sd * rng.standard_normal(len(t))
    phi = run.y[0] + 1e-3 * rng.standard_normal(len(t))
    signals = {"phi_rad": phi, "torque_Nm": recorded}
    return Recording(f"run {seed}", t, signals, path=FILE).thinned(RATE)


def diagnosed(real: Pendulum, seconds: float) -> dict[str, Any]:
    """The answer of a diagnosis with all candidates of two runs; a third one is held out."""
    runs = [recording(seed, seconds, real) for seed in (1, 2, 3)]
    vessels = {FILE: vessel.load_vessel("pendulum")}
    loaded = LoadedRecordings(runs[:2], runs[2:], vessels, "run 3", horizon=1.0)
    return pipeline.diagnose_loaded(loaded).findings.answer
