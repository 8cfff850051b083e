"""Small vessels written into a test's own folder; they share one composition, so that values
differ, not programs."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from boatsim.physics import vessel
from boatsim.physics.vessel import Vessel

HULL = """<mujoco model="{name}">
  <custom><numeric name="drawn_for" data="1 0.4 0.1"/></custom>
  <worldbody>
    <body name="hull"><geom name="collision" type="box" size="0.5 0.2 0.1" contype="0" conaffinity="0"/></body>
  </worldbody>
</mujoco>
"""

# The boat of the reference cases; outboards half a metre to the side of the origin give any surge
# force, sway force and
# yaw moment.
PLANAR = """
about = "rectangular boat for tests"
source = "none"
freedoms = ["surge", "sway", "yaw"]
length = 1.0
beam = 0.4
draught = 0.1
body = { mass = 6.0, roll_inertia = 0.1, yaw_inertia = 0.5 }

[channels]
thrust_port_N = { low = -100.0, high = 100.0 }
thrust_starboard_N = { low = -100.0, high = 100.0 }
steer_port_rad = { low = -3.2, high = 3.2 }
steer_starboard_rad = { low = -3.2, high = 3.2 }

[[effect]]
use = "added_mass"
surge = 0.6
sway = 3.0
yaw = 0.3

[[effect]]
use = "linear_damping"
surge = 3.0
sway = 10.0
yaw = 0.8

[[effect]]
use = "quadratic_damping"
surge = 8.0
sway = 30.0
yaw = 1.0

[[effect]]
use = "current"

[[effect]]
use = "thruster"
name = "port"
on = { thrust = "thrust_port_N", angle = "steer_port_rad" }
y = -0.5

[[effect]]
use = "thruster"
name = "starboard"
on = { thrust = "thrust_starboard_N", angle = "steer_starboard_rad" }
y = 0.5

[loads.laden]
length = 1.5
body = { mass = 8.0 }
added_mass = { surge = 0.9 }
"""

ROLL = """
about = "roll oscillator for tests"
source = "none"
freedoms = ["roll"]
length = 1.0
beam = 0.4
draught = 0.1
body = { mass = 6.0, roll_inertia = 0.5, yaw_inertia = 0.5 }

[[effect]]
use = "righting_arm"
stiffness = 2.0
"""

WITHOUT_DRAG = {
    "linear_damping": {"surge": 0.0, "sway": 0.0, "yaw": 0.0},
    "quadratic_damping": {"surge": 0.0, "sway": 0.0, "yaw": 0.0},
}


def written(folder: Path, name: str, text: str) -> Path:
    """The vessel's folder, with its hull and vessel file in it."""
    place = folder / name
    place.mkdir(exist_ok=True)
    (place / "hull.xml").write_text(HULL.format(name=name))
    (place / "vessel.toml").write_text(text)
    return place


def planar(
    folder: Path, settings: Mapping[str, Mapping[str, Any]] | None = None, **more: Any
) -> Vessel:
    """The boat of the reference cases, `settings` laid over its effects and body."""
    return vessel.load_vessel(str(written(folder, "test_boat", PLANAR)), settings=settings, **more)


def push(X: float, N: float) -> dict[str, float]:
    """Commands with which `planar` is pushed ahead with X [N] and turned with N [N m]."""
    return {"thrust_port_N": X / 2 + N, "thrust_starboard_N": X / 2 - N}


MEASURED_WAVE = """
about = "a box in a measured wave"
source = "none"
freedoms = ["sway", "heave", "roll"]
length = 0.6
beam = 0.4
draught = 0.2
body = { mass = 48.0, roll_inertia = 1.0, yaw_inertia = 1.4 }

[measured]
wave_m = {}

[[effect]]
use = "wave_excitation"
on = { elevation = "wave_m" }
roll_elevation = -30.0
roll_rate = -10.0
sway_rate = -200.0

[[effect]]
use = "wave_drift"
on = { elevation = "wave_m" }
sway = -1400.0
"""
BOX_HULL = """<mujoco model="box"><worldbody><body name="hull">
<geom type="box" size="0.3 0.2 0.13"/></body></worldbody></mujoco>"""


def box_in_measured_wave(folder: Path) -> Vessel:
    """Write a box on which a recorded wave acts to a folder, and load it."""
    (folder / "hull.xml").write_text(BOX_HULL)
    (folder / "vessel.toml").write_text(MEASURED_WAVE)
    return vessel.load_vessel(str(folder))
