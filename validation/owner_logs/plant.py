"""Simulated boats: a hull in the plane with propellers and a rudder, and one Runge-Kutta step.

Axes are SNAME, the origin is the mass centre; velocities are relative to the water, which moves
with a steady current. Resistance: ITTC 1957 friction and a wave term; across: strips of cross-flow
drag, a low aspect wing (R. T. Jones 1946), Munk's moment by Kirchhoff's equations; propeller thrust
falls linearly with the inflow; the rudder works in the propeller race (A. F. Molland, S. R.
Turnock, Marine Rudders and Control Surfaces, 2007).
"""

from dataclasses import dataclass, field
from math import atan2, cos, log10, sin, sqrt

RHO, VISCOSITY, GRAVITY, AIR = 1025.0, 1.19e-6, 9.81, 1.225
STRIPS = tuple((i + 0.5) / 12 - 0.5 for i in range(12))  # [lengths] ahead of mid-length
RACE = 0.6  # share of the propeller's race that the rudder meets

State = tuple[
    float, float, float, float, float, float
]  # north, east [m], psi [rad], u, v [m/s] through water, r [rad/s]


@dataclass(frozen=True)
class Propeller:
    """A screw or an outboard."""

    x: float  # [m] ahead of the mass centre
    y: float  # [m] to starboard
    full: float  # [N] bollard thrust, full ahead
    astern: float  # share of it full astern
    pitch_speed: float  # [m/s] inflow at which the thrust at full ahead is zero
    wake: float = 0.1  # share by which the inflow is slower than the boat
    disc: float = 0.05  # [m^2]
    turns: bool = False


@dataclass(frozen=True)
class Rudder:
    """A blade abaft the first propeller."""

    x: float  # [m]
    area: float  # [m^2]
    slope: float  # of its lift [1/rad]


@dataclass(frozen=True)
class Hull:
    """Inertia and hydrodynamic coefficients of the hull."""

    length: float  # [m]
    beam: float
    draught: float
    hulls: int
    mass: float  # [kg]
    inertia: float  # [kg m^2] in yaw
    added: tuple[float, float, float, float]  # surge, sway [kg], yaw [kg m^2], sway by yaw [kg m]
    wetted: float  # [m^2]
    form: float  # friction is times 1 + form
    wave: float  # coefficient at a Froude number of 0.4
    section: float  # cross-flow drag coefficient
    rake: float  # growth of the draught from amidships to the bow, share of the draught
    lift: float  # of Jones' value
    lift_at: float  # [lengths] ahead of the mass centre
    turning: float  # [N m s] linear damping in yaw
    windage: tuple[float, float, float]  # [m^2] ahead, abeam; [m] of the latter's centre ahead


@dataclass(frozen=True)
class Surroundings:
    """Surroundings, and load and drag that the particulars lack."""

    current: tuple[float, float] = (0.0, 0.0)  # [m/s] north, east
    wind: tuple[float, float] = (0.0, 0.0)  # [m/s] towards north, east
    load: float = 0.0  # [kg]
    load_at: float = 0.0  # [m] ahead
    drag: float = 1.0  # factor of the resistance


@dataclass(frozen=True)
class Plant:
    """The true boat."""

    hull: Hull
    propellers: tuple[Propeller, ...]
    rudder: Rudder | None = None
    around: Surroundings = field(default_factory=Surroundings)

    def masses(self) -> tuple[float, float, float, float]:
        """Return surge, sway [kg], yaw [kg m^2] and sway-yaw mass [kg m] with water and load."""
        h, a = self.hull, self.around
        return (
            h.mass + a.load + h.added[0],
            h.mass + a.load + h.added[1],
            h.inertia + a.load * a.load_at**2 + h.added[2],
            h.added[3] + a.load * a.load_at,
        )


def resistance(hull: Hull, u: float) -> float:
    """Return the resistance [N] in surge."""
    speed = abs(u)
    reynolds = max(speed * hull.length / VISCOSITY, 1e4)
    friction = 0.075 / (log10(reynolds) - 2.0) ** 2 * (1.0 + hull.form)
    froude = speed / sqrt(GRAVITY * hull.length)
    return 0.5 * RHO * hull.wetted * (friction + hull.wave * (froude / 0.4) ** 3) * u * speed


def cross_flow_force(hull: Hull, u: float, v: float, r: float) -> tuple[float, float]:
    """Return side force [N] and moment [N m] of cross flow and lift."""
    Y = N = 0.0
    width = hull.length / len(STRIPS)
    k = 0.5 * RHO * hull.section * hull.draught * width * (1.7 if hull.hulls == 2 else 1.0)
    for share in STRIPS:
        x = share * hull.length
        w = v + x * r
        f = -k * (1.0 + hull.rake * share) * w * abs(w)
        Y += f
        N += x * f
    at = hull.lift_at * hull.length
    wing = -0.5 * RHO * 3.1416 * hull.draught**2 * hull.lift * hull.hulls * abs(u) * (v + at * r)
    return Y + wing, N + at * wing - hull.turning * r


def thrust(p: Propeller, share: float, u: float) -> float:
    """Return the thrust [N] at a share of full revolutions, with the boat under way."""
    ahead = (1.0 - p.wake) * u / p.pitch_speed
    found = p.full * (share * abs(share) - abs(share) * ahead)
    if share >= 0.0:
        return found
    return p.astern * found


def rudder_force(
    rudder: Rudder, p: Propeller, push: float, angle: float, u: float, v: float, r: float
) -> float:
    """Return the normal force [N] of the blade, positive to port."""
    own = (1.0 - p.wake) * u
    race = sqrt(own * own + RACE * max(push, 0.0) / (0.5 * RHO * p.disc)) if u > -0.05 else abs(u)
    attack = angle * (1.0 if u > -0.05 else -1.0) + 0.6 * atan2(v + rudder.x * r, race + 0.05)
    return 0.5 * RHO * rudder.area * rudder.slope * 0.5 * sin(2.0 * attack) * race * race


def forces(
    plant: Plant, s: State, revs: tuple[float, ...], helm: float
) -> tuple[float, float, float]:
    """Return X, Y [N] and N [N m] of hull, drives and wind.

    The angle `helm` [rad] is positive to starboard.
    """
    _, _, psi, u, v, r = s
    Y, N = cross_flow_force(plant.hull, u, v, r)
    X = -plant.around.drag * resistance(plant.hull, u)
    angle = 0.0 if plant.rudder else helm
    c, n = cos(angle), sin(angle)
    for p, share in zip(plant.propellers, revs, strict=True):
        T = thrust(p, share, u)
        side = -T * n if p.turns else 0.0
        along = T * c if p.turns else T
        X, Y, N = X + along, Y + side, N + p.x * side - p.y * along
    if plant.rudder:
        p = plant.propellers[0]
        F = rudder_force(plant.rudder, p, thrust(p, revs[0], u), helm, u, v, r)
        X, Y, N = X - F * sin(helm), Y - F * cos(helm), N - plant.rudder.x * F * cos(helm)
    return add_wind_force(plant, psi, u, v, X, Y, N)


def add_wind_force(
    plant: Plant, psi: float, u: float, v: float, X: float, Y: float, N: float
) -> tuple[float, float, float]:
    """Return the forces with the wind added."""
    wind, current = plant.around.wind, plant.around.current
    if wind == (0.0, 0.0):
        return X, Y, N
    c, s = cos(psi), sin(psi)
    north, east = wind[0] - current[0], wind[1] - current[1]
    ahead, side = north * c + east * s - u, -north * s + east * c - v
    q = 0.5 * AIR * sqrt(ahead * ahead + side * side)
    front, lateral, at = plant.hull.windage
    return (
        X + q * 0.7 * front * ahead,
        Y + q * 0.9 * lateral * side,
        N + q * 0.9 * lateral * side * at,
    )


def state_derivative(
    plant: Plant, s: State, revs: tuple[float, ...], helm: float, push: tuple[float, float, float]
) -> State:
    """Return the rate of change of the state."""
    _, _, psi, u, v, r = s
    X, Y, N = forces(plant, s, revs, helm)
    mx, my, mz, myz = plant.masses()
    pu, pv = mx * u, my * v + myz * r
    X, Y, N = X + push[0] + pv * r, Y + push[1] - pu * r, N + push[2] - (u * pv - v * pu)
    det = my * mz - myz * myz
    c, n = cos(psi), sin(psi)
    current = plant.around.current
    return (
        u * c - v * n + current[0],
        u * n + v * c + current[1],
        r,
        X / mx,
        (mz * Y - myz * N) / det,
        (my * N - myz * Y) / det,
    )


def runge_kutta_step(
    plant: Plant,
    s: State,
    revs: tuple[float, ...],
    helm: float,
    dt: float,
    push: tuple[float, float, float],
) -> State:
    """Take one Runge-Kutta step with drives and ambient force held."""

    def off(k: State, h: float) -> State:
        a, b, c, d, e, f = s
        return a + h * k[0], b + h * k[1], c + h * k[2], d + h * k[3], e + h * k[4], f + h * k[5]

    k1 = state_derivative(plant, s, revs, helm, push)
    k2 = state_derivative(plant, off(k1, dt / 2), revs, helm, push)
    k3 = state_derivative(plant, off(k2, dt / 2), revs, helm, push)
    k4 = state_derivative(plant, off(k3, dt), revs, helm, push)
    mean = tuple((a + 2 * b + 2 * c + d) / 6 for a, b, c, d in zip(k1, k2, k3, k4, strict=True))
    return off(mean, dt)  # type: ignore[arg-type]
