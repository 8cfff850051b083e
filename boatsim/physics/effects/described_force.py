"""Described force: a force term found by symbolic regression."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.physics import terms
from boatsim.physics.base import Boat, Wrench, param
from boatsim.physics.described_laws import SymbolicTerm
from boatsim.physics.param import name_code_parameter


@njit(inline="always")
def law(m: Any, q: Any, act: Any, at: Any, own: Any) -> Wrench:
    """Return the force of a term found by symbolic regression, along one axis of hull or earth.

    The term is a coefficient times up to three factors of the state and a function of time.

    Args:
        m: Motion of the hull: velocities [m/s], rates [rad/s], position [m], attitude [rad].
        q: Parameters of the effect, with the names and units of its class.
        act: Values of all actuators at the evaluated instant of the step.
        at: Offset of that instant in `act`.
        own: Index in `act` of the past value that the effect recalls.

    Returns:
        Force [N] and moment [N m] in body axes.
    """
    return terms.wrench_along(m, q.direction, q.coefficient * terms.term_value(m, q, act, at, own))


@dataclass(frozen=True)
class DescribedForce(SymbolicTerm):
    """Term found by symbolic regression: a force or moment along one axis.

    F = coefficient f1 f2 f3 g(t)

    f1 to f3 are up to three factors of the state (`of`), g is the course in time (`acts`).
    """

    formula: ClassVar[str] = r"F = c \, f_1 f_2 f_3 \, g(t)"
    symbols: ClassVar = {"coefficient": "c"}
    words: ClassVar[str] = "a force that no effect of the library explains"
    shown_by: ClassVar[str] = "the manoeuvre in which it was found"
    law: ClassVar = law

    axis: str = "surge"  # one of `terms.DIRECTIONS`
    coefficient: float = param(
        0.0,
        low=-1e15,
        high=1e15,
        unit="",
        words="force [N] or moment [N m] per product of the factors [SI]",
        fit=True,
        spread=1.0,
    )
    direction: float = name_code_parameter("code of the axis")

    def __post_init__(self) -> None:
        super().__post_init__()
        terms.index_code(f"{self.name}: axis", self.axis, terms.DIRECTIONS)

    def derived_parameters(self, vessel: Boat) -> dict[str, float]:
        """Return the numbers that stand for the axis and the factors of a regression term.

        The compiled law needs numbers in place of names.

        Args:
            vessel: Vessel on which the effect acts.

        Raises:
            BadInput: The vessel does not have one of the factors.
        """
        return super().derived_parameters(vessel) | {
            "direction": terms.index_code(self.name, self.axis, terms.DIRECTIONS)
        }

    def fixed_settings(self) -> dict[str, object]:
        """Return the settings of a regression term that no fit changes, such as axis and factors.

        Settings without influence are omitted.
        """
        return {"axis": self.axis} | super().fixed_settings()
