"""A boat from its particulars: rules by published numbers, files that open, and coefficients found
again from a log."""

import re
import shlex
import tomllib
from collections import Counter
from pathlib import Path

import mujoco
import numpy as np
import pytest
from alike import few
from typer.testing import CliRunner

from boatsim.cli import app
from boatsim.errors import BadInput
from boatsim.newboat.drive_law import DriveLaw
from boatsim.newboat.from_log import fit_boat, fitted_vessel_text
from boatsim.newboat.particulars import Options, Particulars, parse_particulars
from boatsim.newboat.write import boat_files
from boatsim.physics import vessel
from boatsim.physics.base import make_motion
from boatsim.physics.content import shipped_content_names
from boatsim.physics.effects.added_mass import AddedMass
from boatsim.physics.effects.forward_speed_damping import ForwardSpeedDamping
from boatsim.physics.effects.thrust_loss_with_speed import ThrustLossWithSpeed
from boatsim.physics.estimate import added_mass, inertia, sway_yaw_damping
from boatsim.physics.estimate.displacement import hull_particulars
from boatsim.physics.estimate.shallow_water import shallow_water_factor
from boatsim.physics.program import Program
from boatsim.simulate import scenario, world
from boatsim.simulate.run import run
from tests import pushed_three_metre

ROOT = Path(__file__).parents[2]
BOATS = {
    "twin": "--length 3 --beam 1.6 --mass 90 --thruster -1.2,-0.6 --thruster -1.2,0.6",
    "outboard": "--length 5 --beam 2 --mass 600 --draught 0.3 --steered -2.4,0,900,300 --speed 6",
    "ship": "--length 30 --beam 5 --mass 150000 --draught 2 --thruster -14,0,20000 --rudder -15",
    "catamaran": "--length 2 --beam 1.08 --mass 55 --hulls 2 --thruster -0.8,-0.4,120,66 --thruster -0.8,0.4,120,66",
    "propellers": "--length 5 --beam 2 --mass 900 --thruster -2.2,-0.5,900,500 --thruster -2.2,0.5,900,500 --rpm 2400",
    "ship_by_rpm": "--length 20 --beam 4 --mass 40000 --thruster -9,0,8000,5000 --rudder -9.5 --rpm 600 --helm 35,3 --tunnel 7,900",
    "outboard_by_rpm": "--length 5 --beam 2 --mass 600 --steered -2.4,0,900,300 --rpm 5500 --helm 30,20",
    "curve": "--length 3 --beam 1.6 --mass 90 --thruster -1.2,-0.6 --thruster -1.2,0.6 --curve=-100:-20,-10:0,10:0,50:15,100:60",
    "pulses": "--length 3 --beam 1.6 --mass 90 --thruster -1.2,-0.6 --thruster -1.2,0.6 --curve=1100:-40,1500:0,1900:60",
    "balanced": "--length 3 --beam 1.6 --mass 90 --thruster -1,-0.6 --thruster -1,0.6 --balance 1.3 --depth 0.2",
    "narrow_hulls": "--length 2 --beam 1.08 --mass 55 --hulls 2 --hull-beam 0.2 --thruster -0.8,-0.4 --thruster -0.8,0.4",
    "bow": "--length 6 --beam 2 --mass 900 --steered -2.8,0.4,1e3 --steered -2.8,-0.4,1e3 --thruster 2,0,200",
}


def made(folder: Path, options: str) -> Path:
    """The folder of a boat by the command line."""
    result = CliRunner().invoke(app, ["new", str(folder), *shlex.split(options)])
    assert result.exit_code == 0, result.output
    return folder


def boat(**changed: object) -> Particulars:
    said: dict[str, object] = {
        "name": "b",
        "length": 3.0,
        "beam": 1.6,
        "mass": 90.0,
    }
    main = {key: changed.pop(key) for key in said if key in changed}
    options = Options(**({"thrusters": ["-1,0"]} | changed))  # type: ignore[arg-type]
    return parse_particulars(**(said | main), options=options)  # type: ignore[arg-type]


# ---- rules


def test_clarkes_regression_is_near_what_was_measured_on_the_mariner() -> None:
    """L 160.93 m, B 23.17 m, T 8.23 m, C_b 0.59; Clarke's own figures scatter by a third about his
    lines."""
    ship = hull_particulars(160.93, 23.17, 0.59 * 1000 * 160.93 * 23.17 * 8.23, 1, 8.23)
    unit = 0.5 * 1000 * 160.93**3
    # measured on a planar motion mechanism: M. S. Chislett, J. Stroem-Tejsen 1965, Y'_vdot =
    # -748e-5, N'_r = -166e-5
    assert added_mass.sway_added_mass(ship).value / unit == pytest.approx(748e-5, rel=0.4)
    damping = sway_yaw_damping.clarke_derivatives(ship)
    assert damping.yaw / (0.5 * 1000 * 160.93**4) == pytest.approx(166e-5, rel=0.4)
    assert damping.sway / (0.5 * 1000 * 160.93**2) == pytest.approx(1160e-5, rel=0.4)


def test_the_lift_of_a_slender_hull_with_its_munk_moment_is_clarkes_regression() -> None:
    ship = hull_particulars(160.93, 23.17, 0.59 * 1000 * 160.93 * 23.17 * 8.23, 1, 8.23)
    water = AddedMass(
        surge=added_mass.surge_added_mass(ship).value,
        sway=added_mass.sway_added_mass(ship).value,
        yaw=0.0,
    )
    told = sway_yaw_damping.lift_derivatives(ship)
    lift = ForwardSpeedDamping(sway=told.sway.value, at=told.at.value, yaw=told.yaw.value)
    of_ship, u, v, r = sway_yaw_damping.clarke_derivatives(ship), 5.0, 0.1, 1e-3
    drifting = np.add(water.wrench(make_motion(u=u, v=v)), lift.wrench(make_motion(u=u, v=v)))
    assert drifting[[1, 5]] == pytest.approx([-of_ship.sway * u * v, -of_ship.yaw_by_sway * u * v])
    assert lift.wrench(make_motion(u=u, r=r)).N == pytest.approx(-of_ship.yaw * u * r)


def test_the_rules_for_a_catamaran_give_what_the_otter_is_said_to_have() -> None:
    otter = vessel.load_vessel("otter")
    made_by_rule = hull_particulars(2.0, 1.08, 55.0, 2, None)
    assert made_by_rule.draught == pytest.approx(otter.draught, rel=0.1)
    mass = otter.effect("added_mass")
    assert mass is not None
    assert inertia.yaw_inertia(made_by_rule).value == pytest.approx(otter.body.yaw_inertia)
    one = added_mass.surge_added_mass(hull_particulars(2.0, 1.08, 55.0, 1, None)).value * (
        1025.0 / 1000.0
    ) ** (1.0 - 5.0 / 3.0)
    assert one == pytest.approx(mass.surge, rel=1e-6)  # type: ignore[attr-defined]


@pytest.mark.parametrize("scale", [0.1, 10.0])
def test_added_mass_goes_with_the_size_by_froudes_law(scale: float) -> None:
    small, large = (
        hull_particulars(3.0, 1.6, 90.0, 1, None),
        hull_particulars(3.0 * scale, 1.6 * scale, 90.0 * scale**3, 1, None),
    )
    for rule, power in (
        (added_mass.surge_added_mass, 3),
        (added_mass.sway_added_mass, 3),
        (added_mass.yaw_added_mass, 5),
        (inertia.yaw_inertia, 5),
    ):
        assert rule(large).value == pytest.approx(rule(small).value * scale**power)


# ---- the command


@pytest.mark.parametrize("name", few(BOATS, 4, 4))
def test_a_boat_of_any_kind_is_whole_and_runs_its_first_scenario(name: str, tmp_path: Path) -> None:
    folder = made(tmp_path / name, BOATS[name])
    found = vessel.load_vessel(str(folder))
    assert world.build_model(found).nv == 3
    mujoco.MjModel.from_xml_path(str(folder / "hull.xml"))  # as any viewer opens it
    log = run(scenario.load(str(folder / "turn.toml"))).recording
    third = len(log.t) // 3
    assert log["u_mps"][third // 2] > 0.1  # ahead
    assert (
        log["r_radps"][third - 5] > 0.01
    )  # then a turn to starboard, by rudder, outboard or thrust
    assert log["r_radps"][third + third // 2 - 5] < -0.01  # and one to port


@pytest.mark.parametrize("name", BOATS)
def test_every_number_of_a_boat_says_where_it_comes_from(name: str, tmp_path: Path) -> None:
    text = (made(tmp_path / name, BOATS[name]) / "vessel.toml").read_text(encoding="utf-8")
    bare = [line for line in text.splitlines() if re.search(r"= -?\d", line) and "#" not in line]
    assert not bare


@pytest.mark.parametrize("name", BOATS)
def test_the_file_states_which_numbers_are_estimates(name: str, tmp_path: Path) -> None:
    estimated = vessel.load_vessel(str(made(tmp_path / name, BOATS[name]))).estimated
    assert {"damping", "thrust", "added_mass", "lag"} <= set(estimated)
    assert ("mass_centre" in estimated) == ("--balance" not in BOATS[name])
    assert "body.yaw_inertia" in estimated and estimated["body.mass"] == 0.1
    balanced = "--balance" in BOATS[name]
    assert ("position_frame_error.forward" in estimated) != balanced


@pytest.mark.parametrize(("given", "sd"), [("0", None), ("0.02", 0.02)])
def test_a_mass_that_was_weighed_is_no_estimate(
    given: str, sd: float | None, tmp_path: Path
) -> None:
    options = f"{BOATS['outboard']} --mass-uncertainty {given}"
    assert (
        vessel.load_vessel(str(made(tmp_path / "boat", options))).estimated.get("body.mass") == sd
    )


def test_a_stated_top_speed_is_reached_at_full_thrust(tmp_path: Path) -> None:
    folder = made(tmp_path / "fast", BOATS["outboard"])
    (folder / "full.toml").write_text(
        'vessel = "vessel.toml"\nduration = 120\ncontroller = { use = "open_loop" }\n[[goal]]\nthrust_motor_N = 900.0\n'
    )
    assert run(scenario.load(str(folder / "full.toml"))).recording["u_mps"][-1] == pytest.approx(
        6.0, rel=0.01
    )


def settled(folder: Path, commands: dict[str, float]) -> dict[str, float]:
    """Forces and moment of the drives of a boat at rest, long after their commands."""
    found = vessel.load_vessel(str(folder))
    program = Program(found)
    act, memory = np.zeros(program.actuator_signal_size), np.zeros(program.memory_size)
    values, on = program.values(), program.effect_switches()
    for _ in range(3):
        program.simulation_functions.advance_actuators(
            program.command_array(commands), memory, 1e4, values, on, act
        )
    return dict(zip(found.actuators, act.tolist(), strict=False))


def test_the_thrust_of_revolutions_grows_with_their_square(tmp_path: Path) -> None:
    folder = made(tmp_path / "propellers", BOATS["propellers"])
    found = vessel.load_vessel(str(folder))
    low, high = found.limits()["n_port_radps"]
    assert high == pytest.approx(2400 * 2 * np.pi / 60, rel=1e-3) and low == -high
    port = found.effect("port")
    assert port is not None
    for n, force in ((high, 900.0), (0.5 * high, 225.0), (low, -500.0)):
        wrench = port.wrench(make_motion(), shaft=n)
        assert wrench.X == pytest.approx(force, rel=2e-3)
    ahead = found.manoeuvring.ahead["n_port_radps"]
    assert 0.0 < ahead <= np.sqrt(0.5) * high * 1.001


def test_each_thruster_loses_thrust_by_its_own_full_thrust(tmp_path: Path) -> None:
    options = "--length 2 --beam 1 --mass 60 --thruster=-0.8,-0.3,90,60 --thruster=-0.8,0.3,40,40"
    found = vessel.load_vessel(str(made(tmp_path / "boat", options)))
    losses = [e for e in found.effects if isinstance(e, ThrustLossWithSpeed)]
    assert [(e.full_ahead, e.full_astern) for e in losses] == [(90.0, 60.0), (40.0, 40.0)]


def test_a_tunnel_thruster_pushes_the_bow_to_starboard(tmp_path: Path) -> None:
    folder = made(tmp_path / "ship", BOATS["ship_by_rpm"])
    (folder / "bow.toml").write_text(
        'vessel = "vessel.toml"\nduration = 20\ncontroller = { use = "open_loop" }\n[[goal]]\nthrust_bow_N = 900.0\n'
    )
    log = run(scenario.load(str(folder / "bow.toml"))).recording
    early = int(np.searchsorted(log.t, 2.0))  # before the turning ship moves ahead
    assert log["r_radps"][early] > 0.0 and log["v_mps"][early] > 0.0
    assert abs(log["u_mps"][early]) < 0.1 * log["v_mps"][early]


def test_a_vessel_is_shown_with_the_direction_of_each_thruster(tmp_path: Path) -> None:
    folder = made(tmp_path / "ship", BOATS["ship_by_rpm"])
    shown = CliRunner().invoke(app, ["show", str(folder)]).output
    assert "pushes 90 deg to starboard, driven by thrust_bow_N" in shown
    assert "pushes ahead, driven by n_motor_radps" in shown
    shown = CliRunner().invoke(app, ["show", "joystick_boat"]).output
    assert "turned by steer_port_rad, driven by thrust_port_N" in shown


def test_the_range_and_rate_of_a_helm_are_those_of_the_owner(tmp_path: Path) -> None:
    found = vessel.load_vessel(str(made(tmp_path / "ship", BOATS["ship_by_rpm"])))
    assert found.limits()["rudder_rad"] == pytest.approx(
        (-np.radians(35), np.radians(35)), rel=1e-3
    )
    limit = found.effect("steering_rate_limit")
    assert limit is not None and limit.rate == pytest.approx(np.radians(3.0), rel=1e-3)  # type: ignore[attr-defined]


def test_azimuth_drives_turn_all_around_and_are_named_by_their_ends(tmp_path: Path) -> None:
    options = "--length 5 --beam 2.8 --mass 1670 --steered 1.8,0,500 --steered -1.8,0,500"
    found = vessel.load_vessel(str(made(tmp_path / "ferry", f"{options} --helm 360,60")))
    assert found.limits()["steer_forward_rad"] == pytest.approx((-2 * np.pi, 2 * np.pi), rel=1e-3)
    act = settled(tmp_path / "ferry", {"thrust_aft_N": 100.0, "steer_aft_rad": np.pi})
    assert act["thrust_aft_N"] == pytest.approx(100.0)
    assert act["steer_aft_rad"] == pytest.approx(np.pi)


@pytest.mark.parametrize(
    "places, names",
    [
        ("1.8,0 -1.8,0", "forward aft"),
        ("-1.2,0.5 -1.2,-0.5", "starboard port"),
        ("1.8,-1 1.8,1 -1.8,-1 -1.8,1", "port_forward starboard_forward port_aft starboard_aft"),
        ("0,-1 1,-1 -1,-1 0,1", "port1 port2 port3 starboard"),
        ("-2,0 -1.8,-1 -1.8,1", "middle port starboard"),
        ("-2,0.5", "motor"),
    ],
)
def test_several_thrusters_are_named_by_side_and_end(places: str, names: str) -> None:
    named = boat(length=5.0, beam=2.8, mass=1670.0, thrusters=places.split()).named_thrusters()
    assert " ".join(name for name, _ in named) == names


def test_a_curve_gives_the_thrust_of_its_table_and_commands_for_a_thrust(tmp_path: Path) -> None:
    folder = made(tmp_path / "curve", BOATS["curve"])
    for command, force in ((-100.0, -20.0), (5.0, 0.0), (30.0, 7.5), (75.0, 37.5)):
        act = settled(folder, {"throttle_port": command})
        assert act["thrust_port_N"] == pytest.approx(force, abs=1e-6)
    law = DriveLaw(curve=((-100.0, -20.0), (-10.0, 0.0), (10.0, 0.0), (50.0, 15.0), (100.0, 60.0)))
    for force in (-20.0, -3.0, 0.0, 2.0, 15.0, 40.0):
        back = np.interp(law.command_for_thrust(force, 60.0, 20.0), *np.transpose(law.curve))
        assert back == pytest.approx(force, abs=1e-9)
    assert law.neutral_command == 0.0
    pulses = vessel.load_vessel(str(made(tmp_path / "pulses", BOATS["pulses"])))
    assert pulses.commands["throttle_port"].neutral == 1500.0


def test_a_plate_across_a_channel_has_the_added_mass_of_its_potential_flow() -> None:
    """Potential jump 4 h / pi arcosh(cos(pi y / 2 h) / cos(pi T / 2 h)) of a plate of half width T in
    a channel of half width h, in a stream of unit speed: integrated over the plate."""
    assert shallow_water_factor(0.1, 10.0).value == pytest.approx(1.0, abs=1e-3)
    for depth in (1.1, 1.5, 3.0):
        y = np.sin(np.linspace(-0.5 * np.pi, 0.5 * np.pi, 20001))
        ratio = np.cos(0.5 * np.pi * y / depth) / np.cos(0.5 * np.pi / depth)
        jump = 4.0 * depth / np.pi * np.arccosh(np.maximum(ratio, 1.0))
        mass = float(np.trapezoid(jump, y))
        assert shallow_water_factor(1.0, depth).value == pytest.approx(mass / np.pi, rel=1e-4)


def test_a_balance_point_moves_the_middle_of_the_hull_and_depth_adds_water(tmp_path: Path) -> None:
    found = vessel.load_vessel(str(made(tmp_path / "b", BOATS["balanced"])))
    plain = vessel.load_vessel(
        str(made(tmp_path / "p", BOATS["balanced"].partition(" --balance")[0]))
    )
    values = {}
    for name, one in (("given", found), ("plain", plain)):
        mass, drag, lift = map(
            one.effect, ("added_mass", "cross_flow_drag", "forward_speed_damping")
        )
        values[name] = (mass.sway_at, drag.centre, lift.at, mass.sway)  # type: ignore[union-attr]
    assert values["given"][:2] == pytest.approx((0.2, 0.2))
    assert values["given"][2] - values["plain"][2] == pytest.approx(0.2, abs=1e-3)
    factor = shallow_water_factor(found.draught, 0.2).value
    assert values["given"][3] == pytest.approx(factor * values["plain"][3], rel=1e-3)
    assert found.geometry["cg_from_transom"] == 1.3


def test_the_beam_of_a_hull_sets_how_deep_a_catamaran_lies() -> None:
    narrow = boat(hulls=2, hull_beam=0.2, thrusters=["-1,0"])
    wide = boat(hulls=2, hull_beam=0.4, thrusters=["-1,0"])
    assert narrow.hull.draught == pytest.approx(2.0 * wide.hull.draught)
    assert narrow.hull.hull_spacing == pytest.approx(1.4)


@pytest.mark.parametrize(
    "changed, said",
    [
        ({"thrusters": []}, "a boat needs at least one thruster"),
        ({"thrusters": ["-1"]}, "allowed is X,Y"),
        ({"thrusters": ["a,b"]}, "--thruster a,b"),
        ({"thrusters": ["-9,0"]}, "within the length"),
        ({"mass": 90000.0}, "is the mass in kg"),
        ({"mass": -1.0}, "--mass -1; allowed"),
        ({"length": 300.0, "mass": 90.0}, "length = 300 m does not fit mass = 90 kg; allowed"),
        ({"beam": 4.0}, "less than the length"),
        ({"draught": 0.01}, "lies at least"),
        ({"rudder": "0"}, "--rudder 0"),
        ({"name": "a b"}, "allowed are letters"),
        ({"rpm": -5.0}, "--rpm -5; allowed is more than 0"),
        (
            {"helm": "100", "rudder": "-1.4"},
            "--helm 100; allowed for a rudder is an angle of more than 0 to 90 deg",
        ),
        (
            {"helm": "720"},
            "--helm 720; allowed for drives that turn is an angle of more than 0 to 360 deg",
        ),
        ({"helm": "30,0"}, "allowed is a rate of more than 0"),
        ({"tunnels": ["1"]}, "--tunnel 1; allowed is X,MAX_N"),
        ({"tunnels": ["9,50"]}, "--tunnel 9,50; allowed is a place within the length"),
        ({"curve": "0:0,100:60,50:30"}, "by increasing command and thrust"),
        ({"curve": "0-0"}, "allowed are 2 to 8 pairs COMMAND:N"),
        ({"curve": "0:0,1:5", "rpm": 100.0}, "leave out --rpm and --thrust"),
        ({"curve": "0:0,1:5", "thrusters": ["-1,0,60"]}, "leave out MAX_N and ASTERN_N"),
        ({"balance": 4.0}, "--balance 4; allowed is more than 0 to 3"),
        ({"depth": 0.01}, "--depth 0.01; allowed is more than the draught"),
        ({"hull_beam": 0.3}, "allowed with --hulls 2 only"),
        ({"hull_beam": 0.9, "hulls": 2}, "allowed is up to half of the beam, 0.8"),
    ],
)
def test_what_can_not_be_a_boat_is_refused_in_one_line(
    changed: dict[str, object], said: str
) -> None:
    with pytest.raises(BadInput, match=re.escape(said)):
        boat(**changed)


def test_a_folder_that_is_there_stays_as_it_is_without_force(tmp_path: Path) -> None:
    (tmp_path / "b").mkdir()
    args = ["new", str(tmp_path / "b"), *shlex.split(BOATS["twin"])]
    result = CliRunner().invoke(app, args)
    assert result.exit_code == 2
    assert not list((tmp_path / "b").iterdir())
    assert CliRunner().invoke(app, [*args, "--force"]).exit_code == 0
    assert sorted(p.name for p in (tmp_path / "b").iterdir()) == sorted(boat_files(boat()))


def test_nothing_is_left_of_a_boat_whose_log_can_not_be_read(tmp_path: Path) -> None:
    (tmp_path / "run.csv").write_text("t_s,x_m\n0,a\n")
    args = [
        "new",
        str(tmp_path / "b"),
        *shlex.split(BOATS["twin"]),
        "--from-log",
        str(tmp_path / "run.csv"),
    ]
    assert CliRunner().invoke(app, args).exit_code == 2
    assert [p.name for p in tmp_path.iterdir()] == ["run.csv"]


# ---- from a log


@pytest.mark.slow
def test_a_log_of_an_independent_boat_gives_its_lag_weak_reverse_and_current(
    tmp_path: Path,
) -> None:
    folder = made(tmp_path / "b", BOATS["twin"] + " --thrust 60")
    pushed_three_metre.write(tmp_path / "run.csv", 1)
    found = fit_boat(folder / "vessel.toml", [tmp_path / "run.csv"])
    told = {(f.effect, f.name): x for f, x in zip(found.best.free, found.best.theta, strict=True)}
    assert told["thrust_lag", "time_constant"] == pytest.approx(pushed_three_metre.LAG, abs=0.03)
    assert told["weak_reverse", "astern_factor"] == pytest.approx(
        pushed_three_metre.ASTERN, abs=0.03
    )
    current = [told["current", "north"], told["current", "east"]]
    assert np.allclose(current, pushed_three_metre.CURRENT, atol=0.01)
    for family, before in found.before.items():
        assert found.after[family] < 0.2 * before
    (folder / "vessel.toml").write_text(
        fitted_vessel_text(found, [tmp_path / "run.csv"]), encoding="utf-8"
    )
    again = vessel.load_vessel(str(folder))
    assert again.effect("current") is None  # the water's, not the boat's
    assert {"thrust_lag", "weak_reverse"} <= {e.name for e in again.effects}
    assert max(again.diagnosis.coefficient_uncertainty.values()) < 1.0


# ---- show, list


def test_all_that_has_a_name_can_be_shown() -> None:
    for name in (
        "weak_reverse",
        "thruster",
        "pid_autopilot",
        "turning_circle",
        "blueboat",
        "joystick_boat/sway_1",
    ):
        result = CliRunner().invoke(app, ["show", name])
        assert result.exit_code == 0, result.output
        assert "example:" in result.output


def test_an_effect_says_what_is_fitted_and_what_rules_it_out() -> None:
    lines = CliRunner().invoke(app, ["show", "tether"]).output.splitlines()
    assert "  ruled out by: moored = false" in lines
    assert ["tension", "0", "N", "0", "to", "1e+06", "yes", "constant", "tension"] in [
        line.split() for line in lines
    ]


def test_an_example_of_an_effect_can_be_pasted() -> None:
    lines = CliRunner().invoke(app, ["show", "weak_reverse"]).output.splitlines()
    pasted = "\n".join(line.strip() for line in lines[lines.index("example:") + 1 :])
    [table] = tomllib.loads(pasted)["effect"]
    assert vessel.load_vessel("blueboat", extra=[table]).effect("weak_reverse") is not None


@pytest.mark.parametrize(
    "command", [["show", "blueboot"], ["list", "scenarios", "kynok"], ["run", "jet_ski/heding"]]
)
def test_a_misspelt_name_is_answered_by_the_nearest_ones_in_one_short_line(
    command: list[str],
) -> None:
    result = CliRunner().invoke(app, command)
    assert result.exit_code == 2
    assert len(result.output) < 300
    assert "did you mean" in result.output or "such as" in result.output


def test_a_list_is_narrowed_to_names_with_a_word_or_like_a_pattern() -> None:
    by_word = CliRunner().invoke(app, ["list", "scenarios", "kynoc"]).output.splitlines()
    by_pattern = CliRunner().invoke(app, ["list", "scenarios", "kynoc/*"]).output.splitlines()
    assert by_word == by_pattern
    assert all("kynoc" in line for line in by_word[1:])


def test_the_bare_name_of_a_scenario_is_enough_where_one_only_has_it() -> None:
    assert scenario.load("sway_1").name == "joystick_boat/sway_1"
    bare = Counter(name.rpartition("/")[2] for name in shipped_content_names("scenario"))
    shared = next(name for name, times in bare.items() if times > 1)
    with pytest.raises(BadInput, match=f"several scenarios are called {shared}; give one of "):
        scenario.load(shared)
