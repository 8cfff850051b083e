"""The vessel.toml of a new boat from its particulars: every number has the rule it follows from."""

import math
from collections.abc import Iterator

from boatsim.files import toml_value
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
COMMENT_COLUMN = 32  # where comments begin
MAX_ANGLE = 0.7  # [rad] 40 deg, the usual limit of rudders and outboards
# Thrust at the approach of manoeuvres: this part of full thrust, but at most this many times the
# resistance at service speed
APPROACH_PART = 0.5
APPROACH_RESISTANCE = 2.0
# Relative standard deviations of coefficients
DAMPING_SD = 1.0  # rules of thumb for damping are off by a factor of two
GIVEN_THRUST_SD = 0.3  # bollard pull differs from the thrust under way
ESTIMATED_THRUST_SD = 0.6
ADDED_MASS_SD = 0.4  # difference of strip theory, regressions and measurements
INERTIA_SD = 0.3  # radii of gyration of boats differ by this from the usual share of the length
UNKNOWN_SD = 1.0  # numbers that the file sets to zero for want of anything better


def vessel_text(boat: Particulars) -> str:
    """Return the text of vessel.toml.

    Args:
        boat: Particulars of the boat.
    """
    return "\n".join(
        [
            *_head(boat),
            *_body(boat),
            *_channels(boat),
            *_effects(boat),
            *_manoeuvring(boat),
            *_diagnosis(boat),
            *_estimated(boat),
            "",
        ]
    )


def number(value: float) -> str:
    """Return a number with four digits as a TOML float.

    Args:
        value: The number.
    """
    text = f"{value:.4g}"
    if "." in text or "e" in text:
        return text
    return f"{text}.0"


def line(key: str, value: float, unit: str, rule: str) -> str:
    """Return the line `key = value  # [unit] rule`.

    Args:
        key: Name of the entry.
        value: Its value.
        unit: Its unit; "" for none.
        rule: The rule that the value follows.
    """
    entry = f"{key} = {number(value)}"
    comment = rule
    if unit:
        comment = f"[{unit}] {rule}"
    return f"{entry:{COMMENT_COLUMN - 1}} # {comment}"


def _of(key: str, found: Estimate, unit: str) -> str:
    return line(key, found.value, unit, found.rule)


def full_thrust(boat: Particulars) -> tuple[list[float], bool]:
    """Return the largest thrust of each thruster [N], and whether the owner gave all.

    Args:
        boat: Particulars of the boat.
    """
    by_rule = thrust.full_thrust(boat.hull).value / len(boat.thrusters)
    all_given = True
    largest = []
    for mount in boat.thrusters:
        if mount.ahead is None:
            largest.append(by_rule)
            all_given = False
        else:
            largest.append(mount.ahead)
    return largest, all_given


def thrust_channel(name: str) -> str:
    """Return the name of the thrust command of a thruster.

    Args:
        name: Name of the thruster.
    """
    return f"thrust_{name}_N"


def steer_channel(name: str) -> str:
    """Return the name of the angle command of a thruster that turns.

    Args:
        name: Name of the thruster.
    """
    return f"steer_{name}_rad"


def _head(boat: Particulars) -> Iterator[str]:
    hull = boat.hull
    kind = "one hull" if hull.hulls == 1 else "two hulls"
    size = f"{hull.length:g} m, {hull.mass:g} kg"
    about = f"{boat.name}: {size}, {kind}, from its particulars"
    yield f"about = {toml_value(about)}"
    yield (
        "source = \"boatsim new: sizes are the owner's, each other number follows the rule in "
        'its comment"'
    )
    yield 'hull = "hull.xml"'
    yield 'freedoms = ["surge", "sway", "yaw"]'
    yield line("length", hull.length, "m", OWNER)
    yield line("beam", hull.beam, "m", OWNER)
    rule = OWNER
    if not boat.draught_given:
        rule = displacement.hull_draught(hull.length, hull.beam, hull.mass, hull.hulls).rule
    yield line("draught", hull.draught, "m", rule)


def _body(boat: Particulars) -> Iterator[str]:
    hull = boat.hull
    yield from ("", "[body]", line("mass", hull.mass, "kg", OWNER))
    yield _of("roll_inertia", inertia.roll_inertia(hull), "kg m^2")
    yield _of("yaw_inertia", inertia.yaw_inertia(hull), "kg m^2")
    yield from ("", "[geometry]")
    yield line(
        "cg_from_transom", 0.5 * hull.length, "m", "for the drawing: mass centre at mid-length"
    )
    yield line("cg_above_keel", hull.draught, "m", "for the drawing: mass centre in the waterline")


def _channels(boat: Particulars) -> Iterator[str]:
    full, _ = full_thrust(boat)
    yield from ("", "[channels]")
    for (name, mount), most in zip(boat.named(), full, strict=True):
        least = mount.largest_astern(most)
        rule = OWNER
        if mount.ahead is None:
            rule = thrust.full_thrust(boat.hull).rule
        if mount.astern is None:
            rule = f"{rule}; the same astern"
        low = "0.0"
        if least != 0.0:
            low = f"-{number(least)}"
        limits = f'low = {low}, high = {number(most)}, about = "ahead positive"'
        yield f"{thrust_channel(name)} = {{ {limits} }}  # [N] {rule}"
        if mount.turns:
            about = "positive pushes to starboard"
            yield (
                f"{steer_channel(name)} = {{ low = -{MAX_ANGLE}, high = {MAX_ANGLE}, about = "
                f'"{about}" }}  # [rad] 40 deg'
            )
    if boat.rudder is not None:
        side = "starboard" if boat.rudder.x < 0 else "port"
        turns = f'turns = "{side}"'
        yield f"rudder_rad = {{ low = -{MAX_ANGLE}, high = {MAX_ANGLE}, {turns} }}  # [rad] 40 deg"


def _effects(boat: Particulars) -> Iterator[str]:
    hull, speed = boat.hull, service(boat)
    sway, yaw = sway_yaw_damping.damping_at_rest(hull)
    yield from ("", "[[effect]]", 'use = "added_mass"')
    yield _of("surge", added_mass.surge_added_mass(hull), "kg")
    yield _of("sway", added_mass.sway_added_mass(hull), "kg")
    yield _of("yaw", added_mass.yaw_added_mass(hull), "kg m^2")
    linear, quadratic = resistance.surge_damping(hull, given_thrust(boat), boat.speed)
    yield from ("", "[[effect]]", 'use = "linear_damping"')
    yield _of("surge", linear, "N s/m")
    yield _of("sway", sway, "N s/m")
    yield _of("yaw", yaw, "N m s")
    yield from ("", "[[effect]]", 'use = "surge_drag"', _of("quadratic", quadratic, "N s^2/m^2"))
    yield from ("", "[[effect]]", 'use = "cross_flow_drag"')
    yield _of("section_drag_coefficient", sway_yaw_damping.section_drag_coefficient(), "")
    yield line("density", DENSITY, "kg/m^3", "fresh water")
    lift = sway_yaw_damping.lift_derivatives(hull)
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
        _of("loss", thrust.thrust_loss_with_speed(hull, boat.speed), "s/m"),
    )
    if boat.rudder is not None:
        yield from _rudder(boat, speed)


def service(boat: Particulars) -> float:
    """Return the speed of the rudder coefficients [m/s]: service speed, at most top speed.

    Args:
        boat: Particulars of the boat.
    """
    easy = resistance.service_speed(boat.hull)
    if boat.speed is None:
        return easy
    return min(easy, boat.speed)


def given_thrust(boat: Particulars) -> float | None:
    """Return the full thrust of all thrusters [N]; None if the owner did not give all.

    Args:
        boat: Particulars of the boat.
    """
    full, all_given = full_thrust(boat)
    if not all_given:
        return None
    return math.fsum(full)


def _thruster(name: str, mount: Mount) -> Iterator[str]:
    yield from ("", "[[effect]]", 'use = "thruster"', f"name = {toml_value(name)}")
    steer = ""
    if mount.turns:
        steer = f', angle = "{steer_channel(name)}"'
    yield f'on = {{ thrust = "{thrust_channel(name)}"{steer} }}'
    yield line("x", mount.x, "m", f"{OWNER}, ahead of the mass centre")
    yield line("y", mount.y, "m", f"{OWNER}, to starboard")


def _rudder(boat: Particulars, speed: float) -> Iterator[str]:
    blade, by_rule = boat.rudder, rudders.rudder_area(boat.hull)
    assert blade is not None
    area = by_rule
    if blade.area is not None:
        area = Estimate(blade.area, OWNER)
    slope = rudders.rudder_force_slope(area.value, speed)
    # A positive angle pushes a blade aft to port, which turns the bow to starboard
    sign = 1.0 if blade.x < 0 else -1.0
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
    yield line("rudder_sway", 1.0, "", "the force grows with the square of the speed")
    yield line("rudder_yaw", 1.0, "", "same")
    if washed := _washing(boat, blade):
        found = rudders.slipstream_rudder_force()
        yield from ("", "[[effect]]", 'use = "rudder_race"')
        yield f'on = {{ angle = "rudder_rad", thrust = "{thrust_channel(washed)}" }}'
        yield line("normal_force_per_thrust", found.value, "", found.rule)


def _washing(boat: Particulars, blade: Blade) -> str:
    """Name of the only fixed thruster on the centre line ahead of the rudder.

    "" if there is none or several.
    """
    ahead = [name for name, m in boat.named() if m.y == 0.0 and not m.turns and m.x > blade.x]
    if len(ahead) != 1:
        return ""
    return ahead[0]


def approach(boat: Particulars) -> float:
    """Return the part of full thrust at the approach of manoeuvres.

    Args:
        boat: Particulars of the boat.
    """
    full, _ = full_thrust(boat)
    return min(
        APPROACH_PART,
        APPROACH_RESISTANCE * resistance.service_resistance(boat.hull).value / math.fsum(full),
    )


def _manoeuvring(boat: Particulars) -> Iterator[str]:
    full, _ = full_thrust(boat)
    part, named = approach(boat), boat.named()
    ahead: list[str] = []
    astern: list[str] = []
    for (name, mount), most in zip(named, full, strict=True):
        channel = thrust_channel(name)
        ahead.append(f"{channel} = {number(part * most)}")
        if (least := mount.largest_astern(most)) > 0.0 or mount.astern is None:
            astern.append(f"{channel} = -{number(part * least)}")
    rule = "half thrust"
    if part < APPROACH_PART:
        rule = "twice the resistance at an easy speed"
    yield from ("", "[manoeuvring]", f"ahead = {{ {', '.join(ahead)} }}  # [N] {rule}")
    if astern:
        yield f"astern = {{ {', '.join(astern)} }}  # [N]"
    if steer := steering(boat):
        gains = ", ".join(f"{channel} = {number(gain)}" for channel, gain in steer.items())
        yield f"steer = {{ {gains} }}  # per rad of helm, positive to starboard"


def steering(boat: Particulars) -> dict[str, float]:
    """Return the commands per rad of helm: of rudder, turned thrusters or differential thrust.

    Args:
        boat: Particulars of the boat.
    """
    if boat.rudder is not None:
        return {"rudder_rad": 1.0}
    turning: dict[str, float] = {}
    for name, mount in boat.named():
        if mount.turns:
            turning[steer_channel(name)] = -1.0 if mount.x <= 0 else 1.0
    if turning:
        return turning
    full, _ = full_thrust(boat)
    part = approach(boat)
    gains: dict[str, float] = {}
    for (name, mount), most in zip(boat.named(), full, strict=True):
        if mount.y != 0.0:
            gains[thrust_channel(name)] = -math.copysign(part * most / MAX_ANGLE, mount.y)
    return gains


def _thrust_uncertainty(boat: Particulars) -> tuple[float, str]:
    """Relative standard deviation of the thrust, and its reason."""
    _, all_given = full_thrust(boat)
    if all_given:
        return GIVEN_THRUST_SD, "a given thrust is one at rest"
    return ESTIMATED_THRUST_SD, "no thrust was given"


def _diagnosis(boat: Particulars) -> Iterator[str]:
    thrust_sd, thrust_reason = _thrust_uncertainty(boat)
    yield from ("", "[diagnosis]")
    sds = f"damping = {DAMPING_SD}, thrust = {thrust_sd}, added_mass = {ADDED_MASS_SD}"
    yield f"coefficient_uncertainty = {{ {sds} }}  # relative sd"
    reason = f"rules of thumb for damping are off by a factor of two; {thrust_reason}"
    yield f'reasons.coefficient_uncertainty = "{reason}"'


def _estimated(boat: Particulars) -> Iterator[str]:
    thrust_sd, thrust_reason = _thrust_uncertainty(boat)
    yield from ("", "[estimated]  # relative sd of the numbers that nobody measured or published")
    yield line("damping", DAMPING_SD, "", "rules of thumb")
    yield line("thrust", thrust_sd, "", thrust_reason)
    yield line("added_mass", ADDED_MASS_SD, "", "strip theory or regression")
    yield line('"body.roll_inertia"', INERTIA_SD, "", "usual radius of gyration")
    yield line('"body.yaw_inertia"', INERTIA_SD, "", "usual radius of gyration")
    yield line("mass_centre", UNKNOWN_SD, "", "assumed at mid-length")
    yield line("lag", UNKNOWN_SD, "", "lags of motors and steering are assumed to be zero")
