"""Laws that hold for every effect on the shelf, then each effect alone against its closed form."""

import inspect
import re
import sys
from dataclasses import replace
from itertools import pairwise
from math import cos, exp, hypot, pi, sin
from pathlib import Path
from typing import Any

import boats
import numpy as np
import pytest

from boatsim.diagnosis.candidates import instantiate_neutral_effect
from boatsim.errors import BadInput
from boatsim.physics import content, vessel
from boatsim.physics.base import (
    AXES,
    Array,
    ChannelEffect,
    CoefficientRelease,
    Effect,
    Force,
    Inertia,
    MassMatrix,
    Motion,
    RandomForce,
    Reaction,
    SignalSegment,
    WaterFlow,
    Wrench,
    make_motion,
    segment_mean,
)
from boatsim.physics.compose import effect_kinds
from boatsim.physics.effects.added_mass import AddedMass, ShallowWater
from boatsim.physics.effects.cross_flow_drag import CrossFlowDrag
from boatsim.physics.effects.current import Current
from boatsim.physics.effects.damping import (
    CubicDamping,
    DampingError,
    LinearDamping,
    QuadraticDamping,
)
from boatsim.physics.effects.drive_map import PwmThrust
from boatsim.physics.effects.fan_wind import AIR_DENSITY, FanWind
from boatsim.physics.effects.rate_limit import SteeringRateLimit
from boatsim.physics.effects.righting_arm import RightingArm, RightingArmStiffening
from boatsim.physics.effects.servo import Servo
from boatsim.physics.effects.steering_offset import SteeringOffset
from boatsim.physics.effects.surge_drag import SurgeDrag
from boatsim.physics.effects.thrust_imbalance import ThrustImbalance
from boatsim.physics.effects.thrust_lag import ThrustLag
from boatsim.physics.effects.thruster import Thruster, ThrustGainError
from boatsim.physics.effects.weak_reverse import WeakReverse
from boatsim.physics.effects.wind import Wind
from boatsim.physics.program import Program

SHELF: dict[str, type[Effect]] = {
    name: content.load_class("effect", name) for name in content.shipped_content_names("effect")
}
DESCRIBED = {
    n for n, e in SHELF.items() if e.described
}  # laws of any words: those of test_described.py
RANDOM = {
    "filtered_sea"
} | DESCRIBED  # noise knows no sides, nor has an oscillator of its own in the filter
FORCES = [
    n
    for n, e in SHELF.items()
    if issubclass(e, Force) and not issubclass(e, RandomForce) and n not in RANDOM
]
CHANNELS = [n for n, e in SHELF.items() if issubclass(e, ChannelEffect)]
# a current of a table or of signals has no image in its parameters: test_current_table.py and
# test_measured_current.py have their laws
FLOWS = [
    n for n, e in SHELF.items() if issubclass(e, WaterFlow) and not e.sees_table and not e.roles
]
REACTIONS = [n for n, e in SHELF.items() if issubclass(e, Reaction)]
INERTIAS = [n for n, e in SHELF.items() if issubclass(e, Inertia)]
SUSPECTS = [
    n for n, e in SHELF.items() if n not in DESCRIBED and any(p.fit for p in e.params().values())
]

# What a mirror at the boat's plane of symmetry does. A parameter that points to starboard or
# clockwise changes its
# sign: name it here when an effect brings a new one, with its effect where others mean something
# else by it. Pairs
# named port and starboard change places.
TO_STARBOARD = {
    "thruster.y",
    "applied_load.y",
    "applied_load.sway",
    "applied_load.roll",
    "applied_load.yaw",
    "propeller.y",
    "foil.y",
    "towed_drag.y",
    "toward",
    "east",
    "list",
    "side_force_per_thrust",
    "thrust_imbalance.fraction",
    "Y_0",
    "Y_0u",
    "Y_0uu",
    "N_0",
    "N_0u",
    "N_0uu",
    "steering_offset.middle",
    "steering_offset.gain",
    "steering_asymmetry.gain",
    "gusty_wind.veer",
}
TO_STARBOARD |= {
    f"mmg_low_speed_propeller.{axis}_{form}"
    for axis in "YN"
    for form in ("low", "low_J", "mid", "mid_J", "high", "braked", "braked_J", "braked_JJ")
}
TO_STARBOARD |= {
    f"{name}.{axis}" for name in ("push", "steady_force") for axis in ("sway", "yaw", "roll")
}
TO_STARBOARD |= {
    f"wave_excitation.{axis}_{part}"
    for axis in ("sway", "roll")
    for part in ("elevation", "rate", "acceleration")
}
TO_STARBOARD |= {"wave_drift.sway", "wave_drift.roll", "place_east"}
TURNS_SIGN = {"y", "phi", "psi", "v", "p", "r", "vr", "sin_psi"}  # of motions and signals
TURNS_SIGN |= {"angle", "sin_angle", "comes_from", "sin_comes_from"}
MIRROR = np.array([1.0, -1.0, 1.0, -1.0, 1.0, -1.0])  # of a wrench
RESTS = {  # effects that are not always there
    "astern_time_constant",  # going ahead
    "drag_growth",  # at its begin
    "dragged_propeller",  # with the way
    "drive_fade",  # at the begin of a run
    "drive_hull_interaction",  # with the race directed away from the hull
    "drive_ventilation",  # deep below the surface
    "heave_radiation",  # after rest
    "pitch_radiation",  # after rest
    "push",  # before its time and after
    "quay",  # away from the wall
    "roll_radiation",  # after rest
    "rudder_race",  # of a propeller that backs
    "thrust_fade",  # at the begin of a run
    "ventilation",  # deep below the surface
    "thruster_hull_interaction",  # with the race directed away from the hull
}
SI = {"rad", "m", "kg", "s", "N", "V", "A"}
OTTER = Path(__file__).parents[3] / "models" / "otter"
CURRENT = Path(__file__).parents[2] / "data" / "current.csv"
COEFFICIENTS, MESH = OTTER / "hydrodynamics", OTTER / "hull.obj"


def drawn(kind: type[Effect], seed: int) -> Any:
    """An effect with random parameters, none of them zero."""
    rng = np.random.default_rng(seed)
    bounds = {
        n: (max(p.low, min(p.high, -1.5)), min(p.high, 2.0)) for n, p in kind.params().items()
    }
    values = {
        n: low if low >= high else float(rng.uniform(low, high))
        for n, (low, high) in bounds.items()
    }
    if "dead" in values and "span" in values:
        values["dead"] *= (
            values["span"] / 2.5
        )  # a drive that is dead over all of its span is refused
    if "coefficients" in kind.paths:
        values["coefficients"] = str(COEFFICIENTS)
        values.pop("modal_period", None)  # waves shorter than those of the table exert no force
    if "mesh" in kind.paths:
        values |= {"mesh": str(MESH), "scale": 1.0, "draught": 0.13}
        values |= {"cell": 0.2} if "cell" in values else {"strips": 5.0}
    if kind.type_name() == "radiation_memory":  # a mass matrix is positive definite
        least = min(values[axis] for axis in AXES)
        for name in set(MassMatrix._fields) - set(AXES):
            values[name] *= 0.2 * least
    values.pop("cut", None)  # a sea without most of its energy is refused
    for name in ("spreading", "direction_sd"):
        values.pop(name, None)  # random directions have no mirror image with the same seed
    return kind(**values)


def drawn_motion(seed: int) -> dict[str, float]:
    """A random motion in all six freedoms."""
    names = ("z", "phi", "theta", "psi", "u", "v", "w", "p", "q", "r")
    return dict(
        zip(names, np.random.default_rng(seed).uniform(-1.0, 1.0, len(names)).tolist(), strict=True)
    )


RANGES = {
    "thrust": (-1.0, 1.0),
    "shaft": (0.1, 2.0),
    "throttle": (1.0, 7.0),
    "angle": (-0.8, 0.8),
    "bucket": (-0.8, 0.8),
    "speed": (0.5, 3.0),
    "comes_from": (-3.0, 3.0),
    "force": (-1.0, 1.0),
    "moment": (-1.0, 1.0),
    "elevation": (-1.0, 1.0),
}


def drawn_signals(kind: type[Effect], seed: int) -> Any:
    """Random signals for the roles of a law."""
    rng = np.random.default_rng(seed)
    found = {role: float(rng.uniform(*RANGES[role])) for role in kind.roles}
    for role, about in kind.roles.items():
        if about.unit == "rad":
            found |= {f"cos_{role}": cos(found[role]), f"sin_{role}": sin(found[role])}
    found |= {result: float(rng.uniform(-1.0, 1.0)) for result in kind.filtered}
    return kind.signals_type()(**found)


def arguments(kind: type[Effect], seed: int, image: bool = False) -> tuple[Any, ...]:
    """What a law takes beside motion and values: signals of its roles, or those of what it rides on
    and its values."""
    of = SHELF[kind.per_instance_of] if kind.per_instance_of else kind
    if not of.roles:
        return ()
    signals, carrier = drawn_signals(of, seed), drawn(of, seed + 1)
    if image:
        signals, carrier = signals._replace(**mirrored_motion(signals._asdict())), mirrored(carrier)
    if getattr(kind, "influence", None) is not None:
        return (signals, carrier.values(), *another(of, seed, image))
    return (signals, carrier.values()) if kind.per_instance_of else (signals,)


def another(kind: type[Effect], seed: int, image: bool) -> tuple[Any, ...]:
    """Signals and values of a second instance, which acts on the first."""
    signals, carrier = drawn_signals(kind, seed + 100), drawn(kind, seed + 101)
    if image:
        signals, carrier = signals._replace(**mirrored_motion(signals._asdict())), mirrored(carrier)
    return signals, carrier.values()


WALLS = {"y_low": "y_high", "y_high": "y_low"}  # change place and sign


def swapped(name: str) -> str:
    """The other side's name."""
    if name in WALLS:
        return WALLS[name]
    if "port" in name:
        return name.replace("port", "starboard")
    return name.replace("starboard", "port")


def mirrored_motion(given: dict[str, float]) -> dict[str, float]:
    """Motion or signals seen in the mirror."""
    return {n: -a if n in TURNS_SIGN else a for n, a in given.items()}


def mirrored(effect: Any) -> Any:
    """The effect seen in the mirror."""
    kind = type(effect)
    image = {}
    for name in kind.params():
        steers = swapped(name) != name and getattr(kind, "acts_on", "") == "angle"
        turns = (
            steers
            or name in WALLS
            or not TO_STARBOARD.isdisjoint({name, f"{kind.type_name()}.{name}"})
        )
        image[swapped(name)] = (-1.0 if turns else 1.0) * getattr(effect, name)
    return replace(effect, **image)


def on_a_vessel(effect: Effect) -> Any:
    """The effect on the first vessel that can take it."""
    for name in content.shipped_content_names("vessel"):
        try:
            return effect.with_all_parameters(vessel.load_vessel(name))
        except BadInput:
            continue
    raise AssertionError(f"no vessel can take {effect.name}")


def courses(
    effect: Any, commands: list[float], dt: float, side: float = 0.0, source: float = 0.0
) -> list[SignalSegment]:
    """What a channel makes of commands held for dt [s] each, from a memory at zero."""
    memory, values = np.zeros(max(type(effect).slots, 1)), effect.values()
    return [
        SignalSegment(
            *type(effect).transform_signal(
                SignalSegment(x, x, x), side, source, memory, 0, dt, values
            )
        )
        for x in commands
    ]


def stepped(
    effect: Any, commands: list[float], dt: float, side: float = 0.0, source: float = 0.0
) -> list[float]:
    """The same as means over each step."""
    return [segment_mean(x) for x in courses(effect, commands, dt, side, source)]


# Laws of the whole shelf


@pytest.mark.parametrize("name", FORCES)
@pytest.mark.parametrize("seed", range(5))
def test_mirror_image_of_the_motion_gives_the_mirror_image_of_the_force(
    name: str, seed: int
) -> None:
    effect, given = drawn(SHELF[name], seed), drawn_motion(seed)
    seen = effect.wrench(make_motion(current=(0.2, 0.1), **given), *arguments(SHELF[name], seed))
    turned = make_motion(current=(0.2, -0.1), **mirrored_motion(given))
    image = mirrored(effect).wrench(turned, *arguments(SHELF[name], seed, image=True))
    assert any(abs(part) > 1e-6 for part in seen) or name in RESTS
    assert image == pytest.approx(MIRROR * seen, rel=1e-12, abs=1e-12)


@pytest.mark.parametrize("name", REACTIONS)
@pytest.mark.parametrize("seed", range(5))
def test_mirror_image_of_motion_and_forces_gives_the_mirror_image_of_the_reaction(
    name: str, seed: int
) -> None:
    effect, given = drawn(SHELF[name], seed), drawn_motion(seed)
    others = np.random.default_rng(seed).uniform(-1.0, 1.0, 6)
    seen = type(effect).reaction(make_motion(**given), Wrench(*others), effect.values())
    turned = Wrench(*(MIRROR * others))
    image = type(effect).reaction(
        make_motion(**mirrored_motion(given)), turned, mirrored(effect).values()
    )
    assert any(seen)
    assert image == pytest.approx(MIRROR * seen, rel=1e-12, abs=1e-12)


OTHERS = Wrench(1.0, -2.0, 0.3, 0.5, -0.4, 0.7)


def in_a_current(given: dict[str, float], north: float, east: float) -> dict[str, float]:
    """The same motion through water that flows: carried along over the ground since t = 0."""
    c, s = cos(given["psi"]), sin(given["psi"])
    moved = {"x": given["x"] + north * given["t"], "y": given["y"] + east * given["t"]}
    return (
        given
        | moved
        | {"u": given["u"] + c * north + s * east, "v": given["v"] + c * east - s * north}
    )


@pytest.mark.parametrize(
    "name", [n for n, e in SHELF.items() if issubclass(e, Force | Reaction) and n not in DESCRIBED]
)
@pytest.mark.parametrize("seed", range(3))
def test_a_uniform_current_changes_no_force_but_of_what_holds_on_to_the_world(
    name: str, seed: int
) -> None:
    """Inertia over ground feels the current turn in body axes: its Coriolis force changes by -M
    (omega x v_c)."""
    kind, effect, given = (
        SHELF[name],
        drawn(SHELF[name], seed),
        drawn_motion(seed) | {"t": 3.0, "x": 0.4, "y": -0.3},
    )
    if "course_kept" in kind.params():  # then the waves are met as on a course laid down beforehand
        effect = replace(effect, course_kept=0.0)
    still, carried = (
        make_motion(**given),
        make_motion(current=(0.7, -0.4), **in_a_current(given, 0.7, -0.4)),
    )

    def force(m: Motion) -> Array:
        if issubclass(kind, Reaction):
            return np.array(kind.reaction(m, OTHERS, effect.values()))
        return np.array(effect.wrench(m, *arguments(kind, seed)))

    before, after = force(still), force(carried)
    wanted = np.zeros(6)
    if getattr(kind, "moves_with", "") == "hull":
        flow = np.array([carried.u - still.u, carried.v - still.v, 0.0])
        wanted = effect.matrix() @ np.append(
            -np.cross([still.p, still.q, still.r], flow), np.zeros(3)
        )
    same = after - before == pytest.approx(wanted, abs=1e-12 * max(1.0, np.abs(before).max()))
    anchor = getattr(kind, "tied_to", "")
    if name in RESTS and not before.any() and not after.any():
        return
    assert same != bool(anchor), anchor or after - before


@pytest.mark.parametrize("name", CHANNELS)
@pytest.mark.parametrize("seed", range(5))
def test_mirror_image_of_a_command_gives_the_mirror_image_of_the_signal(
    name: str, seed: int
) -> None:
    effect = drawn(SHELF[name], seed)
    sign = -1.0 if type(effect).acts_on == "angle" else 1.0
    rng = np.random.default_rng(seed)
    commands, source = list(rng.uniform(-1.0, 1.0, 8)), float(rng.uniform(-200.0, 200.0))
    port = stepped(effect, commands, 0.05, -1.0, source)
    starboard = stepped(mirrored(effect), [sign * x for x in commands], 0.05, 1.0, source)
    assert starboard == pytest.approx([sign * y for y in port], rel=1e-12, abs=1e-12)


@pytest.mark.parametrize("name", FLOWS)
def test_mirror_image_of_a_flow(name: str) -> None:
    effect = drawn(SHELF[name], 0)
    north, east = effect.velocity_at(0.0, 0.0, 0.0)
    assert mirrored(effect).velocity_at(0.0, 0.0, 0.0) == pytest.approx((north, -east))


@pytest.mark.parametrize("name", INERTIAS)
def test_inertia_is_symmetric_and_takes_no_energy(name: str) -> None:
    effect = drawn(SHELF[name], 1)
    mass = effect.matrix()
    if name == "mass_centre_shift":  # moves the hull's mass, so it is no inertia without that mass
        mass = mass + np.diag([effect.hull_mass] * 3 + [0.0] * 3)
    assert mass == pytest.approx(mass.T)
    assert np.linalg.eigvalsh(mass).min() >= -1e-12
    assert SHELF[name].moves_with in ("water", "hull")  # type: ignore[attr-defined]


@pytest.mark.parametrize("name", INERTIAS)
@pytest.mark.parametrize("seed", range(3))
def test_coriolis_force_of_an_inertia_does_no_work(name: str, seed: int) -> None:
    m = make_motion(current=(0.0, 0.0), **drawn_motion(seed))
    effect = drawn(SHELF[name], seed)
    force = np.array(effect.wrench(m)) - np.array(
        effect.wrench(make_motion())
    )  # less the weight of what has one
    assert hypot(force[0], force[1]) > 1e-6
    power = np.dot(force, (m.ur, m.vr, m.wr, m.p, m.q, m.r))
    assert power == pytest.approx(0.0, abs=1e-12)


@pytest.mark.parametrize("name", SUSPECTS)
@pytest.mark.parametrize("seed", range(3))
def test_a_suspect_whose_fitted_parameters_are_absent_is_not_there(name: str, seed: int) -> None:
    kind = SHELF[name]
    facts: dict[str, object] = {"walls_m": [-4.0, 4.0, -3.0, 3.0], "track_m": [0.0, 0.0, 1.0, 1.0]}
    facts |= {"begin_s": 0.0, "water_depth_m": 30.0}
    given = {"file": str(CURRENT)} if "file" in kind.paths else {}
    effect = on_a_vessel(instantiate_neutral_effect(kind, facts, given))
    if isinstance(effect, CoefficientRelease):
        boat = next(
            b
            for b in map(vessel.load_vessel, content.shipped_content_names("vessel"))
            if effect.changes(b)
        )
        assert boat.with_completed_effect(effect) == boat
    moving = make_motion(current=(0.0, 0.0), **drawn_motion(seed))
    if isinstance(effect, Force):
        assert effect.wrench(moving, *arguments(kind, seed)) == pytest.approx(Wrench(), abs=1e-15)
    if isinstance(effect, Reaction):
        assert type(effect).reaction(moving, OTHERS, effect.values()) == Wrench()
    if isinstance(effect, WaterFlow):
        assert effect.velocity_at(1.0, 2.0, 3.0) == (0.0, 0.0)
    if isinstance(effect, Inertia):
        assert not effect.matrix().any()
    if isinstance(effect, ChannelEffect):
        commands = np.random.default_rng(seed).uniform(-1.0, 1.0, 8).tolist()
        assert courses(effect, commands, 0.05, 1.0) == [SignalSegment(x, x, x) for x in commands]


@pytest.mark.parametrize("name", SHELF)
def test_an_effect_says_what_it_is(name: str) -> None:
    kind = SHELF[name]
    assert kind.type_name() == name
    assert kind.words and kind.shown_by and not kind.words.endswith(".")
    assert kind.kind in ("physics", "measurement")
    assert inspect.getdoc(sys.modules[kind.__module__]) and "__doc__" in vars(kind) and kind.__doc__
    assert issubclass(kind, (*effect_kinds(), CoefficientRelease))


@pytest.mark.parametrize("name", SHELF)
def test_parameters_lie_inside_their_bounds_and_say_what_they_are(name: str) -> None:
    kind = SHELF[name]
    for key, about in kind.params().items():
        assert not kind().has_value(key) or about.low <= getattr(kind(), key) <= about.high, key
        assert about.words, key
        assert set(re.findall("[A-Za-z]+", about.unit)) <= SI, key
        assert about.axis in ("", *AXES), key
        if about.fit:
            assert about.spread > 0 and about.low <= about.inactive_value <= about.high, key
    for start in kind.starts:
        kind(**start)


MACHINES = {
    "thrust",
    "throttle",
    "shaft",
    "bucket",
    "angle",
}  # roles of what a machine or a rudder does
DRIVES = [n for n, e in SHELF.items() if issubclass(e, Force) and not MACHINES.isdisjoint(e.roles)]


CORRECTIONS = {
    "speed_scaled_steering"
}  # what the vessel's own rudder and hull lack: zero unless it is fitted itself


@pytest.mark.parametrize("name", [n for n in DRIVES if n not in CORRECTIONS])
def test_every_thruster_jet_and_rudder_has_a_coefficient_of_thrust_that_may_be_off(
    name: str,
) -> None:
    assert any(p.calibrates == "thrust" for p in SHELF[name].params().values())


@pytest.mark.parametrize("name", sorted(CORRECTIONS))
def test_a_correction_of_a_rudder_is_fitted_itself_and_absent_otherwise(name: str) -> None:
    assert all(p.fit or p.follows for p in SHELF[name].params().values())


@pytest.mark.parametrize("name", SHELF)
def test_a_setting_out_of_bounds_or_misspelt_is_refused_in_words(name: str) -> None:
    kind = SHELF[name]
    key, about = next(iter(kind.params().items()))
    with pytest.raises(
        BadInput, match=re.escape(f"; allowed {about.low:g} to {about.high:g}")
    ) as refused:
        kind.from_settings({key: 2.0 * about.high + 1.0})
    assert str(refused.value).startswith(f"{kind.__name__}.{key} = ") and about.words in str(
        refused.value
    )
    with pytest.raises(BadInput, match=f"did you mean '{key}'"):
        kind.from_settings({f"{key}_": about.low})
    for wrong in (float("nan"), "1", True):
        with pytest.raises(BadInput, match=f"{key} = .*allowed is a number"):
            kind.from_settings({key: wrong})


# Damping and restoring


def test_linear_damping_is_a_matrix_times_the_velocity() -> None:
    force = LinearDamping(
        surge=3, sway=10, yaw=0.8, roll=2, sway_by_yaw=0.5, yaw_by_sway=-0.3
    ).wrench(make_motion(u=0.2, v=0.1, p=0.3, r=-0.4))
    assert force == pytest.approx(Wrench(X=-0.6, Y=-1.0 + 0.2, K=-0.6, N=0.32 + 0.03))


@pytest.mark.parametrize(("kind", "power"), [(QuadraticDamping, 2), (CubicDamping, 3)])
def test_damping_grows_with_a_power_of_the_speed_and_opposes_it(
    kind: type[Force], power: int
) -> None:
    effect = kind(surge=2, sway=3, yaw=5, roll=7)  # type: ignore[call-arg]
    one = effect.wrench(make_motion(u=0.3, v=-0.3, p=0.3, r=-0.3))
    assert one == pytest.approx([k * 0.3**power for k in (-2, 3, 0, -7, 0, 5)])
    double = effect.wrench(make_motion(u=0.6, v=-0.6, p=0.6, r=-0.6))
    assert double == pytest.approx([2**power * part for part in one])


def test_surge_drag() -> None:
    assert SurgeDrag(linear=0.5, quadratic=2).wrench(make_motion(u=-0.4, v=1.0)) == pytest.approx(
        Wrench(X=0.2 + 0.32)
    )


def test_damping_error_multiplies_the_vessels_own_damping() -> None:
    boat = vessel.load_vessel("trial_boat")
    own, m = boat.effect("linear_damping"), make_motion(u=0.3, v=-0.2, r=0.5)
    assert isinstance(own, LinearDamping)
    off = boat.with_completed_effect(
        DampingError(surge_factor=1.4, sway_factor=0.7, yaw_factor=2.0)
    ).effect("linear_damping")
    assert isinstance(off, LinearDamping)
    assert off.wrench(m) == replace(
        own, surge=1.4 * own.surge, sway=0.7 * own.sway, yaw=2.0 * own.yaw
    ).wrench(m)


def test_righting_arm_rests_at_its_list() -> None:
    arm = RightingArm(stiffness=800.0, list=0.02)
    assert arm.wrench(make_motion(phi=0.02)) == Wrench()
    assert arm.wrench(make_motion(phi=0.12)).K == pytest.approx(-80.0)


def test_righting_arm_stiffening_bends_the_vessels_own_curve() -> None:
    boat = vessel.load_vessel("kvlcc2_roll")
    bent = boat.with_completed_effect(RightingArmStiffening(cubic=-2.0)).effect("righting_arm")
    assert isinstance(bent, RightingArm)
    assert bent.wrench(make_motion(phi=0.3)).K == pytest.approx(-822.3 * (0.3 - 2.0 * 0.3**3))


@pytest.mark.parametrize(
    ("kind", "boat"),
    [
        (ThrustGainError, "mariner"),
        (RightingArmStiffening, "trial_boat"),
        (ShallowWater, "mariner"),
    ],
)
def test_an_effect_that_changes_another_says_which_one_is_missing(
    kind: type[Effect], boat: str
) -> None:
    with pytest.raises(BadInput, match=f"{boat}: {kind.type_name()} needs a vessel with"):
        kind().with_all_parameters(vessel.load_vessel(boat))


# Water


PLANAR_AND_ROLL = [AXES.index(axis) for axis in ("surge", "sway", "roll", "yaw")]
PLANAR = [AXES.index(axis) for axis in ("surge", "sway", "yaw")]


def test_added_mass_far_ahead_is_a_point_mass_on_a_lever() -> None:
    mass = AddedMass(surge=1.0, sway=4.0, sway_at=0.5, yaw=0.3, roll=0.2).matrix()
    wanted = np.array([[1, 0, 0, 0], [0, 4, 0, 2], [0, 0, 0.2, 0], [0, 2, 0, 0.3 + 1.0]])
    assert mass[np.ix_(PLANAR_AND_ROLL, PLANAR_AND_ROLL)] == pytest.approx(wanted)
    assert not mass[[2, 4]].any()


def test_coriolis_force_is_the_published_matrix() -> None:
    effect, m = (
        AddedMass(surge=0.6, sway=3.0, yaw=0.3, sway_at=0.2),
        make_motion(current=(0.1, -0.05), psi=0.4, u=1, v=0.3, r=0.2),
    )
    nr = np.array([m.ur, m.vr, m.r])
    a = effect.matrix()[np.ix_(PLANAR, PLANAR)] @ nr
    X, Y, N = -np.array([[0, 0, -a[1]], [0, 0, a[0]], [a[1], -a[0], 0]]) @ nr
    assert effect.wrench(m) == pytest.approx(Wrench(X=X, Y=Y, N=N))
    half = replace(effect, coriolis=0.5).wrench(m)
    assert half == pytest.approx(Wrench(X=X / 2, Y=Y / 2, N=N / 2))


def test_a_current_moves_the_water_and_pushes_a_boat_only_through_it() -> None:
    assert Current.water_velocity(Current(north=0.3, east=-0.1).values()) == (0.3, -0.1)
    drifting = make_motion(
        current=(0.3, -0.1),
        psi=0.7,
        u=0.3 * cos(0.7) - 0.1 * sin(0.7),
        v=-0.1 * cos(0.7) - 0.3 * sin(0.7),
    )
    assert LinearDamping(surge=3, sway=10).wrench(drifting) == pytest.approx(Wrench(), abs=1e-15)


@pytest.mark.parametrize("factor", [1.0, 1.5, 3.0])
def test_shallow_water_multiplies_sway_and_yaw(factor: float) -> None:
    boat, m = vessel.load_vessel("joystick_boat"), make_motion(u=0.3, v=-0.2, r=0.5)
    mass, drag = boat.effect("added_mass"), boat.effect("cross_flow_drag")
    assert isinstance(mass, AddedMass) and isinstance(drag, CrossFlowDrag)
    shallow = boat.with_completed_effect(ShallowWater(factor=factor))
    deeper, more = shallow.effect("added_mass"), shallow.effect("cross_flow_drag")
    assert isinstance(deeper, AddedMass) and isinstance(more, CrossFlowDrag)
    assert deeper.matrix()[1:, 1:] == pytest.approx(factor * mass.matrix()[1:, 1:])
    assert deeper.matrix()[0, 0] == mass.matrix()[0, 0]
    assert more.wrench(m)[1:] == pytest.approx(factor * np.array(drag.wrench(m)[1:]))
    assert more.wrench(m).X == drag.wrench(m).X


def test_cross_flow_drag_takes_length_and_draught_of_its_vessel() -> None:
    boat = vessel.load_vessel("joystick_boat", ["heavy"])
    assert (own := boat.effect("cross_flow_drag")) is not None
    assert own.values().length == 1.25 and own.values().draught == 0.065


def test_linear_sections_and_surge_drag_go_with_cross_flow() -> None:
    drag = CrossFlowDrag(length=2.0, draught=0.1, centre=0.3, linear=4.0, surge_quadratic=5.0)
    x = np.linspace(-0.7, 1.3, 20001)
    sections = -4.0 * (0.2 + 0.5 * x)
    expected = Wrench(X=-5.0 * 0.09, Y=np.trapezoid(sections, x), N=np.trapezoid(sections * x, x))
    assert drag.wrench(make_motion(u=0.3, v=0.2, r=0.5)) == pytest.approx(expected, rel=1e-7)


# Air


@pytest.mark.parametrize("psi", [0.0, 0.3, 2.5, -1.2])
def test_a_boat_drifting_with_the_air_feels_no_wind(psi: float) -> None:
    drifting = make_motion(psi=psi, u=2.0 * cos(0.3 - psi), v=2.0 * sin(0.3 - psi))
    assert FanWind(speed=2.0, toward=0.3).wrench(drifting) == pytest.approx(Wrench(), abs=1e-12)


def test_fan_wind_ahead_and_abeam() -> None:
    astern = FanWind(speed=3.0, toward=0.0, front=0.02, side=0.1, arm=-0.05)
    assert astern.wrench(make_motion()) == pytest.approx(Wrench(X=0.5 * AIR_DENSITY * 9 * 0.02))
    Y = 0.5 * AIR_DENSITY * 9 * 0.1
    assert replace(astern, toward=pi / 2).wrench(make_motion()) == pytest.approx(
        Wrench(Y=Y, N=-0.05 * Y)
    )


@pytest.mark.parametrize("psi", [0.0, 0.8, -2.0])
def test_wind_pushes_in_one_direction_of_the_world(psi: float) -> None:
    force = Wind(force=0.2, toward=0.5, arm=0.1, end_on=1.0).wrench(make_motion(psi=psi))
    north, east = force.X * cos(psi) - force.Y * sin(psi), force.X * sin(psi) + force.Y * cos(psi)
    assert (north, east) == pytest.approx((0.2 * cos(0.5), 0.2 * sin(0.5)))
    assert force.N == pytest.approx(0.1 * force.Y)


# Thrusters and what comes before them


def signals(kind: type[Effect], **given: float) -> Any:
    """Signals of a law's roles, with cosine and sine of angles; those not given are zero."""
    full = {role: given.get(role, 0.0) for role in kind.roles}
    for role, about in kind.roles.items():
        if about.unit == "rad":
            full |= {f"cos_{role}": cos(full[role]), f"sin_{role}": sin(full[role])}
    return kind.signals_type()(**full)


@pytest.mark.parametrize("angle", [0.0, 0.3, -2.0, pi])
def test_a_thruster_is_a_force_at_its_place(angle: float) -> None:
    force = 1.2 * -0.5 * np.array([cos(angle), sin(angle), 0.0])
    seen = Thruster(x=-0.5, y=0.2, z=0.1, gain=1.2).wrench(
        make_motion(), signals(Thruster, thrust=-0.5, angle=angle)
    )
    assert seen == pytest.approx([*force, *np.cross([-0.5, 0.2, 0.1], force)], abs=1e-15)


def test_pwm_curve() -> None:
    curve = PwmThrust(at_span=0.6, span=150.0, dead=30.0, exponent=2.0)
    thrust = [
        stepped(curve, [0.0], 0.02, 1.0, pwm)[0] for pwm in (0.0, 30.0, 90.0, 150.0, 255.0, -150.0)
    ]
    assert thrust == pytest.approx([0.0, 0.0, 0.15, 0.6, 0.6 * 1.875**2, -0.6])
    assert stepped(curve, [0.4], 0.02, 1.0, 150.0) == [1.0]


@pytest.mark.parametrize(("command", "thrust"), [(1.0, 1.0), (0.0, 0.0), (-1.0, -0.7)])
def test_weak_reverse(command: float, thrust: float) -> None:
    assert stepped(WeakReverse(astern_factor=0.7), [command], 0.02) == pytest.approx([thrust])


def test_imbalance_and_gain_error() -> None:
    uneven = ThrustImbalance(fraction=0.1)
    assert [stepped(uneven, [2.0], 0.02, side)[0] for side in (-1.0, 1.0)] == pytest.approx(
        [2.2, 1.8]
    )
    gained = vessel.load_vessel("trial_boat").with_completed_effect(ThrustGainError(factor=1.3))
    assert [e.gain for e in gained.effects_of_type("thruster")] == [1.3, 1.3]  # type: ignore[attr-defined]


def test_steering_offset_of_each_side() -> None:
    offset = SteeringOffset(port=0.1, starboard=-0.2)
    assert [stepped(offset, [0.3], 0.02, side)[0] for side in (-1.0, 1.0)] == pytest.approx(
        [0.4, 0.1]
    )


@pytest.mark.parametrize("dt", [0.02, 0.1, 1.0])
def test_lag_gives_the_mean_of_the_step_response_over_each_step(dt: float) -> None:
    T = 0.15

    def impulse(t: float) -> float:
        return t + T * (exp(-t / T) - 1.0)  # integral of 1 - exp(-t / T)

    ends = [i * dt for i in range(9)]
    expected = [(impulse(b) - impulse(a)) / dt for a, b in pairwise(ends)]
    assert stepped(ThrustLag(time_constant=T), [1.0] * 8, dt) == pytest.approx(expected, rel=1e-12)


def test_lag_does_not_depend_on_the_step() -> None:
    rng = np.random.default_rng(3)
    commands = list(rng.uniform(-1, 1, 10))
    coarse = stepped(ThrustLag(time_constant=0.2), commands, 0.1)
    fine = stepped(ThrustLag(time_constant=0.2), [c for c in commands for _ in range(5)], 0.02)
    assert np.reshape(fine, (10, 5)).mean(axis=1) == pytest.approx(coarse, rel=1e-12)


def positions(servo: Servo, commands: list[float], dt: float) -> Array:
    """Angle at the end of each step."""
    return np.array([0.0, *(x.end for x in courses(servo, commands, dt))])


def test_servo_keeps_its_range() -> None:
    angles = positions(Servo(range=0.7, rate=1e3, lag=1e-3), [2.0, -2.0, 0.5], 0.02)
    assert angles == pytest.approx([0.0, 0.7, -0.7, 0.5])


@pytest.mark.parametrize("dt", [0.01, 0.16, 0.8])
def test_servo_without_lag_is_a_ramp_whatever_the_step(dt: float) -> None:
    means = stepped(Servo(range=1.0, rate=0.5, lag=0.0), [0.3] * round(1.6 / dt), dt)
    assert sum(means) * dt == pytest.approx(0.3 * 1.6 - 0.5 * 0.3 * 0.6)  # 0.6 s on its way


def test_servo_turns_at_its_rate_until_the_lag_takes_over() -> None:
    angles = positions(Servo(range=1.0, rate=0.5, lag=0.2), [1.0] * 400, 0.01)
    turning = np.diff(angles) / 0.01
    assert turning.max() <= 0.5 + 1e-9
    assert turning[:100] == pytest.approx(
        0.5
    )  # the lag alone would turn faster: (1 - angle) / lag > rate
    assert angles[-1] == pytest.approx(1.0, abs=1e-3)


def test_servo_lag_alone_is_the_first_order_response() -> None:
    angles = positions(Servo(range=1.0, rate=1e3, lag=0.06), [0.5] * 20, 0.01)
    assert angles == pytest.approx(0.5 * (1.0 - np.exp(-0.01 * np.arange(21) / 0.06)), abs=1e-12)


@pytest.mark.parametrize(
    "limit", [SteeringRateLimit(rate=0.3), Servo(range=0.8, rate=0.3, lag=0.0)], ids=repr
)
def test_what_has_reached_its_command_asks_for_no_shorter_step(limit: Any) -> None:
    for x in np.random.default_rng(0).uniform(-0.8, 0.8, 1000).tolist():
        assert segment_mean(SignalSegment(x, x, x)) == x
        memory, values = np.zeros(1), limit.values()
        for _ in range(2):  # the ramp in one step, then a rest
            type(limit).transform_signal(SignalSegment(x, x, x), 0.0, 0.0, memory, 0, 10.0, values)
        assert type(limit).time_to_discontinuity(x, memory, 0, values) == np.inf


def actuated(boat: vessel.Vessel, commands: dict[str, float]) -> dict[str, float]:
    """What the boat's actuators settle at."""
    program = Program(boat)
    act, memory = np.zeros(program.actuator_signal_size), np.zeros(program.memory_size)
    values, on = program.values(), program.effect_switches()
    for _ in range(3):
        program.simulation_functions.advance_actuators(
            program.command_array(commands), memory, 1e4, values, on, act
        )
    return dict(zip(boat.actuators, act.tolist(), strict=False))


@pytest.mark.parametrize("first", ["weak_reverse", "pwm_thrust"])
def test_maps_from_raw_commands_act_first_wherever_they_stand(tmp_path: Any, first: str) -> None:
    order = [first, "pwm_thrust" if first == "weak_reverse" else "weak_reverse"]
    fed = {"on": "thrust_port_N", "fed_by": "pwm_port"}
    values = {
        "weak_reverse": {"astern_factor": 0.5},
        "pwm_thrust": {"at_span": 1.0, "span": 150.0} | fed,
    }
    pwm = "[channels]\npwm_port = { low = -255.0, high = 255.0 }"
    folder = boats.written(tmp_path, "ordered", boats.PLANAR.replace("[channels]", pwm))
    boat = vessel.load_vessel(str(folder), extra=[{"use": name} | values[name] for name in order])
    settled = actuated(
        boat, {"thrust_port_N": -1.0, "pwm_port": -150.0, "thrust_starboard_N": -1.0}
    )
    # the thrust beside what the PWM gives, weakened together
    assert settled["thrust_port_N"] == pytest.approx(0.5 * -2.0)
    assert settled["thrust_starboard_N"] == -0.5
