"""Particulars of a boat as its owner gives them on the command line, with checks."""

import math
import re
from dataclasses import dataclass

from boatsim.errors import BadInput
from boatsim.physics.estimate.base import HullParticulars
from boatsim.physics.estimate.displacement import hull_particulars

NAME = re.compile(r"[A-Za-z0-9][\w.+-]{0,59}")


@dataclass(frozen=True)
class Mount:
    """A thruster of a new boat: position and largest thrust.

    Attributes:
        x: Position ahead of the mass centre [m].
        y: Position to starboard of the mass centre [m].
        ahead: Largest thrust ahead [N], None if unknown.
        astern: Largest thrust astern [N], None if unknown.
        turns: Whether the thruster can be turned.
    """

    x: float
    y: float
    ahead: float | None = None
    astern: float | None = None
    turns: bool = False

    def largest_astern(self, ahead: float) -> float:
        """Return the largest thrust of a thruster astern [N]; that ahead if it is unknown.

        Args:
            ahead: Largest thrust ahead [N].
        """
        if self.astern is None:
            return ahead
        return self.astern


@dataclass(frozen=True)
class Rudder:
    """A rudder of a new boat: position and area.

    Attributes:
        x: Position ahead of the mass centre [m].
        area: Area [m^2], None if unknown.
    """

    x: float
    area: float | None = None


@dataclass(frozen=True)
class Particulars:
    """Main particulars of a new boat as its owner gives them: dimensions, mass, speed, thrusters.

    Attributes:
        name: Name of the boat.
        hull: Dimensions and mass.
        draught_given: Whether the owner gave the draught.
        speed: Speed at full thrust [m/s], None if unknown.
        thrusters: Thrusters.
        rudder: Rudder, None without one.
    """

    name: str
    hull: HullParticulars
    draught_given: bool
    speed: float | None
    thrusters: tuple[Mount, ...]
    rudder: Rudder | None = None

    def named_thrusters(self) -> list[tuple[str, Mount]]:
        """Return the thrusters of the boat with names by side, numbered if a side has several.

        A single one is `motor`.
        """
        sides = list(map(_side_name, self.thrusters))
        if len(sides) == 1:
            return [("motor", self.thrusters[0])]
        seen = dict.fromkeys(sides, 0)
        found = []
        for side, mount in zip(sides, self.thrusters, strict=True):
            seen[side] += 1
            name = side
            if sides.count(side) > 1:
                name = f"{side}{seen[side]}"
            found.append((name, mount))
        return found


def _side_name(mount: Mount) -> str:
    if mount.y == 0:
        return "middle"
    return "starboard" if mount.y > 0 else "port"


def parse_particulars(
    name: str,
    length: float,
    beam: float,
    mass: float,
    thrusters: list[str],
    steered: list[str],
    rudder: str | None = None,
    draught: float | None = None,
    hulls: int = 1,
    speed: float | None = None,
    thrust: float | None = None,
) -> Particulars:
    """Check the main particulars of a new boat from the command line and return them.

    Args:
        name: Name of the boat.
        length: Length [m].
        beam: Beam [m].
        mass: Mass [kg].
        thrusters: Fixed thrusters, each "X,Y[,MAX_N[,ASTERN_N]]".
        steered: Thrusters that turn, in the same form.
        rudder: Rudder, "X[,AREA]".
        draught: Draught [m].
        hulls: Number of hulls, 1 or 2.
        speed: Speed at full thrust [m/s].
        thrust: Largest thrust of each thruster without one [N].

    Raises:
        BadInput: For values that no boat can have.
    """
    if not NAME.fullmatch(name):
        raise BadInput(f"the boat's name = {name!r}; allowed are letters, digits and _ . + -")
    sizes = {"length": (length, 500.0), "beam": (beam, 100.0), "mass": (mass, 1e9)}
    optional = {"draught": (draught, 50.0), "speed": (speed, 50.0), "thrust": (thrust, 1e8)}
    for key, (value, most) in {**sizes, **optional}.items():
        if value is None:
            continue
        if not (math.isfinite(value) and 0.0 < value <= most):
            raise BadInput(f"--{key} {value:g}; allowed is more than 0 to {most:g}")
    if beam >= length:
        raise BadInput(f"--beam {beam:g}; allowed is less than the length, {length:g}")
    mounts = [_parse_thruster("--thruster", text, thrust, length, False) for text in thrusters]
    mounts += [_parse_thruster("--steered", text, thrust, length, True) for text in steered]
    if not mounts:
        raise BadInput("no --thruster X,Y and no --steered X,Y; a boat needs at least one thruster")
    blade = None
    if rudder is not None:
        blade = _parse_rudder(rudder, length)
    return Particulars(
        name,
        hull_particulars(length, beam, mass, hulls, draught),
        draught is not None,
        speed,
        tuple(mounts),
        blade,
    )


def _parse_numbers(option: str, text: str, least: int, most: int) -> list[float]:
    try:
        values = list(map(float, text.split(",")))
    except ValueError:
        values = []
    if not least <= len(values) <= most or not all(map(math.isfinite, values)):
        form = "X[,AREA]"
        if most == 4:
            form = "X,Y[,MAX_N[,ASTERN_N]]"
        raise BadInput(
            f"{option} {text}; allowed is {form}, numbers in m and N, as {option} -1.2,0.6"
        )
    return values


def _parse_thruster(
    option: str, text: str, thrust: float | None, length: float, turns: bool
) -> Mount:
    """A thruster from X,Y[,MAX_N[,ASTERN_N]]."""
    x, y, *most = _parse_numbers(option, text, 2, 4)
    if max(abs(x), abs(y)) > length:
        raise BadInput(
            f"{option} {text}; allowed are places within the length, {length:g} m, of the mass "
            "centre"
        )
    if (most and abs(most[0]) < 1e-6) or max(map(abs, most), default=0.0) > 1e8:
        raise BadInput(f"{option} {text}; allowed is a largest thrust of more than 0 N")
    ahead = thrust
    astern = None
    if most:
        ahead = abs(most[0])
    if len(most) > 1:
        astern = abs(most[1])
    return Mount(x, y, ahead, astern, turns)


def _parse_rudder(text: str, length: float) -> Rudder:
    """A rudder from X[,AREA]."""
    x, *area = _parse_numbers("--rudder", text, 1, 2)
    if not 0.0 < abs(x) <= length:
        raise BadInput(
            f"--rudder {text}; allowed is a place within the length, {length:g} m, of the mass "
            "centre, not 0"
        )
    if area and not 0.0 < area[0] <= 500.0:
        raise BadInput(f"--rudder {text}; allowed is an area of more than 0 to 500 m^2")
    if not area:
        return Rudder(x, None)
    return Rudder(x, area[0])
