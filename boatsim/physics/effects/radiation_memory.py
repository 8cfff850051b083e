"""Radiation memory: added mass at infinite frequency and the memory of radiated waves."""

from dataclasses import dataclass, field
from typing import Any, ClassVar

from numba import njit

from boatsim.errors import BadInput
from boatsim.physics.base import (
    UNSET,
    Array,
    Boat,
    Inertia,
    MassMatrix,
    MotionMemory,
    Wrench,
    mass_matrix,
    param,
    wrench,
)
from boatsim.physics.coefficients.files import read_coefficients
from boatsim.physics.coefficients.memory_step import (
    FACTORS,
    FORCES,
    HEAD,
    OSCILLATORS,
    SIGNALS,
    advance_sections,
    store_momentum,
)
from boatsim.physics.signals import MASS_ENTRIES


@njit(inline="always")
def inertia(q: Any) -> MassMatrix:
    """Return the added mass matrix at infinite frequency.

    Args:
        q: Parameters of the effect, with the names and units of its class.

    Returns:
        Entries of the mass matrix [kg, kg m, kg m^2] about the origin of motion.
    """
    return mass_matrix(
        surge=q.surge,
        sway=q.sway,
        heave=q.heave,
        roll=q.roll,
        pitch=q.pitch,
        yaw=q.yaw,
        surge_heave=q.surge_heave,
        surge_pitch=q.surge_pitch,
        heave_pitch=q.heave_pitch,
        sway_roll=q.sway_roll,
        sway_yaw=q.sway_yaw,
        roll_yaw=q.roll_yaw,
    )


@njit
def remember_motion(
    m: Any,
    act: Array,
    held: Any,
    own: Any,
    memory: Array,
    at: Any,
    dt: float,
    q: Any,
    p: Array,
    first: Any,
) -> None:
    """Advance the states of the radiated waves to the begin of a step.

    Args:
        m: Motion of the hull at the begin of the step.
        act: Signals of the laws; the forces of the step are stored in them.
        held: Number of signals in a row.
        own: Index of the first signal of the effect.
        memory: States of all effects.
        at: Index of the first state of the effect.
        dt: Length of the step that begins [s].
        q: Parameters of the effect.
        p: Parameters and tables of all effects.
        first: Index of the effect's table.
    """
    speeds = (m.ur, m.wr, m.q, m.vr, m.p, m.r)
    advance_sections(speeds, act, held, own, memory, at, dt, p, first)
    if q.forward_speed != 0.0:
        store_momentum(act, held, own, memory, at, p, first)


@njit
def law(m: Any, q: Any, act: Array, at: Any, own: Any, p: Array, first: Any) -> Wrench:
    """Return the force of the radiated waves, and the Coriolis force of the added mass.

    With the terms of forward speed the momentum of the memory in heave and sway has a Coriolis
    force too, as far as it contains the forward speed.

    Args:
        m: Motion of the hull: velocities [m/s], rates [rad/s], position [m], attitude [rad].
        q: Parameters of the effect, with the names and units of its class.
        act: Signals of the laws.
        at: Index of the row of the signals.
        own: Index of the first signal of the effect in the row.
        p: Parameters and tables of all effects.
        first: Index of the effect's table.

    Returns:
        Force [N] and moment [N m] in body axes.
    """
    c, f = q.coriolis, at + own
    along = c * (q.surge * m.ur + q.surge_heave * m.wr + q.surge_pitch * m.q)
    across = c * (q.sway * m.vr + q.sway_roll * m.p + q.sway_yaw * m.r)
    down = c * (q.surge_heave * m.ur + q.heave * m.wr + q.heave_pitch * m.q)
    rolling = c * (q.sway_roll * m.vr + q.roll * m.p + q.roll_yaw * m.r)
    pitching = c * (q.surge_pitch * m.ur + q.heave_pitch * m.wr + q.pitch * m.q)
    turning = c * (q.sway_yaw * m.vr + q.roll_yaw * m.p + q.yaw * m.r)
    g = f + 6
    X = act[f] + act[g] * m.ur + act[g + 1] * m.wr + act[g + 2] * m.q
    Z = act[f + 1] + act[g + 1] * m.ur + act[g + 3] * m.wr + act[g + 4] * m.q
    M = act[f + 2] + act[g + 2] * m.ur + act[g + 4] * m.wr + act[g + 5] * m.q
    g = f + 12
    Y = act[f + 3] + act[g] * m.vr + act[g + 1] * m.p + act[g + 2] * m.r
    K = act[f + 4] + act[g + 1] * m.vr + act[g + 3] * m.p + act[g + 4] * m.r
    N = act[f + 5] + act[g + 2] * m.vr + act[g + 4] * m.p + act[g + 5] * m.r
    if q.forward_speed != 0.0:
        g = f + FORCES
        heaved = act[g] + act[g + 2] * m.ur + act[g + 3] * m.wr + act[g + 4] * m.q
        swayed = act[g + 1] + act[g + 5] * m.vr + act[g + 6] * m.p + act[g + 7] * m.r
        X += q.forward_speed * (heaved * m.q - swayed * m.r)
        M -= q.forward_speed * heaved * m.ur
        N += q.forward_speed * swayed * m.ur
    return wrench(
        X=across * m.r - down * m.q - X,
        Y=down * m.p - along * m.r - Y,
        Z=along * m.q - across * m.p - Z,
        K=across * m.wr - down * m.vr + pitching * m.r - turning * m.q - K,
        M=down * m.ur - along * m.wr + turning * m.p - rolling * m.r - M,
        N=along * m.vr - across * m.ur + rolling * m.q - pitching * m.p - N,
    )


def entry_parameter(symbol: str, unit: str, least: float) -> float:
    """Declare an entry of the added mass matrix at infinite frequency.

    Args:
        symbol: Symbol of the entry, such as "A_11".
        unit: Its unit.
        least: Lower bound.
    """
    return param(
        UNSET,
        low=least,
        high=1e13,
        unit=unit,
        words=f"{symbol} at infinite frequency; default: that of the coefficients",
    )


@dataclass(frozen=True)
class RadiationMemory(Inertia, MotionMemory):
    """Radiation force of a hull by Cummins' equation: the water remembers how the hull moved.

    tau = -A_inf nu_r' - coriolis C_A(nu_r) nu_r - integral K(t - s) nu_r(s) ds

    A_inf is the added mass at infinite frequency, K the retardation function of the added mass and
    damping over frequency. The integral is computed by the states of a passive model that `boatsim
    hydrodynamics` fits to them, K(s) = sum (s M + N) / (s^2 + a s + b). `coefficients` is the
    folder that this command writes, about the vessel's origin of motion. The effect replaces
    `added_mass`, and the part of `linear_damping` that is radiation of waves.

    At forward speed the water that the hull has set in motion carries momentum along. That of A_inf
    is part of the Coriolis force; `forward_speed` = f adds that of the memory in sway and heave,
    lambda = integral of the memory's force mu over time:

    X = f (lambda_2 r - lambda_3 q),  M = f u_r lambda_3,  N = -f u_r lambda_2

    These terms exert no power in total. With f = 1 the equations contain the added mass and damping
    at forward speed of the strip theory of Salvesen, Tuck and Faltinsen, for a hull without
    transom.
    """

    formula: ClassVar[str] = (
        r"\begin{aligned} \tau &= -\mathbf{A}_\infty \dot{\nu_r} - c \, \mathbf{C}_A(\nu_r) "
        r"\nu_r - \mu + f \, \left(\lambda_2 r - \lambda_3 q, 0, 0, 0, u_r \lambda_3, -u_r "
        r"\lambda_2\right) \\ \mu &= \int_0^t \mathbf{K}(t - s) \, \nu_r(s) \, \mathrm{d}s, "
        r"\quad \lambda = \int_0^t \mu(s) \, \mathrm{d}s "
        r"\\ \mathbf{K}(\mathrm{i} \omega) &= \mathbf{B}(\omega) + \mathrm{i} \omega \left("
        r"\mathbf{A}(\omega) - \mathbf{A}_\infty\right) \approx \sum_k \frac{\mathrm{i} \omega "
        r"\mathbf{M}_k + \mathbf{N}_k}{b_k - \omega^2 + \mathrm{i} a_k \omega} \end{aligned}"
    )
    symbols: ClassVar = {
        "surge": r"A_{\infty,11}",
        "sway": r"A_{\infty,22}",
        "heave": r"A_{\infty,33}",
        "roll": r"A_{\infty,44}",
        "pitch": r"A_{\infty,55}",
        "yaw": r"A_{\infty,66}",
        "surge_heave": r"A_{\infty,13}",
        "surge_pitch": r"A_{\infty,15}",
        "heave_pitch": r"A_{\infty,35}",
        "sway_roll": r"A_{\infty,24}",
        "sway_yaw": r"A_{\infty,26}",
        "roll_yaw": r"A_{\infty,46}",
        "coriolis": "c",
        "forward_speed": "f",
    }
    ruled_out_by: ClassVar = {"no_water": (True,)}
    words: ClassVar[str] = "the waves that the hull radiates act on it later"
    shown_by: ClassVar[str] = "oscillations in heave, roll and pitch at several frequencies"
    source: ClassVar[str] = (
        "W. E. Cummins, The impulse response function and ship motions, Schiffstechnik 9, 1962; "
        "T. I. Fossen, Handbook of Marine Craft Hydrodynamics, 2nd ed. 2021, section 5.4; "
        "forward speed: N. Salvesen, E. O. Tuck and O. Faltinsen, Ship motions and sea loads, "
        "Transactions of SNAME 78, 1970; T. Perez and T. I. Fossen, Kinematic models for "
        "manoeuvring and seakeeping of marine vessels, Modeling, Identification and Control 28(1), "
        "2007"
    )
    moves_with: ClassVar[str] = "water"
    memory_signals: ClassVar[int] = SIGNALS
    paths: ClassVar = ("coefficients",)
    inertia: ClassVar = inertia
    law: ClassVar = law
    remember_motion: ClassVar = remember_motion

    coefficients: str = field(default="")  # folder that `boatsim hydrodynamics` writes
    surge: float = entry_parameter("A_11", "kg", 0.0)
    sway: float = entry_parameter("A_22", "kg", 0.0)
    heave: float = entry_parameter("A_33", "kg", 0.0)
    roll: float = entry_parameter("A_44", "kg m^2", 0.0)
    pitch: float = entry_parameter("A_55", "kg m^2", 0.0)
    yaw: float = entry_parameter("A_66", "kg m^2", 0.0)
    surge_heave: float = entry_parameter("A_13", "kg", -1e13)
    surge_pitch: float = entry_parameter("A_15", "kg m", -1e13)
    heave_pitch: float = entry_parameter("A_35", "kg m", -1e13)
    sway_roll: float = entry_parameter("A_24", "kg m", -1e13)
    sway_yaw: float = entry_parameter("A_26", "kg m", -1e13)
    roll_yaw: float = entry_parameter("A_46", "kg m^2", -1e13)
    coriolis: float = param(
        1.0, low=-1.0, high=3.0, unit="", words="factor on the Coriolis force; 1: as the theory"
    )
    forward_speed: float = param(
        0.0,
        low=0.0,
        high=1.0,
        unit="",
        words="factor on the memory's terms of forward speed; 1: as strip theory, 0: none",
    )

    def table(self) -> tuple[float, ...]:
        """Return the numbers of sections of both sets of axes, then all sections."""
        if not self.coefficients:
            return (0.0, 0.0)
        memory = read_coefficients(self.coefficients).memory
        if memory is None:
            return (0.0, 0.0)
        upright, sideways = memory.sections
        counts = (float(len(upright)), float(len(sideways)))
        return (*counts, *upright.ravel().tolist(), *sideways.ravel().tolist())

    def radiates_as_at_rest(self) -> bool:
        """Return whether the memory has no terms of forward speed."""
        return self.forward_speed == 0.0

    @property
    def memory_states(self) -> int:
        """Number of floats stored from step to step: oscillators, factors and last velocities."""
        counts = self.table()[:2]
        return HEAD + int(sum(counts)) * (FACTORS + OSCILLATORS)

    def derived_parameters(self, vessel: Boat) -> dict[str, float]:
        """Return the added mass at infinite frequency of the coefficients.

        Args:
            vessel: Vessel on which the effect acts.

        Raises:
            BadInput: No coefficients are given, they have no memory, or the vessel has a constant
                added mass too.
        """
        if not self.coefficients:
            raise BadInput(
                f"{vessel.name}: {self.name} needs coefficients = the folder that boatsim "
                "hydrodynamics writes"
            )
        constant = vessel.effect("added_mass")
        if isinstance(constant, Inertia) and constant.matrix().any():
            raise BadInput(
                f"{vessel.name}: {self.name} contains the added mass; remove {constant.name} or "
                "set all of its masses to 0"
            )
        found = read_coefficients(self.coefficients)
        if found.memory is None:
            raise BadInput(f"{self.coefficients}: there is no memory.csv")
        entries = {}
        for name, (i, j) in zip(MassMatrix._fields, MASS_ENTRIES, strict=True):
            entries[name] = float(found.infinite_added_mass[i, j])
        return entries
