"""Commands beyond the range of the vessel file: reported, and used if they may be true."""

from dataclasses import replace

import numpy as np
import pytest

from boatsim.diagnosis.checks.channel_ranges import widen_channel_ranges
from boatsim.diagnosis.checks.command_unit import check_command_unit
from boatsim.diagnosis.checks.data_cleaning import cleaning_findings
from boatsim.diagnosis.config import DEFAULT
from boatsim.errors import BadInput
from boatsim.physics.vessel import load_vessel
from boatsim.recordings.table import Recording, read

OTTER = load_vessel("otter")
T = 0.1 * np.arange(200)
SHAFTS = ("n_port_radps", "n_starboard_radps")


def recording(values: np.ndarray) -> Recording:
    poses = {name: 0.1 * T for name in ("x_m", "y_m")} | {"psi_rad": 0.01 * T}
    return Recording("run", T, {**poses, **dict.fromkeys(SHAFTS, values)})


def file_of(tmp_path, values):
    run = recording(values)
    names = list(run.signals)
    rows = zip(T, *run.signals.values(), strict=True)
    text = [",".join(["t_s", *names]), *[",".join(map(str, row)) for row in rows]]
    path = tmp_path / "run.csv"
    path.write_text("\n".join(text) + "\n")
    return path


SWING = np.sin(0.5 * T)


def test_a_command_a_little_beyond_the_range_is_a_mended_finding_and_no_other_unit(tmp_path):
    run = read(file_of(tmp_path, 125.0 * SWING), OTTER.limits())
    found = [f for f in cleaning_findings(run) if f.name == "command_range"]
    assert len(found) == len(SHAFTS)
    assert all(f.kind == "mended" and "-104 to 104" in f.evidence for f in found)
    assert not check_command_unit(recording(125.0 * SWING), OTTER, DEFAULT.checks)


def test_the_diagnosis_uses_the_range_of_the_log():
    wide = widen_channel_ranges(OTTER, [recording(125.0 * SWING)])
    assert wide.limits()["n_port_radps"] == pytest.approx((-125.0, 125.0), rel=1e-3)
    assert widen_channel_ranges(OTTER, [recording(50.0 * SWING)]) is OTTER
    assert replace(wide, commands=OTTER.commands) == OTTER


def test_an_impossible_command_is_refused_with_its_row(tmp_path):
    path = file_of(tmp_path, 1100.0 * np.maximum(SWING, 0.0))
    with pytest.raises(BadInput, match=r"column n_port_radps: command .* in what unit is it\?"):
        read(path, OTTER.limits())


@pytest.mark.parametrize(
    ("values", "unit"),
    [
        (900.0 * SWING, "revolutions a minute"),
        (1500.0 + 400.0 * SWING, "pulses in us"),
        (180.0 * SWING, ""),
    ],
)
def test_another_unit_needs_a_second_sign(values, unit):
    found = check_command_unit(recording(values), OTTER, DEFAULT.checks)
    assert [f.evidence.rpartition("is ")[2] for f in found] == [unit] * bool(unit)


@pytest.mark.parametrize(("digits", "is_found"), [(1, True), (4, False)])
def test_per_cent_of_a_smaller_range_are_round_numbers(digits, is_found):
    boat = load_vessel("blueboat")
    name = next(iter(boat.commands))
    size = 80.0
    assert size > DEFAULT.checks.command_excess * boat.commands[name].high
    run = Recording("run", T, {"x_m": T, name: np.round(size * SWING, digits)})
    assert bool(check_command_unit(run, boat, DEFAULT.checks)) is is_found
