"""The hull.xml of a boat: a plain drawing from its sizes, boxes and ellipsoids, as any MuJoCo viewer opens it."""

from collections.abc import Iterator
from xml.sax.saxutils import quoteattr

from boatsim.newboat.particulars import Particulars
from boatsim.physics.estimate import inertia

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


def hull_xml(boat: Particulars) -> str:
    """The whole file. Origin at the transom on the centre line at the waterline; x forward, y to port, z up."""
    h = boat.hull
    return "\n".join(
        [
            f"<mujoco model={quoteattr(boat.name)}>",
            "  <!-- Drawn by boatsim new from the boat's sizes; forces and masses are in vessel.toml. -->",
            "  <custom>",
            f'    <numeric name="drawn_for" data="{h.length:g} {h.beam:g} {h.draught:.4g}"/> <!-- [m] L, B, T -->',
            "  </custom>",
            HEAD,
            "  <worldbody>",
            '    <body name="hull">',
            *(f"      {part}" for part in _parts(boat)),
            "    </body>",
            "  </worldbody>",
            "</mujoco>",
            "",
        ]
    )


def _parts(boat: Particulars) -> Iterator[str]:
    """Its mass, what touches walls, and what is seen."""
    h = boat.hull
    high = max(h.draught, 0.08 * h.length)  # [m] of the deck above the water, by eye
    middle, deep = 0.5 * (high - h.draught), 0.5 * (high + h.draught)
    i = inertia.yaw(h).value
    yield f'<inertial pos="{_at(0.5 * h.length, 0, 0)}" mass="{h.mass:g}" diaginertia="{_at(i, i, i)}"/>'
    yield _geom(
        "collision",
        "box",
        (0.5 * h.length, 0, middle),
        (0.5 * h.length, 0.5 * h.beam, deep),
        "touch",
    )
    sides = (
        (("", 0.0),)
        if h.hulls == 1
        else (("_port", 0.5 * h.spacing), ("_starboard", -0.5 * h.spacing))
    )
    for side, y in sides:
        yield from _one_hull(boat, side, y, high, middle, deep)
    if h.hulls == 2:
        for name, x in (("fore", 0.65), ("aft", 0.35)):
            at, size = (
                (x * h.length, 0, 1.1 * high),
                (0.02 * h.length, 0.5 * h.spacing, 0.012 * h.length),
            )
            yield _geom(f"beam_{name}", "box", at, size, "seen", "deck")
        yield _geom(
            "tray",
            "box",
            (0.5 * h.length, 0, 1.2 * high),
            (0.18 * h.length, 0.2 * h.beam, 0.01 * h.length),
            "seen",
            "dark",
        )
    for name, mount in boat.named():
        x, y = 0.5 * h.length + mount.x, -mount.y
        leg, r = 0.5 * (high + h.draught), 0.02 * h.length
        yield _geom(
            f"leg_{name}", "box", (x, y, high - leg), (0.6 * r, 0.3 * r, leg), "seen", "dark"
        )
        if mount.turns:
            yield _geom(
                f"cowl_{name}",
                "ellipsoid",
                (x, y, high + 1.5 * r),
                (2.2 * r, 1.6 * r, 2.2 * r),
                "seen",
                "dark",
            )
        yield (
            f'<geom name="propeller_{name}" class="seen" type="cylinder" material="dark" '
            f'pos="{_at(x, y, -h.draught)}" euler="0 90 0" size="{r:.4g} {1.5 * r:.4g}"/>'
        )
    if boat.rudder is not None:
        at = (0.5 * h.length + boat.rudder.x, 0, -0.5 * h.draught)
        yield _geom(
            "rudder",
            "box",
            at,
            (0.02 * h.length, 0.003 * h.length, 0.5 * h.draught),
            "seen",
            "dark",
        )


def _one_hull(
    boat: Particulars, side: str, y: float, high: float, middle: float, deep: float
) -> Iterator[str]:
    """A box aft that runs into an ellipsoid, the bow, and a deck on both."""
    L, b = boat.hull.length, 0.5 * boat.hull.breadth
    aft, bow = 0.55 * L, 0.45 * L
    yield _geom(f"aft{side}", "box", (0.5 * aft, y, middle), (0.5 * aft, b, deep), "seen", "hull")
    yield _geom(f"bow{side}", "ellipsoid", (aft, y, middle), (bow, b, deep), "seen", "hull")
    yield _geom(
        f"deck{side}",
        "box",
        (0.5 * aft, y, high),
        (0.46 * aft, 0.85 * b, 0.03 * deep),
        "seen",
        "deck",
    )
    if boat.hull.hulls == 1:
        yield _geom(
            "console",
            "box",
            (0.42 * L, y, 1.5 * high),
            (0.06 * L, 0.4 * b, 0.5 * high),
            "seen",
            "deck",
        )


def _geom(
    name: str,
    kind: str,
    pos: tuple[float, float, float],
    size: tuple[float, float, float],
    look: str,
    of: str = "",
) -> str:
    material = f' material="{of}"' if of else ""
    return f'<geom name={quoteattr(name)} class="{look}" type="{kind}"{material} pos="{_at(*pos)}" size="{_at(*size)}"/>'


def _at(*values: float) -> str:
    return " ".join(f"{x:.4g}" for x in values)
