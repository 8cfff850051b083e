"""Writes the two logs of the tutorial, docs/your_boat.md, into tests/data/pond; run again, the same
bytes.

python -m tests.make_pond_logs

The boat is that of tests/pushed_three_metre.py, whose integrator shares no code with the tool. Two
days on a pond: on the first its owner tries it out and an ArduPilot logs it; on the second a logger
writes a table while weed round the starboard propeller takes a third of that one's thrust.
"""

from pathlib import Path

import numpy as np

from boatsim.physics.base import Array
from tests.make_logs import FULL as WHOLE
from tests.make_logs import ardupilot, pulse, table
from tests.pushed_three_metre import FULL, RATE, SD, path

HERE = Path(__file__).parent / "data" / "pond"
HOLD, FINE = 4.0, 0.02  # [s] between commands; step of the rows that the writers of logs take apart
WEED = 0.65  # of the starboard propeller's thrust is left


def levels(rng: np.random.Generator, duration: float) -> Array:
    """(N, 2) commands [N], a new pair every few seconds, as the nearest microsecond of a servo's
    pulse has them."""
    held = rng.uniform(-0.5, 1.0, (int(duration / HOLD) + 1, 2))
    us = np.vectorize(pulse)(WHOLE * held)
    return np.repeat((us - 1500.0) / 400.0 * FULL, round(HOLD * RATE), axis=0)[
        : round(duration * RATE) + 1
    ]


def day(seed: int, duration: float, starboard: float = 1.0) -> dict[str, Array]:
    """Columns of a run as the instruments read it, every FINE s, commands as shares of WHOLE."""
    rng = np.random.default_rng(seed)
    commands = levels(rng, duration)
    slow = np.arange(len(commands)) / RATE
    true = path(commands * [1.0, starboard], slow)
    t = FINE * np.arange(round(duration / FINE) + 1)
    read = [
        np.interp(t, slow, c) + sd * rng.standard_normal(len(t))
        for c, sd in zip(true.T, SD, strict=True)
    ]
    r = np.interp(t, slow, np.gradient(true[:, 2], slow)) + 0.01 * rng.standard_normal(len(t))
    now = np.minimum((t * RATE + 1e-9).astype(int), len(commands) - 1)
    still = np.zeros(len(t))
    sent = {
        f"n_{side}_radps": WHOLE * commands[now, k] / FULL
        for k, side in enumerate(("port", "starboard"))
    }
    pose = dict(zip(("x_m", "y_m", "psi_rad"), read, strict=True))
    return {"t_s": t, **pose, "phi_rad": still, "theta_rad": still, "r_radps": r, **sent}


def main() -> None:
    """Write both."""
    HERE.mkdir(parents=True, exist_ok=True)
    ardupilot(day(1, 120.0), HERE / "day_1.BIN")
    table(day(2, 90.0, WEED), HERE / "day_2.csv")


if __name__ == "__main__":
    main()
