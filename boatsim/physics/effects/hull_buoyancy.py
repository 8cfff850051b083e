"""Hull buoyancy: pressure of still water or waves on the submerged part of a hull's mesh."""

from dataclasses import dataclass, field
from math import cos, sin
from typing import Any, ClassVar, Self

from numba import njit

from boatsim.errors import BadInput
from boatsim.physics import particulars
from boatsim.physics.base import AXES, UNSET, Array, Boat, Force, Wrench, param, wrench
from boatsim.physics.hull.floating import depth_of_volume
from boatsim.physics.hull.mesh import ClosedMesh, mesh_of_file
from boatsim.physics.hull.panels import CALM, hull_load, panel_table
from boatsim.physics.particulars import GRAVITY
from boatsim.physics.waves.sea_parameters import SeaParameters

# A tenth of the length: in waves as long as the hull, the pressure that is linear in each cell errs
# by some 2 % on average
CELLS = 10.0
# Each evaluation of the law visits all triangles; this many take some milliseconds
MOST_TRIANGLES = 20_000
# Numbers of other effects that exert buoyancy
OTHERS = (
    ("hydrostatics", "heave"),
    ("hydrostatics", "roll"),
    ("hydrostatics", "pitch"),
    ("righting_arm", "stiffness"),
    ("righting_moment", "moment"),
)


@njit
def law(m: Any, q: Any, p: Array, first: Any) -> Wrench:
    """Return buoyancy and weight of a hull, from the pressure on the wetted part of its mesh.

    Args:
        m: Motion of the hull: velocities [m/s], rates [rad/s], position [m], attitude [rad].
        q: Parameters of the effect, with the names and units of its class.
        p: Parameters and tables of all effects.
        first: Index of the effect's table.

    Returns:
        Force [N] and moment [N m] in body axes.
    """
    f = hull_load(m, p, first)
    c = q.density * GRAVITY
    weight = q.mass * GRAVITY
    ct = cos(m.theta)
    X, Y, Z = -weight * sin(m.theta), weight * ct * sin(m.phi), weight * ct * cos(m.phi)
    return wrench(
        X=c * f.X + X,
        Y=c * f.Y + Y,
        Z=c * f.Z + Z,
        K=c * f.K - q.below * Y,
        M=c * f.M + q.below * X - q.ahead * Z,
        N=c * f.N + q.ahead * Y,
    )


def hull_mesh(path: str, scale: float) -> ClosedMesh:
    """Return the mesh of a hull with its lowest point at z = 0.

    Args:
        path: STL or OBJ file.
        scale: Length of a unit of the file [m].

    Raises:
        BadInput: It cannot be read, is not closed, or has too many triangles.
    """
    mesh = mesh_of_file(path, scale)
    if len(mesh.faces) > MOST_TRIANGLES:
        raise BadInput(
            f"{path}: {len(mesh.faces)} triangles; allowed in a simulation are {MOST_TRIANGLES}, "
            "and some hundred suffice for most hulls"
        )
    return mesh


@dataclass(frozen=True)
class HullBuoyancy(SeaParameters, Force):
    """Buoyancy of the submerged part of a hull's mesh, and its weight, at any heel and trim.

    F = -rho g integral_S h n dS + W,  h = z + sum_i a_i C_i(z) cos(theta_i),
    theta_i = w_i t - k_i (x cos gamma_i + y sin gamma_i) + epsilon_i

    S is the part of the mesh on which the pressure head h is positive, n its normal towards the
    water, z the depth below the still water, W the weight at the mass centre, and K, M and N are
    the moments about the origin of motion. C = exp(-k z), or cosh k (h - z) / cosh k h in water of
    a `depth` h; above the level of the still water C = 1. On still water force and moment are exact
    for the mesh. In waves the pressure is that of the undisturbed wave (Froude-Krylov), which is
    linear in each cell of the hull with edges of `cell`; triangles that are longer are divided. The
    hull may heel, take waves over its bow, and capsize.

    The effect takes the place of `hydrostatics`, `righting_arm` and `righting_moment`. The file
    `mesh` has x forward, y to port and z up, and the surface is closed. The sea is that of
    `irregular_sea`: `spectrum`, `significant_height`, `modal_period`, `toward` and the other
    parameters have the same meaning. Diffraction and added mass belong to other effects.
    """

    formula: ClassVar[str] = (
        r"\begin{aligned} \mathbf{f} &= -\rho g \int_{S, h > 0} h \, \mathbf{n} \, \mathrm{d}S + m "
        r"g \, \mathbf{e}_z, \quad \mathbf{m} = -\rho g \int_{S, h > 0} h \, \mathbf{r} \times "
        r"\mathbf{n} \, \mathrm{d}S + m g \, \mathbf{r}_G \times \mathbf{e}_z \\ h &= z + \sum_i "
        r"a_i C_i(z) \cos\theta_i, \quad \theta_i = \omega_i t - k_i \left((x - V_N t) "
        r"\cos\gamma_i + (y - V_E t) \sin\gamma_i\right) + \epsilon_i \end{aligned}"
    )
    symbols: ClassVar = {
        "toward": r"\gamma",
        "density": r"\rho",
        "mass": "m",
        "ahead": "x_G",
        "below": "z_G",
    }
    needs: ClassVar = ("heave",)
    ruled_out_by: ClassVar = {"no_water": (True,)}
    turns_over: ClassVar[bool] = True
    words: ClassVar[str] = "the water presses on the submerged part of the hull"
    shown_by: ClassVar[str] = "a release from a large heel"
    source: ClassVar[str] = (
        "T. I. Fossen, Handbook of Marine Craft Hydrodynamics, 2nd ed. 2021, section 4.1; "
        "O. M. Faltinsen, Sea Loads on Ships and Offshore Structures, 1990, chapter 2"
    )
    sees_table: ClassVar[bool] = True
    paths: ClassVar = ("mesh", "spectrum_file")
    law: ClassVar = law

    mesh: str = field(default="")  # STL or OBJ file of the closed hull
    scale: float = param(1.0, low=1e-6, high=1e6, unit="m", words="length of a unit of the mesh")
    origin: float = param(
        0.0, low=-500.0, high=500.0, unit="m", words="place of the origin of motion in the mesh"
    )
    draught: float = param(
        UNSET,
        low=-100.0,
        high=100.0,
        unit="m",
        words="height of the origin above the lowest point of the mesh; default: the draught at "
        "which the level hull displaces the mass",
    )
    mass: float = param(
        UNSET, low=0.0, high=1e12, unit="kg", words="mass of the boat", follows="vessel.body.mass"
    )
    ahead: float = param(
        UNSET,
        low=-250.0,
        high=250.0,
        unit="m",
        words="mass centre ahead of the origin; default: that of the vessel",
    )
    below: float = param(
        UNSET,
        low=-100.0,
        high=100.0,
        unit="m",
        words="mass centre below the origin; default: that of the vessel",
    )
    density: float = param(
        particulars.SEA_WATER, low=1.0, high=1500.0, unit="kg/m^3", words="density of the water"
    )
    cell: float = param(
        UNSET,
        low=1e-4,
        high=100.0,
        unit="m",
        words="edge of a cell in which the pressure of waves is linear; default: a tenth of the "
        "length of the mesh",
    )

    def placed_mesh(self) -> ClosedMesh:
        """Return the mesh in the axes of motion.

        Raises:
            BadInput: It cannot be read, is not closed, or has too many triangles.
        """
        return hull_mesh(self.mesh, self.scale).moved(-self.origin, 0.0, self.draught)

    def table(self) -> tuple[float, ...]:
        """Return the triangles of the hull and the waves, as the law reads them."""
        if not self.mesh:
            return CALM
        corners = self.placed_mesh().corners
        return tuple(panel_table(corners, self.cell, self.wave_field(), self.depth))

    def derived_parameters(self, vessel: Boat) -> dict[str, float]:
        """Return the mass centre of the vessel, the draught at its mass, and the size of cells.

        Args:
            vessel: Vessel on which the effect acts.
        """
        ahead, below = vessel.body.centre
        mesh = hull_mesh(self.mesh, self.scale)
        found = {"ahead": ahead, "below": below, "cell": mesh.length / CELLS}
        if not self.has_value("draught"):
            try:
                found["draught"] = depth_of_volume(mesh, self.mass / self.density)
            except BadInput as error:
                raise BadInput(f"{vessel.name}: {self.name}: {error}") from None
        return found

    def with_all_parameters(self, vessel: Boat) -> Self:
        """Return a copy of the effect in which every parameter has a value.

        Args:
            vessel: Vessel on which the effect acts.

        Raises:
            BadInput: There is no mesh, it is not closed, the vessel does not heave, or another
                effect exerts buoyancy.
        """
        if not self.mesh:
            raise BadInput(
                f"{vessel.name}: {self.name} needs mesh = an STL or OBJ file of the hull"
            )
        if "heave" not in vessel.dof:
            raise BadInput(f"{vessel.name}: {self.name} needs a vessel that is free to heave")
        for owner, key in OTHERS:
            other = vessel.effect(owner)
            if other is not None and other.has_value(key) and getattr(other, key) != 0.0:
                raise BadInput(
                    f"{vessel.name}: {self.name} takes the place of {owner}; set {owner}.{key} = 0"
                )
        return super().with_all_parameters(vessel)

    def wave_axes(self) -> tuple[str, ...]:
        """Return the degrees of freedom in which the sea exerts a force; empty if it is calm."""
        if self.significant_height == 0.0:
            return ()
        return AXES
