"""Responses of a catamaran to regular and irregular waves against the frequency domain.

The hull has the particulars of the Otter. `models/otter/hydrodynamics` holds its coefficients,
which `boatsim hydrodynamics` computed from the mesh of `hulls.write_catamaran`.
"""

from pathlib import Path

import numpy as np

from boatsim.hydrodynamics.response import linear_stiffness, rigid_body
from boatsim.physics.base import AXES, Array
from boatsim.physics.coefficients.files import read_coefficients
from boatsim.physics.coefficients.table import Coefficients
from boatsim.physics.vessel import Vessel
from boatsim.simulate.open_water import OpenWater
from boatsim.simulate.stepper import State
from validation.waves.boats import linear_response, write_vessel

OTTER = Path(__file__).parents[2] / "models" / "otter" / "hydrodynamics"
# Rigid body of `models/otter`, with the mass centre above the centre of buoyancy
INERTIA = (10.26432, 13.75, 13.75)  # [kg m^2]
DEPTH = -0.2  # [m] of the mass centre
# Springs that hold the place and the heading, soft against the waves
SPRINGS = {"surge": 5.0, "sway": 5.0, "yaw": 5.0}  # [N/m], [N m]
AMPLITUDE = 0.001  # [m] small, so that the motion is linear
PERIODS, HEADINGS = (1.0, 1.2, 1.5, 2.0, 3.0, 4.5), (0.5, 0.75, 1.0)  # [s], [pi]
STEPS = 100  # in a period of the waves
SETTLING, FITTED = 25, 10  # periods
COLUMNS = ("x", "y", "z", "phi", "theta", "psi")
TEXT = """
about = "catamaran in waves"
source = "hull of models/otter"
freedoms = {dof}
length = 2.0
beam = 1.04
draught = 0.134146341463

[body]
mass = {mass}
centre = [{centre}, {depth}]
roll_inertia = {inertia[0]}
pitch_inertia = {inertia[1]}
yaw_inertia = {inertia[2]}

[[effect]]
use = "radiation_memory"
coefficients = "{folder}"

[[effect]]
use = "hydrostatics"
heave = {stiffness[2]}
roll = {stiffness[3]}
pitch = {stiffness[4]}

[[effect]]
use = "ground_spring"
stiffness_north = {springs[surge]}
stiffness_east = {springs[sway]}
turn = {springs[yaw]}

[[effect]]
use = "panel_wave_loads"
coefficients = "{folder}"
"""


class FloatingCatamaran:
    """The catamaran with the mass that it displaces.

    Attributes:
        coefficients: Coefficients of the hull.
        stiffness: Stiffness (6, 6) of buoyancy, weight and springs.
        body: Mass matrix (6, 6) of the rigid body.
        text: Content of the vessel file, with the degrees of freedom left open.
    """

    def __init__(self) -> None:
        """Read the coefficients."""
        self.coefficients: Coefficients = read_coefficients(OTTER)
        own = self.coefficients
        mass, centre = own.volume * own.density, float(own.buoyancy[0])
        self.stiffness = linear_stiffness(own, mass, DEPTH)
        self.body = rigid_body(mass, (centre, DEPTH), np.array(INERTIA))
        self._numbers = {
            "mass": mass,
            "centre": centre,
            "depth": DEPTH,
            "inertia": INERTIA,
            "folder": OTTER,
            "stiffness": np.diag(self.stiffness).tolist(),
            "springs": SPRINGS,
        }
        for axis, spring in SPRINGS.items():
            place = AXES.index(axis)
            self.stiffness[place, place] += spring

    def vessel(self, folder: Path, dof: tuple[str, ...], **sea: object) -> Vessel:
        """Return the vessel in a sea.

        Args:
            folder: Folder in which it is written.
            dof: Degrees of freedom.
            **sea: Parameters of the sea.
        """
        text = TEXT.format(dof=list(dof), **self._numbers)
        for key, value in sea.items():
            text += f"{key} = {value!r}\n".replace("'", '"')
        return write_vessel(folder, text)


def regular_wave_errors(folder: Path) -> list[list[float]]:
    """Return errors of the simulated motion in regular waves, in per cent of the largest response.

    Args:
        folder: Working folder.

    Returns:
        A row for each period and heading: period [s], heading [rad], then for each axis the error
        over the largest amplitude of that axis over all periods and headings [%].
    """
    catamaran = FloatingCatamaran()
    found, expected, keys = [], [], []
    for heading in HEADINGS:
        for period in PERIODS:
            w = 2.0 * np.pi / period
            linear = linear_response(
                catamaran.coefficients,
                catamaran.body,
                catamaran.stiffness,
                AXES,
                np.array([w]),
                heading * np.pi,
            )[0]
            sea = {
                "spectrum": "regular",
                "significant_height": 2.0 * AMPLITUDE,
                "modal_period": period,
                "toward": heading * np.pi,
            }
            vessel = catamaran.vessel(folder / "catamaran", AXES, **sea)
            found.append(_simulated_response(vessel, w, linear))
            expected.append(linear)
            keys.append((period, heading * np.pi))
    errors = np.abs(np.array(found) - np.array(expected))
    largest = np.abs(np.array(expected)).max(axis=0)
    return [[*key, *(100.0 * row / largest)] for key, row in zip(keys, errors, strict=True)]


def _simulated_response(vessel: Vessel, w: float, start: Array) -> Array:
    """Return the complex motion per amplitude, simulated from the linear response."""
    step = 2.0 * np.pi / w / STEPS
    place, speed = AMPLITUDE * start.real, AMPLITUDE * (1j * w * start).real
    engine = OpenWater(vessel, step=step)
    engine.reset(State(0.0, *place.tolist(), *speed.tolist()))
    engine.advance(SETTLING * STEPS)
    rows = []
    for _ in range(FITTED * STEPS):
        engine.advance()
        state = engine.state
        rows.append([engine.t, *(getattr(state, name) for name in COLUMNS)])
    table = np.array(rows)
    t = table[:, 0]
    slow = (t - t[0]) / (t[-1] - t[0])
    # besides the wave a cubic, for the slow motion on the springs
    basis = np.column_stack([np.cos(w * t), np.sin(w * t), *(slow**k for k in range(4))])
    # weighted by a Hann window, which the slow motion does not pass
    weight = np.sin(np.pi * slow)[:, None] ** 2
    cosine, sine = np.linalg.lstsq(weight * basis, weight * table[:, 1:], rcond=None)[0][:2]
    return np.asarray((cosine - 1j * sine) / AMPLITUDE)


def irregular_sea_errors(folder: Path) -> list[list[float]]:
    """Return rms responses in an irregular sea, simulated and by linear theory.

    Args:
        folder: Working folder.

    Returns:
        A row for heave, roll and pitch: simulated and expected rms [m, rad], and the difference
        [%].
    """
    catamaran, dof, toward = FloatingCatamaran(), ("heave", "roll", "pitch"), 0.6 * np.pi
    height, duration, step = 0.01, 600.0, 0.02
    sea = {"significant_height": height, "modal_period": 3.0, "toward": toward, "cut": 7.5}
    vessel = catamaran.vessel(folder / "irregular", dof, **sea)
    own = vessel.effect("panel_wave_loads")
    assert own is not None
    waves = own.wave_field()
    assert waves is not None
    response = linear_response(
        catamaran.coefficients,
        catamaran.body,
        catamaran.stiffness,
        dof,
        np.maximum(waves.frequency, catamaran.coefficients.frequency[0]),
        toward,
    )
    engine = OpenWater(vessel, step=step)
    engine.advance(int(60.0 / step))
    rows, phases = [], []
    for _ in range(int(duration / step)):
        engine.advance()
        state = engine.state
        rows.append([state.z, state.phi, state.theta])
        phases.append(engine.t)
    simulated = np.std(np.array(rows), axis=0)
    t = np.array(phases)
    amplitude = waves.amplitude * np.exp(1j * waves.phase)
    expected = []
    for axis in range(3):
        total = np.zeros(len(t))
        for k, w in enumerate(waves.frequency):
            total += (amplitude[k] * response[k, axis] * np.exp(1j * w * t)).real
        expected.append(float(np.std(total)))
    return [
        [float(a), b, 100.0 * (float(a) / b - 1.0)]
        for a, b in zip(simulated, expected, strict=True)
    ]
