"""Strip wave loads: forces of a sea on a hull, from its particulars or the sections of its mesh."""

from dataclasses import dataclass, field, replace
from math import exp, pi, sqrt
from typing import Any, ClassVar, Self

from numba import njit

from boatsim.errors import BadInput
from boatsim.physics import particulars
from boatsim.physics.base import AXES, UNSET, Array, Boat, Force, Wrench, param, wrench
from boatsim.physics.debugging import interpreted
from boatsim.physics.hull.floating import depth_of_volume
from boatsim.physics.hull.mesh import mesh_of_file, time_of_change
from boatsim.physics.hull.sections import HullSections, sections_of_file
from boatsim.physics.waves.dispersion import wave_number
from boatsim.physics.waves.encounter import heading_of_waves
from boatsim.physics.waves.hull_strips import (
    NO_SECTIONS,
    end_of_sections,
    line_value,
    section_table,
    strip_hull,
    strip_place,
)
from boatsim.physics.waves.sea_parameters import SeaParameters
from boatsim.physics.waves.sea_state import (
    has_directions,
    sea_state,
    wave_component,
    wave_direction,
)
from boatsim.physics.waves.strip_loads import EncounteredWave, wave_loads

GRAVITY = particulars.GRAVITY
ZERO_BY_DEFAULT = ("hull_spacing", "centre")
POINTED = 0.2  # gyradius squared of a parabola that ends in points, over half the length squared


@njit
def law(m: Any, q: Any, p: Array, first: Any) -> Wrench:
    """Return the force of a sea on the strips of a hull.

    It is a sum over wave components. The waves travel on the water, which moves with the current.

    Args:
        m: Motion of the hull: velocities [m/s], rates [rad/s], position [m], attitude [rad].
        q: Parameters of the effect, with the names and units of its class.
        p: Parameters and tables of all effects.
        first: Index of the effect's table.

    Returns:
        Force [N] and moment [N m] in body axes.
    """
    X = Y = Z = K = M = N = 0.0
    if q.significant_height == 0.0:
        return wrench()
    waves = end_of_sections(p, first)
    hull, sea = strip_hull(q), sea_state(q, p, waves)
    ahead, across, run = heading_of_waves(q.toward, m)
    for k in range(int(sea.number)):
        w, amplitude, phase = wave_component(k, q, sea, p, waves)
        if has_directions(q):
            ahead, across, run = heading_of_waves(wave_direction(k, q, p, waves), m)
        number = wave_number(w, q.depth)
        # Components have a trough at phase 0
        here = w * m.t - number * run + phase + pi
        bed = 0.0
        if q.depth > 0.0:
            bed = exp(-2.0 * number * q.depth)
        wave = EncounteredWave(w, amplitude, number, ahead, across, here, bed)
        f = wave_loads(wave, hull, q, p, first)
        X += f.X
        Y += f.Y
        Z += f.Z
        K += f.K
        M += f.M
        N += f.N
    return wrench(X=X, Y=Y, Z=Z, K=K, M=M, N=N)


def added_mass_parameter(axis: str, unit: str) -> float:
    """Declare an added mass or added inertia that follows that of the vessel."""
    return param(
        UNSET,
        low=0.0,
        high=1e13,
        unit=unit,
        words=f"added mass in {axis}; default: that of the vessel's added_mass",
        follows=f"added_mass.{axis}?",
    )


def damping_parameter(axis: str, unit: str) -> float:
    """Declare a linear damping that follows that of the vessel."""
    return param(
        UNSET,
        low=0.0,
        high=1e15,
        unit=unit,
        words=f"damping in {axis}; default: that of the vessel's linear_damping",
        follows=f"linear_damping.{axis}?",
    )


def place_parameter(words: str, follows: str = "") -> float:
    """Declare a place along or below the hull [m]."""
    return param(UNSET, low=-250.0, high=250.0, unit="m", words=words, follows=follows)


@dataclass(frozen=True)
class StripWaveLoads(SeaParameters, Force):
    """Forces of the waves of a spectrum on a hull of one or two hulls in strips.

    With the elevation eta = a cos(theta), theta = w t - k (x cos beta + y sin beta) + epsilon, the
    undisturbed wave has the pressure rho g a C(z) cos(theta), C = exp(-k z), or cosh k (h - z) /
    cosh k h in water of a `depth` h. On a strip of breadth b, draught d and area A = b d it exerts

    Y = -rho g a k sin(beta) integral_A C sin(theta) dA,  Z = -rho g a C(d) integral_b cos(theta) dy

    X is Y with cos(beta) instead of sin(beta), and K, M and N are the moments of these forces about
    the origin, which lies in the waterplane. The integrals over the breadth of both hulls are
    closed forms, so that Y, Z and K decrease in waves as short as the beam. Diffraction is that of
    the motion relative to the water: added mass times the acceleration of the undisturbed water and
    linear damping times its velocity, in each strip, at the depth of its bottom in heave and roll
    and averaged over the draught in surge, sway and yaw.

    Breadth, section area, added mass and damping are polynomials of second degree along the hull,
    with given area, centre and gyradius of the waterplane, volume and centre of buoyancy, and the
    added mass and damping of the vessel. A boat whose hydrostatics belong to the same waterplane
    therefore follows the surface of long waves.

    With a `mesh`, breadth and section area of each strip are cut from it at the `draught`, by
    default that at which it displaces the mass of the vessel. Length, beam, coefficients, centres
    and spacing of two hulls are then those of the mesh. The file has x forward, y to port and z up,
    and its surface is closed.

    The sea is that of `irregular_sea`: `spectrum`, `significant_height`, `modal_period`, `toward`
    and the other parameters have the same meaning.
    """

    formula: ClassVar[str] = (
        r"\begin{aligned} \theta_i &= \omega_i t - k_i \left((x + \xi - V_N t) \cos\gamma_i + "
        r"(y + \zeta - V_E t) \sin\gamma_i\right) + \epsilon_i, \quad \eta = \sum_i a_i "
        r"\cos\theta_i, \quad \omega_i^2 = g k_i \tanh k_i h "
        r"\\ X + \mathrm{i} Y &= \sum_i e^{\mathrm{i} \beta_i} \int_L \left(-\rho g a_i k_i \int_A "
        r"C \sin\theta_i \, \mathrm{d}A + a_{11,22} \, \dot u_w + b_{11,22} \, u_w\right) "
        r"\mathrm{d}\xi "
        r"\\ Z &= \sum_i \int_L \left(-\rho g a_i C(d) \int_b \cos\theta_i \, \mathrm{d}\zeta + "
        r"a_{33} \, \dot w_w + b_{33} \, w_w\right) \mathrm{d}\xi "
        r"\\ u_w &= \frac{g k_i a_i}{\omega_i} \, \bar C \cos\theta_i, \quad w_w = \frac{g k_i "
        r"a_i}{\omega_i} \, S(d) \sin\theta_i, \quad \beta_i = \gamma_i - \psi "
        r"\\ C(z) &= \frac{\cosh k (h - z)}{\cosh k h}, \quad S(z) = \frac{\sinh k (h - z)}"
        r"{\cosh k h} \end{aligned}"
    )
    symbols: ClassVar = {
        "toward": r"\gamma",
        "depth": "h",
        "density": r"\rho",
        "length": "L",
        "surge_mass": "a_{11}",
        "sway_mass": "a_{22}",
        "heave_mass": "a_{33}",
        "surge_damping": "b_{11}",
        "sway_damping": "b_{22}",
        "heave_damping": "b_{33}",
    }
    ruled_out_by: ClassVar = {"no_waves": (True,), "no_water": (True,)}
    words: ClassVar[str] = "waves exert forces on the hull in all degrees of freedom"
    shown_by: ClassVar[str] = "lying at several headings to the sea"
    source: ClassVar[str] = (
        "O. M. Faltinsen, Sea Loads on Ships and Offshore Structures, 1990, chapter 3; "
        "N. Salvesen, E. O. Tuck, O. M. Faltinsen, Ship Motions and Sea Loads, SNAME 78, 1970"
    )
    sees_table: ClassVar[bool] = True
    paths: ClassVar = ("mesh", "spectrum_file")
    law: ClassVar = law

    mesh: str = field(default="")  # STL or OBJ file of the closed hull, in place of particulars
    scale: float = param(1.0, low=1e-6, high=1e6, unit="m", words="length of a unit of the mesh")
    origin: float = param(
        0.0, low=-500.0, high=500.0, unit="m", words="place of the origin of motion in the mesh"
    )
    strips: float = param(20.0, low=3.0, high=400.0, unit="", words="number of strips")
    hull_spacing: float = param(
        0.0,
        low=0.0,
        high=100.0,
        unit="m",
        words="distance between the centre planes of the two hulls of a catamaran; 0: one hull",
    )
    hull_beam: float = param(
        UNSET,
        low=0.0,
        high=100.0,
        unit="m",
        words="beam of one hull; default: that of the vessel less the spacing",
    )
    length: float = param(
        UNSET,
        low=0.0,
        high=500.0,
        unit="m",
        words="length of the waterline; default: that of the vessel",
        follows="vessel.length",
    )
    draught: float = param(
        UNSET,
        low=0.0,
        high=50.0,
        unit="m",
        words="default: that of the vessel; with a mesh that at which it displaces the mass",
        follows="vessel.draught",
    )
    block_coefficient: float = param(
        UNSET,
        low=0.01,
        high=1.0,
        unit="",
        words="volume over length, hull beam and draught; default: from the mass of the vessel",
    )
    waterplane_coefficient: float = param(
        UNSET,
        low=0.01,
        high=1.0,
        unit="",
        words="waterplane area over length and hull beam; default: from hydrostatics, or "
        "(1 + 2 block) / 3",
    )
    waterplane_gyradius: float = param(
        UNSET,
        low=0.0,
        high=250.0,
        unit="m",
        words="longitudinal gyradius of the waterplane about its centre; default: from "
        "hydrostatics, or that of a parabola",
    )
    flotation: float = place_parameter(
        "centre of flotation ahead of the origin; default: that of hydrostatics",
        "hydrostatics.flotation?",
    )
    buoyancy: float = place_parameter(
        "centre of buoyancy ahead of the origin; default: the mass centre"
    )
    centre: float = param(
        0.0, low=-250.0, high=250.0, unit="m", words="mid-length ahead of the origin"
    )
    density: float = param(
        particulars.SEA_WATER, low=1.0, high=1500.0, unit="kg/m^3", words="density of the water"
    )
    surge_mass: float = added_mass_parameter("surge", "kg")
    sway_mass: float = added_mass_parameter("sway", "kg")
    sway_mass_at: float = place_parameter(
        "centre of the sway added mass, ahead of the origin", "added_mass.sway_at?"
    )
    sway_mass_below: float = place_parameter(
        "centre of the sway added mass, below the origin", "added_mass.sway_below?"
    )
    heave_mass: float = added_mass_parameter("heave", "kg")
    roll_mass: float = added_mass_parameter("roll", "kg m^2")
    pitch_mass: float = added_mass_parameter("pitch", "kg m^2")
    yaw_mass: float = added_mass_parameter("yaw", "kg m^2")
    surge_damping: float = damping_parameter("surge", "N s/m")
    sway_damping: float = damping_parameter("sway", "N s/m")
    sway_damping_at: float = place_parameter(
        "centre of the sway damping, ahead of the origin", "linear_damping.sway_at?"
    )
    heave_damping: float = damping_parameter("heave", "N s/m")
    roll_damping: float = damping_parameter("roll", "N m s")
    pitch_damping: float = damping_parameter("pitch", "N m s")
    yaw_damping: float = damping_parameter("yaw", "N m s")

    def wave_axes(self) -> tuple[str, ...]:
        """Return the degrees of freedom in which the sea exerts a force; empty if it is calm."""
        if self.significant_height == 0.0:
            return ()
        return AXES

    def with_all_parameters(self, vessel: Boat) -> Self:
        """Return a copy of the effect in which every parameter has a value.

        Args:
            vessel: Vessel on which the effect acts.

        Raises:
            BadInput: A strip of the hull would have a negative breadth or section area, or the mesh
                cannot be read or does not float.
        """
        if self.mesh:
            known = self._with_particulars_of_mesh(vessel)
            return super(StripWaveLoads, known).with_all_parameters(vessel)
        own = super().with_all_parameters(vessel)
        q = own.values()
        hull = interpreted(strip_hull)(q)
        for i in range(int(own.strips)):
            place = interpreted(strip_place)(i, q)
            for quantity, line in (("breadth", hull.breadth), ("section area", hull.area)):
                if not interpreted(line_value)(place, line) > 0.0:
                    raise BadInput(
                        f"{vessel.name}: {own.name}: the {quantity} is not positive "
                        f"{own.centre + 0.5 * own.length * place:.3g} m ahead of the origin; "
                        "state waterplane_gyradius, flotation and buoyancy that fit the length"
                    )
        return own

    def table(self) -> tuple[float, ...]:
        """Return breadth and area of the sections of the mesh, then the table of the sea."""
        table: tuple[float, ...] = NO_SECTIONS
        if self.mesh:
            sections = self.sections()
            table = section_table(sections.breadth.tolist(), sections.area.tolist())
        return (*table, *self.sea_table())

    def sections(self) -> HullSections:
        """Return the sections of the mesh.

        Raises:
            BadInput: The mesh cannot be read, is not closed, or does not float.
        """
        changed = time_of_change(self.mesh)
        return sections_of_file(
            self.mesh, changed, self.scale, self.origin, self.draught, int(self.strips)
        )

    def _with_particulars_of_mesh(self, vessel: Boat) -> Self:
        """Return a copy with the particulars of the mesh. Raises BadInput if they were given."""
        own = self
        filled = set(self.filled)
        if not own.has_value("draught"):
            try:
                mesh = mesh_of_file(self.mesh, self.scale)
                draught = depth_of_volume(mesh, vessel.body.mass / self.density)
            except BadInput as error:
                raise BadInput(f"{vessel.name}: {self.name}: {error}") from None
            own = own.with_values({"draught": draught})
            filled.add("draught")
        found = own.sections().particulars()
        for key, value in found.items():
            given = getattr(self, key)
            stated = self.has_value(key) and not (key in ZERO_BY_DEFAULT and given == 0.0)
            if stated and key not in self.filled:
                raise BadInput(
                    f"{vessel.name}: {self.name}: {key} = {given:g} and mesh; the mesh gives "
                    f"{value:.4g}; leave out {key} or mesh"
                )
        return replace(own.with_values(found), filled=frozenset(filled | set(found)))

    def derived_parameters(self, vessel: Boat) -> dict[str, float]:
        """Return the particulars of the hull that follow from the vessel.

        The waterplane is that of the vessel's hydrostatics. Without it the waterplane coefficient
        is (1 + 2 C_B) / 3 (H. Schneekluth, V. Bertram, Ship Design for Efficiency and Economy,
        1998, section 1.6), and the waterline is a parabola.

        Args:
            vessel: Vessel on which the effect acts.

        Returns:
            Name of the parameter -> value.
        """
        found = {"hull_beam": vessel.beam - self.hull_spacing}
        beam = self._value_or_derived("hull_beam", found)
        box = self.length * beam * (2.0 if self.hull_spacing > 0.0 else 1.0)  # [m^2]
        found["block_coefficient"] = vessel.body.mass / (self.density * box * self.draught)
        block = self._value_or_derived("block_coefficient", found)
        water = vessel.effect("hydrostatics")
        heave = getattr(water, "heave", 0.0)
        found["waterplane_coefficient"] = (1.0 + 2.0 * block) / 3.0
        if heave > 0.0:
            found["waterplane_coefficient"] = heave / (self.density * GRAVITY * box)
        fullness = self._value_or_derived("waterplane_coefficient", found)
        # Gyradius squared of a parabola, pointed at most, and that of the stiffness m g GM_L
        parabola = max(1.0 / 3.0 + 4.0 / 15.0 * (1.0 - 1.0 / fullness), POINTED)
        square = (0.5 * self.length) ** 2 * parabola
        ahead, below = vessel.body.centre
        pitch = getattr(water, "pitch", 0.0)
        if pitch > 0.0:
            lever = 0.5 * self.draught * block / fullness - below
            weight = self.density * GRAVITY * box * self.draught * block
            square = (pitch + weight * lever) / (self.density * GRAVITY * box * fullness)
        found["waterplane_gyradius"] = sqrt(max(square, 0.0))
        found["buoyancy"] = ahead
        return found

    def _value_or_derived(self, name: str, derived: dict[str, float]) -> float:
        """Return the value of a parameter, or the derived one if it has none."""
        return float(getattr(self, name)) if self.has_value(name) else derived[name]
