"""Vessel files: loads and settings laid over them, and one clear line for whatever is wrong in
them."""

import re
from pathlib import Path
from typing import Any

import boats
import pytest

from boatsim.diagnosis import pipeline, priors
from boatsim.diagnosis.candidates import (
    candidate_library,
    has_fittable_parameter,
    name_without_prefixes,
    without_excluded_effects,
)
from boatsim.diagnosis.config import DEFAULT
from boatsim.diagnosis.problem import check_uncertain_coefficients
from boatsim.errors import BadInput
from boatsim.physics import content, vessel
from boatsim.physics.effects.added_mass import AddedMass
from boatsim.physics.effects.thruster import Thruster

COMMANDS = ("thrust_port_N", "thrust_starboard_N", "steer_port_rad", "steer_starboard_rad")


def of(text: str, tmp_path: Path, **more: Any) -> vessel.Vessel:
    return vessel.load_vessel(str(boats.written(tmp_path, "test_boat", text)), **more)


@pytest.mark.parametrize("name", content.shipped_content_names("vessel"))
def test_every_vessel_loads_in_every_load(name: str) -> None:
    boat = vessel.load_vessel(name)
    assert boat.about and boat.source and (boat.path / boat.hull).is_file()
    for load in boat.loads:
        assert vessel.load_vessel(name, [load]).load == (load,)
    for command in boat.commands.values():
        assert command.low < command.high


@pytest.mark.parametrize("name", content.shipped_content_names("vessel"))
def test_every_entry_that_is_tried_can_be_put_on_the_vessel_and_fitted(name: str) -> None:
    boat = vessel.load_vessel(name)
    library = candidate_library(boat)
    for entry in library.entries:
        own = [p for p in type(entry).params().values() if p.fit and p.axis in ("", *boat.dof)]
        assert own and set(type(entry).needs) <= set(boat.dof)
        vessel.check_bindings(boat.with_completed_effect(entry), name)
    there = set()
    for entry in library.entries:
        # an error of a single drive is an entry for each drive
        single = type(entry).once_per
        there.add(type(entry).type_name() if single else name_without_prefixes(entry.name))
    of_shelf = {
        n
        for n in content.shipped_content_names("effect")
        if has_fittable_parameter(content.load_class("effect", n))
    }
    # of single drives some may push in one direction only
    lacking = {n for n in library.inapplicable if n in of_shelf}
    assert there | lacking | set(library.excluded) == of_shelf and not there & lacking


def test_facts_and_the_vessels_reasons_leave_entries_out(tmp_path: Path) -> None:
    boat = vessel.load_vessel("trial_boat")
    everything = set(candidate_library(boat).tested_names)
    facts = {
        "indoors": True,
        "still_water": True,
        "no_waves": True,
        "moored": False,
        "position_fix": "gnss",
    }
    indoors = candidate_library(boat, (), facts | {"steering_measured": True})
    ruled_out = {n: why for n, why in indoors.excluded.items() if "--library" not in why}
    usual = {
        "wind",
        "current",
        "wave_forcing",
        "tether",
        "camera_scale",
        "steering_backlash",
        "steering_rate_limit",
    }
    of_drives = {"azimuth_backlash", "azimuth_delay", "azimuth_lag", "azimuth_rate_limit"}
    of_drives |= {"steering_lag", "steering_delay"}
    assert everything - set(indoors.tested_names) == usual
    assert set(ruled_out) == usual | of_drives
    assert not of_drives & set(indoors.tried_last)
    assert (
        indoors.excluded["wind"] == "indoors = true"
        and indoors.entries == candidate_library(boat).entries
    )
    blind = candidate_library(boat, (), None, ("t_s", "x_m", "y_m"))
    assert everything - set(blind.tested_names) == {"heading_offset", "heading_deviation"}
    reasons = '[diagnosis.leave_out]\ntether = "nothing is tied to it"\n'
    planar = of(boats.PLANAR + reasons, tmp_path)
    assert (
        candidate_library(planar).excluded["tether"] == "the vessel's reason: nothing is tied to it"
    )
    with pytest.raises(BadInput, match="leave_out 'tehter' does not exist; did you mean 'tether'"):
        candidate_library(of(boats.PLANAR + reasons.replace("tether", "tehter"), tmp_path))


def test_what_facts_rule_out_does_not_act_either_where_it_is_the_vessels_own() -> None:
    """A measured angle is behind the steering machine: its limit would hold it back once more."""
    ship = vessel.load_vessel("kvlcc2_mmg")
    measured = without_excluded_effects(ship, {"steering_measured": True})
    assert [e.name for e in ship.effects if e not in measured.effects] == ["steering_rate_limit"]
    assert (
        without_excluded_effects(ship, {"steering_measured": False, "indoors": True}).effects
        == ship.effects
    )


def test_an_entry_that_shows_as_another_does_is_tried_where_it_is_asked_for() -> None:
    boat = vessel.load_vessel("trial_boat")
    usual = candidate_library(boat)
    assert (
        "shallow_water" not in usual.tested_names
        and "added_mass_error" in usual.excluded["shallow_water"]
    )
    assert set(candidate_library(boat, ["shallow_water"]).tested_names) == {
        *usual.tested_names,
        "shallow_water",
    }


def test_what_takes_the_place_of_a_rule_needs_a_reason(tmp_path: Path) -> None:
    with pytest.raises(BadInput, match="rate replaces a rule; give the reason in reasons.rate"):
        of(boats.PLANAR + "[diagnosis]\nrate = 3.0\n", tmp_path)
    boat = of(
        boats.PLANAR + '[diagnosis]\nrate = 3.0\nreasons = { rate = "a slow hull" }\n', tmp_path
    )
    assert priors.downsampling_rate(boat) == priors.downsampling_rate(boat, 36_000.0) == 3.0


def test_rows_of_a_long_recording_are_thinned_by_its_length_but_never_to_less_than_a_quarter() -> (
    None
):
    boat = vessel.load_vessel("trial_boat")
    usual = priors.downsampling_rate(boat)
    assert priors.downsampling_rate(boat, 300.0) == usual
    assert 1200.0 * priors.downsampling_rate(boat, 1200.0) == pytest.approx(
        DEFAULT.load.enough_rows
    )
    assert priors.downsampling_rate(boat, 36_000.0) == pytest.approx(
        DEFAULT.load.least_row_share * usual
    )


@pytest.mark.parametrize("name", content.shipped_content_names("vessel"))
def test_every_uncertainty_that_a_vessel_states_is_one_of_its_coefficients(name: str) -> None:
    boat = vessel.load_vessel(name)
    check_uncertain_coefficients(boat, priors.coefficient_uncertainty(boat), name)


def test_an_uncertainty_that_nothing_takes_up_is_one_line(tmp_path: Path) -> None:
    boat = of(boats.PLANAR, tmp_path)
    check_uncertain_coefficients(boat, {"damping": 0.1, "thrust": 0.1}, "here")
    for kind, hint in (("restoring", ""), ("thurst", "; did you mean 'thrust'")):
        line = f"here: coefficient_uncertainty.{kind} = 0.1, but test_boat has no coefficient of {kind}{hint}; "
        with pytest.raises(BadInput, match=f"^{line}allowed are added_mass, damping, thrust$"):
            check_uncertain_coefficients(boat, {"damping": 0.1, kind: 0.1}, "here")


@pytest.mark.parametrize("where", ["vessel", "notes"])
def test_a_diagnosis_refuses_an_uncertainty_that_nothing_takes_up(
    tmp_path: Path, where: str
) -> None:
    stated = "coefficient_uncertainty = { restoring = 0.1 }\n"
    place = boats.written(
        tmp_path,
        "test_boat",
        boats.PLANAR + (f"[diagnosis]\n{stated}" if where == "vessel" else ""),
    )
    (tmp_path / "recording.toml").write_text(stated if where == "notes" else "")
    for name in ("one", "two"):
        rows = [f"{0.1 * i:.1f},{0.01 * i:g},0,0,0.1,0.1,0,0" for i in range(40)]
        (tmp_path / f"{name}.csv").write_text(
            "\n".join(["t_s,x_m,y_m,psi_rad," + ",".join(COMMANDS), *rows])
        )
    label = (
        "test_boat/vessel.toml: diagnosis: "
        if where == "vessel"
        else r"one\.csv by its recording\.toml: "
    )
    with pytest.raises(
        BadInput, match=f"{label}coefficient_uncertainty.restoring = 0.1, but test_boat has no"
    ):
        pipeline.diagnose([tmp_path / "one.csv"], [tmp_path / "two.csv"], str(place))


def test_a_load_changes_what_it_names_and_nothing_else(tmp_path: Path) -> None:
    plain, laden = boats.planar(tmp_path), boats.planar(tmp_path, loads=["laden"])
    assert (plain.body.mass, laden.body.mass) == (6.0, 8.0)
    assert (plain.length, laden.length) == (1.0, 1.5)
    assert laden.body.yaw_inertia == plain.body.yaw_inertia
    assert laden.effect("added_mass") == AddedMass(surge=0.9, sway=3.0, yaw=0.3, roll=0.0)
    assert plain.effects[1:] == laden.effects[1:]


def test_loads_add_up_and_settings_go_on_top() -> None:
    boat = vessel.load_vessel("joystick_boat", ["heavy", "wide"], {"port": {"gain": 0.9}})
    assert boat.load == ("heavy", "wide")
    on = {"thrust": "thrust_port_N", "angle": "steer_port_rad"}
    assert boat.effect("port") == Thruster(x=-0.571, y=-0.28, gain=0.9, name="port", on=on)
    assert boat.body.mass == 5.6 and boat.body.roll_inertia == 0.3
    assert boat.geometry["ballast_mass"] == 1.0 and boat.geometry["motor_half_spacing"] == 0.28


def test_settings_can_change_the_body(tmp_path: Path) -> None:
    assert boats.planar(tmp_path, {"body": {"mass": 7.0}}).body.mass == 7.0


def test_extra_effects_come_after_the_vessels_own() -> None:
    boat = vessel.load_vessel(
        "trial_boat", extra=[{"use": "current", "north": 0.1}, {"use": "weak_reverse"}]
    )
    assert [e.name for e in boat.effects][-4:] == ["port", "starboard", "current", "weak_reverse"]


def test_what_the_vessel_is_asked_for() -> None:
    boat = vessel.load_vessel("joystick_boat")
    assert boat.effect("wind") is None
    assert boat.actuators == (
        "thrust_port_N",
        "thrust_starboard_N",
        "steer_port_rad",
        "steer_starboard_rad",
    )
    assert boat.limits()["pwm_port"] == (-255.0, 255.0)
    assert boat.roles["thrust_port_N"] == "thrust" and "pwm_port" not in boat.roles
    assert boat.angles == ("steer_port_rad", "steer_starboard_rad")
    fed = boat.effect("pwm_thrust")
    assert (
        fed is not None and boat.command_for_actuator(fed, "thrust_starboard_N") == "pwm_starboard"
    )
    assert [boat.side(n) for n in ("thrust_port_N", "pwm_starboard", "steer_starboard_rad")] == [
        -1,
        1,
        1,
    ]
    assert boat.names_of("thruster") == ["port", "starboard"] and boat.names_of("port") == ["port"]
    assert boat.effect("thruster") is None  # which of them?


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (
            ("about =", "abuot ="),
            r"test_boat/vessel\.toml: key 'abuot' does not exist; did you mean 'about'",
        ),
        (
            ("roll_inertia", "roll_inerta"),
            r"key in \[body\] 'roll_inerta' .*did you mean 'roll_inertia'",
        ),
        (
            ("mass = 6.0", "mass = -6.0"),
            r"vessel\.toml: body\.mass = -6\.0; input should be greater than 0",
        ),
        (("beam = 0.4\n", ""), r"vessel\.toml: beam is missing"),
        (
            ('"yaw"]', '"jaw"]'),
            r"freedoms\.2 = 'jaw'; input should be 'surge', 'sway', 'heave', 'roll', 'pitch' or 'yaw'",
        ),
        (
            ("high = 100.0 }", "high = 100.0, side = 1 }"),
            r"key in \[channels\.thrust_port_N\] 'side' does not exist",
        ),
        (
            ('use = "current"', 'use = "curent"'),
            "effect 'curent' does not exist; did you mean 'current'",
        ),
        (
            ("sway = 3.0", "swai = 3.0"),
            "test_boat/vessel.toml: AddedMass: setting 'swai' does not exist; did you mean 'sway'",
        ),
        (
            ("surge = 0.6", "surge = -0.6"),
            r"test_boat/vessel.toml: AddedMass\.surge = -0\.6 kg; allowed 0 to 1e\+09 kg \(-X_udot\)",
        ),
        (('use = "current"', "north = 0.1"), r"an \[\[effect\]\] needs use = its name"),
        (("length = 1.0", "length ="), "not a TOML file .*line 5"),
        (
            ("beam = 0.4\n", "beam = 0.4\ndiagnosis.facts.walls_m = [1.0, 2.0]\n"),
            r"diagnosis\.facts.*walls_m = \[1\.0, 2\.0\]; allowed is \[x_low, x_high, y_low, y_high\]",
        ),
    ],
)
def test_a_mistake_in_a_vessel_file_is_one_line(
    tmp_path: Path, change: tuple[str, str], message: str
) -> None:
    assert change[0] in boats.PLANAR
    with pytest.raises(BadInput, match=message) as refused:
        of(boats.PLANAR.replace(*change, 1), tmp_path)
    assert "\n" not in str(refused.value)


@pytest.mark.usefixtures("trusted")
def test_a_class_that_is_no_effect_is_one_line(tmp_path: Path) -> None:
    boats.written(
        tmp_path, "test_boat", boats.PLANAR.replace('use = "current"', 'use = "plain.py"')
    )
    (tmp_path / "test_boat" / "plain.py").write_text("class Plain:\n    pass\n")
    with pytest.raises(
        BadInput,
        match=r"plain\.py: class Plain is no effect; it must be derived from the base class of one",
    ):
        vessel.load_vessel(str(tmp_path / "test_boat" / "vessel.toml"))


PORT = 'on = { thrust = "thrust_port_N", angle = "steer_port_rad" }'
BINDINGS = [
    (
        PORT.replace("angle", "angel"),
        "effect port: on 'angel' does not exist; did you mean 'angle'? (there are: angle, thrust)",
    ),
    (
        PORT.replace("port_N", "prot_N"),
        "effect port: on.thrust channel 'thrust_prot_N' does not exist; did you mean 'thrust_port_N'",
    ),
    (
        'on = { angle = "steer_port_rad" }',
        "effect port: on.thrust is missing: the channel of its thrust, ahead positive; there are: thrust_port_N, ",
    ),
    ('on = "thrust_port_N"', "port: on = 'thrust_port_N'; allowed is a table of thrust, angle"),
    ("on = { thrust = true }", "port: on = {'thrust': True}; allowed is a table of thrust, angle"),
    ("on = { thrust = nan }", "port: on = {'thrust': nan}; allowed is a table of thrust, angle"),
]
MORE = [
    (
        'use = "thruster"\nname = "port"\non = { thrust = 1.0 }',
        "effect port occurs 2 times; each needs a unique name",
    ),
    ('use = "current"', "effect current occurs 2 times; each needs a unique name"),
    (
        'use = "weak_reverse"\non = "thrust_prot_N"',
        "effect weak_reverse: channel 'thrust_prot_N' does not exist; did you mean 'thrust_port_N'",
    ),
    (
        'use = "weak_reverse"\non = { thrust = "thrust_port_N" }',
        "weak_reverse: on = {'thrust': 'thrust_port_N'}; allowed is a name or a list of names",
    ),
    (
        'use = "pwm_thrust"\non = "thrust_port_N"\nfed_by = ["steer_port_rad", "steer_starboard_rad"]',
        "effect pwm_thrust: fed_by names 2 channels, on 1; each needs one",
    ),
    (
        'use = "pwm_thrust"\non = "thrust_port_N"\nfed_by = "pwm"',
        "effect pwm_thrust: channel 'pwm' does not exist",
    ),
    (
        'use = "prop_walk"\non = "prot"',
        "effect prop_walk: thruster 'prot' does not exist; did you mean 'port'",
    ),
    ('use = "steering_drag"', "effect steering_drag needs a vessel with rudder"),
]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        *((boats.PLANAR.replace(PORT, wrong, 1), message) for wrong, message in BINDINGS),
        *(
            (boats.PLANAR.replace("[loads", f"[[effect]]\n{table}\n\n[loads", 1), message)
            for table, message in MORE
        ),
    ],
    ids=[message[:40] for _, message in BINDINGS + MORE],
)
def test_a_bad_binding_is_one_line(tmp_path: Path, text: str, message: str) -> None:
    assert PORT in boats.PLANAR
    with pytest.raises(BadInput, match=re.escape(message)) as refused:
        of(text, tmp_path)
    assert str(refused.value).startswith("test_boat/vessel.toml: ") and "\n" not in str(
        refused.value
    )


@pytest.mark.parametrize(
    ("more", "message"),
    [
        (
            {"loads": ["ladden"]},
            r"test_boat/vessel\.toml: load 'ladden' does not exist; did you mean 'laden'",
        ),
        (
            {"settings": {"curent": {}}},
            "table to change 'curent' does not exist; did you mean 'current'",
        ),
        (
            {"settings": {"current": 1.0}},
            "test_boat/vessel.toml: current = 1.0; allowed is a table of its values",
        ),
        (
            {"settings": {"current": {"nort": 1.0}}},
            "Current: setting 'nort' does not exist; did you mean 'north'",
        ),
        ({"settings": {"current": {"north": 9.0}}}, r"Current\.north = 9 m/s; allowed -5 to 5 m/s"),
        (
            {"settings": {"body": {"mas": 9.0}}},
            r"key in \[body\] 'mas' does not exist; did you mean 'mass'",
        ),
        (
            {"extra": [{"use": "current"}]},
            r"current is one of test_boat's own effects; .*\[set\.current\]",
        ),
        ({"extra": [{"use": "wnid"}]}, "effect 'wnid' does not exist; did you mean 'wind'"),
    ],
)
def test_a_mistake_in_what_is_laid_over_it_is_one_line(
    tmp_path: Path, more: dict[str, Any], message: str
) -> None:
    with pytest.raises(BadInput, match=message) as refused:
        of(boats.PLANAR, tmp_path, **more)
    assert "\n" not in str(refused.value)


def test_a_vessel_that_does_not_exist_is_named_with_the_nearest() -> None:
    with pytest.raises(
        BadInput, match="vessel 'joystik_boat' does not exist; did you mean 'joystick_boat'"
    ):
        vessel.load_vessel("joystik_boat")


def test_a_command_that_does_not_exist_is_named_with_the_nearest() -> None:
    assert "did you mean 'pwm_port'" in vessel.load_vessel("joystick_boat").unknown_command_message(
        "pmw_port"
    )
