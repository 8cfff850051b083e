"""Loads of a table of motions: against the excitation that caused them, and in a closed loop."""

from pathlib import Path

import numpy as np
import pytest

from boatsim.cli.hydrodynamics import HydrodynamicsOptions, write_hydrodynamics
from boatsim.errors import BadInput
from boatsim.physics.base import AXES, Array
from boatsim.physics.coefficients.files import write_wave_loads
from boatsim.physics.coefficients.table import WaveLoads
from boatsim.physics.vessel import Vessel, load_vessel
from boatsim.simulate.motion_loads import loads_of_motion
from boatsim.simulate.wave_response import Complex, wave_response
from validation.waves.boats import linear_response
from validation.waves.response import SPRINGS, FloatingCatamaran

UPRIGHT = ("heave", "roll", "pitch")


def linear_motions(dof: tuple[str, ...]) -> tuple[FloatingCatamaran, Complex]:
    """The catamaran, and its motions (N, H, 6) in the frequency domain."""
    catamaran = FloatingCatamaran()
    own = catamaran.coefficients
    motion = np.full(own.excitation.shape, np.nan + 0j)
    places = [AXES.index(axis) for axis in dof]
    for h, heading in enumerate(own.heading):
        motion[:, h, places] = linear_response(
            own, catamaran.body, catamaran.stiffness, dof, own.frequency, heading
        )
    return catamaran, motion


@pytest.mark.parametrize("dof", [pytest.param(AXES, marks=pytest.mark.slow), UPRIGHT])
def test_loads_are_the_excitation_that_causes_the_motion(
    tmp_path: Path, dof: tuple[str, ...]
) -> None:
    catamaran, motion = linear_motions(dof)
    own = catamaran.coefficients
    number = own.frequency**2 / 9.81
    vessel = catamaran.vessel(tmp_path / "catamaran", dof)
    loads, axes = loads_of_motion(vessel, own.frequency, own.heading, motion, number)
    assert axes == dof
    places = [AXES.index(axis) for axis in dof]
    largest = np.abs(own.excitation).max(axis=(0, 1))[places]
    errors = np.abs(loads - own.excitation).max(axis=(0, 1))[places] / largest
    # the model of the memory of radiated waves has an error of 0.5 %
    assert errors.max() < 0.02
    assert not np.delete(loads, places, axis=2).any()


def closed_loop(
    folder: Path, vessel: Vessel, loads: WaveLoads, periods: Array, headings: Array
) -> Complex:
    """Response (H, P, D) of a vessel by simulation in waves with loads."""
    write_wave_loads(folder / "loads", loads)
    waves = {"use": "panel_wave_loads", "coefficients": str(folder / "loads")}
    found = wave_response(vessel, headings.tolist(), periods.tolist(), 0.002, waves)
    assert found.steady.all()
    return found.operators


@pytest.mark.parametrize("dof", [AXES, UPRIGHT])
def test_simulated_response_is_the_table(tmp_path: Path, dof: tuple[str, ...]) -> None:
    """A table of any motion, amplitude and phase, is what `boatsim manoeuvre response` finds."""
    vessel = load_vessel("otter")
    if dof == UPRIGHT:  # on a vessel that is also free otherwise: no load acts there
        given = [2, 3, 4]
    else:
        given = list(range(6))
    frequency = np.linspace(1.5, 5.0, 15)
    heading = np.linspace(0.0, np.pi, 9)
    along, across = np.cos(heading), np.sin(heading)
    fade = 1.0 / (1.0 + (frequency[:, None] / 4.0) ** 4) * np.exp(0.2j * frequency[:, None])
    size = np.ones_like(frequency)[:, None]
    motion = np.full((15, 9, 6), np.nan + 0j)
    shapes = {
        0: -1j * along * size,
        1: -1j * across * size,
        2: -1.0 + 0.1 * along * size,
        3: 0.5j * across * size,
        4: -0.4j * along * size,
        5: 0.2 * along * across * size,
    }
    for axis in given:
        motion[:, :, axis] = fade * shapes[axis]
    number = frequency**2 / 9.81
    loads, axes = loads_of_motion(vessel, frequency, heading, motion, number)
    assert axes == dof
    table = WaveLoads("a table", 0.0, frequency, heading, np.asarray(loads))
    periods, some = 2.0 * np.pi / frequency[[2, 8, 12]], heading[[1, 4, 7]]
    found = closed_loop(tmp_path, vessel, table, periods, some)
    expected = np.swapaxes(motion[[2, 8, 12]][:, [1, 4, 7]], 0, 1)[..., given]
    largest = np.abs(motion[..., given]).max(axis=(0, 1))
    errors = np.abs(found[..., given] - expected).max(axis=(0, 1)) / largest
    assert errors.max() < 0.01  # the springs of the simulation change the response by 0.25 %


@pytest.mark.slow
def test_moving_vessel_responds_at_the_frequency_of_encounter(tmp_path: Path) -> None:
    vessel = FloatingCatamaran().vessel(tmp_path / "catamaran", ("surge", "heave"))
    vessel = vessel.without_effect("ground_spring")
    frequency, heading, speed = np.array([1.0, 1.5, 2.0]), np.array([0.0, np.pi]), 0.8
    number = frequency**2 / 9.81
    motion = np.full((3, 2, 6), np.nan + 0j)
    motion[..., 2] = -1.0
    moving, _ = loads_of_motion(vessel, frequency, heading, motion, number, speed)
    for h, along in enumerate((1.0, -1.0)):
        met = frequency - speed * number * along
        rest, _ = loads_of_motion(vessel, met, heading, motion, number)
        assert moving[:, h, 2] == pytest.approx(rest[:, h, 2], rel=1e-4)
    assert np.abs(moving[:, 0, 2] - moving[:, 1, 2]).min() > 1.0


def test_vessel_that_is_free_in_no_axis_of_the_table_is_refused() -> None:
    motion = np.full((3, 2, 6), np.nan + 0j)
    motion[..., 2] = -1.0
    waves = np.array([1.0, 2.0, 3.0]), np.array([0.0, np.pi])
    with pytest.raises(BadInput, match="is free in surge, sway, yaw; the table has heave"):
        loads_of_motion(load_vessel("osv"), *waves, motion, waves[0])


@pytest.mark.slow
def test_springs_and_memory_belong_to_the_vessel(tmp_path: Path) -> None:
    """Without its springs in the plane the vessel needs a smaller load in long waves."""
    catamaran, motion = linear_motions(AXES)
    own = catamaran.coefficients
    vessel = catamaran.vessel(tmp_path / "catamaran", AXES).without_effect("ground_spring")
    number = own.frequency**2 / 9.81
    loads, _ = loads_of_motion(vessel, own.frequency, own.heading, motion, number)
    held = own.excitation[0, :, 0] - SPRINGS["surge"] * motion[0, :, 0]
    size = np.abs(own.excitation[:, :, 0]).max()
    assert np.abs(loads[0, :, 0] - held).max() < 0.01 * size


def test_the_command_converts_a_response_of_the_program(tmp_path: Path) -> None:
    rows = ["direction_rad,frequency_radps,heave_m_per_m,heave_phase_rad"]
    for heading in np.linspace(0.0, np.pi, 5):
        rows += [f"{heading:.6g},{w},1,3.14159265" for w in (2.0, 3.0, 4.0)]
    (tmp_path / "response.csv").write_text("\n".join(rows))
    fields = dict.fromkeys(HydrodynamicsOptions.__dataclass_fields__)
    numbers = {"density": 1025.0, "depth": 0.0, "origin": 0.0, "scale": 1.0, "speed": 0.0}
    options = HydrodynamicsOptions(**{**fields, **numbers, "vessel": "otter", "loads": ()})
    assert write_hydrodynamics(tmp_path / "response.csv", options) == 0
    waves = {"use": "panel_wave_loads", "coefficients": str(tmp_path / "hydrodynamics")}
    found = wave_response(load_vessel("otter"), [np.pi / 2], [2.0], 0.002, waves)
    assert found.operators[0, 0, 2] == pytest.approx(-1.0, abs=0.005)
