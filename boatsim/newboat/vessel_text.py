"""The vessel.toml of a new boat from its particulars: every number has the rule it follows from."""

import math
from collections.abc import Iterator

from boatsim.files import toml_value
from boatsim.newboat.particulars import MAX_ANGLE, Mount, Particulars, Rudder
from boatsim.physics.estimate import (
    added_mass,
    displacement,
    inertia,
    resistance,
    shallow_water,
    sway_yaw_damping,
    thrust,
)
from boatsim.physics.estimate import rudder as rudders
from boatsim.physics.estimate.base import DENSITY, Estimate

OWNER = "the owner's"
COMMENT_COLUMN = 32  # where comments begin
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
    """Return the text of vessel.toml for a new boat, with coefficients estimated from particulars.

    Args:
        boat: Particulars of the boat.
    """
    return "\n".join(
        [
            *_head_lines(boat),
            *_body_lines(boat),
            *_channel_lines(boat),
            *_effect_lines(boat),
            *_manoeuvring_lines(boat),
            *_diagnosis_lines(boat),
            *_estimated_lines(boat),
            "",
        ]
    )


def format_number(value: float) -> str:
    """Return a number as TOML text, as a float with four digits.

    Args:
        value: The number.
    """
    text = f"{value:.4g}"
    if "." in text or "e" in text:
        return text
    return f"{text}.0"


def toml_line(key: str, value: float, unit: str, rule: str) -> str:
    """Return one entry of a vessel.toml as the line `key = value  # [unit] rule`.

    Args:
        key: Name of the entry.
        value: Its value.
        unit: Its unit; "" for none.
        rule: The rule that the value follows.
    """
    entry = f"{key} = {format_number(value)}"
    comment = rule
    if unit:
        comment = f"[{unit}] {rule}"
    return f"{entry:{COMMENT_COLUMN - 1}} # {comment}"


def _estimate_line(key: str, found: Estimate, unit: str) -> str:
    return toml_line(key, found.value, unit, found.rule)


def full_thrust(boat: Particulars) -> tuple[list[float], bool]:
    """Return the largest thrust of each thruster of a new boat [N], and whether its owner gave all.

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


def _thrust_channel(name: str) -> str:
    """Name of the channel for the thrust of a thruster in newtons."""
    return f"thrust_{name}_N"


def steering_channel_name(name: str) -> str:
    """Return the name of the command channel for the angle of a thruster that turns.

    Args:
        name: Name of the thruster.
    """
    return f"steer_{name}_rad"


def _head_lines(boat: Particulars) -> Iterator[str]:
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
    yield toml_line("length", hull.length, "m", OWNER)
    yield toml_line("beam", hull.beam, "m", OWNER)
    rule = OWNER
    if not boat.draught_given:
        rule = displacement.hull_draught(hull.length, hull.beam, hull.mass, hull.hulls).rule
    yield toml_line("draught", hull.draught, "m", rule)
    if hull.hulls == 2:
        breadth = displacement.hull_breadth(hull.beam, hull.hulls).rule
        if boat.breadth_given:
            breadth = OWNER
        yield f"# breadth of one hull {format_number(hull.breadth)} m: {breadth}"


def _body_lines(boat: Particulars) -> Iterator[str]:
    hull = boat.hull
    yield from ("", "[body]", toml_line("mass", hull.mass, "kg", OWNER))
    yield _estimate_line("roll_inertia", inertia.roll_inertia(hull), "kg m^2")
    yield _estimate_line("yaw_inertia", inertia.yaw_inertia(hull), "kg m^2")
    yield from ("", "[geometry]")
    place = "for the drawing: mass centre at mid-length"
    if boat.mass_centre is not None:
        place = OWNER
    yield toml_line("cg_from_transom", boat.mass_centre_from_transom, "m", place)
    yield toml_line(
        "cg_above_keel", hull.draught, "m", "for the drawing: mass centre in the waterline"
    )


def _channel_lines(boat: Particulars) -> Iterator[str]:
    full, _ = full_thrust(boat)
    yield from ("", "[channels]")
    angle = format_number(boat.helm.most)
    unit = f"[rad] {math.degrees(boat.helm.most):.2g} deg"
    if boat.helm.given:
        unit = f"[rad] {math.degrees(boat.helm.most):.4g} deg, {OWNER}"
    for (name, mount), most in zip(boat.named_thrusters(), full, strict=True):
        yield from _command_lines(boat, name, mount, most)
        if mount.turns:
            about = "positive pushes to starboard"
            yield (
                f"{steering_channel_name(name)} = {{ low = -{angle}, high = {angle}, about = "
                f'"{about}" }}  # {unit}'
            )
    for name, mount in boat.named_tunnels():
        most_text = format_number(mount.ahead or 0.0)
        about = "tunnel thruster, positive pushes to starboard"
        limits = f'low = -{most_text}, high = {most_text}, about = "{about}"'
        yield f"{_thrust_channel(name)} = {{ {limits} }}  # [N] {OWNER}"
    if boat.rudder is not None:
        side = "starboard" if boat.rudder.x < 0 else "port"
        turns = f'turns = "{side}"'
        yield f"rudder_rad = {{ low = -{angle}, high = {angle}, {turns} }}  # {unit}"


def _command_lines(boat: Particulars, name: str, mount: Mount, most: float) -> Iterator[str]:
    """Lines of the command channels of a thruster."""
    least = mount.largest_astern(most)
    rule = _thrust_rule(boat, mount)
    limits = f"low = {_negative(least)}, high = {format_number(most)}"
    if boat.law.curve:
        yield (
            f'{_thrust_channel(name)} = {{ {limits}, about = "thrust beside that of the '
            f'throttle" }}  # [N] {OWNER}'
        )
        low, high = boat.law.curve[0][0], boat.law.curve[-1][0]
        neutral = ""
        if not low <= 0.0 <= high:
            neutral = f", neutral = {format_number(boat.law.neutral_command)}"
        yield (
            f"{boat.law.channel_name(name)} = {{ low = {format_number(low)}, high = "
            f'{format_number(high)}{neutral}, about = "raw command of the thrust curve" }}'
            f"  # {OWNER}"
        )
        return
    if boat.law.rpm is None:
        yield f'{_thrust_channel(name)} = {{ {limits}, about = "ahead positive" }}  # [N] {rule}'
        return
    rate = boat.law.full_rate
    slowest = "0.0"
    if least != 0.0:
        slowest = _negative(rate)
    limits = f'low = {slowest}, high = {format_number(rate)}, about = "shaft rate, ahead positive"'
    yield f"{boat.law.channel_name(name)} = {{ {limits} }}  # [rad/s] {boat.law.rpm:g} rpm, {OWNER}"


def _negative(value: float) -> str:
    """The text of a number with the opposite sign."""
    if value == 0.0:
        return "0.0"
    return f"-{format_number(value)}"


def _thrust_rule(boat: Particulars, mount: Mount) -> str:
    """The source of the largest thrusts of a thruster."""
    rule = OWNER
    if mount.ahead is None:
        rule = thrust.full_thrust(boat.hull).rule
    if mount.astern is None:
        rule = f"{rule}; the same astern"
    return rule


def _effect_lines(boat: Particulars) -> Iterator[str]:
    hull, speed = boat.hull, rudder_design_speed(boat)
    sway, yaw = sway_yaw_damping.damping_at_rest(hull)
    yield from ("", "[[effect]]", 'use = "added_mass"')
    yield _estimate_line("surge", added_mass.surge_added_mass(hull), "kg")
    yield _estimate_line("sway", _in_depth(boat, added_mass.sway_added_mass(hull)), "kg")
    yield _estimate_line("yaw", _in_depth(boat, added_mass.yaw_added_mass(hull)), "kg m^2")
    middle = "mid-length ahead of the mass centre"
    if boat.mass_centre is not None:
        yield toml_line("sway_at", boat.midship_position, "m", middle)
    linear, quadratic = resistance.surge_damping(hull, specified_full_thrust(boat), boat.speed)
    yield from ("", "[[effect]]", 'use = "linear_damping"')
    yield _estimate_line("surge", linear, "N s/m")
    yield _estimate_line("sway", sway, "N s/m")
    yield _estimate_line("yaw", yaw, "N m s")
    yield from (
        "",
        "[[effect]]",
        'use = "surge_drag"',
        _estimate_line("quadratic", quadratic, "N s^2/m^2"),
    )
    yield from ("", "[[effect]]", 'use = "cross_flow_drag"')
    section = _in_depth(boat, sway_yaw_damping.section_drag_coefficient())
    yield _estimate_line("section_drag_coefficient", section, "")
    if boat.mass_centre is not None:
        yield toml_line("centre", boat.midship_position, "m", middle)
    yield toml_line("density", DENSITY, "kg/m^3", "fresh water")
    lift = sway_yaw_damping.lift_derivatives(hull)
    yield from ("", "[[effect]]", 'use = "forward_speed_damping"')
    yield _estimate_line("sway", lift.sway, "N s^2/m^2")
    yield _estimate_line("at", Estimate(lift.at.value + boat.midship_position, lift.at.rule), "m")
    yield _estimate_line("yaw", lift.yaw, "N s^2")
    if boat.helm.rate is not None:
        yield from ("", "[[effect]]", 'use = "steering_rate_limit"')
        degrees = f"{math.degrees(boat.helm.rate):.3g} deg/s, {OWNER}"
        yield toml_line("rate", boat.helm.rate, "rad/s", degrees)
    full, _ = full_thrust(boat)
    if boat.law.curve:
        yield from _curve_lines(boat)
    for (name, mount), most in zip(boat.named_thrusters(), full, strict=True):
        if boat.law.rpm is None:
            yield from _thruster_lines(name, mount)
        else:
            yield from _propeller_lines(boat, name, mount, most)
    for name, mount in boat.named_tunnels():
        yield from _tunnel_lines(name, mount)
    yield from _thrust_loss_lines(boat)
    if boat.rudder is not None:
        yield from _rudder_lines(boat, speed)


def _thrust_loss_lines(boat: Particulars) -> Iterator[str]:
    """Lines of the loss of thrust with speed, once for all thrusters with the same full thrusts."""
    full, _ = full_thrust(boat)
    alike: dict[tuple[float, float], list[str]] = {}
    for (name, mount), most in zip(boat.named_thrusters(), full, strict=True):
        alike.setdefault((most, mount.largest_astern(most)), []).append(name)
    for (ahead, astern), names in alike.items():
        yield from ("", "[[effect]]", 'use = "thrust_loss_with_speed"')
        if len(alike) > 1:
            yield f"name = {toml_value(f'thrust_loss_{names[0]}')}"
        # a tunnel thruster has no axis along the flow
        if boat.tunnels or len(alike) > 1:
            yield f"on = {toml_value(names)}"
        yield _estimate_line("loss", thrust.thrust_loss_with_speed(boat.hull, boat.speed), "s/m")
        rule = "full thrust at rest: the loss grows with the revolutions"
        yield toml_line("full_ahead", ahead, "N", rule)
        yield toml_line("full_astern", astern, "N", "the same astern")


def _in_depth(boat: Particulars, found: Estimate) -> Estimate:
    """An estimate for deep water in the depth that the owner gave."""
    if boat.depth is None:
        return found
    factor = shallow_water.shallow_water_factor(boat.hull.draught, boat.depth)
    return Estimate(found.value * factor.value, f"{found.rule}; {factor.rule}")


def rudder_design_speed(boat: Particulars) -> float:
    """Return the speed for which a new boat's rudder coefficients are estimated [m/s].

    It is the service speed, at most the top speed.

    Args:
        boat: Particulars of the boat.
    """
    easy = resistance.service_speed(boat.hull)
    if boat.speed is None:
        return easy
    return min(easy, boat.speed)


def specified_full_thrust(boat: Particulars) -> float | None:
    """Return the total full thrust of a new boat [N]; None if its owner did not give all thrusts.

    Args:
        boat: Particulars of the boat.
    """
    full, all_given = full_thrust(boat)
    if not all_given:
        return None
    return math.fsum(full)


def _thruster_lines(name: str, mount: Mount) -> Iterator[str]:
    yield from ("", "[[effect]]", 'use = "thruster"', f"name = {toml_value(name)}")
    steer = ""
    if mount.turns:
        steer = f', angle = "{steering_channel_name(name)}"'
    yield f'on = {{ thrust = "{_thrust_channel(name)}"{steer} }}'
    yield from _mount_lines(mount)


def _mount_lines(mount: Mount) -> Iterator[str]:
    yield toml_line("x", mount.x, "m", f"{OWNER}, ahead of the mass centre")
    yield toml_line("y", mount.y, "m", f"{OWNER}, to starboard")


def _propeller_lines(boat: Particulars, name: str, mount: Mount, most: float) -> Iterator[str]:
    """Lines of a propeller, whose thrust grows with the square of its revolutions."""
    yield from ("", "[[effect]]", 'use = "propeller"', f"name = {toml_value(name)}")
    steer = ""
    if mount.turns:
        steer = f', angle = "{steering_channel_name(name)}"'
    yield f'on = {{ shaft = "{boat.law.channel_name(name)}"{steer} }}'
    rule = _thrust_rule(boat, mount)
    for key, force in (("ahead", most), ("astern", mount.largest_astern(most))):
        at_full = f"{format_number(force)} N at {boat.law.rpm:g} rpm: {rule}"
        yield toml_line(key, force / boat.law.full_rate**2, "N s^2/rad^2", at_full)
    yield from _mount_lines(mount)


def _tunnel_lines(name: str, mount: Mount) -> Iterator[str]:
    """Lines of a tunnel thruster, a thruster that points to starboard."""
    yield from ("", "[[effect]]", 'use = "thruster"', f"name = {toml_value(name)}")
    yield f'on = {{ thrust = "{_thrust_channel(name)}", angle = 1.5708 }}  # [rad] to starboard'
    yield from _mount_lines(mount)


def _curve_lines(boat: Particulars) -> Iterator[str]:
    """Lines of the measured thrust by raw command."""
    points = ", ".join(f"[{x:g}, {force:g}]" for x, force in boat.law.curve)
    for name, _ in boat.named_thrusters():
        yield from ("", "[[effect]]", 'use = "thrust_curve"', f'name = "curve_{name}"')
        yield f'on = "{_thrust_channel(name)}"'
        yield f'fed_by = "{boat.law.channel_name(name)}"'
        yield f"points = [{points}]  # raw command, thrust [N]: {OWNER}"


def _rudder_lines(boat: Particulars, speed: float) -> Iterator[str]:
    blade, by_rule = boat.rudder, rudders.rudder_area(boat.hull)
    assert blade is not None
    area = by_rule
    if blade.area is not None:
        area = Estimate(blade.area, OWNER)
    slope = rudders.rudder_force_slope(area.value, speed)
    # A positive angle pushes a blade aft to port, which turns the bow to starboard
    sign = 1.0 if blade.x < 0 else -1.0
    yield from (
        "",
        "[[effect]]",
        'use = "rudder"',
        f"# area {format_number(area.value)} m^2: {area.rule}",
    )
    yield 'on = { angle = "rudder_rad" }'
    yield toml_line("sway", -sign * slope.value, "N/rad", slope.rule)
    yield toml_line(
        "yaw",
        -sign * slope.value * blade.x,
        "N m/rad",
        f"at {format_number(blade.x)} m from the mass centre",
    )
    yield from ("", "[[effect]]", 'use = "speed_scaled_steering"', 'on = { angle = "rudder_rad" }')
    yield toml_line("speed", speed, "m/s", "to which the coefficients above belong")
    yield toml_line("rudder_sway", 1.0, "", "the force grows with the square of the speed")
    yield toml_line("rudder_yaw", 1.0, "", "same")
    washed = _thruster_ahead_of_rudder(boat, blade)
    if washed and boat.law.rpm is not None:
        yield "# no rudder_race: its law needs the thrust as a command, this boat has revolutions"
    elif washed:
        found = rudders.slipstream_rudder_force()
        yield from ("", "[[effect]]", 'use = "rudder_race"')
        yield f'on = {{ angle = "rudder_rad", thrust = "{_thrust_channel(washed)}" }}'
        yield toml_line("normal_force_per_thrust", found.value, "", found.rule)


def _thruster_ahead_of_rudder(boat: Particulars, blade: Rudder) -> str:
    """Name of the only fixed thruster on the centre line ahead of the rudder.

    "" if there is none or several.
    """
    ahead = [
        name for name, m in boat.named_thrusters() if m.y == 0.0 and not m.turns and m.x > blade.x
    ]
    if len(ahead) != 1:
        return ""
    return ahead[0]


def approach_thrust_share(boat: Particulars) -> float:
    """Return the fraction of full thrust with which a new boat approaches standard manoeuvres.

    Args:
        boat: Particulars of the boat.
    """
    full, _ = full_thrust(boat)
    return min(
        APPROACH_PART,
        APPROACH_RESISTANCE * resistance.service_resistance(boat.hull).value / math.fsum(full),
    )


def _manoeuvring_lines(boat: Particulars) -> Iterator[str]:
    full, _ = full_thrust(boat)
    part, named = approach_thrust_share(boat), boat.named_thrusters()
    ahead: list[str] = []
    astern: list[str] = []
    for (name, mount), most in zip(named, full, strict=True):
        channel, least = boat.law.channel_name(name), mount.largest_astern(most)
        forward = boat.law.command_for_thrust(part * most, most, least)
        ahead.append(f"{channel} = {format_number(forward)}")
        if least > 0.0 or mount.astern is None:
            backward = boat.law.command_for_thrust(-part * least, most, least)
            astern.append(f"{channel} = {format_number(backward)}")
    rule = "half thrust"
    if part < APPROACH_PART:
        rule = "twice the resistance at an easy speed"
    unit = "[N] "
    if boat.law.rpm is not None:
        unit = "[rad/s] "
    elif boat.law.curve:
        unit = ""
    yield from ("", "[manoeuvring]", f"ahead = {{ {', '.join(ahead)} }}  # {unit}{rule}")
    if astern:
        yield f"astern = {{ {', '.join(astern)} }}  # {unit}{rule}"
    if steer := steering_commands(boat):
        gains = ", ".join(f"{channel} = {format_number(gain)}" for channel, gain in steer.items())
        yield f"steer = {{ {gains} }}  # per rad of helm, positive to starboard"


def steering_angles(boat: Particulars) -> dict[str, float]:
    """Return the angle commands per rad of helm that steer a new boat: rudder or turned thrusters.

    The result is empty for a boat with fixed thrusters alone.

    Args:
        boat: Particulars of the boat.
    """
    if boat.rudder is not None:
        return {"rudder_rad": 1.0}
    turning: dict[str, float] = {}
    for name, mount in boat.named_thrusters():
        if mount.turns:
            turning[steering_channel_name(name)] = -1.0 if mount.x <= 0 else 1.0
    return turning


def differential_thrust(boat: Particulars) -> dict[str, float]:
    """Return the thrust [N] per rad of helm, by thruster, that steers a boat with fixed thrusters.

    Args:
        boat: Particulars of the boat.
    """
    full, _ = full_thrust(boat)
    part = approach_thrust_share(boat)
    gains: dict[str, float] = {}
    for (name, mount), most in zip(boat.named_thrusters(), full, strict=True):
        if mount.y != 0.0:
            gains[name] = -math.copysign(part * most / MAX_ANGLE, mount.y)
    return gains


def steering_commands(boat: Particulars) -> dict[str, float]:
    """Return the commands per rad of helm that steer a new boat.

    They are commands of the rudder, of turned thrusters or of differential thrust.

    Args:
        boat: Particulars of the boat.
    """
    if turning := steering_angles(boat):
        return turning
    full, _ = full_thrust(boat)
    gains: dict[str, float] = {}
    by_name = differential_thrust(boat)
    for (name, mount), most in zip(boat.named_thrusters(), full, strict=True):
        if name in by_name:
            change = abs(by_name[name]) * MAX_ANGLE
            least = mount.largest_astern(most)
            neutral = boat.law.command_for_thrust(0.0, most, least)
            step = (boat.law.command_for_thrust(change, most, least) - neutral) / MAX_ANGLE
            gains[boat.law.channel_name(name)] = math.copysign(step, by_name[name])
    return gains


def _thrust_uncertainty(boat: Particulars) -> tuple[float, str]:
    """Relative standard deviation of the thrust, and its reason."""
    _, all_given = full_thrust(boat)
    if all_given:
        return GIVEN_THRUST_SD, "a given thrust is one at rest"
    return ESTIMATED_THRUST_SD, "no thrust was given"


def _diagnosis_lines(boat: Particulars) -> Iterator[str]:
    thrust_sd, thrust_reason = _thrust_uncertainty(boat)
    yield from ("", "[diagnosis]")
    sds = f"damping = {DAMPING_SD}, thrust = {thrust_sd}, added_mass = {ADDED_MASS_SD}"
    yield f"coefficient_uncertainty = {{ {sds} }}  # relative sd"
    reason = f"rules of thumb for damping are off by a factor of two; {thrust_reason}"
    yield f'reasons.coefficient_uncertainty = "{reason}"'


def _estimated_lines(boat: Particulars) -> Iterator[str]:
    thrust_sd, thrust_reason = _thrust_uncertainty(boat)
    yield from ("", "[estimated]  # relative sd of the numbers that nobody measured or published")
    yield toml_line("damping", DAMPING_SD, "", "rules of thumb")
    yield toml_line("thrust", thrust_sd, "", thrust_reason)
    yield toml_line("added_mass", ADDED_MASS_SD, "", "strip theory or regression")
    if boat.mass_uncertainty > 0.0:
        yield toml_line('"body.mass"', boat.mass_uncertainty, "", "the owner's mass, not weighed")
    yield toml_line('"body.roll_inertia"', INERTIA_SD, "", "usual radius of gyration")
    yield toml_line('"body.yaw_inertia"', INERTIA_SD, "", "usual radius of gyration")
    if boat.mass_centre is None:
        yield toml_line("mass_centre", UNKNOWN_SD, "", "assumed at mid-length")
        rule = "positions are recorded ahead of the mass centre by an unknown distance"
        yield toml_line('"position_frame_error.forward"', UNKNOWN_SD, "", rule)
    yield toml_line("lag", UNKNOWN_SD, "", "lags of motors and steering are assumed to be zero")
