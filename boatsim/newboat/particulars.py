"""Particulars of a boat as its owner gives them on the command line, with checks."""

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

from boatsim.errors import BadInput
from boatsim.newboat.drive_law import DriveLaw
from boatsim.physics.effects.thrust_curve import MAX_POINTS
from boatsim.physics.estimate.base import HullParticulars
from boatsim.physics.estimate.displacement import hull_particulars

MAX_ANGLE = 0.7  # [rad] 40 deg, the usual limit of rudders and outboards
MAX_RUDDER_ANGLE = 90.0  # [deg] across the hull
MAX_AZIMUTH = 360.0  # [deg] a full turn to either side
# Relative standard deviation of a mass that was not weighed: assumed, as crew, fuel and gear of
# a small boat change from day to day
MASS_SD = 0.1
NAME = re.compile(r"[A-Za-z0-9][\w.+-]{0,59}")


EXAMPLES = {
    "--thruster": "in m and N, as --thruster -1.2,0.6",
    "--steered": "in m and N, as --steered -1.2,0.6",
    "--tunnel": "in m and N, as --tunnel 2.1,150",
    "--rudder": "in m and m^2, as --rudder -1.2",
    "--helm": "in deg and deg/s, as --helm 35,6",
}


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
class Helm:
    """Range and rate of the rudder or of thrusters that turn.

    Attributes:
        most: Largest angle to either side [rad].
        rate: Largest rate [rad/s], None if unknown.
        given: Whether the owner gave the range.
    """

    most: float = MAX_ANGLE
    rate: float | None = None
    given: bool = False


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
        tunnels: Tunnel thrusters, which push to starboard and to port.
        law: Commands of the thrusters.
        helm: Range and rate of the steering.
        mass_centre: Mass centre ahead of the transom [m], None if unknown.
        depth: Depth of the water [m], None for deep water.
        breadth_given: Whether the owner gave the breadth of one hull.
        mass_uncertainty: Relative standard deviation of the mass; 0 for a weighed boat.
    """

    name: str
    hull: HullParticulars
    draught_given: bool
    speed: float | None
    thrusters: tuple[Mount, ...]
    rudder: Rudder | None = None
    tunnels: tuple[Mount, ...] = ()
    law: DriveLaw = DriveLaw()
    helm: Helm = Helm()
    mass_centre: float | None = None
    depth: float | None = None
    breadth_given: bool = False
    mass_uncertainty: float = 0.0

    @property
    def mass_centre_from_transom(self) -> float:
        """Mass centre ahead of the transom [m]; at mid-length where nobody stated it."""
        if self.mass_centre is None:
            return 0.5 * self.hull.length
        return self.mass_centre

    @property
    def midship_position(self) -> float:
        """Middle of the length ahead of the mass centre [m]."""
        return 0.5 * self.hull.length - self.mass_centre_from_transom

    def named_tunnels(self) -> list[tuple[str, Mount]]:
        """Return the tunnel thrusters with names by place, numbered if several have one name."""
        places = []
        for mount in self.tunnels:
            places.append("bow" if mount.x > 0.0 else "stern")
        return _numbered(places, self.tunnels)

    def named_thrusters(self) -> list[tuple[str, Mount]]:
        """Return the thrusters of the boat with names by their places.

        A single one is `motor`, others are named by their side. Two on one side, or two in the
        middle, are `forward` and `aft`; more of them are numbered.
        """
        if len(self.thrusters) == 1:
            return [("motor", self.thrusters[0])]
        sides = list(map(_side_name, self.thrusters))
        names = []
        for side, mount in zip(sides, self.thrusters, strict=True):
            places = [m.x for m, other in zip(self.thrusters, sides, strict=True) if other == side]
            if len(places) != 2 or places[0] == places[1]:
                names.append(side or "middle")
                continue
            end = "forward" if mount.x == max(places) else "aft"
            names.append(f"{side}_{end}" if side else end)
        return _numbered(names, self.thrusters)


def _numbered(names: list[str], mounts: tuple[Mount, ...]) -> list[tuple[str, Mount]]:
    """Mounts with their names, numbered if several have one name."""
    seen = dict.fromkeys(names, 0)
    found = []
    for name, mount in zip(names, mounts, strict=True):
        seen[name] += 1
        if names.count(name) > 1:
            name = f"{name}{seen[name]}"
        found.append((name, mount))
    return found


def _side_name(mount: Mount) -> str:
    if mount.y == 0:
        return ""
    return "starboard" if mount.y > 0 else "port"


@dataclass(frozen=True)
class Options:
    """Options of the command line for a new boat, as text or numbers, not yet checked.

    Attributes:
        thrusters: Fixed thrusters, each "X,Y[,MAX_N[,ASTERN_N]]".
        steered: Thrusters that turn, in the same form.
        tunnels: Tunnel thrusters, each "X,MAX_N".
        rudder: Rudder, "X[,AREA]".
        draught: Draught [m].
        hulls: Number of hulls, 1 or 2.
        hull_beam: Breadth of one of two hulls [m].
        speed: Speed at full thrust [m/s].
        thrust: Largest thrust of each thruster without one [N].
        rpm: Full revolutions of propellers that are commanded by their shaft rate [1/min].
        curve: Measured thrust by raw command, "COMMAND:N,COMMAND:N,...".
        helm: Range and rate of the steering, "DEG[,DEG_PER_S]".
        balance: Mass centre ahead of the transom [m].
        depth: Depth of the water [m].
        mass_uncertainty: Relative standard deviation of the mass, 0 for a weighed boat; None for
            the usual one.
    """

    thrusters: Sequence[str] = ()
    steered: Sequence[str] = ()
    tunnels: Sequence[str] = ()
    rudder: str | None = None
    draught: float | None = None
    hulls: int = 1
    hull_beam: float | None = None
    speed: float | None = None
    thrust: float | None = None
    rpm: float | None = None
    curve: str | None = None
    helm: str | None = None
    balance: float | None = None
    depth: float | None = None
    mass_uncertainty: float | None = None


def parse_particulars(
    name: str, length: float, beam: float, mass: float, options: Options
) -> Particulars:
    """Check the main particulars of a new boat from the command line and return them.

    Args:
        name: Name of the boat.
        length: Length [m].
        beam: Beam [m].
        mass: Mass [kg].
        options: What else the owner gave.

    Raises:
        BadInput: For values that no boat can have.
    """
    if not NAME.fullmatch(name):
        raise BadInput(f"the boat's name = {name!r}; allowed are letters, digits and _ . + -")
    _check_sizes(length, beam, mass, options)
    _check_hull_beam(options, beam)
    law = DriveLaw(options.rpm, _parse_curve(options))
    blade = None
    if options.rudder is not None:
        blade = _parse_rudder(options.rudder, length)
    hull = hull_particulars(length, beam, mass, options.hulls, options.draught, options.hull_beam)
    if options.depth is not None and options.depth <= hull.draught:
        raise BadInput(
            f"--depth {options.depth:g}; allowed is more than the draught, {hull.draught:.3g} m"
        )
    return Particulars(
        name=name,
        hull=hull,
        draught_given=options.draught is not None,
        speed=options.speed,
        thrusters=tuple(_parse_mounts(options, length, law)),
        rudder=blade,
        tunnels=tuple(_parse_tunnel(text, length) for text in options.tunnels),
        law=law,
        helm=_parse_helm(options),
        mass_centre=options.balance,
        depth=options.depth,
        breadth_given=options.hull_beam is not None,
        mass_uncertainty=_parse_mass_uncertainty(options.mass_uncertainty),
    )


def _parse_mass_uncertainty(given: float | None) -> float:
    """Relative standard deviation of the mass. Raises BadInput."""
    if given is None:
        return MASS_SD
    if not 0.0 <= given <= 1.0:  # false for a value that is not a number
        raise BadInput(f"--mass-uncertainty {given:g}; allowed is 0 (a weighed boat) to 1")
    return given


def _check_sizes(length: float, beam: float, mass: float, options: Options) -> None:
    """Check that all sizes are those of a boat. Raises BadInput."""
    sizes: dict[str, tuple[float | None, float]] = {
        "length": (length, 500.0),
        "beam": (beam, 100.0),
        "mass": (mass, 1e9),
        "draught": (options.draught, 50.0),
        "speed": (options.speed, 50.0),
        "thrust": (options.thrust, 1e8),
        "rpm": (options.rpm, 1e5),
        "depth": (options.depth, 1e4),
        "hull-beam": (options.hull_beam, 100.0),
        "balance": (options.balance, length),
    }
    for key, (value, most) in sizes.items():
        if value is None:
            continue
        if not (math.isfinite(value) and 0.0 < value <= most):
            raise BadInput(f"--{key} {value:g}; allowed is more than 0 to {most:g}")
    if beam >= length:
        raise BadInput(f"--beam {beam:g}; allowed is less than the length, {length:g}")


def _parse_mounts(options: Options, length: float, law: DriveLaw) -> list[Mount]:
    """Parse places, directions and thrusts of all thrusters. Raises BadInput."""
    mounts = []
    for text in options.thrusters:
        mounts.append(_parse_thruster("--thruster", text, options.thrust, length, False))
    for text in options.steered:
        mounts.append(_parse_thruster("--steered", text, options.thrust, length, True))
    if not mounts:
        raise BadInput("no --thruster X,Y and no --steered X,Y; a boat needs at least one thruster")
    if law.curve:
        return [_with_curve(mount, law) for mount in mounts]
    return mounts


def _check_hull_beam(options: Options, beam: float) -> None:
    if options.hull_beam is None:
        return
    if options.hulls != 2:
        raise BadInput(
            f"--hull-beam {options.hull_beam:g} is the breadth of one of two hulls; allowed with "
            "--hulls 2 only: the breadth of one hull is its --beam"
        )
    if 2.0 * options.hull_beam > beam:
        raise BadInput(
            f"--hull-beam {options.hull_beam:g}; allowed is up to half of the beam, {0.5 * beam:g}"
        )


def _parse_curve(options: Options) -> tuple[tuple[float, float], ...]:
    """Points of a measured curve of thrust from COMMAND:N,COMMAND:N,..."""
    if options.curve is None:
        return ()
    if options.rpm is not None or options.thrust is not None:
        raise BadInput("--curve gives the thrust of each command; leave out --rpm and --thrust")
    points = []
    for text in options.curve.split(","):
        command, colon, force = text.partition(":")
        try:
            points.append((float(command), float(force)))
        except ValueError:
            points = []
            break
    finite = all(math.isfinite(x) and abs(x) < 1e9 for point in points for x in point)
    rising = all(a[0] < b[0] and a[1] <= b[1] for a, b in pairwise(points))
    if not 2 <= len(points) <= MAX_POINTS or not finite or not rising or not points[-1][1] > 0.0:
        raise BadInput(
            f"--curve {options.curve[:80]}; allowed are 2 to {MAX_POINTS} pairs COMMAND:N by "
            "increasing command and thrust, as --curve=-100:-20,0:0,50:15,100:60"
        )
    if points[0][1] > 0.0:
        raise BadInput(f"--curve {options.curve[:80]}; allowed is a first thrust of at most 0 N")
    return tuple(points)


def _with_curve(mount: Mount, law: DriveLaw) -> Mount:
    if mount.ahead is not None:
        raise BadInput(
            "--curve gives the largest thrusts; leave out MAX_N and ASTERN_N of the thrusters"
        )
    return replace(mount, ahead=law.curve[-1][1], astern=-law.curve[0][1])


def _parse_tunnel(text: str, length: float) -> Mount:
    """A tunnel thruster from X,MAX_N."""
    x, most = _parse_numbers("--tunnel", text, "X,MAX_N", (2, 2))
    if not 0.0 < abs(x) <= length:
        raise BadInput(
            f"--tunnel {text}; allowed is a place within the length, {length:g} m, of the mass "
            "centre, not 0"
        )
    if not 1e-6 <= most <= 1e8:
        raise BadInput(f"--tunnel {text}; allowed is a largest thrust of more than 0 N")
    return Mount(x, 0.0, most, most)


def _parse_helm(options: Options) -> Helm:
    """Range and rate of the steering from DEG[,DEG_PER_S].

    A drive without a rudder beside it may turn all around, and several times.
    """
    text = options.helm
    if text is None:
        return Helm()
    most, *rate = _parse_numbers("--helm", text, "DEG[,DEG_PER_S]", (1, 2))
    largest = MAX_RUDDER_ANGLE if options.rudder is not None else MAX_AZIMUTH
    if not 0.0 < most <= largest:
        of = "a rudder" if options.rudder is not None else "drives that turn"
        raise BadInput(
            f"--helm {text}; allowed for {of} is an angle of more than 0 to {largest:g} deg"
        )
    if rate and not 0.0 < rate[0] <= 1000.0:
        raise BadInput(f"--helm {text}; allowed is a rate of more than 0 to 1000 deg/s")
    if not rate:
        return Helm(math.radians(most), None, True)
    return Helm(math.radians(most), math.radians(rate[0]), True)


def _parse_numbers(option: str, text: str, form: str, count: tuple[int, int]) -> list[float]:
    try:
        values = list(map(float, text.split(",")))
    except ValueError:
        values = []
    if not count[0] <= len(values) <= count[1] or not all(map(math.isfinite, values)):
        raise BadInput(f"{option} {text}; allowed is {form}, numbers, {EXAMPLES[option]}")
    return values


def _parse_thruster(
    option: str, text: str, thrust: float | None, length: float, turns: bool
) -> Mount:
    """A thruster from X,Y[,MAX_N[,ASTERN_N]]."""
    x, y, *most = _parse_numbers(option, text, "X,Y[,MAX_N[,ASTERN_N]]", (2, 4))
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
    x, *area = _parse_numbers("--rudder", text, "X[,AREA]", (1, 2))
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
