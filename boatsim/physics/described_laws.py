"""Base of the effects that a diagnosis finds by symbolic regression: one term of a law."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import ClassVar

from boatsim.errors import BadInput
from boatsim.physics import terms
from boatsim.physics.base import UNSET, Boat, Force, SignalHistory, param
from boatsim.physics.param import name_code_parameter
from boatsim.physics.particulars import GRAVITY

EVER = 1e12  # [s] beyond any clock, also one that counts from 1970
# Speed within which the sign of a speed changes, as a share of the speed sqrt(g L), or rate
# sqrt(g / L)
LITTLE = 0.01


@dataclass(frozen=True)
class SymbolicTerm(Force, SignalHistory):
    """Base class of effects found by symbolic regression: one term of a force law.

    The term is a coefficient times up to three factors of the state and a function of time.
    """

    described: ClassVar[bool] = True
    sees_held: ClassVar[bool] = True
    update_signal_history: ClassVar = terms.update_signal_history
    longest_history_step: ClassVar = terms.longest_history_step

    # the factors; none: it is constant
    of: Sequence[str] = field(default=(), hash=False)
    acts: str = "always"  # which of `terms.COURSES`
    coefficient: float = param(
        0.0, low=-1e15, high=1e15, unit="", words="per product of its factors", fit=True, spread=1.0
    )
    # the recording in which it acts; "": in all
    run: str = field(default="", metadata={"ours": True})
    begin: float = param(
        -EVER, low=-EVER, high=EVER, unit="s", words="begin, on the clock of the recording"
    )
    end: float = param(
        EVER,
        low=-EVER,
        high=EVER,
        unit="s",
        words="end; of a course that fades or swings, one time constant or period later",
    )
    wavelength: float = param(
        1.0, low=1e-3, high=1e6, unit="m", words="of a pattern that is fixed in the water"
    )
    crest: float = param(
        0.0, low=-1e6, high=1e6, unit="m", words="place of its crest, north or east"
    )
    beyond: float = param(
        0.0, low=0.0, high=1e3, unit="", words="threshold [SI] of a factor beyond_"
    )
    memory: float = param(
        UNSET,
        low=0.01,
        high=3600.0,
        unit="s",
        words="time constant of a factor recent_ or changed_",
    )
    little: float = param(
        UNSET, low=1e-9, high=1e3, unit="", words="speed [SI] within which a factor sign_ changes"
    )

    first: float = name_code_parameter("first factor")
    second: float = name_code_parameter("second factor")
    third: float = name_code_parameter("third factor")
    course: float = name_code_parameter("course in time")
    looks_at: float = name_code_parameter("signal whose history is used")
    looks: float = name_code_parameter("kind of history")

    def __post_init__(self) -> None:
        super().__post_init__()
        object.__setattr__(self, "of", (self.of,) if isinstance(self.of, str) else tuple(self.of))
        terms.index_code(f"{self.name}: acts", self.acts, terms.COURSES)
        if not self.begin < self.end:
            raise BadInput(
                f"{self.name}: begin = {self.begin:g}, end = {self.end:g} s; "
                "allowed is an end after the begin"
            )

    @property
    def uses_history(self) -> bool:
        """Whether one of the term's factors uses past values of an actuator signal."""
        return self.has_value("memory") and "memory" not in self.filled

    def derived_parameters(self, vessel: Boat) -> dict[str, float]:
        """Return the numbers that stand for factor names in a regression term's compiled law.

        Args:
            vessel: The vessel.

        Raises:
            BadInput: A factor does not exist on the vessel, or `memory` is missing.
        """
        first, second, third = terms.factor_codes(self.name, self.of, vessel.described_signals)
        turning = any(terms.UNITS.get(name.removeprefix("sign_")) == "rad/s" for name in self.of)
        square = GRAVITY / vessel.length if turning else GRAVITY * vessel.length
        little = LITTLE * square**0.5
        acts = terms.index_code(self.name, self.acts, terms.COURSES)
        looks_at, looks = terms.history_codes(self.name, self.of, vessel.described_signals)
        if looks_at and not self.has_value("memory"):
            raise BadInput(
                f"{self.name}: memory is missing: the time constant [s] of of = {list(self.of)}"
            )
        return {
            "little": little,
            "first": first,
            "second": second,
            "third": third,
            "course": acts,
            "looks_at": looks_at,
            "looks": looks,
            "memory": 1.0,
        }

    def law_parameters(self) -> dict[str, float]:
        """Return the parameters of a regression term's compiled law by name.

        The coefficient is not among them.
        """
        return {n: getattr(self, n) for n in type(self).params() if n != "coefficient"}

    def fixed_settings(self) -> dict[str, object]:
        """Return the settings that define the form of a regression term, which no fit changes.

        Keys that have no influence are omitted.
        """
        found: dict[str, object] = {"of": list(self.of), "acts": self.acts}
        if self.acts != "always":
            found |= {"begin": self.begin, "end": self.end}
        if set(self.of) & set(terms.RIPPLES):
            found |= {"wavelength": self.wavelength, "crest": self.crest}
        if set(self.of) & set(terms.BEYOND):
            found["beyond"] = self.beyond
        if self.uses_history:
            found["memory"] = self.memory
        return found
