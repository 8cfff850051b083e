"""The hull.xml of a new boat: the plain hull with its outboards, legs and rudder."""

from collections.abc import Iterator

from boatsim.newboat.particulars import Mount, Particulars
from boatsim.physics.vessel import plain_hull
from boatsim.physics.vessel.plain_hull import format_numbers, geom_element

COMMENT = "Drawn by boatsim new from the boat's sizes; forces and masses are in vessel.toml."


def hull_xml(boat: Particulars) -> str:
    """Return the hull drawing of a new boat as MJCF text (MuJoCo's XML format).

    The origin is at the transom in the water surface. The axes are x forward, y to port and z up.

    Args:
        boat: Particulars of the boat.
    """
    return plain_hull.hull_xml(boat.hull, boat.name, COMMENT, _fitting_lines(boat))


def _fitting_lines(boat: Particulars) -> Iterator[str]:
    hull = boat.hull
    for name, mount in boat.named_thrusters():
        yield from _outboard_lines(boat, name, mount)
    if boat.rudder is not None:
        at = (boat.mass_centre_from_transom + boat.rudder.x, 0, -0.5 * hull.draught)
        size = (0.02 * hull.length, 0.003 * hull.length, 0.5 * hull.draught)
        yield geom_element("rudder", "box", at, size, "seen", "dark")


def _outboard_lines(boat: Particulars, name: str, mount: Mount) -> Iterator[str]:
    """Leg and propeller of a thruster, with a cowl where it turns."""
    hull = boat.hull
    high = plain_hull.deck_height(hull)
    x, y = boat.mass_centre_from_transom + mount.x, -mount.y
    leg, radius = 0.5 * (high + hull.draught), 0.02 * hull.length
    size = (0.6 * radius, 0.3 * radius, leg)
    yield geom_element(f"leg_{name}", "box", (x, y, high - leg), size, "seen", "dark")
    if mount.turns:
        at = (x, y, high + 1.5 * radius)
        size = (2.2 * radius, 1.6 * radius, 2.2 * radius)
        yield geom_element(f"cowl_{name}", "ellipsoid", at, size, "seen", "dark")
    yield (
        f'<geom name="propeller_{name}" class="seen" type="cylinder" material="dark" '
        f'pos="{format_numbers(x, y, -hull.draught)}" euler="0 90 0" size="{radius:.4g} '
        f'{1.5 * radius:.4g}"/>'
    )
