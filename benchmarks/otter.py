"""The Otter's reference run on MuJoCo in all six freedoms: from rest, propellers told to turn at 80 and 60 rad/s.

python -m benchmarks.otter
"""

from math import pi

from boatsim.simulate.pontoon_boat import otter

SIGNALS = ("u", "v", "w", "p", "q", "r", "x", "y", "z", "roll", "pitch", "yaw")


def figures() -> dict[str, float]:
    """Velocities [m/s, rad/s] and pose [m, rad] after 20 s of a turn; speed and distance after 40 s straight ahead."""
    return after_20_s(21, "stations") | after_20_s(0, "exact") | straight()


def after_20_s(stations: int, words: str) -> dict[str, float]:
    """State at the end of the turn, cross-flow drag by stations or exact; the heading counts on from a half turn."""
    boat = otter()
    boat = boat.model_copy(update={"water": boat.water.model_copy(update={"stations": stations})})
    body = boat.launched(80.0, 60.0)
    body.advance(1000)
    *found, yaw = [*body.velocity.tolist(), *body.pose.tolist()]
    return {f"{name}, {words}": value for name, value in zip(SIGNALS, [*found, yaw % (2.0 * pi)], strict=True)}


def straight() -> dict[str, float]:
    """Both propellers at 60 rad/s."""
    body = otter().launched(60.0, 60.0)
    body.advance(2000)
    return {"u, straight": float(body.velocity[0]), "x, straight": float(body.pose[0])}


if __name__ == "__main__":
    for name, value in figures().items():
        print(f"{name:18} {value:13.8f}")
