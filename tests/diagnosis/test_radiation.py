"""A body whose damping depends on the frequency: what a diagnosis finds in runs and decays.

The recordings come from the linear equations of the body and share no code with the tool.
"""

from pathlib import Path

import numpy as np
import pytest

from boatsim.diagnosis.filter import NoiseLevels
from boatsim.diagnosis.recording_mapping import map_recording
from boatsim.physics.program import Program
from tests.radiation_rig import (
    DAMPING,
    INERTIA,
    SENSOR,
    Body,
    Radiation,
    body_vessel,
    decays,
    diagnosed,
    driven_runs,
    recorded,
)

LARGEST = np.array([150.0, 1.2])  # [N s/m, N m s]
NAMES = {"heave_radiation", "roll_radiation"}


@pytest.mark.slow
def test_free_runs_remember_the_motion_before_they_begin(tmp_path: Path) -> None:
    """Each continues the recording within its noise, although waves were radiated before it."""
    boat = body_vessel(tmp_path)
    for axis, damping, w in (("heave", 150.0, 7.0), ("roll", 1.2, 6.0)):
        boat = boat.with_effect(
            {"use": f"{axis}_radiation", "damping": damping, "frequency": w, "damping_ratio": 0.5}
        )
    run = recorded(1, Body(Radiation(LARGEST)), None).thinned(10.0)
    mapped = map_recording(run, Program(boat))
    on = mapped.program.effect_switches(())
    noise = {"heave_sd_m": SENSOR, "roll_sd_rad": SENSOR}
    levels = NoiseLevels(np.array([0.1, 0.02]), 0.7, noise)
    for remembers, low, high in ((True, 0.0, 2.0), (False, 3.0, np.inf)):
        starts = mapped.free_run_starts(mapped.values, on, levels, 4.0)
        if not remembers:
            starts = starts._replace(path=starts.path[:0])
        runs = mapped.simulate_from(mapped.values, on, starts)
        errors = []
        for first, channels in runs[1:]:
            off = channels[:, :2] - mapped.measured[first : first + len(channels), :2]
            errors.append(np.sqrt(np.mean(off**2)))
        assert low * SENSOR < max(errors) < high * SENSOR


@pytest.mark.slow
@pytest.mark.parametrize("acts", [(1.0, 0.0), (0.0, 1.0), (1.0, 1.0)])
def test_radiation_is_named_in_driven_runs_with_its_size(
    acts: tuple[float, float], tmp_path: Path
) -> None:
    body = Body(Radiation(LARGEST * acts), damping=DAMPING * [0.5 if acts[0] else 1.0, 1.0])
    answer = diagnosed(driven_runs(body), tmp_path).findings.answer
    assert answer["verdict"] == "named" and not answer["unknown"]["flag"], answer["sentence"]
    expected = {}
    for name, size, unit, w in (
        ("heave_radiation", 150.0, "Nspm", 7.0),
        ("roll_radiation", 1.2, "Nms", 6.0),
    ):
        if acts[name == "roll_radiation"]:
            expected[name] = {f"damping_{unit}": size, "frequency_radps": w, "damping_ratio": 0.5}
    found = {effect["name"]: effect["parameters"] for effect in answer["effects"]}
    assert set(found) == set(expected) and not answer["also_possible"]
    for name, parameters in expected.items():
        for parameter, size in parameters.items():
            assert found[name][parameter]["value"] == pytest.approx(size, rel=0.1), parameter
        errors = next(e for e in answer["effects"] if e["name"] == name)
        assert errors["confirmed"]


@pytest.mark.slow
def test_radiation_in_roll_is_named_in_decays_from_several_angles(tmp_path: Path) -> None:
    body = Body(Radiation(LARGEST * [0.0, 1.0]))
    answer = diagnosed(decays(body), tmp_path).findings.answer
    (effect,) = answer["effects"]
    assert effect["name"] == "roll_radiation" and not effect["tied_with"], answer["sentence"]
    assert effect["parameters"]["damping_Nms"]["value"] == pytest.approx(1.2, rel=0.15)
    assert effect["parameters"]["frequency_radps"]["value"] == pytest.approx(6.0, rel=0.1)


@pytest.mark.slow
@pytest.mark.parametrize("driven", [True, False])
@pytest.mark.parametrize(
    "body",
    [Body(), Body(damping=2.5 * DAMPING), Body(inertia=INERTIA + [-15.0, -0.15])],
    ids=["as in the file", "damping", "mass"],
)
def test_constant_damping_and_added_mass_do_not_get_its_name(
    body: Body, driven: bool, tmp_path: Path
) -> None:
    runs = driven_runs(body) if driven else decays(body)
    answer = diagnosed(runs, tmp_path).findings.answer
    named = {effect["name"] for effect in answer["effects"]}
    assert not NAMES & (named | set(answer["also_possible"])), answer["sentence"]
    assert answer["verdict"] in ("named", "ambiguous", "nothing_missing")
