"""Laws of the faults that one drive of several has alone."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
import pytest
from driven_boats import platform_of_three_drives, platform_of_turning_drives

from boatsim.diagnosis.candidates import candidate_library
from boatsim.physics import vessel
from boatsim.physics.base import Array
from boatsim.physics.content import load_class, shipped_content_names
from boatsim.physics.vessel import Vessel
from boatsim.simulate.open_water import OpenWater

STEP = 0.02  # [s] of the simulation


def final_state(boat: Vessel, commands: Mapping[str, float | Array], steps: int = 100) -> Array:
    """Pose and velocities after commands, constant or one for each step, from rest.

    Before the first step the commands are the first ones.
    """
    orders = [np.broadcast_to(np.asarray(one), steps + 1) for one in commands.values()]
    table = np.column_stack(orders)
    engine = OpenWater(boat, STEP)
    engine.reset(commands=dict(zip(commands, table[0].tolist(), strict=True)))
    for row in table[1:]:
        engine.command(dict(zip(commands, row.tolist(), strict=True)))
        engine.advance()
    now = engine.state
    return np.array([now.x, now.y, now.psi, now.u, now.v, now.r])


@pytest.mark.parametrize(("command", "thrust"), [(5.0, 3.4), (1.2, 0.0), (-1.6, 0.0), (-4.0, -2.4)])
def test_a_dead_band_reduces_the_thrust_of_its_drive_alone(command: float, thrust: float) -> None:
    boat = platform_of_three_drives()
    dead = boat.with_effect({"use": "drive_deadband", "width": 1.6, "on": ["port_N"]})
    others = {"bow_N": 1.0, "starboard_N": 3.0}
    found = final_state(dead, {"port_N": command, **others})
    assert found == pytest.approx(final_state(boat, {"port_N": thrust, **others}))


@pytest.mark.parametrize(("command", "thrust"), [(5.0, 5.0), (-5.0, -3.0)])
def test_a_weak_reverse_reduces_the_thrust_astern_of_its_drive_alone(
    command: float, thrust: float
) -> None:
    boat = platform_of_three_drives()
    weak = boat.with_effect({"use": "drive_weak_reverse", "astern_factor": 0.6, "on": ["port_N"]})
    others = {"bow_N": -2.0, "starboard_N": -4.0}
    found = final_state(weak, {"port_N": command, **others})
    assert found == pytest.approx(final_state(boat, {"port_N": thrust, **others}))


def test_a_weak_reverse_is_a_candidate_for_drives_that_can_push_astern() -> None:
    names = {f"drive_weak_reverse_{drive}_N" for drive in ("bow", "port", "starboard")}
    assert "drive_weak_reverse" in candidate_library(platform_of_three_drives()).tried_last
    requested = candidate_library(platform_of_three_drives(), ("drive_weak_reverse",))
    assert names <= set(requested.tested_names)
    one_way = candidate_library(platform_of_turning_drives(), ("drive_weak_reverse",))
    assert not names & set(one_way.tested_names)
    assert one_way.inapplicable["drive_weak_reverse_port_N"] == "no command is negative"
    assert "drive_weak_reverse" not in candidate_library(platform_of_turning_drives()).tried_last


def test_a_dead_band_is_a_candidate_for_each_of_several_drives() -> None:
    several = candidate_library(platform_of_three_drives()).tested_names
    names = {f"drive_deadband_{drive}_N" for drive in ("bow", "port", "starboard")}
    assert names == {name for name in several if "drive_deadband" in name}
    two = candidate_library(vessel.load_vessel("trial_boat"))
    assert "drive_deadband" in two.tried_last
    assert not {name for name in two.tested_names if "drive_deadband" in name}


def test_a_loss_with_the_speed_reduces_the_speed_under_one_drive() -> None:
    """In the steady state (d + l T) u = 2 T, with the loss l of one of two drives with thrust T."""
    boat = replace(platform_of_three_drives(), dof=("surge",))
    lossy = boat.with_effect({"use": "drive_loss_with_speed", "loss": 0.5, "on": ["port"]})
    commands = {"port_N": 4.0, "starboard_N": 4.0, "bow_N": 3.0}
    speed = final_state(lossy, commands, round(100.0 / STEP))[3]
    assert speed == pytest.approx(2.0 * 4.0 / (6.0 + 0.5 * 4.0), rel=1e-5)


@pytest.mark.parametrize(("direction", "share"), [(0.0, 0.7), (np.pi, 1.0)])
def test_a_race_on_the_hull_reduces_the_thrust_of_its_drive_alone(
    direction: float, share: float
) -> None:
    """The drive at the bow pushes astern or ahead; ahead its race is directed at the hull."""
    boat = platform_of_turning_drives()
    table = {"use": "drive_hull_interaction", "loss": 0.3, "on": ["bow"]}
    others = {"port_N": 4.0, "starboard_N": 3.0, "port_rad": np.pi, "starboard_rad": np.pi}
    commands = {**others, "bow_rad": direction}
    found = final_state(boat.with_effect(table), {**commands, "bow_N": 5.0})
    assert found == pytest.approx(final_state(boat, {**commands, "bow_N": share * 5.0}))


def test_a_race_on_the_hull_is_a_candidate_for_each_drive_that_turns() -> None:
    boat = platform_of_turning_drives(("port", "starboard"))
    assert "drive_hull_interaction" in candidate_library(boat).tried_last
    library = candidate_library(boat, ("drive_hull_interaction",))
    names = {name for name in library.tested_names if "drive_hull_interaction" in name}
    assert names == {"drive_hull_interaction_port", "drive_hull_interaction_starboard"}
    assert "60 degrees" in library.inapplicable["drive_hull_interaction_bow"]
    assert "drive_hull_interaction" in candidate_library(vessel.load_vessel("mariner")).inapplicable


def test_races_of_all_others_reduce_the_thrust_of_one_drive_alone() -> None:
    """Where all drives push alike, the published ratios of both races multiply."""
    boat = replace(platform_of_turning_drives(), dof=("surge",))
    table = {"use": "drive_interaction", "size": 1.0, "diameter": 0.1, "on": ["starboard"]}
    push = {"bow_N": 4.0, "port_N": 4.0, "starboard_N": 4.0}
    # the races of both other drives are directed at the starboard one, which pushes ahead
    turned = {"bow_rad": float(np.arctan2(-0.3, 1.2)), "port_rad": -0.5 * np.pi}
    share = 1.0
    for distance in (float(np.hypot(1.2, 0.3)), 0.6):
        share *= 1.0 - 0.75 ** ((distance / 0.1) ** (2.0 / 3.0))
    assert share < 0.9
    commands = {**turned, "starboard_rad": 0.0}
    found = final_state(boat.with_effect(table), {**push, **commands})
    given = final_state(boat, {**push, **commands, "starboard_N": share * 4.0})
    assert found == pytest.approx(given)


def test_a_drive_in_a_race_is_a_candidate_where_another_one_can_be_turned_on_it() -> None:
    boat = platform_of_turning_drives(("bow",))
    assert "drive_interaction" in candidate_library(boat).tried_last
    library = candidate_library(boat, ("drive_interaction",))
    names = {name for name in library.tested_names if "drive_interaction" in name}
    assert names == {"drive_interaction_port", "drive_interaction_starboard"}
    assert "in the race of another" in library.inapplicable["drive_interaction_bow"]


# ---- the direction of one drive


T = STEP * np.arange(101)  # [s] from the last instant before the first step
TURN = np.where(T > 0.0, 0.8, 0.0)  # rad
FORTH_AND_BACK = 0.6 * np.sin(2.0 * np.pi * T)  # rad
OTHERS = {"bow_N": 0.0, "port_N": 4.0, "starboard_N": 4.0, "bow_rad": 0.0}


def turned_alike(effect: dict[str, object], order: Array, port: Array, rel: float) -> None:
    """An effect on the port drive acts as if this drive alone had the directions `port`."""
    boat = platform_of_turning_drives()
    changed = boat.with_effect({**effect, "on": ["port_rad"]})
    found = final_state(changed, {**OTHERS, "port_rad": order, "starboard_rad": order})
    given = final_state(boat, {**OTHERS, "port_rad": port, "starboard_rad": order})
    sound = final_state(boat, {**OTHERS, "port_rad": order, "starboard_rad": order})
    assert found == pytest.approx(given, rel=rel)
    assert abs(found - sound).max() > 0.005


def test_a_lag_of_one_direction_is_an_exponential_approach() -> None:
    tau = 0.5  # s
    # mean over each step of the closed form 0.8 (1 - exp(-t / tau))
    decay = np.exp(-(T - STEP) / tau) - np.exp(-T / tau)
    mean = np.where(T > 0.0, 0.8 * (1.0 - decay * tau / STEP), 0.0)
    turned_alike({"use": "azimuth_lag", "time_constant": tau}, TURN, mean, 1e-3)


def test_a_dead_time_of_one_direction_shifts_it() -> None:
    late = np.where(T > 0.4 + 0.5 * STEP, 0.8, 0.0)
    turned_alike({"use": "azimuth_delay", "delay": 0.4}, TURN, late, 1e-9)


def test_play_of_one_direction_follows_the_ends_of_the_play() -> None:
    width, port = 0.3, np.zeros(len(T))  # rad
    for i in range(1, len(T)):
        low, high = FORTH_AND_BACK[i] - 0.5 * width, FORTH_AND_BACK[i] + 0.5 * width
        port[i] = min(max(port[i - 1], low), high)
    turned_alike({"use": "azimuth_backlash", "width": width}, FORTH_AND_BACK, port, 1e-9)


@pytest.mark.parametrize(
    ("common", "single", "setting", "kind"),
    [
        ("steering_lag", "azimuth_lag", {"time_constant": 0.5}, "rad"),
        ("steering_delay", "azimuth_delay", {"delay": 0.4}, "rad"),
        ("thrust_delay", "drive_delay", {"delay": 0.4}, "N"),
        ("thrust_rate_limit", "drive_rate_limit", {"rate": 5.0}, "N"),
    ],
)
def test_an_error_of_all_drives_is_that_of_each_of_them(
    common: str, single: str, setting: dict[str, float], kind: str
) -> None:
    boat = platform_of_turning_drives()
    changed, sound = boat.with_effect({"use": common, **setting}), boat
    for drive in ("bow", "port", "starboard"):
        channel = f"{drive}_{kind}"
        boat = boat.with_effect({"use": single, "name": channel, "on": [channel], **setting})
    pushed = np.where(T > 0.0, 5.0, 0.0)
    commands = {"bow_N": 0.5 * pushed, "port_N": pushed, "starboard_N": 0.3 * pushed}
    commands |= {"bow_rad": -TURN, "port_rad": TURN, "starboard_rad": 0.3 * TURN}
    found = final_state(changed, commands)
    assert found == pytest.approx(final_state(boat, commands), rel=1e-9, abs=1e-12)
    assert abs(found - final_state(sound, commands)).max() > 0.005


def test_errors_that_all_drives_share_are_candidates_where_those_of_single_ones_are() -> None:
    turning = candidate_library(platform_of_turning_drives()).tested_names
    assert {"steering_lag", "steering_delay", "thrust_delay", "thrust_rate_limit"} <= set(turning)
    one = candidate_library(platform_of_turning_drives(("bow",)))
    assert not {"steering_lag", "steering_delay"} & set(one.tested_names)
    fixed = candidate_library(platform_of_three_drives())
    assert "command_delay" in fixed.inapplicable["thrust_delay"]
    assert "thrust_rate_limit" in fixed.tested_names
    two = candidate_library(vessel.load_vessel("trial_boat"))
    assert {"steering_lag", "steering_delay"} <= set(two.tried_last)


def test_every_error_of_a_single_drive_has_one_of_all_drives_with_its_parameters() -> None:
    for name in shipped_content_names("effect"):
        kind = load_class("effect", name)
        if not kind.once_per or kind.jointly:
            continue
        assert kind.of_all, name
        own = {key for key, about in kind.params().items() if about.fit}
        for common in kind.of_all:
            other = load_class("effect", common)
            assert own <= {key for key, about in other.params().items() if about.fit}


AZIMUTH = ("azimuth_lag", "azimuth_delay", "azimuth_backlash", "azimuth_rate_limit")


@pytest.mark.parametrize("turning", [("bow", "port", "starboard"), ("port", "starboard")])
def test_faults_of_each_direction_are_candidates_where_several_drives_turn(
    turning: tuple[str, ...],
) -> None:
    """The number of drives decides, and not that of the drives that turn."""
    tested = candidate_library(platform_of_turning_drives(turning)).tested_names
    names = {f"{effect}_{drive}_rad" for effect in AZIMUTH for drive in turning}
    assert names == {name for name in tested if "azimuth" in name}


def test_faults_of_each_direction_are_none_where_one_drive_turns() -> None:
    """Where one drive turns, an error of all directions is the same as that of its direction."""
    library = candidate_library(platform_of_turning_drives(("bow",)))
    assert "drives" in library.inapplicable["azimuth_rate_limit"]
    assert not {name for name in library.tested_names if "azimuth" in name}


def test_faults_of_each_of_two_directions_are_tried_last() -> None:
    library = candidate_library(vessel.load_vessel("trial_boat"))
    assert {"azimuth_rate_limit", "azimuth_lag", "azimuth_delay"} <= set(library.tried_last)
    assert not {name for name in library.tested_names if "azimuth" in name}


def test_directions_that_were_measured_have_no_such_faults() -> None:
    measured = candidate_library(platform_of_turning_drives(), (), {"steering_measured": True})
    assert not {name for name in measured.tested_names if "azimuth" in name}
