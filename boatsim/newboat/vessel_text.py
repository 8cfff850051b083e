"""The vessel.toml of a boat of which only the particulars are known: every number with its rule."""

import json
import math
from collections.abc import Iterator

from boatsim.newboat.particulars import Blade, Mount, Particulars
from boatsim.physics.estimate import (
    added_mass,
    displacement,
    inertia,
    resistance,
    sway_yaw_damping,
    thrust,
)
from boatsim.physics.estimate import rudder as rudders
from boatsim.physics.estimate.base import DENSITY, Estimate

OWNER = "the owner's"
COLUMN = 32  # where comments begin
TURNS = 0.7  # [rad] 40 deg: rudders and outboards turn no further
HALF = 0.5  # of the full thrust: what a manoeuvre is approached with, if that is
EASY = 2.0  # times the resistance at the easy speed at most
DAMPING = 1.0  # relative sd of a coefficient by a rule: rules of thumb are off by a factor of two
STATED, RULED = 0.3, 0.6  # of thrust: bollard pull beside that under way; nobody stated any
WATER = 0.4  # of added mass: strips beside regressions beside measurements


def vessel_text(boat: Particulars) -> str:
    """The whole file."""
    return "\n".join(
        [
            *_head(boat),
            *_body(boat),
            *_channels(boat),
            *_effects(boat),
            *_manoeuvring(boat),
            *_diagnosis(boat),
            "",
        ]
    )


def number(value: float) -> str:
    """Four digits, as TOML reads a float."""
    text = f"{value:.4g}"
    return text if any(c in text for c in ".e") else f"{text}.0"


def line(key: str, value: float, unit: str, rule: str) -> str:
    """`key = value  # [unit] rule`."""
    stated = f"{key} = {number(value)}"
    return f"{stated:{COLUMN - 1}} # {f'[{unit}] ' if unit else ''}{rule}"


def _of(key: str, found: Estimate, unit: str) -> str:
    return line(key, found.value, unit, found.rule)


def _text(value: str) -> str:
    return json.dumps(value, ensure_ascii=False)


def full_thrust(boat: Particulars) -> tuple[list[float], bool]:
    """Largest thrust of each thruster [N], and whether the owner stated them all."""
    by_rule = thrust.full(boat.hull).value / len(boat.thrusters)
    stated = all(m.ahead is not None for m in boat.thrusters)
    return [by_rule if m.ahead is None else m.ahead for m in boat.thrusters], stated


def thrust_channel(name: str) -> str:
    """Its thrust command."""
    return f"thrust_{name}_N"


def steer_channel(name: str) -> str:
    """Its angle command, of a thruster that turns."""
    return f"steer_{name}_rad"


def _head(boat: Particulars) -> Iterator[str]:
    hull = boat.hull
    kind = "one hull" if hull.hulls == 1 else "two hulls"
    yield f"about = {_text(f'{boat.name}: {hull.length:g} m, {hull.mass:g} kg, {kind}, from its particulars')}"
    yield 'source = "boatsim new: sizes are the owner\'s, each other number by the rule beside it"'
    yield 'hull = "hull.xml"'
    yield 'freedoms = ["surge", "sway", "yaw"]'
    yield line("length", hull.length, "m", OWNER)
    yield line("beam", hull.beam, "m", OWNER)
    rule = (
        OWNER
        if boat.draught_stated
        else displacement.draught(hull.length, hull.beam, hull.mass, hull.hulls).rule
    )
    yield line("draught", hull.draught, "m", rule)


def _body(boat: Particulars) -> Iterator[str]:
    hull = boat.hull
    yield from ("", "[body]", line("mass", hull.mass, "kg", OWNER))
    yield _of("roll_inertia", inertia.roll(hull), "kg m^2")
    yield _of("yaw_inertia", inertia.yaw(hull), "kg m^2")
    yield from ("", "[geometry]")
    yield line(
        "cg_from_transom", 0.5 * hull.length, "m", "for the drawing: mass centre at mid-length"
    )
    yield line("cg_above_keel", hull.draught, "m", "for the drawing: mass centre in the waterline")


def _channels(boat: Particulars) -> Iterator[str]:
    full, _ = full_thrust(boat)
    yield from ("", "[channels]")
    for (name, mount), most in zip(boat.named(), full, strict=True):
        least = most if mount.astern is None else mount.astern
        said = OWNER if mount.ahead is not None else thrust.full(boat.hull).rule
        if mount.astern is None:
            said = f"{said}; astern as much"
        low = "0.0" if least == 0.0 else f"-{number(least)}"
        limits = f'low = {low}, high = {number(most)}, about = "ahead positive"'
        yield f"{thrust_channel(name)} = {{ {limits} }}  # [N] {said}"
        if mount.turns:
            about = "positive pushes to starboard"
            yield f'{steer_channel(name)} = {{ low = -{TURNS}, high = {TURNS}, about = "{about}" }}  # [rad] 40 deg'
    if boat.rudder is not None:
        turns = f'turns = "{"starboard" if boat.rudder.x < 0 else "port"}"'
        yield f"rudder_rad = {{ low = -{TURNS}, high = {TURNS}, {turns} }}  # [rad] 40 deg"


def _effects(boat: Particulars) -> Iterator[str]:
    hull, speed = boat.hull, service(boat)
    sway, yaw = sway_yaw_damping.at_rest(hull)
    yield from ("", "[[effect]]", 'use = "added_mass"')
    yield _of("surge", added_mass.surge(hull), "kg")
    yield _of("sway", added_mass.sway(hull), "kg")
    yield _of("yaw", added_mass.yaw(hull), "kg m^2")
    linear, quadratic = resistance.coefficients(hull, stated_thrust(boat), boat.speed)
    yield from ("", "[[effect]]", 'use = "linear_damping"')
    yield _of("surge", linear, "N s/m")
    yield _of("sway", sway, "N s/m")
    yield _of("yaw", yaw, "N m s")
    yield from ("", "[[effect]]", 'use = "surge_drag"', _of("quadratic", quadratic, "N s^2/m^2"))
    yield from ("", "[[effect]]", 'use = "cross_flow_drag"')
    yield _of("section_drag_coefficient", sway_yaw_damping.section_drag(), "")
    yield line("density", DENSITY, "kg/m^3", "fresh water")
    lift = sway_yaw_damping.lift(hull)
    yield from ("", "[[effect]]", 'use = "forward_speed_damping"')
    yield _of("sway", lift.sway, "N s^2/m^2")
    yield _of("at", lift.at, "m")
    yield _of("yaw", lift.yaw, "N s^2")
    for name, mount in boat.named():
        yield from _thruster(name, mount)
    yield from (
        "",
        "[[effect]]",
        'use = "thrust_loss_with_speed"',
        _of("loss", thrust.loss(hull, boat.speed), "s/m"),
    )
    if boat.rudder is not None:
        yield from _rudder(boat, speed)


def service(boat: Particulars) -> float:
    """Speed [m/s] at which a rudder is taken: an easy one, or the boat's top speed where that is less."""
    easy = resistance.service_speed(boat.hull)
    return easy if boat.speed is None else min(easy, boat.speed)


def stated_thrust(boat: Particulars) -> float | None:
    """Full thrust of all thrusters [N], None where nobody stated it."""
    full, stated = full_thrust(boat)
    return math.fsum(full) if stated else None


def _thruster(name: str, mount: Mount) -> Iterator[str]:
    yield from ("", "[[effect]]", 'use = "thruster"', f"name = {_text(name)}")
    steer = f', angle = "{steer_channel(name)}"' if mount.turns else ""
    yield f'on = {{ thrust = "{thrust_channel(name)}"{steer} }}'
    yield line("x", mount.x, "m", f"{OWNER}, ahead of the mass centre")
    yield line("y", mount.y, "m", f"{OWNER}, to starboard")


def _rudder(boat: Particulars, speed: float) -> Iterator[str]:
    blade, by_rule = boat.rudder, rudders.area(boat.hull)
    assert blade is not None
    area = Estimate(blade.area, OWNER) if blade.area is not None else by_rule
    slope = rudders.slope(area.value, speed)
    sign = (
        1.0 if blade.x < 0 else -1.0
    )  # a positive angle pushes a blade astern to port, which swings the bow to
    yield from ("", "[[effect]]", 'use = "rudder"', f"# area {number(area.value)} m^2: {area.rule}")
    yield 'on = { angle = "rudder_rad" }'
    yield line("sway", -sign * slope.value, "N/rad", slope.rule)
    yield line(
        "yaw",
        -sign * slope.value * blade.x,
        "N m/rad",
        f"at {number(blade.x)} m from the mass centre",
    )
    yield from ("", "[[effect]]", 'use = "speed_scaled_steering"', 'on = { angle = "rudder_rad" }')
    yield line("speed", speed, "m/s", "to which the coefficients above belong")
    yield line("rudder_sway", 1.0, "", "the blade's force goes with the square of the speed")
    yield line("rudder_yaw", 1.0, "", "same")
    if washed := _washing(boat, blade):
        found = rudders.race()
        yield from ("", "[[effect]]", 'use = "rudder_race"')
        yield f'on = {{ angle = "rudder_rad", thrust = "{thrust_channel(washed)}" }}'
        yield line("normal_force_per_thrust", found.value, "", found.rule)


def _washing(boat: Particulars, blade: Blade) -> str:
    """Name of the only fixed thruster in the middle line ahead of the rudder; "" where there is none, or several."""
    ahead = [name for name, m in boat.named() if m.y == 0.0 and not m.turns and m.x > blade.x]
    return ahead[0] if len(ahead) == 1 else ""


def approach(boat: Particulars) -> float:
    """Part of the full thrust with which manoeuvres are approached."""
    full, _ = full_thrust(boat)
    return min(HALF, EASY * resistance.at_service(boat.hull).value / math.fsum(full))


def _manoeuvring(boat: Particulars) -> Iterator[str]:
    full, _ = full_thrust(boat)
    part, named = approach(boat), boat.named()
    drives = [(thrust_channel(name), most) for (name, _), most in zip(named, full, strict=True)]
    ahead = ", ".join(f"{channel} = {number(part * most)}" for channel, most in drives)
    astern = ", ".join(
        f"{channel} = -{number(part * (most if m.astern is None else m.astern))}"
        for (channel, most), (_, m) in zip(drives, named, strict=True)
        if m.astern is None or m.astern > 0.0
    )
    rule = "twice the resistance at an easy speed" if part < HALF else "half thrust"
    yield from ("", "[manoeuvring]", f"ahead = {{ {ahead} }}  # [N] {rule}")
    if astern:
        yield f"astern = {{ {astern} }}  # [N]"
    if steer := steering(boat):
        told = ", ".join(f"{channel} = {number(gain)}" for channel, gain in steer.items())
        yield f"steer = {{ {told} }}  # per rad of helm, positive to starboard"


def steering(boat: Particulars) -> dict[str, float]:
    """Command per rad of helm: the rudder, else what turns, else thrust more on the outer side."""
    if boat.rudder is not None:
        return {"rudder_rad": 1.0}
    turning = {steer_channel(n): -1.0 if m.x <= 0 else 1.0 for n, m in boat.named() if m.turns}
    if turning:
        return turning
    full, _ = full_thrust(boat)
    pairs, part = zip(boat.named(), full, strict=True), approach(boat)
    return {
        thrust_channel(n): -math.copysign(part * most / TURNS, m.y)
        for (n, m), most in pairs
        if m.y != 0.0
    }


def _diagnosis(boat: Particulars) -> Iterator[str]:
    _, stated = full_thrust(boat)
    yield from ("", "[diagnosis]")
    sds = f"damping = {DAMPING}, thrust = {STATED if stated else RULED}, added_mass = {WATER}"
    yield f"coefficient_uncertainty = {{ {sds} }}  # relative sd"
    pushes = "a stated thrust is one at rest" if stated else "nobody stated a thrust"
    yield f'reasons.coefficient_uncertainty = "rules of thumb for damping are off by a factor of two; {pushes}"'
