"""Drives on one supply: what each loses by the load of the others."""

import pytest

from boatsim.diagnosis.candidates import candidate_library
from boatsim.errors import BadInput
from boatsim.physics.base import make_motion
from boatsim.physics.drive_ranges import drive_ranges
from boatsim.physics.effects.shared_supply import SharedSupply
from boatsim.physics.effects.thruster import Thruster
from boatsim.physics.vessel import load_vessel

SUPPLY = SharedSupply(loss=0.3, full_others=20.0)


def loss(own: float, *others: float, supply: SharedSupply = SUPPLY) -> float:
    """Share of its thrust that a drive loses."""
    given = []
    for thrust in (own, *others):
        given += [Thruster.signals(thrust=thrust), Thruster(y=0.4, gain=0.5).values()]
    return -supply.wrench(make_motion(), *given).X / (0.5 * own)


def test_a_drive_alone_loses_nothing() -> None:
    assert loss(10.0) == 0.0
    assert loss(10.0, 0.0, 0.0) == 0.0


def test_the_loss_is_reached_at_full_load_of_the_others_in_either_direction() -> None:
    for own in (10.0, -3.0):
        assert loss(own, 20.0, -20.0) == pytest.approx(0.3)
        assert loss(own, 20.0, 0.0) == pytest.approx(0.15)


def test_a_drive_loses_all_of_its_thrust_at_most() -> None:
    assert loss(10.0, 80.0, -80.0) == pytest.approx(1.0)


def test_the_full_load_follows_from_the_largest_commands() -> None:
    vessel = load_vessel("osv").with_effect({"use": "shared_supply", "loss": 0.1})
    supply = vessel.effect("shared_supply")
    assert isinstance(supply, SharedSupply)
    assert supply.full_others == pytest.approx(0.75 * (300e3 + 300e3 + 655e3 + 420e3))
    two = load_vessel("osv").with_effect({"use": "shared_supply", "on": ["port", "starboard"]})
    pair = two.effect("shared_supply")
    assert isinstance(pair, SharedSupply)
    assert pair.full_others == pytest.approx(0.5 * (655e3 + 420e3))


def test_the_full_thrust_of_a_propeller_is_that_of_its_largest_shaft_rate() -> None:
    otter = load_vessel("otter")
    effect = SharedSupply()
    (port, _), propeller = drive_ranges(effect, otter), otter.effects_of_type("propeller")[0]
    low, high = otter.limits()["n_port_radps"]
    assert port.ahead == pytest.approx(propeller.ahead * high**2)  # type: ignore[attr-defined]
    assert port.astern == pytest.approx(propeller.astern * low**2)  # type: ignore[attr-defined]


def test_it_is_tested_from_three_drives_on_and_refuses_drives_that_do_not_exist() -> None:
    assert "shared_supply" in candidate_library(load_vessel("osv")).tested_names
    reason = candidate_library(load_vessel("trial_boat")).inapplicable["shared_supply"]
    assert reason == "fewer than 3 drives that could share a supply"
    asked = candidate_library(load_vessel("trial_boat"), ("shared_supply",))
    assert "shared_supply" in asked.tested_names
    with pytest.raises(BadInput, match="'prt' does not exist; did you mean 'port'"):
        load_vessel("osv").with_effect({"use": "shared_supply", "on": ["prt"]})
