"""The Otter's reference run on MuJoCo in all six freedoms: from rest, propellers told to turn at 80 and 60 rad/s.

python -m benchmarks.otter
"""

from math import pi

from boatsim.physics import vessel
from boatsim.simulate.engine import Engine, State

SIGNALS = {
    "roll": "phi",
    "pitch": "theta",
    "yaw": "psi",
}  # as the table of papers calls them; others as they are


def figures() -> dict[str, float]:
    """Velocities [m/s, rad/s] and pose [m, rad] after 20 s of a turn; speed and distance after 40 s straight ahead."""
    return after_20_s(21, "stations") | after_20_s(0, "exact") | straight()


def sailed(port: float, starboard: float, seconds: float, stations: int = 0) -> State:
    """State after a run from rest with these rates [rad/s]; cross-flow drag by stations, or exact (0)."""
    boat = vessel.load("otter", settings={"cross_flow_drag": {"stations": stations}})
    engine = Engine(boat)
    engine.command({"n_port_radps": port, "n_starboard_radps": starboard})
    engine.advance(round(seconds / engine.step))
    return engine.state


def after_20_s(stations: int, words: str) -> dict[str, float]:
    """State at the end of the turn; the heading counts on from a half turn."""
    state = sailed(80.0, 60.0, 20.0, stations)
    found = {
        n: getattr(state, SIGNALS.get(n, n))
        for n in ("u", "v", "w", "p", "q", "r", "x", "y", "z", *SIGNALS)
    }
    found["yaw"] %= 2.0 * pi
    return {f"{name}, {words}": value for name, value in found.items()}


def straight() -> dict[str, float]:
    """Both propellers at 60 rad/s."""
    state = sailed(60.0, 60.0, 40.0)
    return {"u, straight": state.u, "x, straight": state.x}


if __name__ == "__main__":
    for name, value in figures().items():
        print(f"{name:18} {value:13.8f}")
