"""Panel wave loads: excitation and drift of a sea from coefficients over frequency and heading."""

from dataclasses import dataclass, field
from math import cos, pi, sin
from typing import Any, ClassVar

from numba import njit

from boatsim.errors import BadInput
from boatsim.physics.base import AXES, UNSET, Array, Boat, Force, Wrench, param, wrench
from boatsim.physics.coefficients.drift_pairs import (
    NO_PAIRS,
    added_wave,
    end_of_pairs,
    no_waves,
    pair_amplitudes,
    pair_products,
    pair_table,
    pair_weight,
)
from boatsim.physics.coefficients.excitation_grid import (
    end_of_grid,
    excitation_force,
    excitation_grid,
    mean_drift_force,
)
from boatsim.physics.coefficients.files import read_wave_loads
from boatsim.physics.waves.dispersion import wave_number
from boatsim.physics.waves.encounter import heading_of_waves
from boatsim.physics.waves.sea_parameters import SeaParameters
from boatsim.physics.waves.sea_state import (
    has_directions,
    sea_state,
    wave_component,
    wave_direction,
)

DEPTHS = (
    0.01  # relative difference of the depths of the sea and of the coefficients that is allowed
)
# The grid without coefficients: no force
EMPTY = (1.0, 1.0, 2.0, 2.0, *[0.0] * 60, *NO_PAIRS, 0.0)


@njit
def pair_drift(m: Any, q: Any, p: Array, table: Any, waves: Any) -> Wrench:
    """Return the slow drift of all pairs of waves of a sea.

    The sum over pairs is a sum over products of two sums over waves. Each pass over the waves has
    four products.

    Args:
        m: Motion of the hull.
        q: Parameters of the effect.
        p: Parameters and tables of all effects.
        table: Index of the table of the pairs.
        waves: Index of the table of a tabulated sea.

    Returns:
        Force [N] and moment [N m] in body axes.
    """
    X = Y = Z = K = M = N = 0.0
    sea = sea_state(q, p, waves)
    for group in range(int(p[table])):
        sums = no_waves()
        ahead, across, run = heading_of_waves(q.toward, m)
        for k in range(int(sea.number)):
            w, amplitude, phase = wave_component(k, q, sea, p, waves)
            if has_directions(q):
                ahead, across, run = heading_of_waves(wave_direction(k, q, p, waves), m)
            here = w * m.t - wave_number(w, q.depth) * run + phase + pi
            c, s = amplitude * cos(here), amplitude * sin(here)
            wave = pair_amplitudes(w, ahead, across, p, table, group)
            sums = added_wave(sums, wave, c, s)
        one, two, three, four = pair_products(sums)
        at = pair_weight(p, table, group)
        X += p[at] * one + p[at + 1] * two + p[at + 2] * three + p[at + 3] * four
        Y += p[at + 4] * one + p[at + 5] * two + p[at + 6] * three + p[at + 7] * four
        Z += p[at + 8] * one + p[at + 9] * two + p[at + 10] * three + p[at + 11] * four
        K += p[at + 12] * one + p[at + 13] * two + p[at + 14] * three + p[at + 15] * four
        M += p[at + 16] * one + p[at + 17] * two + p[at + 18] * three + p[at + 19] * four
        N += p[at + 20] * one + p[at + 21] * two + p[at + 22] * three + p[at + 23] * four
    return wrench(X=X, Y=Y, Z=Z, K=K, M=M, N=N)


@njit
def law(m: Any, q: Any, p: Array, first: Any) -> Wrench:
    """Return the force of a sea on the hull, a sum over wave components.

    The waves travel on the water, which moves with the current. The drift is the product of the
    complex elevation and the complex elevation with its components weighted by their mean drift,
    which equals the sum over pairs of components. With a table of pairs the drift is that of
    `pair_drift`.

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
    rise = turn = 0.0  # complex elevation at the origin of motion
    surge_rise = surge_turn = sway_rise = sway_turn = yaw_rise = yaw_turn = 0.0
    pairs = end_of_grid(p, first)
    waves = end_of_pairs(p, pairs)
    newman = q.drift > 0.0 and p[pairs] == 0.0
    sea = sea_state(q, p, waves)
    ahead, across, run = heading_of_waves(q.toward, m)
    for k in range(int(sea.number)):
        w, amplitude, phase = wave_component(k, q, sea, p, waves)
        if has_directions(q):
            ahead, across, run = heading_of_waves(wave_direction(k, q, p, waves), m)
        # Components have a trough at phase 0
        here = w * m.t - wave_number(w, q.depth) * run + phase + pi
        c, s = cos(here), sin(here)
        f = excitation_force(w, ahead, across, c, s, p, first)
        X += amplitude * f.X
        Y += amplitude * f.Y
        Z += amplitude * f.Z
        K += amplitude * f.K
        M += amplitude * f.M
        N += amplitude * f.N
        if newman:
            surge, sway, yaw = mean_drift_force(w, ahead, across, p, first)
            c, s = amplitude * c, amplitude * s
            rise, turn = rise + c, turn + s
            surge_rise, surge_turn = surge_rise + surge * c, surge_turn + surge * s
            sway_rise, sway_turn = sway_rise + sway * c, sway_turn + sway * s
            yaw_rise, yaw_turn = yaw_rise + yaw * c, yaw_turn + yaw * s
    X += q.drift * (rise * surge_rise + turn * surge_turn)
    Y += q.drift * (rise * sway_rise + turn * sway_turn)
    N += q.drift * (rise * yaw_rise + turn * yaw_turn)
    if q.drift > 0.0 and not newman:
        slow = pair_drift(m, q, p, pairs, waves)
        X += q.drift * slow.X
        Y += q.drift * slow.Y
        Z += q.drift * slow.Z
        K += q.drift * slow.K
        M += q.drift * slow.M
        N += q.drift * slow.N
    return wrench(X=X, Y=Y, Z=Z, K=K, M=M, N=N)


@dataclass(frozen=True)
class PanelWaveLoads(SeaParameters, Force):
    """Forces and drift of the waves of a spectrum, from a table of a boundary element method.

    tau_j = Re sum_i a_i X_j(w_i, beta_i) exp(i theta_i)
          + f sum_i sum_k a_i a_k (D_j(w_i, beta_i) + D_j(w_k, beta_k)) / 2 cos(theta_i - theta_k),
    theta_i = w_i t - k_i (x cos gamma_i + y sin gamma_i) + epsilon_i

    X is the excitation of a wave of unit amplitude: pressure of the undisturbed wave and
    diffraction, at the forward speed of the coefficients, at rest by default. It does not change
    with the speed of the hull, which meets the waves at the frequency of encounter because it moves
    through them. beta = gamma - psi is the direction of the wave relative to the hull. D is the
    mean drift of a wave of unit amplitude in surge, sway and yaw, and `drift` is the factor f on
    the mean and slowly varying drift: 1 for the whole drift, 0 for none. The double
    sum is Newman's approximation. If the folder has a drift_pairs.csv, the drift is that of the
    full quadratic transfer functions D(w_i, w_k) of its pairs of waves instead, the real part of
    f sum_i sum_k a_i a_k D_j(w_i, w_k, beta) exp(i (theta_i - theta_k)), in all axes that it has.
    `coefficients` is the folder that `boatsim hydrodynamics` writes, about the vessel's origin of
    motion: for a hull, or for a table of response amplitude operators. The sea is that of
    `irregular_sea`: `spectrum`, `significant_height`, `modal_period`, `toward` and the other
    parameters have the same meaning.
    Below the lowest frequency of the table excitation and drift are those of the lowest one; above
    the highest the excitation is zero and the drift is that of the highest one.
    """

    formula: ClassVar[str] = (
        r"\begin{aligned} \tau_j &= \operatorname{Re} \sum_i a_i X_j(\omega_i, \gamma_i - \psi) "
        r"\, e^{\mathrm{i} \theta_i} + f \sum_i \sum_k a_i a_k \tfrac{1}{2} \left(D_j(\omega_i, "
        r"\gamma_i - \psi) + D_j(\omega_k, \gamma_k - \psi)\right) \cos(\theta_i - \theta_k), "
        r"\quad j = 1, \ldots, 6 \\ \theta_i &= \omega_i t - k_i \left("
        r"(x - V_N t) \cos\gamma_i + (y - V_E t) \sin\gamma_i\right) + \epsilon_i, \quad "
        r"\omega_i^2 = g k_i \tanh k_i h \end{aligned}"
    )
    symbols: ClassVar = {"toward": r"\gamma", "depth": "h", "drift": "f"}
    ruled_out_by: ClassVar = {"no_waves": (True,), "no_water": (True,)}
    words: ClassVar[str] = "waves exert forces on the hull in all degrees of freedom"
    shown_by: ClassVar[str] = "lying at several headings to the sea"
    source: ClassVar[str] = (
        "J. N. Newman, Marine Hydrodynamics, 1977, section 6.18; "
        "T. I. Fossen, Handbook of Marine Craft Hydrodynamics, 2nd ed. 2021, section 10.2; "
        "drift: J. N. Newman, Second-order, slowly-varying forces on vessels in irregular waves, "
        "Int. Symp. Dynamics of Marine Vehicles and Structures in Waves, London 1974; "
        "O. M. Faltinsen, Sea Loads on Ships and Offshore Structures, 1990, section 5.2"
    )
    sees_table: ClassVar[bool] = True
    paths: ClassVar = ("coefficients", "spectrum_file")
    law: ClassVar = law

    coefficients: str = field(default="")  # folder that `boatsim hydrodynamics` writes
    depth: float = param(
        UNSET,
        low=0.0,
        high=11000.0,
        unit="m",
        words="depth of the water, 0: deep water; default: that of the coefficients",
    )

    drift: float = param(
        0.0,
        low=0.0,
        high=10.0,
        unit="",
        words="factor on the mean and slowly varying drift; 1: as computed, 0: none",
    )

    def table(self) -> tuple[float, ...]:
        """Return excitation and drift on grids of frequency and heading, and a tabulated sea."""
        if not self.coefficients:
            return EMPTY
        found = read_wave_loads(self.coefficients)
        grid = excitation_grid(found, self.coefficients)
        if found.drift_pairs is None:
            return (*grid, *NO_PAIRS, *self.sea_table())
        pairs = pair_table(found.drift_pairs, self.coefficients)
        return (*grid, *pairs, *self.sea_table())

    def derived_parameters(self, vessel: Boat) -> dict[str, float]:
        """Return the depth of the coefficients.

        Args:
            vessel: Vessel on which the effect acts.
        """
        return {"depth": read_wave_loads(self.coefficients).depth}

    def with_all_parameters(self, vessel: Boat) -> "PanelWaveLoads":
        """Return a copy of the effect in which every parameter has a value.

        Args:
            vessel: Vessel on which the effect acts.

        Raises:
            BadInput: No coefficients are given, they hold for another depth of the water, or they
                lack the mean drift that the effect needs.
        """
        if not self.coefficients:
            raise BadInput(
                f"{vessel.name}: {self.name} needs coefficients = the folder that boatsim "
                "hydrodynamics writes"
            )
        own = super().with_all_parameters(vessel)
        found = read_wave_loads(own.coefficients)
        if abs(own.depth - found.depth) > DEPTHS * found.depth:
            raise BadInput(
                f"{vessel.name}: {self.name}.depth = {own.depth:g} m; the coefficients hold for "
                f"{found.depth:g} m (0 is deep water)"
            )
        if own.drift > 0.0 and found.drift is None and found.drift_pairs is None:
            raise BadInput(
                f"{vessel.name}: {self.name}.drift = {own.drift:g}; {own.coefficients} has no "
                "drift.csv, which boatsim hydrodynamics writes for a mesh, and no drift_pairs.csv"
            )
        own.table()  # a table that cannot be used is refused when the vessel is loaded
        return own

    def wave_axes(self) -> tuple[str, ...]:
        """Return the degrees of freedom in which the sea exerts a force; empty if it is calm."""
        if self.significant_height == 0.0:
            return ()
        return AXES

    def excitation_speed(self) -> float:
        """Return the forward speed of the coefficients [m/s]; 0 if the sea is calm."""
        if self.significant_height == 0.0 or not self.coefficients:
            return 0.0
        return read_wave_loads(self.coefficients).speed
