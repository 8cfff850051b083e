"""Damping: hydrodynamic resistance proportional to a power of the speed in each axis."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import (
    AXES,
    CoefficientRelease,
    Force,
    ParameterChanges,
    Wrench,
    factor_parameter,
    param,
    preset_effect,
    replacement_parameter,
    shift_parameter,
    wrench,
)

# a strongly nonlinear start in one axis impairs the fit of the others
NEARLY_LINEAR = {"surge_exponent": 1.001, "sway_exponent": 1.001, "yaw_exponent": 1.001}
ITTC = "ITTC Recommended Procedure 7.5-02-07-04.5, Estimation of Roll Damping"


@njit(inline="always")
def speed_power_law(speed: float, exponent: float, equal: float) -> float:
    """Return the power law speed (|speed| / equal)^(exponent - 1) of a damping force.

    The law replaces the speed in a linear damping. Exponents 1, 2 and 3 are evaluated by products.

    Args:
        speed: Velocity of the axis [m/s or rad/s].
        exponent: Power of the speed [-].
        equal: Speed at which all exponents give the same force [m/s or rad/s].
    """
    if exponent == 1.0:
        return speed
    if exponent == 2.0:
        return speed * abs(speed) / equal
    if exponent == 3.0:
        return speed * speed * speed / (equal * equal)
    return float(speed * (abs(speed) / equal) ** (exponent - 1.0))


@njit(inline="always")
def law(m: Any, q: Any) -> Wrench:
    """Return the hydrodynamic damping force on the hull, -D nu_r with a power law in each axis.

    Each speed is raised to the exponent of its axis. The sway damping acts on the cross flow at its
    own place, v_r + sway_at r.

    Args:
        m: Motion of the hull: velocities [m/s], rates [rad/s], position [m], attitude [rad].
        q: Parameters of the effect, with the names and units of its class.

    Returns:
        Force [N] and moment [N m] in body axes.
    """
    Y = -q.sway * speed_power_law(m.vr + q.sway_at * m.r, q.sway_exponent, q.sway_equal)
    return wrench(
        X=-q.surge * speed_power_law(m.ur, q.surge_exponent, q.surge_equal),
        Y=Y - q.sway_by_yaw * m.r,
        Z=-q.heave * speed_power_law(m.wr, q.heave_exponent, q.heave_equal),
        K=-q.roll * speed_power_law(m.p, q.roll_exponent, q.roll_equal),
        M=-q.pitch * speed_power_law(m.q, q.pitch_exponent, q.pitch_equal),
        N=-q.yaw * speed_power_law(m.r, q.yaw_exponent, q.yaw_equal)
        - q.yaw_by_sway * m.vr
        + q.sway_at * Y,
    )


def exponent_parameter(axis: str) -> float:
    """Declare the exponent of the speed in one axis's damping as a parameter of an effect."""
    return param(
        1.0, low=1.0, high=3.0, unit="", words=f"power of the speed in {axis}; 1: linear", axis=axis
    )


def equal_speed_parameter(axis: str, unit: str) -> float:
    """Declare the speed at which a power-law damping equals the linear law as a parameter."""
    return param(
        1.0,
        low=0.01,
        high=20.0,
        unit=unit,
        words="speed at which the power law equals the linear law",
        axis=axis,
    )


@dataclass(frozen=True)
class LinearDamping(Force):
    """Damping of slow or small motion: skin friction, wave making and hull lift at small angles.

    X_i = -d_i nu_i (|nu_i| / e_i)^(n_i - 1)

    With exponents n_i = 1 this is tau = -D nu_r, d_i = -X_u, -Y_v, -Z_w, -K_p, -M_q, -N_r.
    `sway_by_yaw` = -Y_r and `yaw_by_sway` = -N_v are linear couplings; `sway_at` [m] is the place
    at which the sway damping acts. e_i is the speed at which a power law equals the linear one.
    """

    formula: ClassVar[str] = (
        r"\begin{aligned} X &= -d_u f(u_r), \quad Z = -d_w f(w_r), \quad K = -d_p f(p), "
        r"\quad M = -d_q f(q) \\ Y &= Y_a + Y_r r, \quad N = -d_r f(r) + N_v v_r + a \, "
        r"Y_a, \quad Y_a = -d_v f(v_r + a r) \\ f(\nu) &= \nu "
        r"\left(\frac{|\nu|}{e}\right)^{n - 1} \end{aligned}"
    )
    symbols: ClassVar = {
        "surge": "d_u",
        "sway": "d_v",
        "heave": "d_w",
        "roll": "d_p",
        "pitch": "d_q",
        "yaw": "d_r",
        "sway_by_yaw": "-Y_r",
        "yaw_by_sway": "-N_v",
        "sway_at": "a",
    }
    words: ClassVar[str] = "the water resists in proportion to the speed"
    refines: ClassVar[str] = "damping"
    shown_by: ClassVar[str] = "coasting down from a low speed"
    source: ClassVar[str] = (
        "T. I. Fossen, Handbook of Marine Craft Hydrodynamics, 2nd ed. 2021, section 6.4"
    )
    law: ClassVar = law

    surge: float = param(
        0.0, low=0.0, high=1e9, unit="N s/m", words="-X_u", calibrates="damping", axis="surge"
    )
    sway: float = param(
        0.0, low=0.0, high=1e9, unit="N s/m", words="-Y_v", calibrates="damping", axis="sway"
    )
    yaw: float = param(
        0.0, low=0.0, high=1e13, unit="N m s", words="-N_r", calibrates="damping", axis="yaw"
    )
    roll: float = param(
        0.0, low=0.0, high=1e13, unit="N m s", words="-K_p", calibrates="damping", axis="roll"
    )
    heave: float = param(
        0.0, low=0.0, high=1e9, unit="N s/m", words="-Z_w", calibrates="damping", axis="heave"
    )
    pitch: float = param(
        0.0, low=0.0, high=1e13, unit="N m s", words="-M_q", calibrates="damping", axis="pitch"
    )
    sway_by_yaw: float = param(
        0.0, low=-1e11, high=1e11, unit="N s", words="-Y_r", calibrates="damping"
    )
    yaw_by_sway: float = param(
        0.0, low=-1e11, high=1e11, unit="N s", words="-N_v", calibrates="damping"
    )
    sway_at: float = param(
        0.0,
        low=-200.0,
        high=200.0,
        unit="m",
        words="place of the sway damping, ahead of the origin",
    )
    surge_exponent: float = exponent_parameter("surge")
    sway_exponent: float = exponent_parameter("sway")
    yaw_exponent: float = exponent_parameter("yaw")
    roll_exponent: float = exponent_parameter("roll")
    heave_exponent: float = exponent_parameter("heave")
    pitch_exponent: float = exponent_parameter("pitch")
    surge_equal: float = equal_speed_parameter("surge", "m/s")
    sway_equal: float = equal_speed_parameter("sway", "m/s")
    yaw_equal: float = equal_speed_parameter("yaw", "rad/s")
    roll_equal: float = equal_speed_parameter("roll", "rad/s")
    heave_equal: float = equal_speed_parameter("heave", "m/s")
    pitch_equal: float = equal_speed_parameter("pitch", "rad/s")


PLAIN = dict.fromkeys(("sway_by_yaw", "yaw_by_sway", "sway_at"), 0.0) | {
    f"{axis}_equal": 1.0 for axis in AXES
}


def power_law_damping_parameters(
    word: str, power: int, **spreads: float
) -> dict[str, ParameterChanges]:
    """Return the free parameters of damping that grows with a power of the speed, by axis.

    Args:
        word: Word for the power, "quadratic" for example.
        power: The power.
        spreads: Prior standard deviation of each axis.
    """
    frees: dict[str, ParameterChanges] = {}
    for axis, spread in spreads.items():
        unit = f"N m s^{power}" if axis in ("roll", "pitch", "yaw") else f"N s^{power}/m^{power}"
        words = f"{word} {axis} damping"
        frees[axis] = {"unit": unit, "words": words, "spread": spread, "calibrates": "damping"}
    return frees


QuadraticDamping = preset_effect(
    LinearDamping,
    "QuadraticDamping",
    formula=(
        r"\begin{aligned} X &= -d_u |u_r| u_r, \quad Y = -d_v |v_r| v_r, \quad Z = -d_w "
        r"|w_r| w_r \\ K &= -d_p |p| p, \quad M = -d_q |q| q, \quad N = -d_r |r| r "
        r"\end{aligned}"
    ),
    symbols={
        "surge": "d_u",
        "sway": "d_v",
        "heave": "d_w",
        "roll": "d_p",
        "pitch": "d_q",
        "yaw": "d_r",
    },
    words="damping grows with the square of the speed",
    shown_by="the same motion at a large and at a small amplitude",
    source=ITTC,
    frees=power_law_damping_parameters(
        "quadratic", 2, surge=4.0, sway=40.0, yaw=1.5, roll=0.1, heave=40.0, pitch=1.5
    ),
    fixed=PLAIN | {f"{axis}_exponent": 2.0 for axis in AXES},
)

CubicDamping = preset_effect(
    LinearDamping,
    "CubicDamping",
    formula=(
        r"\begin{aligned} X &= -d_u u_r^3, \quad Y = -d_v v_r^3, \quad Z = -d_w w_r^3 \\ "
        r"K &= -d_p p^3, \quad M = -d_q q^3, \quad N = -d_r r^3 \end{aligned}"
    ),
    symbols={
        "surge": "d_u",
        "sway": "d_v",
        "heave": "d_w",
        "roll": "d_p",
        "pitch": "d_q",
        "yaw": "d_r",
    },
    words="damping grows with the cube of the speed",
    shown_by="the same motion at a large and at a small amplitude",
    source=ITTC,
    frees=power_law_damping_parameters(
        "cubic", 3, surge=4.0, sway=40.0, yaw=1.5, roll=0.003, heave=40.0, pitch=1.5
    ),
    fixed=PLAIN | {f"{axis}_exponent": 3.0 for axis in AXES},
)


@dataclass(frozen=True)
class DampingError(CoefficientRelease):
    """Damping that differs from its specified value by a factor in each axis.

    The factor scales the linear damping or, for a hull without one, the equivalent coefficient of
    its own model.
    """

    formula: ClassVar[str] = r"d_i = k_i \, d_i^0, \quad i = u, v, r, p, w, q"
    symbols: ClassVar = {
        "surge_factor": "k_u",
        "sway_factor": "k_v",
        "yaw_factor": "k_r",
        "roll_factor": "k_p",
        "heave_factor": "k_w",
        "pitch_factor": "k_q",
    }
    words: ClassVar[str] = (
        "the damping coefficients differ from their values by more than their specified uncertainty"
    )
    refines: ClassVar[str] = "damping"
    shown_by: ClassVar[str] = "coasting down in each axis"

    surge_factor: float = factor_parameter(
        "linear_damping.surge|surge_drag.linear|approach_balance.damping|mmg_hull.R_0"
        "|abkowitz_hull.X_u|mmg_low_speed_hull.X_0F",
        "surge_drag.quadratic",
        "quadratic_damping.surge",
        words="factor on the surge damping",
        in_per_cent="the damping in surge is {share} of its value in the vessel file",
        axis="surge",
    )
    sway_factor: float = factor_parameter(
        "linear_damping.sway|linear_hull.sway|mmg_hull.Y_v|abkowitz_hull.Y_v|mmg_low_speed_hull.C_D"
        "|cross_flow_drag.section_drag_coefficient",
        "quadratic_damping.sway",
        words="factor on the sway damping",
        in_per_cent="the damping in sway is {share} of its value in the vessel file",
        axis="sway",
    )
    yaw_factor: float = factor_parameter(
        "linear_damping.yaw|linear_hull.yaw|mmg_hull.N_r|abkowitz_hull.N_r|mmg_low_speed_hull.N_r",
        "quadratic_damping.yaw",
        words="factor on the yaw damping",
        in_per_cent="the damping in yaw is {share} of its value in the vessel file",
        axis="yaw",
    )
    roll_factor: float = factor_parameter(
        "linear_damping.roll|roll_damping.roll",
        "quadratic_damping.roll",
        words="factor on the roll damping",
        in_per_cent="the damping in roll is {share} of its value in the vessel file",
        axis="roll",
    )
    heave_factor: float = factor_parameter(
        "linear_damping.heave",
        "quadratic_damping.heave",
        words="factor on the heave damping",
        in_per_cent="the damping in heave is {share} of its value in the vessel file",
        axis="heave",
    )
    pitch_factor: float = factor_parameter(
        "linear_damping.pitch",
        "quadratic_damping.pitch",
        words="factor on the pitch damping",
        in_per_cent="the damping in pitch is {share} of its value in the vessel file",
        axis="pitch",
    )


@dataclass(frozen=True)
class LateralCentreShift(CoefficientRelease):
    """Shift of the centre of the linear sway damping, by skeg, trim or load."""

    formula: ClassVar[str] = (
        r"a = a^0 + \mathrm{shift}, \quad Y = -d_v (v_r + a r), \quad N = a \, Y"
    )
    needs: ClassVar = ("sway", "yaw")
    ruled_out_by: ClassVar = {"no_water": (True,)}
    words: ClassVar[str] = "the lateral resistance acts ahead of or behind the mass centre"
    refines: ClassVar[str] = "mass_centre"
    shown_by: ClassVar[str] = "pushing sideways, and coasting after a turn"
    source: ClassVar[str] = (
        "T. I. Fossen, Handbook of Marine Craft Hydrodynamics, 2nd ed. 2021, section 6.4 (Y_r, N_v)"
    )

    shift: float = shift_parameter(
        "linear_damping.sway_at",
        words="shift of the centre, positive forward",
        unit="m",
        spread=0.1,
        low=-200.0,
        high=200.0,
        within=(-0.6, 0.6),
    )


def replaced_exponent_parameter(axis: str) -> float:
    """Declare the exponent that replaces the linear law of one axis's damping as a parameter.

    It belongs to a hypothesis that a diagnosis tests.
    """
    return replacement_parameter(
        f"linear_damping.{axis}_exponent",
        words=f"exponent of the {axis} damping",
        unit="",
        spread=0.5,
        low=1.0,
        high=3.0,
        inactive_value=1.0,
        axis=axis,
    )


def agreement_speed_parameter(axis: str, unit: str) -> float:
    """Declare the speed at which the linear and the power-law damping agree as a parameter.

    It belongs to a hypothesis that a diagnosis tests.
    """
    return replacement_parameter(
        f"linear_damping.{axis}_equal",
        words="speed at which both laws agree",
        unit=unit,
        spread=0.5,
        low=0.01,
        high=20.0,
        inactive_value=1.0,
        axis=axis,
    )


@dataclass(frozen=True)
class DampingExponent(CoefficientRelease):
    """Power law d |x|^n sign(x) in place of the linear damping of the vessel.

    Both laws agree at one speed of each axis (`surge_equal`, `sway_equal`, `yaw_equal`).
    """

    formula: ClassVar[str] = (
        r"X_i = -d_i^0 \, \nu_i \left(\frac{|\nu_i|}{e_i}\right)^{n_i - 1}, \quad i = u, "
        r"v, r"
    )
    symbols: ClassVar = {
        "surge_exponent": "n_u",
        "sway_exponent": "n_v",
        "yaw_exponent": "n_r",
        "surge_equal": "e_u",
        "sway_equal": "e_v",
        "yaw_equal": "e_r",
    }
    words: ClassVar[str] = "damping follows a power of the speed other than the first"
    refines: ClassVar[str] = "damping"
    shown_by: ClassVar[str] = "the same motion at a large and at a small amplitude"
    source: ClassVar[str] = "Y. Huang and Z. Ji, Autonomous boat dynamics, eqs 4-6: d sign(x) |x|^a"
    strength: ClassVar = ("surge_exponent", "sway_exponent", "yaw_exponent")
    starts: ClassVar = tuple(
        {**NEARLY_LINEAR, f"{axis}_exponent": 2.0, f"{axis}_equal": equal}
        for axis, equal in (
            ("surge", 1.0),
            ("sway", 1.0),
            ("sway", 0.3),
            ("sway", 0.1),
            ("yaw", 1.0),
        )
    )

    surge_exponent: float = replaced_exponent_parameter("surge")
    sway_exponent: float = replaced_exponent_parameter("sway")
    yaw_exponent: float = replaced_exponent_parameter("yaw")
    surge_equal: float = agreement_speed_parameter("surge", "m/s")
    sway_equal: float = agreement_speed_parameter("sway", "m/s")
    yaw_equal: float = agreement_speed_parameter("yaw", "rad/s")
