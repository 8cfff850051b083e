"""Plain drawing of a hull as MJCF: boxes and ellipsoids from its dimensions.

The origin is at the transom on the centre line in the water surface; x forward, y to port, z up.
"""

import html
from collections.abc import Iterable, Iterator

from boatsim.physics.estimate import inertia
from boatsim.physics.estimate.base import HullParticulars

HEAD = """\
  <asset>
    <material name="hull" rgba="0.10 0.42 0.70 1" specular="0.4" shininess="0.4"/>
    <material name="deck" rgba="0.85 0.85 0.82 1" specular="0.3" shininess="0.3"/>
    <material name="dark" rgba="0.14 0.15 0.17 1" specular="0.3"/>
  </asset>
  <default>
    <default class="seen">
      <geom contype="0" conaffinity="0" group="2" mass="0"/>
    </default>
    <default class="touch">
      <geom contype="0" conaffinity="0" group="3" mass="0" rgba="0.8 0.2 0.2 0.3"/>
    </default>
  </default>"""


def hull_xml(hull: HullParticulars, name: str, comment: str, fittings: Iterable[str] = ()) -> str:
    """Return a plain drawing of a hull (boxes and ellipsoids) as the text of a MuJoCo MJCF file.

    Args:
        hull: Dimensions [m] and mass [kg].
        name: Name of the model.
        comment: Comment at the top of the file.
        fittings: Elements of outboards, rudders and the like.
    """
    lines = [
        f'<mujoco model="{html.escape(name)}">',
        f"  <!-- {comment} -->",
        "  <custom>",
        f'    <numeric name="drawn_for" data="{hull.length:g} {hull.beam:g} {hull.draught:.4g}"/> '
        "<!-- [m] L, B, T -->",
        "  </custom>",
        HEAD,
        "  <worldbody>",
        '    <body name="hull">',
    ]
    for part in (*_hull_parts(hull), *fittings):
        lines.append(f"      {part}")
    lines += ["    </body>", "  </worldbody>", "</mujoco>", ""]
    return "\n".join(lines)


def deck_height(hull: HullParticulars) -> float:
    """Return the height of the deck above the water [m] in a plain drawing of a hull.

    It is chosen for the looks.
    """
    return max(hull.draught, 0.08 * hull.length)


def _hull_parts(hull: HullParticulars) -> Iterator[str]:
    """Inertia, the box that touches walls, and what is drawn."""
    length, high = hull.length, deck_height(hull)
    middle = 0.5 * (high - hull.draught)
    half_height = 0.5 * (high + hull.draught)
    yaw_inertia = inertia.yaw_inertia(hull).value
    diagonal = format_numbers(yaw_inertia, yaw_inertia, yaw_inertia)
    yield (
        f'<inertial pos="{format_numbers(0.5 * length, 0, 0)}" mass="{hull.mass:g}" '
        f'diaginertia="{diagonal}"/>'
    )
    size = (0.5 * length, 0.5 * hull.beam, half_height)
    yield geom_element("collision", "box", (0.5 * length, 0, middle), size, "touch")
    if hull.hulls == 1:
        yield from _one_hull(hull, "", 0.0)
        return
    yield from _one_hull(hull, "_port", 0.5 * hull.hull_spacing)
    yield from _one_hull(hull, "_starboard", -0.5 * hull.hull_spacing)
    for name, x in (("fore", 0.65), ("aft", 0.35)):
        size = (0.02 * length, 0.5 * hull.hull_spacing, 0.012 * length)
        yield geom_element(f"beam_{name}", "box", (x * length, 0, 1.1 * high), size, "seen", "deck")
    size = (0.18 * length, 0.2 * hull.beam, 0.01 * length)
    yield geom_element("tray", "box", (0.5 * length, 0, 1.2 * high), size, "seen", "dark")


def _one_hull(hull: HullParticulars, side: str, y: float) -> Iterator[str]:
    """A box aft that ends in an ellipsoid, the bow, and a deck on both."""
    high = deck_height(hull)
    middle = 0.5 * (high - hull.draught)
    half_height = 0.5 * (high + hull.draught)
    half_beam = 0.5 * hull.breadth
    aft, bow = 0.55 * hull.length, 0.45 * hull.length
    size = (0.5 * aft, half_beam, half_height)
    yield geom_element(f"aft{side}", "box", (0.5 * aft, y, middle), size, "seen", "hull")
    size = (bow, half_beam, half_height)
    yield geom_element(f"bow{side}", "ellipsoid", (aft, y, middle), size, "seen", "hull")
    size = (0.46 * aft, 0.85 * half_beam, 0.03 * half_height)
    yield geom_element(f"deck{side}", "box", (0.5 * aft, y, high), size, "seen", "deck")
    if hull.hulls == 1:
        size = (0.06 * hull.length, 0.4 * half_beam, 0.5 * high)
        at = (0.42 * hull.length, y, 1.5 * high)
        yield geom_element("console", "box", at, size, "seen", "deck")


def geom_element(
    name: str,
    kind: str,
    pos: tuple[float, float, float],
    size: tuple[float, float, float],
    default_class: str,
    material: str = "",
) -> str:
    """Return the text of an MJCF geom element, one shape in the drawing of a hull.

    Args:
        name: Name of the geom.
        kind: "box" or "ellipsoid".
        pos: Centre [m].
        size: Half sizes [m].
        default_class: "seen" for what is drawn, "touch" for what touches walls.
        material: "hull", "deck" or "dark"; "" for that of the class.
    """
    of_material = ""
    if material:
        of_material = f' material="{material}"'
    return (
        f'<geom name="{html.escape(name)}" class="{default_class}" type="{kind}"{of_material} '
        f'pos="{format_numbers(*pos)}" size="{format_numbers(*size)}"/>'
    )


def format_numbers(*values: float) -> str:
    """Return numbers as text with four digits, as MJCF attributes have them."""
    return " ".join(f"{value:.4g}" for value in values)
