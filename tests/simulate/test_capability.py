"""The capability of a vessel is that of a static balance."""

import csv
from math import pi, sqrt
from pathlib import Path

import numpy as np
import pytest

from boatsim.cli.commands import app
from boatsim.control.vessel_model import WindLoads
from boatsim.physics.vessel import Vessel, load_vessel
from boatsim.simulate.capability import INTACT, LARGEST_WIND, capability

AREA = 2.0  # [m^2]


def barge(tunnels: float = 10.0) -> Vessel:
    """A vessel with tunnel thrusters at 2 m before and behind the middle, and one thruster ahead."""
    channels = {name: {"low": -tunnels, "high": tunnels} for name in ("bow_N", "stern_N")}
    thrusters = [
        {"use": "thruster", "name": name, "on": {"thrust": f"{name}_N", "angle": 0.5 * pi}, "x": x}
        for name, x in (("bow", 2.0), ("stern", -2.0))
    ]
    return Vessel.from_effects(
        name="barge",
        dof=("surge", "sway", "yaw"),
        length=5.0,
        beam=2.0,
        draught=0.3,
        body={"mass": 900.0, "roll_inertia": 300.0, "yaw_inertia": 1500.0},
        channels={**channels, "main_N": {"low": -30.0, "high": 30.0}},
        effects=[
            {"use": "added_mass", "surge": 90.0, "sway": 600.0, "yaw": 800.0},
            {"use": "linear_damping", "surge": 50.0, "sway": 200.0, "yaw": 400.0},
            *thrusters,
            {"use": "thruster", "name": "main", "on": {"thrust": "main_N"}, "x": -2.5},
        ],
    )


def test_it_is_the_closed_form_of_a_simple_set_of_thrusters() -> None:
    found = capability(barge(), WindLoads(AREA, AREA), directions=8)
    winds = found.winds[INTACT]
    assert winds[2] == pytest.approx(sqrt(2.0 * 20.0 / (1.2 * AREA)), rel=1e-4)
    assert winds[0] == pytest.approx(sqrt(2.0 * 30.0 / (1.2 * AREA)), rel=1e-4)
    # at 45 degrees the tunnel thrusters are the limit: 20 N of side force
    assert winds[1] == pytest.approx(sqrt(2.0 * 20.0 * sqrt(2.0) / (1.2 * AREA)), rel=1e-4)


def test_one_lost_tunnel_thruster_leaves_no_side_force_without_moment() -> None:
    found = capability(barge(), WindLoads(AREA, AREA), directions=4)
    assert found.winds["without bow"][1] < 0.5
    assert found.winds["without bow"][0] == pytest.approx(found.winds[INTACT][0], rel=1e-4)
    # a side force at the stern needs no thruster at the bow
    aft = capability(barge(), WindLoads(AREA, AREA, arm=-2.0), directions=4)
    assert aft.winds["without bow"][1] == pytest.approx(sqrt(2.0 * 10.0 / (1.2 * AREA)), rel=1e-3)


def test_a_current_takes_its_share_of_the_thrust() -> None:
    found = capability(barge(), WindLoads(AREA, AREA), current=0.2, directions=4)
    # head current of 0.2 m/s: 10 N of 30 N
    assert found.winds[INTACT][0] == pytest.approx(sqrt(2.0 * 20.0 / (1.2 * AREA)), rel=1e-4)
    strong = capability(barge(), WindLoads(AREA, AREA), current=1.0, directions=4)
    assert strong.winds[INTACT][0] == 0.0


def test_half_of_the_thrust_holds_a_wind_with_half_the_load() -> None:
    whole, half = (
        capability(barge(), WindLoads(AREA, AREA), share=share, directions=4).winds[INTACT]
        for share in (1.0, 0.5)
    )
    assert half == pytest.approx(whole / sqrt(2.0), rel=1e-4)


def test_a_vessel_with_equal_sides_has_equal_capability_on_both() -> None:
    vessel = load_vessel("osv").replace(commands=dict(load_vessel("osv").commands))
    equal = vessel.commands["starboard_N"].model_copy(update={"high": 655e3})
    vessel = vessel.replace(commands={**vessel.commands, "starboard_N": equal})
    found = capability(vessel, current=0.5, directions=12, lost=["bow_1", "port", "starboard"])
    for case in (INTACT, "without bow_1"):
        winds = found.winds[case]
        assert winds[1:] == pytest.approx(winds[:0:-1], rel=1e-3)
        assert winds.min() > 10.0
    # the loss of one side mirrors the loss of the other
    assert found.winds["without port"][1:] == pytest.approx(
        found.winds["without starboard"][:0:-1], rel=1e-3
    )
    assert (found.winds["without port"] <= found.winds[INTACT] * (1.0 + 1e-6)).all()


def test_a_wind_that_is_never_too_strong_has_the_largest_speed() -> None:
    found = capability(barge(1e6), WindLoads(1e-3, 1e-3), directions=4, lost=[])
    assert np.array_equal(found.winds[INTACT], np.full(4, LARGEST_WIND))


def run_command(*words: object) -> int:
    with pytest.raises(SystemExit) as stop:
        app(["capability", *map(str, words)])
    return int(stop.value.code or 0)


def test_the_command_writes_a_plot_and_its_numbers(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "out"
    assert run_command("osv", "--directions", 4, "--lost", "bow_1", "--out", out) == 0
    assert "without bow_1" in capsys.readouterr().out
    with (out / "capability.csv").open(newline="") as file:
        rows = list(csv.reader(file))
    assert rows[0] == ["wind_from_rad", "intact_mps", "without_bow_1_mps"] and len(rows) == 5
    svg = (out / "capability.svg").read_text()
    assert svg.startswith("<svg") and svg.count('stroke-linejoin="round"') == 2


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (("otter",), "no wind force with drag areas"),
        (("otter", "--front", 1), "--front and --side belong together"),
        (("osv", "--lost", "bow"), "did you mean 'bow_"),
        (("osv", "--current", -1), "--current"),
        (("mariner",), "no thruster, propeller or rudder"),
        (("ovs",), "ovs"),
    ],
)
def test_wrong_input_is_one_line_and_code_2(
    words: tuple[object, ...], message: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run_command(*words) == 2
    error = capsys.readouterr().err
    assert message in error and error.count("\n") == 1
