"""Generates the equations of motion for any degrees of freedom, without zero terms.

    M nu' = f - C(nu) nu + M_water nu_c' + M_hull R' a_c,   nu = J(q) q'

q are the joint coordinates (x, y, z, phi, theta, psi) that are free, nu the velocities in body
axes, and nu_c the velocity of the current in body axes, which changes as the hull turns. The
Coriolis force of added mass and ballast belongs to the laws of those effects. State s = (q, q'),
SNAME.

The water around the hull is taken as uniform, with the velocity V(t, x, y) at the origin of motion.
Where V varies, two accelerations act. The added mass feels that of the water at the hull, dV/dt
along the path of the hull, as each section of a slender hull does (M. J. Lighthill, Note on the
swimming of slender fish, J. Fluid Mech. 9, 1960). The pressure that accelerates the water itself
acts on the displaced mass, which is the mass of a floating hull with its ballast: it follows the
water, a_c = DV/Dt (T. R. Auton, J. C. R. Hunt and M. Prud'homme, The force exerted on a body in
inviscid unsteady non-uniform rotational flow, J. Fluid Mech. 197, 1988). Both are dV/dt where V
depends on time alone, and where the hull drifts with the water.

The body axes are fixed in the hull if it may pitch, or heave and roll (`HULL_FIXED_AXES`).
Otherwise they turn with the heading alone and remain level when the hull rolls, as is usual in
manoeuvring models. If as many body rates as coordinates are free (`has_square_jacobian`), the mass
matrix is inverted once; otherwise J' M J is factored at every evaluation. T. I. Fossen, Handbook of
Marine Craft Hydrodynamics and Motion Control, 2nd ed. 2021, chapters 2, 3 and 6.
"""

from dataclasses import dataclass
from operator import add, neg, sub

from boatsim.physics.kernel.algebra import (
    ONE,
    ZERO,
    CodeLines,
    SymbolicSum,
    dot_product,
    sum_expressions,
    symbol,
)
from boatsim.physics.signals import AXES, MASS_ENTRIES, Motion, Wrench

COORDINATES = ("x", "y", "z", "phi", "theta", "psi")
JOINTS = ("x", "y", "z", "psi", "theta", "phi")  # MuJoCo's order: yaw, then pitch, then roll
# SNAME = sign * z-up, for coordinates and rates
SIGN = dict(zip(COORDINATES, (1, -1, -1, 1, -1, -1), strict=True))
# First places in the constants k: m, x_G, z_G, I_x, I_y, I_z; then 12 `MassMatrix` entries each for
# added mass, ballast and the sum (or its inverse)
WATER, HULL, WHOLE = 6, 18, 30
CONSTANTS = 42
LINEAR, ANGULAR = range(3), range(3, 6)


def has_hull_fixed_axes(free: frozenset[str]) -> bool:
    """Return whether a vessel's equations use body axes that are fixed in the hull.

    Otherwise the axes turn with the heading and stay level when the hull rolls.

    Args:
        free: Degrees of freedom of the vessel.
    """
    return "pitch" in free or {"heave", "roll"} <= free


def has_square_jacobian(free: frozenset[str]) -> bool:
    """Return whether a vessel has as many free body velocities as free coordinates.

    This holds for all six degrees of freedom, and for level axes unless the hull yaws with only one
    of surge and sway.

    Args:
        free: Degrees of freedom of the vessel.
    """
    if has_hull_fixed_axes(free):
        return free == frozenset(AXES)
    return "yaw" not in free or len(free & {"surge", "sway"}) != 1


def mass_matrix_entry(begin: int, i: int, j: int) -> SymbolicSum:
    """Return the symbol of one entry of a constant 6 by 6 mass matrix in generated code.

    It is zero where port-starboard symmetry of the hull requires it.

    Args:
        begin: Index in the array of constants at which the matrix begins.
        i: Row.
        j: Column.
    """
    pair = (min(i, j), max(i, j))
    return symbol(f"k[{begin + MASS_ENTRIES.index(pair)}]") if pair in MASS_ENTRIES else ZERO


def cross_product(a: list[SymbolicSum], b: list[SymbolicSum]) -> list[SymbolicSum]:
    """Return the vector product of two vectors (3,) of symbolic expressions."""
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


@dataclass
class Kinematics:
    """Symbolic kinematics of a vessel at one state, as variables of the generated code.

    It holds rotation matrix, Jacobian, body velocities and the velocity of the water.
    """

    R: list[list[SymbolicSum]]  # body axes to earth axes
    # 6 by 6: body rates per joint rate; columns of coordinates that are held are not used
    J: list[list[SymbolicSum]]
    nu: list[SymbolicSum]  # (6,) body rates
    turning: list[SymbolicSum]  # (3,) angular velocity of the axes
    drift: list[SymbolicSum]  # (6,) J' q': body acceleration at constant joint rates
    water: list[SymbolicSum]  # (3,) velocity of the current in body axes
    # (3,) rate of that velocity at the hull, in axes that do not turn; zero if it does not vary
    water_rate: list[SymbolicSum]
    # (3,) acceleration of the water itself; zero if its velocity does not vary
    water_acceleration: list[SymbolicSum]

    def jacobian_column(self, i: int) -> list[SymbolicSum]:
        """Return the symbolic body velocities (6,) per unit rate of coordinate i."""
        return [row[i] for row in self.J]


class EquationWriter:
    """Generates the source of the equations of motion for one set of degrees of freedom."""

    def __init__(self, dof: tuple[str, ...], centred: bool, varying_water: bool = False) -> None:
        """Set the degrees of freedom.

        Args:
            dof: The degrees of freedom.
            centred: Whether the mass centre is the origin of motion.
            varying_water: Whether the velocity of the water may vary with time and place.
        """
        self.free = [i for i, axis in enumerate(AXES) if axis in dof]
        self.set = frozenset(dof)
        self.hull_fixed_axes, self.square_jacobian, self.centred = (
            has_hull_fixed_axes(self.set),
            has_square_jacobian(self.set),
            centred,
        )
        self.moves_horizontally = bool({0, 1} & set(self.free))
        self.varying_water = varying_water and self.moves_horizontally
        self.n = len(self.free)

    # Kinematics
    # ------------------------------------------------------------------------------------------

    def coordinate_symbol(self, i: int) -> SymbolicSum:
        """Return the symbol of coordinate i (x, y, z, phi, theta, psi); zero if it is not free."""
        return symbol(COORDINATES[i]) if i in self.free else ZERO

    def rate_symbol(self, i: int) -> SymbolicSum:
        """Return the symbol of the time derivative of coordinate i; zero if it is not free."""
        return symbol(COORDINATES[i] + "d") if i in self.free else ZERO

    def generate_cosine_and_sine(self, lines: CodeLines, i: int) -> tuple[SymbolicSum, SymbolicSum]:
        """Return symbols of cosine and sine of an Euler angle, and generate their computation.

        They are 1 and 0 for an angle that is not free, and for roll and pitch of level axes.
        """
        angle = COORDINATES[i]
        if i not in self.free or (i != 5 and not self.hull_fixed_axes):
            return ONE, ZERO
        lines.append_line(f"c_{angle}, s_{angle} = cos({angle}), sin({angle})")
        return symbol(f"c_{angle}"), symbol(f"s_{angle}")

    def generate_kinematics(self, lines: CodeLines, current: bool = True) -> Kinematics:
        """Generate the kinematics of a state: rotation, Jacobian and velocities as symbols.

        Coordinates and rates of the state are variables already.

        Args:
            lines: The function so far, to which variables are added.
            current: Whether the velocity of the water is needed.
        """
        (cf, sf), (ct, st), (cp, sp) = (self.generate_cosine_and_sine(lines, i) for i in ANGULAR)
        R = [
            [cp * ct, cp * st * sf - sp * cf, sp * sf + cp * st * cf],
            [sp * ct, cp * cf + sp * st * sf, sp * st * cf - cp * sf],
            [-st, ct * sf, ct * cf],
        ]
        R = [[lines.generate_assignment(f"R{i}{j}", R[i][j]) for j in LINEAR] for i in LINEAR]
        T = [
            [ONE, ZERO, -st],
            [ZERO, cf, lines.generate_assignment("T12", ct * sf)],
            [ZERO, -sf, lines.generate_assignment("T22", ct * cf)],
        ]
        J = [[ZERO] * 6 for _ in range(6)]
        for i in LINEAR:
            for j in LINEAR:
                J[i][j], J[3 + i][3 + j] = R[j][i], T[i][j]
        nu = [
            lines.generate_assignment(
                "uvwpqr"[i] + "_", sum_expressions(J[i][j] * self.rate_symbol(j) for j in self.free)
            )
            for i in range(6)
        ]
        turning = nu[3:] if self.hull_fixed_axes else [ZERO, ZERO, nu[5]]
        phid, thetad, psid = map(self.rate_symbol, ANGULAR)
        bend = [ZERO, ZERO, ZERO]
        if self.hull_fixed_axes:
            bend = [
                -(ct * thetad * psid),
                ct * cf * phid * psid - sf * phid * thetad - st * sf * thetad * psid,
                -(cf * phid * thetad) - st * cf * thetad * psid - ct * sf * phid * psid,
            ]
        drift = list(map(neg, cross_product(turning, nu[:3]))) + lines.generate_assignments(
            "bend", bend
        )
        water = rate = acceleration = [ZERO, ZERO, ZERO]
        if current and self.moves_horizontally:
            lines.append_line(f"north, east = water_velocity({self.place_text()}, p, on, act, at)")
            water = self.generate_horizontal_vector(lines, R, "water", ("north", "east"))
        if current and self.varying_water:
            self.generate_water_change(lines)
            rate = self.generate_horizontal_vector(lines, R, "rate", ("rate_north", "rate_east"))
            acceleration = self.generate_horizontal_vector(
                lines, R, "gain", ("gain_north", "gain_east")
            )
        return Kinematics(R, J, nu, turning, drift, water, rate, acceleration)

    def place_text(self) -> str:
        """Return the source text of time and place of the hull."""
        return f"t, {self.coordinate_symbol(0)}, {self.coordinate_symbol(1)}"

    def generate_horizontal_vector(
        self, lines: CodeLines, R: list[list[SymbolicSum]], name: str, parts: tuple[str, str]
    ) -> list[SymbolicSum]:
        """Generate the components (3,) in body axes of a horizontal vector; return their symbols.

        Args:
            lines: The function so far.
            R: Rotation matrix from body to earth axes.
            name: Ending of the names of the variables.
            parts: Variables of the components to north and east.
        """
        north, east = map(symbol, parts)
        found = []
        for i, axis in enumerate("uvw"):
            component = R[0][i] * north + R[1][i] * east
            found.append(lines.generate_assignment(f"{axis}_{name}", component))
        return found

    def generate_water_change(self, lines: CodeLines) -> None:
        """Generate the rate of the water's velocity along the hull's path, and along its own."""
        changes = [f"{part}_{by}" for part in ("north", "east") for by in "txy"]
        lines.append_line(f"{', '.join(changes)} = water_change({self.place_text()}, p, on)")
        along_hull = (self.rate_symbol(0), self.rate_symbol(1))
        along_water = (symbol("north"), symbol("east"))
        for name, (xd, yd) in (("rate", along_hull), ("gain", along_water)):
            for part in ("north", "east"):
                t, x, y = (symbol(f"{part}_{by}") for by in "txy")
                lines.append_line(f"{name}_{part} = {t + x * xd + y * yd}")

    def motion_constructor_text(self, frame: Kinematics) -> str:
        """Return the source text of the `Motion` object that is passed to the force laws."""
        through = map(sub, frame.nu[:3], frame.water)
        psi = ("c_psi", "s_psi") if 5 in self.free else ("1.0", "0.0")
        over_ground = ("north", "east") if self.moves_horizontally else ("0.0", "0.0")
        carried = tuple(f"{velocity} * t" for velocity in over_ground)
        if self.varying_water:
            carried = ("carried_north", "carried_east")
        values = [
            *map(str, map(self.coordinate_symbol, range(6))),
            *map(str, frame.nu),
            *map(str, through),
            *psi,
            *over_ground,
            *carried,
        ]
        assert len(values) + 1 == len(Motion._fields)
        return f"Motion(t, {', '.join(values)})"

    # Forces
    # ------------------------------------------------------------------------------------------

    def current_acceleration_force(self, frame: Kinematics, axis: int) -> SymbolicSum:
        """Return one component of the force by the acceleration of the water.

        On the added mass acts the rate of the water's velocity in body axes: it changes as the
        hull turns, and where the current varies. The ballast is part of the displaced mass, on
        which the acceleration of the water itself acts.
        """
        away = map(neg, cross_product(frame.turning, frame.water))
        rate = map(add, away, frame.water_rate)
        on_water = dot_product((mass_matrix_entry(WATER, axis, j) for j in LINEAR), rate)
        ballast = (mass_matrix_entry(HULL, axis, j) for j in LINEAR)
        return on_water + dot_product(ballast, frame.water_acceleration)

    def displaced_mass_force(self, frame: Kinematics) -> list[SymbolicSum]:
        """Return the force (6,) of the pressure that accelerates the water, without the ballast.

        It acts on the mass that the hull displaces, its own, at the mass centre: the slope of the
        surface to which this pressure belongs, a / g, does not heel the hull.
        """
        force = [symbol("k[0]") * a for a in frame.water_acceleration]
        return force + cross_product(self.mass_centre(), force)

    def mass_centre(self) -> list[SymbolicSum]:
        """Return the place (3,) of the mass centre relative to the origin of motion."""
        if self.centred:
            return [ZERO, ZERO, ZERO]
        return [symbol("k[1]"), ZERO, symbol("k[2]") if self.hull_fixed_axes else ZERO]

    def generate_rigid_body_force(self, lines: CodeLines, frame: Kinematics) -> list[SymbolicSum]:
        """Return symbols of the rigid body's Coriolis and centripetal force (6,).

        The moments are about the origin of motion.
        """
        m, inertia = symbol("k[0]"), [symbol(f"k[{3 + i}]") for i in LINEAR]
        spin = frame.turning
        p, q, r = frame.nu[3:]
        at_centre = cross_product(spin, frame.nu[:3])
        lever = self.mass_centre()
        at_centre = list(map(add, at_centre, cross_product(spin, cross_product(spin, lever))))
        force = lines.generate_assignments("rigid", [-(m * a) for a in at_centre])
        moment = [ZERO, ZERO, ZERO]
        if self.hull_fixed_axes:
            gyroscopic = [(q * r, 1, 2), (r * p, 2, 0), (p * q, 0, 1)]
            moment = [a * (inertia[i] - inertia[j]) for a, i, j in gyroscopic]
        return force + list(map(add, cross_product(lever, force), moment))

    def generate_total_force(
        self, lines: CodeLines, frame: Kinematics, extra: str
    ) -> list[SymbolicSum]:
        """Return the total force (6,), the right-hand side of M nu' = ..., as symbolic sums.

        Source lines that evaluate the force laws are added.
        """
        self.generate_wrench(lines, frame)
        rigid = self.generate_rigid_body_force(lines, frame)
        displaced = self.displaced_mass_force(frame)
        found = []
        for i, component in enumerate(Wrench._fields):
            more = symbol(f"{extra}[{self.free.index(i)}]") if i in self.free else ZERO
            found.append(
                symbol(f"f.{component}")
                + more
                + rigid[i]
                + self.current_acceleration_force(frame, i)
                + displaced[i]
            )
        return found

    def generate_wrench(
        self, lines: CodeLines, frame: Kinematics, function: str = "wrench"
    ) -> None:
        """Generate the line that evaluates the force laws of all effects, or of those of the air.

        Args:
            lines: Lines of the function.
            frame: Kinematics of the vessel.
            function: Function of `laws.py` that is called.
        """
        self.generate_carried_water(lines)
        lines.append_line(f"f = {function}({self.motion_constructor_text(frame)}, p, on, act, at)")

    def generate_carried_water(self, lines: CodeLines) -> None:
        """Generate the displacement of the water on which waves travel, where it is no product."""
        if self.varying_water:
            lines.append_line("carried_north, carried_east = water_displacement(t, p, on)")

    def generate_state_unpacking(self, lines: CodeLines) -> None:
        """Generate the line that unpacks a state array into variables of coordinates and rates."""
        for more, first in (("", 0), ("d", self.n)):
            names = ", ".join(COORDINATES[i] + more for i in self.free)
            lines.append_line(f"{names} = {', '.join(f's[{first + j}]' for j in range(self.n))}")

    # Accelerations
    # ------------------------------------------------------------------------------------------

    def accelerations_code(self) -> list[str]:
        """Return the source lines of the generated function `accelerations`."""
        lines = CodeLines()
        self.generate_state_unpacking(lines)
        frame = self.generate_kinematics(lines)
        load = self.generate_total_force(lines, frame, "extra")
        if not self.square_jacobian:
            load = list(map(sub, load, self.mass_matrix_product(WHOLE, frame.drift)))
            named = lines.generate_assignments("load", load)
            self.generate_mass_matrix_factors(lines, frame)
            right = [dot_product(frame.jacobian_column(i), named) for i in self.free]
            found = self.generate_factored_solution(lines, right, "")
            lines.append_line(f"return {self.tuple_text(found)}")
            return lines.text
        pushed = {i: lines.generate_assignment(f"load{i}", load[i]) for i in self.free}
        nudot = {
            i: sum_expressions(mass_matrix_entry(WHOLE, i, j) * pushed[j] for j in self.free)
            for i in self.free
        }
        for i in LINEAR:
            if i in nudot:  # acceleration over ground along the axes
                nudot[i] = nudot[i] - frame.drift[i]
        moved = {i: lines.generate_assignment(f"a{i}", a) for i, a in nudot.items()}
        joints = self.generate_joint_accelerations(lines, frame, moved, moving=True)
        lines.append_line(f"return {self.tuple_text(joints)}")
        return lines.text

    def generate_joint_accelerations(
        self, lines: CodeLines, frame: Kinematics, body: dict[int, SymbolicSum], moving: bool
    ) -> list[str]:
        """Generate joint accelerations (of the coordinates) from body accelerations.

        Args:
            lines: The function so far.
            frame: Kinematics of the state.
            body: Body acceleration of each free axis.
            moving: Whether to include the terms that are quadratic in the Euler rates.
        """
        found = []
        for i in LINEAR:
            if i in self.free:
                found.append(
                    str(sum_expressions(frame.R[i][j] * body[j] for j in LINEAR if j in body))
                )
        if not self.hull_fixed_axes:
            return found + [str(body[i]) for i in ANGULAR if i in body]
        cf, sf, ct, st = map(symbol, ("c_phi", "s_phi", "c_theta", "s_theta"))
        phid, thetad, psid = map(self.rate_symbol, ANGULAR)
        secant, along = symbol("secant"), symbol("along")
        quadratic = [ZERO] * 4
        if moving:
            lines.append_line("secant = 1.0 / c_theta")
            turn = thetad * psid
            quadratic = [phid * thetad, turn * secant, phid * psid * ct, turn * st * secant]
        lines.append_line(f"along = {sf * body[4] + cf * body[5] + quadratic[0]}")
        rest = [
            body[3] + quadratic[1] + along * st * secant,
            cf * body[4] - sf * body[5] - quadratic[2],
            along * secant + quadratic[3],
        ]
        return found + list(map(str, rest))

    def mass_matrix_product(self, begin: int, motion: list[SymbolicSum]) -> list[SymbolicSum]:
        """Return the symbolic product of a constant mass matrix and a body motion (6,)."""
        found = []
        for i in range(6):
            found.append(dot_product((mass_matrix_entry(begin, i, j) for j in range(6)), motion))
        return found

    def generate_mass_matrix_factors(self, lines: CodeLines, frame: Kinematics) -> None:
        """Generate the mass matrix J' M J of the free coordinates and its factors L D L'."""
        for b, j in enumerate(self.free):
            column = self.mass_matrix_product(WHOLE, frame.jacobian_column(j))
            for a, i in enumerate(self.free[b:], b):
                value = dot_product(frame.jacobian_column(i), column)
                lines.append_line(f"M{a}{b} = {value}")
        for j in range(self.n):
            lines.append_line(
                f"D{j} = M{j}{j}" + "".join(f" - L{j}{k} * L{j}{k} * D{k}" for k in range(j))
            )
            for i in range(j + 1, self.n):
                taken = "".join(f" - L{i}{k} * L{j}{k} * D{k}" for k in range(j))
                lines.append_line(f"L{i}{j} = (M{i}{j}{taken}) / D{j}")

    def generate_factored_solution(
        self, lines: CodeLines, right: list[SymbolicSum], tag: str
    ) -> list[str]:
        """Generate the solution of a system with the factored mass matrix; return its symbols."""
        for i, value in enumerate(right):
            lines.append_line(
                f"y{tag}{i} = {value}" + "".join(f" - L{i}{k} * y{tag}{k}" for k in range(i))
            )
        for i in reversed(range(self.n)):
            lines.append_line(
                f"x{tag}{i} = y{tag}{i} / D{i}"
                + "".join(f" - L{k}{i} * x{tag}{k}" for k in range(i + 1, self.n))
            )
        return [f"x{tag}{i}" for i in range(self.n)]

    def acceleration_per_force_code(self) -> list[str]:
        """Return the source lines of the generated function `acceleration_per_force`.

        It computes the derivatives of the accelerations by a body force.
        """
        lines = CodeLines()
        self.generate_state_unpacking(lines)
        frame = self.generate_kinematics(lines, current=False)
        if self.hull_fixed_axes and self.square_jacobian:
            lines.append_line("secant = 1.0 / c_theta")
        if not self.square_jacobian:
            self.generate_mass_matrix_factors(lines, frame)
        for b, j in enumerate(self.free):
            if self.square_jacobian:
                body = {i: mass_matrix_entry(WHOLE, i, j) for i in self.free}
                found = self.generate_joint_accelerations(lines, frame, body, moving=False)
            else:
                found = self.generate_factored_solution(
                    lines, [frame.J[j][i] for i in self.free], f"{b}_"
                )
            for a, text in enumerate(found):
                lines.append_line(f"A[row + {a}, column + {b}] = {text}")
        return lines.text

    # Further functions
    # ------------------------------------------------------------------------------------------

    def body_force_code(self, function: str) -> list[str]:
        """Return the source lines of `total_body_force` or `air_body_force`.

        Args:
            function: Function of `laws.py` that sums the forces: `wrench` or `air_wrench`.
        """
        lines = CodeLines()
        self.generate_state_unpacking(lines)
        frame = self.generate_kinematics(lines)
        self.generate_wrench(lines, frame, function)
        lines.append_line(
            f"return {self.tuple_text([f'f.{Wrench._fields[i]}' for i in self.free])}"
        )
        return lines.text

    def advance_memory_of_motion_code(self) -> list[str]:
        """Return the source lines of the generated function `advance_memory_of_motion`.

        It advances the states of effects that remember the motion of the hull.
        """
        lines = CodeLines()
        self.generate_state_unpacking(lines)
        lines.append_line("at = np.int64(0)")  # the actuators at the begin of the step
        frame = self.generate_kinematics(lines)
        self.generate_carried_water(lines)
        motion = self.motion_constructor_text(frame)
        lines.append_line(
            f"advance_motion_memory({motion}, memory, dt, p, on, act, np.int64(HELD))"
        )
        return lines.text

    def pose_and_velocities_code(self) -> list[str]:
        """Return the source lines of the generated function `pose_and_velocities`.

        It computes the true values of all recorded signals.
        """
        lines = CodeLines()
        self.generate_state_unpacking(lines)
        frame = self.generate_kinematics(lines, current=False)
        values = [*map(str, map(self.coordinate_symbol, range(6))), *map(str, frame.nu)]
        lines.append_line(f"return MeasuredMotion({', '.join(values)})")
        return lines.text

    def instrument_readings_code(self) -> list[str]:
        """Return the source lines of the generated function `instrument_readings`.

        It computes noiseless readings of instruments on board.
        """
        lines = CodeLines()
        self.generate_state_unpacking(lines)
        frame = self.generate_kinematics(lines, current=False)
        lines.append_line("a = accelerations(t, s, act, at, p, on, k, extra)")
        ahead, aside = (
            sum_expressions(
                frame.J[row][i] * symbol(f"a[{b}]") for b, i in enumerate(self.free) if i in LINEAR
            )
            for row in (0, 1)
        )
        u, v, _, rolling, _, turning = frame.nu
        x, y, _, roll, _, heading = map(self.coordinate_symbol, range(6))
        readings = (heading, turning, ahead, aside, u, v, x, y, roll, rolling)
        lines.append_line(f"return {self.tuple_text(list(map(str, readings)))}")
        return lines.text

    def jacobian_code(self) -> list[str]:
        """Return the source lines of the generated function `jacobian`.

        It computes the derivatives of body velocities by coordinate rates.
        """
        lines = CodeLines()
        self.generate_state_unpacking(lines)
        frame = self.generate_kinematics(lines, current=False)
        for i in range(6):
            for b, j in enumerate(self.free):
                if frame.J[i][j]:
                    lines.append_line(f"J[{i}, {b}] = {frame.J[i][j]}")
        return lines.text

    def expected_measurement_of_level_hull_code(self) -> list[str]:
        """Return the source lines of the generated function `expected_measurement_of_level_hull`.

        It computes the expected value of a measured position or velocity for level axes.
        """
        lines = CodeLines()
        lines.append_line("if code < NQ:")
        lines.append_line("    row[code] = 1.0")
        lines.append_line("    return float(s[code])")
        if not self.hull_fixed_axes and {0, 1, 5} <= set(self.free):
            psi, north, east = self.free.index(5), self.n, self.n + 1
            lines.append_line("if code < NQ + 2:")
            lines.append_line(f"    c, s_ = cos(s[{psi}]), sin(s[{psi}])")
            along = f"c * s[{north}] + s_ * s[{east}]"
            lines.append_line(f"    along, across = {along}, c * s[{east}] - s_ * s[{north}]")
            lines.append_line("    if code == NQ:")
            lines.append_line(f"        row[{north}], row[{east}], row[{psi}] = c, s_, across")
            lines.append_line("        return float(along)")
            lines.append_line(f"    row[{north}], row[{east}], row[{psi}] = -s_, c, -along")
            lines.append_line("    return float(across)")
        lines.append_line("row[code] = 1.0")
        lines.append_line("return float(s[code])")
        return lines.text

    def mujoco_code(self) -> list[str]:
        """Return the source lines of the generated function `add_force_and_inertia_to_mujoco`."""
        lines = CodeLines()
        order = [i for i in map(COORDINATES.index, JOINTS) if i in self.free]
        for b, i in enumerate(order):
            flip = "-" if SIGN[COORDINATES[i]] < 0 else ""
            lines.append_line(f"{COORDINATES[i]}, {COORDINATES[i]}d = {flip}q[{b}], {flip}qd[{b}]")
        lines.append_line("on = ()")
        frame = self.generate_kinematics(lines)
        self.generate_wrench(lines, frame)
        added = [
            [mass_matrix_entry(WATER, i, j) + mass_matrix_entry(HULL, i, j) for j in range(6)]
            for i in range(6)
        ]
        needed = [a for a in range(6) if any(frame.J[a][i] for i in self.free)]
        displaced = self.displaced_mass_force(frame)
        load = {}
        for a in needed:
            bent = dot_product(added[a], frame.drift)
            load[a] = lines.generate_assignment(
                f"load{a}",
                symbol(f"f.{Wrench._fields[a]}")
                + self.current_acceleration_force(frame, a)
                + displaced[a]
                - bent,
            )
        for b, i in enumerate(order):
            force = sum_expressions(frame.J[a][i] * load[a] for a in needed)
            lines.append_line(f"force[{b}] += {force if SIGN[COORDINATES[i]] > 0 else -force}")
        mass = [[ZERO] * 6 for _ in range(6)]
        for a in needed:
            for c in range(a, 6):
                mass[a][c] = mass[c][a] = lines.generate_assignment(f"M{a}{c}", added[a][c])
        for b, i in enumerate(order):
            for d, j in enumerate(order[: b + 1]):
                value = ZERO
                for a in needed:
                    value = value + sum_expressions(
                        frame.J[a][i] * mass[a][c] * frame.J[c][j] for c in needed
                    )
                if value:
                    same = SIGN[COORDINATES[i]] == SIGN[COORDINATES[j]]
                    lines.append_line(f"M[{b * (b + 1) // 2 + d}] += {value if same else -value}")
        return lines.text

    def tuple_text(self, items: list[str]) -> str:
        """Return the source text of a tuple with the given items."""
        return f"({', '.join(items)},)"
