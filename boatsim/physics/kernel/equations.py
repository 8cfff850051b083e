"""Generates the equations of motion for any degrees of freedom, without zero terms.

    M nu' = f - C(nu) nu + M_water nu_c',   nu = J(q) q'

q are the joint coordinates (x, y, z, phi, theta, psi) that are free, nu the velocities in body
axes, and nu_c the velocity of a uniform current in body axes, which changes as the hull turns. The
Coriolis force of added mass and ballast belongs to the laws of those effects. State s = (q, q'),
SNAME.

The body axes are fixed in the hull if it may pitch, or heave and roll (`TILTS`). Otherwise they
turn with the heading alone and remain level when the hull rolls, as is usual in manoeuvring models.
If as many body rates as coordinates are free (`closed`), the mass matrix is inverted once;
otherwise J' M J is factored at every evaluation. T. I. Fossen, Handbook of Marine Craft
Hydrodynamics and Motion Control, 2nd ed. 2021, chapters 2, 3 and 6.
"""

from dataclasses import dataclass
from operator import add, neg, sub

from boatsim.physics.kernel.algebra import ONE, ZERO, Lines, Sum, dot, name, total
from boatsim.physics.signals import AXES, MASS_ENTRIES, Motion, Wrench

COORDINATES = ("x", "y", "z", "phi", "theta", "psi")
JOINTS = ("x", "y", "z", "psi", "theta", "phi")  # MuJoCo's order: yaw, then pitch, then roll
# SNAME = sign * z-up, for coordinates and rates
SIGN = dict(zip(COORDINATES, (1, -1, -1, 1, -1, -1), strict=True))
# First places in the constants k: m, x_G, z_G, I_x, I_y, I_z; then 12 entries of `Mass` each for
# added mass, ballast and the sum (or its inverse)
WATER, HULL, WHOLE = 6, 18, 30
CONSTANTS = 42
LINEAR, ANGULAR = range(3), range(3, 6)


def tilts(free: frozenset[str]) -> bool:
    """Return whether the body axes are fixed in the hull; otherwise they are level.

    Args:
        free: The degrees of freedom.
    """
    return "pitch" in free or {"heave", "roll"} <= free


def closed(free: frozenset[str]) -> bool:
    """Return whether as many body rates as coordinates are free.

    They are for all six, and for level axes unless the hull yaws with only one of surge and sway.

    Args:
        free: The degrees of freedom.
    """
    if tilts(free):
        return free == frozenset(AXES)
    return "yaw" not in free or len(free & {"surge", "sway"}) != 1


def entry(begin: int, i: int, j: int) -> Sum:
    """Return an entry of one of the constant 6 by 6 matrices of a symmetric hull.

    Args:
        begin: First place of the matrix in the constants.
        i: Row.
        j: Column.
    """
    pair = (min(i, j), max(i, j))
    return name(f"k[{begin + MASS_ENTRIES.index(pair)}]") if pair in MASS_ENTRIES else ZERO


def cross(a: list[Sum], b: list[Sum]) -> list[Sum]:
    """Return the vector product of two vectors (3,)."""
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


@dataclass
class Frame:
    """Kinematics at one state, in the names of variables of the generated code."""

    R: list[list[Sum]]  # body axes to earth axes
    # 6 by 6: body rates per joint rate; columns of coordinates that are held are not used
    J: list[list[Sum]]
    nu: list[Sum]  # (6,) body rates
    turning: list[Sum]  # (3,) angular velocity of the axes
    drift: list[Sum]  # (6,) J' q': body acceleration at constant joint rates
    water: list[Sum]  # (3,) velocity of the current in body axes

    def column(self, i: int) -> list[Sum]:
        """Return the body rates (6,) per rate of coordinate i."""
        return [row[i] for row in self.J]


class Writer:
    """Text of the functions for one set of degrees of freedom."""

    def __init__(self, dof: tuple[str, ...], centred: bool) -> None:
        """Set the degrees of freedom.

        Args:
            dof: The degrees of freedom.
            centred: Whether the mass centre is the origin of motion.
        """
        self.free = [i for i, axis in enumerate(AXES) if axis in dof]
        self.set = frozenset(dof)
        self.tilts, self.closed, self.centred = tilts(self.set), closed(self.set), centred
        self.n = len(self.free)

    # Kinematics
    # ------------------------------------------------------------------------------------------

    def coordinate(self, i: int) -> Sum:
        """Return the name of a joint coordinate, zero if it is held."""
        return name(COORDINATES[i]) if i in self.free else ZERO

    def rate(self, i: int) -> Sum:
        """Return the name of a joint rate, zero if it is held."""
        return name(COORDINATES[i] + "d") if i in self.free else ZERO

    def turn(self, lines: Lines, i: int) -> tuple[Sum, Sum]:
        """Return cosine and sine of an angle i; level axes do not roll or pitch."""
        angle = COORDINATES[i]
        if i not in self.free or (i != 5 and not self.tilts):
            return ONE, ZERO
        lines.add(f"c_{angle}, s_{angle} = cos({angle}), sin({angle})")
        return name(f"c_{angle}"), name(f"s_{angle}")

    def frame(self, lines: Lines, current: bool = True) -> Frame:
        """Return the kinematics of a state whose coordinates and rates are variables.

        Args:
            lines: The function so far, to which variables are added.
            current: Whether the velocity of the water is needed.
        """
        (cf, sf), (ct, st), (cp, sp) = (self.turn(lines, i) for i in ANGULAR)
        R = [
            [cp * ct, cp * st * sf - sp * cf, sp * sf + cp * st * cf],
            [sp * ct, cp * cf + sp * st * sf, sp * st * cf - cp * sf],
            [-st, ct * sf, ct * cf],
        ]
        R = [[lines.let(f"R{i}{j}", R[i][j]) for j in LINEAR] for i in LINEAR]
        T = [
            [ONE, ZERO, -st],
            [ZERO, cf, lines.let("T12", ct * sf)],
            [ZERO, -sf, lines.let("T22", ct * cf)],
        ]
        J = [[ZERO] * 6 for _ in range(6)]
        for i in LINEAR:
            for j in LINEAR:
                J[i][j], J[3 + i][3 + j] = R[j][i], T[i][j]
        nu = [
            lines.let("uvwpqr"[i] + "_", total(J[i][j] * self.rate(j) for j in self.free))
            for i in range(6)
        ]
        turning = nu[3:] if self.tilts else [ZERO, ZERO, nu[5]]
        phid, thetad, psid = map(self.rate, ANGULAR)
        bend = [ZERO, ZERO, ZERO]
        if self.tilts:
            bend = [
                -(ct * thetad * psid),
                ct * cf * phid * psid - sf * phid * thetad - st * sf * thetad * psid,
                -(cf * phid * thetad) - st * cf * thetad * psid - ct * sf * phid * psid,
            ]
        drift = list(map(neg, cross(turning, nu[:3]))) + lines.let_all("bend", bend)
        water = [ZERO, ZERO, ZERO]
        if current and {0, 1} & set(self.free):
            lines.add("north, east = flow(p, on)")
            water = [
                lines.let(f"{n}_water", R[0][i] * name("north") + R[1][i] * name("east"))
                for i, n in enumerate("uvw")
            ]
        return Frame(R, J, nu, turning, drift, water)

    def seen(self, frame: Frame) -> str:
        """Return the text of the `Motion` that force laws take."""
        through = map(sub, frame.nu[:3], frame.water)
        psi = ("c_psi", "s_psi") if 5 in self.free else ("1.0", "0.0")
        values = [
            *map(str, map(self.coordinate, range(6))),
            *map(str, frame.nu),
            *map(str, through),
            *psi,
        ]
        assert len(values) + 1 == len(Motion._fields)
        return f"Motion(t, {', '.join(values)})"

    # Forces
    # ------------------------------------------------------------------------------------------

    def carried(self, frame: Frame, axis: int) -> Sum:
        """Return a component of the force of added mass as a uniform current turns in body axes."""
        away = map(neg, cross(frame.turning, frame.water))
        return dot((entry(WATER, axis, j) for j in LINEAR), away)

    def rigid(self, lines: Lines, frame: Frame) -> list[Sum]:
        """Return the Coriolis and centripetal force (6,) of the rigid body about the origin."""
        m, inertia = name("k[0]"), [name(f"k[{3 + i}]") for i in LINEAR]
        spin = frame.turning
        p, q, r = frame.nu[3:]
        at_centre = cross(spin, frame.nu[:3])
        lever = [ZERO, ZERO, ZERO]
        if not self.centred:
            lever = [name("k[1]"), ZERO, name("k[2]") if self.tilts else ZERO]
        at_centre = list(map(add, at_centre, cross(spin, cross(spin, lever))))
        force = lines.let_all("rigid", [-(m * a) for a in at_centre])
        moment = [ZERO, ZERO, ZERO]
        if self.tilts:
            gyroscopic = [(q * r, 1, 2), (r * p, 2, 0), (p * q, 0, 1)]
            moment = [a * (inertia[i] - inertia[j]) for a, i, j in gyroscopic]
        return force + list(map(add, cross(lever, force), moment))

    def load(self, lines: Lines, frame: Frame, extra: str) -> list[Sum]:
        """Return the right-hand side (6,) of M nu' = ..., as sums."""
        lines.add(f"f = wrench({self.seen(frame)}, p, on, act, at)")
        rigid = self.rigid(lines, frame)
        found = []
        for i, component in enumerate(Wrench._fields):
            more = name(f"{extra}[{self.free.index(i)}]") if i in self.free else ZERO
            found.append(name(f"f.{component}") + more + rigid[i] + self.carried(frame, i))
        return found

    def unpack(self, lines: Lines) -> None:
        """Add variables for the coordinates and rates of the state."""
        for more, first in (("", 0), ("d", self.n)):
            names = ", ".join(COORDINATES[i] + more for i in self.free)
            lines.add(f"{names} = {', '.join(f's[{first + j}]' for j in range(self.n))}")

    # Accelerations
    # ------------------------------------------------------------------------------------------

    def accelerations(self) -> list[str]:
        """Return the body of `accelerations`."""
        lines = Lines()
        self.unpack(lines)
        frame = self.frame(lines)
        load = self.load(lines, frame, "extra")
        if not self.closed:
            load = list(map(sub, load, self.weighed(WHOLE, frame.drift)))
            named = lines.let_all("load", load)
            self.factor(lines, frame)
            right = [dot(frame.column(i), named) for i in self.free]
            found = self.solved(lines, right, "")
            lines.add(f"return {self.tuple(found)}")
            return lines.text
        pushed = {i: lines.let(f"load{i}", load[i]) for i in self.free}
        nudot = {i: total(entry(WHOLE, i, j) * pushed[j] for j in self.free) for i in self.free}
        for i in LINEAR:
            if i in nudot:  # acceleration over ground along the axes
                nudot[i] = nudot[i] - frame.drift[i]
        moved = {i: lines.let(f"a{i}", a) for i, a in nudot.items()}
        lines.add(f"return {self.tuple(self.joints(lines, frame, moved, moving=True))}")
        return lines.text

    def joints(self, lines: Lines, frame: Frame, body: dict[int, Sum], moving: bool) -> list[str]:
        """Return joint accelerations from body accelerations.

        Args:
            lines: The function so far.
            frame: Kinematics.
            body: Body acceleration of each free axis.
            moving: Whether to include the terms that are quadratic in the Euler rates.
        """
        found = []
        for i in LINEAR:
            if i in self.free:
                found.append(str(total(frame.R[i][j] * body[j] for j in LINEAR if j in body)))
        if not self.tilts:
            return found + [str(body[i]) for i in ANGULAR if i in body]
        cf, sf, ct, st = map(name, ("c_phi", "s_phi", "c_theta", "s_theta"))
        phid, thetad, psid = map(self.rate, ANGULAR)
        secant, along = name("secant"), name("along")
        quadratic = [ZERO] * 4
        if moving:
            lines.add("secant = 1.0 / c_theta")
            turn = thetad * psid
            quadratic = [phid * thetad, turn * secant, phid * psid * ct, turn * st * secant]
        lines.add(f"along = {sf * body[4] + cf * body[5] + quadratic[0]}")
        rest = [
            body[3] + quadratic[1] + along * st * secant,
            cf * body[4] - sf * body[5] - quadratic[2],
            along * secant + quadratic[3],
        ]
        return found + list(map(str, rest))

    def weighed(self, begin: int, motion: list[Sum]) -> list[Sum]:
        """Return the product of a constant matrix and a body motion (6,)."""
        found = []
        for i in range(6):
            found.append(dot((entry(begin, i, j) for j in range(6)), motion))
        return found

    def factor(self, lines: Lines, frame: Frame) -> None:
        """Add variables for J' M J of the free coordinates and its factors L D L'."""
        for b, j in enumerate(self.free):
            column = self.weighed(WHOLE, frame.column(j))
            for a, i in enumerate(self.free[b:], b):
                value = dot(frame.column(i), column)
                lines.add(f"M{a}{b} = {value}")
        for j in range(self.n):
            lines.add(f"D{j} = M{j}{j}" + "".join(f" - L{j}{k} * L{j}{k} * D{k}" for k in range(j)))
            for i in range(j + 1, self.n):
                taken = "".join(f" - L{i}{k} * L{j}{k} * D{k}" for k in range(j))
                lines.add(f"L{i}{j} = (M{i}{j}{taken}) / D{j}")

    def solved(self, lines: Lines, right: list[Sum], tag: str) -> list[str]:
        """Add variables for the solution of the factored system; return their names."""
        for i, value in enumerate(right):
            lines.add(f"y{tag}{i} = {value}" + "".join(f" - L{i}{k} * y{tag}{k}" for k in range(i)))
        for i in reversed(range(self.n)):
            lines.add(
                f"x{tag}{i} = y{tag}{i} / D{i}"
                + "".join(f" - L{k}{i} * x{tag}{k}" for k in range(i + 1, self.n))
            )
        return [f"x{tag}{i}" for i in range(self.n)]

    def force_slopes(self) -> list[str]:
        """Return the body of `force_slopes`."""
        lines = Lines()
        self.unpack(lines)
        frame = self.frame(lines, current=False)
        if self.tilts and self.closed:
            lines.add("secant = 1.0 / c_theta")
        if not self.closed:
            self.factor(lines, frame)
        for b, j in enumerate(self.free):
            if self.closed:
                body = {i: entry(WHOLE, i, j) for i in self.free}
                found = self.joints(lines, frame, body, moving=False)
            else:
                found = self.solved(lines, [frame.J[j][i] for i in self.free], f"{b}_")
            for a, text in enumerate(found):
                lines.add(f"A[row + {a}, column + {b}] = {text}")
        return lines.text

    # Further functions
    # ------------------------------------------------------------------------------------------

    def forces(self) -> list[str]:
        """Return the body of `forces`."""
        lines = Lines()
        self.unpack(lines)
        frame = self.frame(lines)
        lines.add(f"f = wrench({self.seen(frame)}, p, on, act, at)")
        lines.add(f"return {self.tuple([f'f.{Wrench._fields[i]}' for i in self.free])}")
        return lines.text

    def moved(self) -> list[str]:
        """Return the body of `moved`."""
        lines = Lines()
        self.unpack(lines)
        frame = self.frame(lines, current=False)
        values = [*map(str, map(self.coordinate, range(6))), *map(str, frame.nu)]
        lines.add(f"return Shown({', '.join(values)})")
        return lines.text

    def feels(self) -> list[str]:
        """Return the body of `feels`."""
        lines = Lines()
        self.unpack(lines)
        frame = self.frame(lines, current=False)
        lines.add("a = accelerations(t, s, act, at, p, on, k, extra)")
        ahead, aside = (
            total(frame.J[row][i] * name(f"a[{b}]") for b, i in enumerate(self.free) if i in LINEAR)
            for row in (0, 1)
        )
        u, v, _, rolling, _, turning = frame.nu
        x, y, _, roll, _, heading = map(self.coordinate, range(6))
        readings = (heading, turning, ahead, aside, u, v, x, y, roll, rolling)
        lines.add(f"return {self.tuple(list(map(str, readings)))}")
        return lines.text

    def jacobian(self) -> list[str]:
        """Return the body of `jacobian`."""
        lines = Lines()
        self.unpack(lines)
        frame = self.frame(lines, current=False)
        for i in range(6):
            for b, j in enumerate(self.free):
                if frame.J[i][j]:
                    lines.add(f"J[{i}, {b}] = {frame.J[i][j]}")
        return lines.text

    def level_rates(self) -> list[str]:
        """Return the body of `observe_level`: a position, or a rate along level axes."""
        lines = Lines()
        lines.add("if code < NQ:")
        lines.add("    row[code] = 1.0")
        lines.add("    return float(s[code])")
        if not self.tilts and {0, 1, 5} <= set(self.free):
            psi, north, east = self.free.index(5), self.n, self.n + 1
            lines.add("if code < NQ + 2:")
            lines.add(f"    c, s_ = cos(s[{psi}]), sin(s[{psi}])")
            along = f"c * s[{north}] + s_ * s[{east}]"
            lines.add(f"    along, across = {along}, c * s[{east}] - s_ * s[{north}]")
            lines.add("    if code == NQ:")
            lines.add(f"        row[{north}], row[{east}], row[{psi}] = c, s_, across")
            lines.add("        return float(along)")
            lines.add(f"    row[{north}], row[{east}], row[{psi}] = -s_, c, -along")
            lines.add("    return float(across)")
        lines.add("row[code] = 1.0")
        lines.add("return float(s[code])")
        return lines.text

    def add_to_mujoco(self) -> list[str]:
        """Return the body of `add_to_mujoco`: what MuJoCo's rigid body does not contain."""
        lines = Lines()
        order = [i for i in map(COORDINATES.index, JOINTS) if i in self.free]
        for b, i in enumerate(order):
            flip = "-" if SIGN[COORDINATES[i]] < 0 else ""
            lines.add(f"{COORDINATES[i]}, {COORDINATES[i]}d = {flip}q[{b}], {flip}qd[{b}]")
        lines.add("on = ()")
        frame = self.frame(lines)
        lines.add(f"f = wrench({self.seen(frame)}, p, on, act, at)")
        added = [[entry(WATER, i, j) + entry(HULL, i, j) for j in range(6)] for i in range(6)]
        needed = [a for a in range(6) if any(frame.J[a][i] for i in self.free)]
        load = {}
        for a in needed:
            bent = dot(added[a], frame.drift)
            load[a] = lines.let(
                f"load{a}", name(f"f.{Wrench._fields[a]}") + self.carried(frame, a) - bent
            )
        for b, i in enumerate(order):
            force = total(frame.J[a][i] * load[a] for a in needed)
            lines.add(f"force[{b}] += {force if SIGN[COORDINATES[i]] > 0 else -force}")
        mass = [[ZERO] * 6 for _ in range(6)]
        for a in needed:
            for c in range(a, 6):
                mass[a][c] = mass[c][a] = lines.let(f"M{a}{c}", added[a][c])
        for b, i in enumerate(order):
            for d, j in enumerate(order[: b + 1]):
                value = ZERO
                for a in needed:
                    value = value + total(
                        frame.J[a][i] * mass[a][c] * frame.J[c][j] for c in needed
                    )
                if value:
                    same = SIGN[COORDINATES[i]] == SIGN[COORDINATES[j]]
                    lines.add(f"M[{b * (b + 1) // 2 + d}] += {value if same else -value}")
        return lines.text

    def tuple(self, items: list[str]) -> str:
        """Return the text of a tuple."""
        return f"({', '.join(items)},)"
