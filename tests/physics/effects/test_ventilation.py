"""Propellers near the surface: published factor, immersion, and recordings in which it is found."""

from collections.abc import Sequence
from math import pi
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from alike import long
from answers import diagnosed, named, nothing_missing
from driven_boats import PER_ROW, STEP, ranked
from scipy.spatial.transform import Rotation

from boatsim.diagnosis.candidates import candidate_library
from boatsim.errors import BadInput
from boatsim.physics import vessel
from boatsim.physics.base import Array, make_motion
from boatsim.physics.effects.irregular_sea import IrregularSea
from boatsim.physics.effects.propeller import Propeller
from boatsim.physics.effects.thruster import Thruster
from boatsim.physics.effects.ventilation import Ventilation, thrust_diminution
from boatsim.physics.vessel import Vessel
from boatsim.recordings.table import Notes, Recording
from boatsim.simulate.open_water import OpenWater
from boatsim.simulate.stepper import State

OTTER = Path(__file__).parents[3] / "models" / "otter"


def published(ratio: float | Array) -> Array:
    """Minsaas, Faltinsen and Persson 1983: thrust near the surface over that of a deep propeller."""
    above = np.maximum(1.0 - 0.769 * np.asarray(ratio), 0.0)
    return np.maximum(1.0 - 0.675 * above**1.258, 0.0)


@pytest.mark.parametrize(
    ("ratio", "factor"),
    [(2.0, 1.0), (1.3, 1.0), (1.0, 0.893), (0.5, 0.633), (0.0, 0.325), (-0.48, 0.0), (-1.0, 0.0)],
)
def test_the_factor_is_the_published_one(ratio: float, factor: float) -> None:
    assert thrust_diminution.py_func(ratio) == pytest.approx(factor, abs=2e-3)
    assert thrust_diminution.py_func(ratio) == pytest.approx(float(published(ratio)), abs=1e-12)


def test_the_factor_rises_with_the_immersion_without_jumps() -> None:
    ratios = np.linspace(-1.0, 2.0, 3001)
    factors = np.array([thrust_diminution.py_func(ratio) for ratio in ratios])
    steps = np.diff(factors)
    # its slope is at most that where the thrust vanishes, 0.675 0.769 1.258 1.367^0.258
    assert steps.min() >= 0.0 and steps.max() < 0.71 * 1e-3


def lost_thrust(effect: Ventilation, place: tuple[float, float, float], **motion: float) -> float:
    """Thrust [N] that a thruster of 10 N at a place loses."""
    mount = Thruster(x=place[0], y=place[1], z=place[2]).values()
    own = Thruster.signals(thrust=10.0)
    return -effect.wrench(make_motion(**motion), own, mount).X


@pytest.mark.parametrize(
    "motion",
    [
        {},
        {"z": -0.05},
        {"theta": -0.1},
        {"theta": 0.1, "phi": 0.3},
        {"z": 0.02, "theta": 0.2, "phi": -0.4, "psi": 2.0},
    ],
)
def test_the_immersion_is_the_depth_of_the_mount_in_any_attitude(motion: dict[str, float]) -> None:
    place, effect = (-0.9, 0.3, 0.12), Ventilation(loss=0.8, radius=0.15, shaft_depth=0.0)
    angles = [motion.get(name, 0.0) for name in ("psi", "theta", "phi")]
    depth = motion.get("z", 0.0) + Rotation.from_euler("ZYX", angles).apply(place)[2]
    expected = 0.8 * (1.0 - float(published(depth / 0.15))) * 10.0
    assert lost_thrust(effect, place, **motion) == pytest.approx(expected)


def test_a_stern_that_rises_loses_thrust_and_one_that_sinks_does_not() -> None:
    effect, place = Ventilation(loss=1.0, radius=0.1, shaft_depth=0.0), (-0.9, 0.0, 0.14)
    assert lost_thrust(effect, place) == 0.0
    assert lost_thrust(effect, place, theta=-0.1) > 2.0  # bow down
    assert lost_thrust(effect, place, theta=0.1) == 0.0


@pytest.mark.parametrize("height", [0.05, 0.2, 1.0])
def test_a_propeller_that_draws_air_loses_all_of_its_thrust_at_most(height: float) -> None:
    effect = Ventilation(loss=4.0, radius=0.1, shaft_depth=0.0)
    lost = lost_thrust(effect, (-0.9, 0.0, 0.05), z=-height)
    assert lost == pytest.approx(10.0)


@pytest.mark.parametrize("spreading", [0.0, 2.0])
def test_a_wave_counts_with_its_elevation_at_the_propeller(spreading: float) -> None:
    sea = {"significant_height": 0.3, "modal_period": 3.0, "toward": 0.7, "components": 20.0}
    sea |= {"spreading": spreading, "realisation": 5.0}
    effect = Ventilation(loss=1.0, radius=0.2, shaft_depth=0.15, **sea)
    field = IrregularSea(**sea).wave_field()
    assert field is not None and effect.wave_field() is None
    seeded = effect.with_seed(7), IrregularSea(**sea).with_seed(7)
    assert seeded[0].realisation == seeded[1].realisation != effect.realisation
    x, y = -0.9, 0.3
    for t, north, east, psi in ((0.0, 0.0, 0.0, 0.0), (7.3, 2.0, -5.0, 1.1)):
        propeller_north = north + x * np.cos(psi) - y * np.sin(psi)
        propeller_east = east + x * np.sin(psi) + y * np.cos(psi)
        depth = 0.15 + float(field.elevation(propeller_north, propeller_east, t))
        expected = (1.0 - float(published(depth / 0.2))) * 10.0
        found = lost_thrust(effect, (x, y, 0.0), t=t, x=north, y=east, psi=psi)
        assert found == pytest.approx(expected, abs=1e-9)


def test_a_vessel_without_depths_of_its_mounts_has_its_shafts_at_its_draught() -> None:
    otter = vessel.load_vessel("otter")
    effect = Ventilation().with_all_parameters(otter)
    assert effect.shaft_depth == pytest.approx(otter.draught)
    assert effect.radius == pytest.approx(0.769 * otter.draught)
    at_rest = Ventilation(loss=1.0).with_all_parameters(otter)
    own = Propeller.as_thruster(Propeller.signals(shaft=80.0), Propeller().values())
    assert at_rest.wrench(make_motion(), own, Thruster().values()).X == pytest.approx(0.0, abs=1e-9)


def test_depths_of_mounts_are_used_where_they_are_given() -> None:
    effect = Ventilation().with_all_parameters(pitching_craft())
    assert (effect.shaft_depth, effect.radius) == (0.0, pytest.approx(0.769 * 0.12))
    both = pitching_craft({"z": -0.1})
    with pytest.raises(BadInput, match="platform: ventilation: a mount at z = -0.1 m is not below"):
        Ventilation().with_all_parameters(both)


def test_it_is_tested_only_where_a_vessel_heaves_or_pitches() -> None:
    assert "ventilation" in candidate_library(vessel.load_vessel("otter")).tested_names
    level = candidate_library(vessel.load_vessel("trial_boat"))
    assert level.inapplicable["ventilation"] == "no degree of freedom in heave or pitch"


# ---- recordings on still water, of hulls that a machine pulls up and down by a recorded force


def pitching_craft(second: dict[str, float] | None = None) -> Vessel:
    """A craft that surges, heaves and pitches, with a thruster at its stern 0.12 m below water."""
    on = {"thrust": "drive_N"}
    effects: list[dict[str, object]] = [
        {"use": "linear_damping", "surge": 15.0, "heave": 200.0, "pitch": 30.0},
        {"use": "hydrostatics", "heave": 600.0, "pitch": 80.0, "roll": 80.0},
        {"use": "thruster", "name": "drive", "on": on, "x": -0.7, "z": 0.12},
        {"use": "applied_load", "on": {"force": "winch_N"}, "heave": 1.0, "x": -0.4},
    ]
    if second is not None:
        effects.append({"use": "thruster", "name": "second", "on": on, **second})
    return Vessel.from_effects(
        name="platform",
        dof=("surge", "heave", "pitch"),
        length=1.5,
        beam=0.6,
        draught=0.15,
        body={"mass": 30.0, "roll_inertia": 1.0, "pitch_inertia": 5.0, "yaw_inertia": 5.0},
        effects=effects,
        channels={
            "drive_N": {"low": -20.0, "high": 20.0},
            "winch_N": {"low": -300.0, "high": 300.0},
        },
        diagnosis={"facts": {"still_water": True, "no_waves": True, "indoors": True}},
    )


def pulled_otter(folder: Path) -> Vessel:
    """The Otter under a winch above its origin."""
    text = (OTTER / "vessel.toml").read_text(encoding="utf-8")
    channel = "[channels]\nwinch_N = { low = -600.0, high = 600.0 }\n"
    load = '\n[[effect]]\nuse = "applied_load"\non = { force = "winch_N" }\nheave = 1.0\n'
    facts = "\n[diagnosis]\nfacts = { still_water = true, no_waves = true, indoors = true }\n"
    place = folder / "pulled_otter"
    place.mkdir()
    (place / "vessel.toml").write_text(
        text.replace("[channels]\n", channel, 1) + load + facts, encoding="utf-8"
    )
    (place / "hull.xml").write_bytes((OTTER / "hull.xml").read_bytes())
    return vessel.load_vessel(str(place))


NOISE = {"x": 0.003, "y": 0.003, "z": 0.003, "phi": 0.004, "theta": 0.004, "psi": 0.004}
CRAFT_NOISE = {name: NOISE[name] for name in ("x", "z", "theta")}
UNITS = {"x": "m", "y": "m", "z": "m", "phi": "rad", "theta": "rad", "psi": "rad"}


def sailed(
    boat: Vessel, commands: dict[str, Array], seed: int, noise: dict[str, float]
) -> Recording:
    """A recording of a vessel under commands, one for each row of 0.2 s.

    The force of the winch is measured at the rows and changes steadily between them.
    """
    rng = np.random.default_rng(seed)
    engine = OpenWater(boat, STEP)
    rows: list[list[float]] = []
    for row in range(len(next(iter(commands.values())))):
        rows.append([getattr(engine.state, name) for name in noise])
        now = {name: float(orders[row]) for name, orders in commands.items()}
        further = commands["winch_N"][min(row + 1, len(commands["winch_N"]) - 1)] - now["winch_N"]
        for step in range(PER_ROW):
            pull = now["winch_N"] + further * (step + 0.5) / PER_ROW
            engine.command({**now, "winch_N": pull})
            engine.advance(1)
    seen = np.array(rows) + rng.standard_normal((len(rows), len(noise))) * list(noise.values())
    columns = [f"{name}_{UNITS[name]}" for name in noise]
    signals = dict(zip(columns, seen.T, strict=True)) | commands
    return Recording(f"run_{seed}", np.arange(len(rows)) * STEP * PER_ROW, signals, Notes())


def pulls(rng: np.random.Generator, rows: int, largest: float) -> Array:
    """Forces of a winch [N] with three frequencies, up and down."""
    t = np.arange(rows) * STEP * PER_ROW
    parts = [np.sin(w * t + rng.uniform(0.0, 2.0 * pi)) for w in (0.7, 1.3, 2.1)]
    return largest * np.sum(parts, axis=0) / 3.0


RIVALS = (
    "ventilation",
    "thrust_gain_error",
    "thrust_loss_with_speed",
    "thrust_exponent",
    "thrust_deadband",
    "shaft_deadband",
    "quadratic_damping",
    "steady_force",
    "wave_forcing",
)


def ranking_of(name: str, loss: float, folder: Path) -> Any:
    """What two recordings say of a vessel with or without loss of thrust near the surface."""
    boat = pitching_craft() if name == "platform" else pulled_otter(folder)
    truth = boat
    if loss > 0.0:
        truth = boat.with_effect({"use": "ventilation", "loss": loss})
    recordings = []
    for seed in (1, 2):
        rng = np.random.default_rng(seed)
        if name == "platform":
            orders = {"drive_N": np.repeat(rng.uniform(0.0, 15.0, 15), 20)}
            orders["winch_N"] = pulls(rng, 300, 50.0)
            recordings.append(sailed(truth, orders, seed, CRAFT_NOISE))
            continue
        level = rng.uniform(20.0, 90.0, (15, 2))
        level[:, 1] = level[:, 0] + 10.0 * (rng.random(15) - 0.5)
        port, starboard = np.repeat(level, 20, axis=0).T
        orders = {"n_port_radps": port, "n_starboard_radps": starboard}
        orders["winch_N"] = pulls(rng, 300, 550.0)
        recordings.append(sailed(truth, orders, seed, NOISE))
    return ranked(boat, RIVALS, *recordings)


@pytest.mark.slow
@pytest.mark.parametrize("name", ["platform", long("otter")])
def test_a_loss_near_the_surface_is_found_with_its_size(name: str, tmp_path: Path) -> None:
    ranking = ranking_of(name, 1.0, tmp_path)
    assert [one.name for one in ranking.named] == ["ventilation"]
    value, sd = ranking.best.value("ventilation", "loss")
    assert abs(value - 1.0) < max(4.0 * sd, 0.1)
    assert sd < 0.2


@pytest.mark.slow
@pytest.mark.parametrize("name", ["platform", "otter"])
def test_no_loss_is_found_where_there_is_none(name: str, tmp_path: Path) -> None:
    assert "ventilation" not in [one.name for one in ranking_of(name, 0.0, tmp_path).named]


@pytest.mark.slow
@pytest.mark.parametrize(("period", "toward"), [long(1.6, pi), long(2.5, 0.6)])
def test_no_loss_is_found_in_waves_of_which_only_the_motion_is_recorded(
    period: float, toward: float, tmp_path: Path
) -> None:
    """The boat rises with a wave, and the water with it: the immersion hardly changes."""
    otter = vessel.load_vessel("otter")
    sea = {"use": "strip_wave_loads", "hull_spacing": 0.79, "hull_beam": 0.25}
    sea |= {"significant_height": 0.2, "modal_period": period, "toward": toward}
    recordings = []
    for seed in (1, 2):
        rng = np.random.default_rng(seed)
        orders = np.repeat(rng.uniform(20.0, 90.0, (15, 2)), 20, axis=0)
        drives = {"n_port_radps": orders[:, 0], "n_starboard_radps": orders[:, 1]}
        truth = otter.with_effect(sea | {"realisation": float(seed)})
        recordings.append(sailed(truth, drives, seed, NOISE))
    tested = ("ventilation", "thrust_gain_error", "wave_forcing")
    assert "ventilation" not in [one.name for one in ranked(otter, tested, *recordings).named]


# ---- one propeller of three


SIDES = {"port": -0.25, "middle": 0.0, "starboard": 0.25}  # to starboard [m]


def craft_of_three() -> Vessel:
    """A craft that surges, heaves, pitches and yaws, with three propellers at its stern."""
    effects: list[dict[str, object]] = [
        {"use": "linear_damping", "surge": 15.0, "heave": 200.0, "pitch": 30.0, "yaw": 8.0},
        {"use": "hydrostatics", "heave": 600.0, "pitch": 80.0, "roll": 80.0},
        {"use": "applied_load", "on": {"force": "winch_N"}, "heave": 1.0, "x": -0.4},
    ]
    channels = {"winch_N": {"low": -300.0, "high": 300.0}}
    for drive, y in SIDES.items():
        on = {"thrust": f"{drive}_N"}
        effects.append({"use": "thruster", "name": drive, "on": on, "x": -0.7, "y": y, "z": 0.12})
        channels[f"{drive}_N"] = {"low": -20.0, "high": 20.0}
    return Vessel.from_effects(
        name="platform",
        dof=("surge", "heave", "pitch", "yaw"),
        length=1.5,
        beam=0.6,
        draught=0.15,
        body={"mass": 30.0, "roll_inertia": 1.0, "pitch_inertia": 5.0, "yaw_inertia": 5.0},
        effects=effects,
        channels=channels,
        diagnosis={"facts": {"still_water": True, "no_waves": True, "indoors": True}},
    )


def runs_of_three(seeds: Sequence[int], *added: dict[str, Any]) -> list[Recording]:
    """Recordings of the craft with effects."""
    truth = craft_of_three()
    for table in added:
        truth = truth.with_effect(table)
    runs = []
    for seed in seeds:
        rng = np.random.default_rng(seed)
        levels = np.repeat(rng.uniform(0.0, 10.0, (15, 3)), 20, axis=0)
        orders = {f"{drive}_N": levels[:, k] for k, drive in enumerate(SIDES)}
        orders["winch_N"] = pulls(rng, 300, 50.0)
        runs.append(sailed(truth, orders, seed, {name: NOISE[name] for name in THREE}))
    return runs


def ranking_of_three(*added: dict[str, Any]) -> Any:
    """What two recordings say of the craft with effects."""
    single = ("drive_ventilation", "drive_gain_error", "drive_loss_with_speed")
    own = [f"{effect}_{drive}" for effect in single for drive in SIDES]
    runs = runs_of_three((1, 2), *added)
    return ranked(craft_of_three(), (*RIVALS, *own), *runs, requested=single[:1])


@pytest.mark.long
@pytest.mark.slow
def test_a_diagnosis_names_the_propeller_that_ventilates(tmp_path: Path) -> None:
    saved = craft_of_three().save(tmp_path / "platform").file
    fault = {"use": "drive_ventilation", "on": ["port"], "loss": 1.0}
    answer = diagnosed(runs_of_three((1, 2, 3), fault), tmp_path, str(saved))
    named(answer, "drive_ventilation_port", {"loss": 1.0})


@pytest.mark.slow
def test_a_diagnosis_finds_nothing_where_no_propeller_ventilates(tmp_path: Path) -> None:
    saved = craft_of_three().save(tmp_path / "platform").file
    nothing_missing(diagnosed(runs_of_three((1, 2, 3)), tmp_path, str(saved)))


THREE = ("x", "y", "z", "theta", "psi")


@pytest.mark.slow
@pytest.mark.parametrize(
    ("fault", "name"),
    [
        ({"use": "drive_ventilation", "on": ["port"]}, "drive_ventilation_port"),
        long({"use": "ventilation"}, "ventilation"),
    ],
)
def test_one_propeller_or_all_that_ventilate_are_named_with_the_loss(
    fault: dict[str, Any], name: str
) -> None:
    ranking = ranking_of_three({**fault, "loss": 1.0})
    assert [one.name for one in ranking.named] == [name]
    value, sd = ranking.best.value(name, "loss")
    assert abs(value - 1.0) < max(4.0 * sd, 0.1)
    assert sd < 0.2


@pytest.mark.slow
def test_no_propeller_ventilates_where_none_does() -> None:
    assert not [one.name for one in ranking_of_three().named if "ventilation" in one.name]


def test_one_propeller_loses_what_all_would_lose_at_its_place() -> None:
    """A raised stern costs the named propeller its share, and the others nothing."""
    craft = craft_of_three()
    lost = {}
    for table in ({"use": "ventilation"}, {"use": "drive_ventilation", "on": ["port"]}):
        boat = craft.with_effect({**table, "loss": 1.0})
        engine = OpenWater(boat, STEP)
        engine.reset(State(z=-0.1), {"port_N": 10.0, "starboard_N": 10.0})
        engine.advance(5)
        lost[table["use"]] = engine.state
    assert abs(lost["ventilation"].r) < 1e-9
    assert lost["drive_ventilation"].r < -0.001


def test_each_propeller_is_a_candidate_of_its_own() -> None:
    assert "drive_ventilation" in candidate_library(craft_of_three()).tried_last
    tested = candidate_library(craft_of_three(), ("drive_ventilation",)).tested_names
    assert {f"drive_ventilation_{drive}" for drive in SIDES} <= set(tested)
    assert "drive_ventilation" in candidate_library(vessel.load_vessel("otter")).tried_last
