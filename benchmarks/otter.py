"""Print the Otter's reference run on MuJoCo in six degrees of freedom: `python -m benchmarks.otter`.

The run starts from rest with propeller commands of 80 and 60 rad/s.
"""

from math import pi

from boatsim.physics import vessel
from boatsim.simulate.engine import Engine, State

# Names in the table of published figures that differ from the symbols of a state.
SIGNALS = {"roll": "phi", "pitch": "theta", "yaw": "psi"}


def figures() -> dict[str, float]:
    """Return velocities [m/s, rad/s] and pose [m, rad] after 20 s of a turn, and 40 s straight ahead."""
    return state_after_turn(21, "stations") | state_after_turn(0, "exact") | straight_run()


def final_state(port: float, starboard: float, seconds: float, stations: int = 0) -> State:
    """Return the state after a run from rest.

    Args:
        port: Commanded propeller rate on the port side [rad/s].
        starboard: Commanded propeller rate on the starboard side [rad/s].
        seconds: Length of the run [s].
        stations: Number of hull sections for the cross-flow drag; 0 for the exact integral.
    """
    boat = vessel.load_vessel("otter", settings={"cross_flow_drag": {"stations": stations}})
    engine = Engine(boat)
    engine.command({"n_port_radps": port, "n_starboard_radps": starboard})
    engine.advance(round(seconds / engine.step))
    return engine.state


def state_after_turn(stations: int, words: str) -> dict[str, float]:
    """Return the state at the end of the turn, with the heading between 0 and 2 pi."""
    state = final_state(80.0, 60.0, 20.0, stations)
    found = {
        n: getattr(state, SIGNALS.get(n, n))
        for n in ("u", "v", "w", "p", "q", "r", "x", "y", "z", *SIGNALS)
    }
    found["yaw"] %= 2.0 * pi
    return {f"{name}, {words}": value for name, value in found.items()}


def straight_run() -> dict[str, float]:
    """Return speed and distance with both propellers at 60 rad/s."""
    state = final_state(60.0, 60.0, 40.0)
    return {"u, straight": state.u, "x, straight": state.x}


if __name__ == "__main__":
    for name, value in figures().items():
        print(f"{name:18} {value:13.8f}")
