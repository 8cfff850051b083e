"""Described thrust: a relative change of thrust found by symbolic regression."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.physics import terms
from boatsim.physics.base import Boat, Wrench, param
from boatsim.physics.described_laws import SymbolicTerm
from boatsim.physics.effects.thruster import thrust_wrench_at_mount
from boatsim.physics.param import name_code_parameter

SIDES = {"all": 0.0, "port": -1.0, "starboard": 1.0}
SENSES = {"both": 0.0, "ahead": 1.0, "astern": -1.0}


@njit(inline="always")
def law(m: Any, q: Any, s: Any, t: Any, act: Any, at: Any, own: Any) -> Wrench:
    """Return the change of one drive's thrust by a term found by symbolic regression.

    It acts only on the drives of the given side and for the given sense of thrust.

    Args:
        m: Motion of the hull: velocities [m/s], rates [rad/s], position [m], attitude [rad].
        q: Parameters of the effect, with the names and units of its class.
        s: Signals of the thruster on which the effect acts.
        t: Parameters of that thruster.
        act: Values of all actuators at the evaluated instant of the step.
        at: Offset of that instant in `act`.
        own: Index in `act` of the past value that the effect recalls.

    Returns:
        Force [N] and moment [N m] in body axes.
    """
    thrust = t.gain * s.thrust
    on_side = q.where == 0.0 or q.where * t.y > 0.0
    about = thrust != 0.0 and on_side and q.way * thrust >= 0.0
    return thrust_wrench_at_mount(
        q.coefficient * terms.term_value(m, q, act, at, own) * thrust if about else 0.0, s, t
    )


@dataclass(frozen=True)
class DescribedThrust(SymbolicTerm):
    """Term found by symbolic regression: a share by which the thrust of the drives changes.

    dT = coefficient f1 f2 f3 g(t) T

    f1 to f3 are up to three factors of the state (`of`), g is the course in time (`acts`).
    """

    formula: ClassVar[str] = r"\Delta T = c \, f_1 f_2 f_3 \, g(t) \, T"
    symbols: ClassVar = {"coefficient": "c"}
    words: ClassVar[str] = "a change of thrust that no effect of the library explains"
    shown_by: ClassVar[str] = "the same command, repeated"
    per_instance_of: ClassVar[str] = "thruster"
    law: ClassVar = law

    side: str = "all"  # one of `SIDES`
    sense: str = "both"  # one of `SENSES`
    coefficient: float = param(
        0.0,
        low=-1e9,
        high=1e9,
        unit="",
        words="share of the thrust per product of the factors [SI]",
        fit=True,
        spread=0.3,
    )
    where: float = name_code_parameter("code of the side")
    way: float = name_code_parameter("code of the sense")

    def __post_init__(self) -> None:
        super().__post_init__()
        terms.index_code(f"{self.name}: side", self.side, tuple(SIDES))
        terms.index_code(f"{self.name}: sense", self.sense, tuple(SENSES))

    def derived_parameters(self, vessel: Boat) -> dict[str, float]:
        """Return the numbers that stand for side, sense of thrust and factors of a regression term.

        The compiled law needs numbers in place of names.

        Args:
            vessel: Vessel on which the effect acts.

        Raises:
            BadInput: The vessel does not have one of the factors.
        """
        return super().derived_parameters(vessel) | {
            "where": SIDES[self.side],
            "way": SENSES[self.sense],
        }

    def fixed_settings(self) -> dict[str, object]:
        """Return the settings of a regression term that no fit changes, such as side and factors.

        Settings without influence are omitted.
        """
        return {"side": self.side, "sense": self.sense} | super().fixed_settings()
