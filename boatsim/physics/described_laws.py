"""What described laws share: the words of their terms, and how files and programs put them."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import ClassVar

from boatsim.errors import BadInput
from boatsim.physics import terms
from boatsim.physics.base import UNSET, Boat, Force, Recall, param
from boatsim.physics.param import code
from boatsim.physics.particulars import GRAVITY

EVER = 1e12  # [s] beyond any clock, one that counts from 1970 too
# of the speed, or rate, that belongs to the length by Froude: within so much a sense turns
LITTLE = 0.01


@dataclass(frozen=True)
class Described(Force, Recall):
    """One term of a law: a coefficient times up to three factors, always or for a while."""

    described: ClassVar[bool] = True
    sees_held: ClassVar[bool] = True
    recall: ClassVar = terms.recall
    reach: ClassVar = terms.reach

    # the factors it goes with; none: it is constant
    of: Sequence[str] = field(default=(), hash=False)
    acts: str = "always"  # which of `terms.COURSES`
    coefficient: float = param(
        0.0, low=-1e15, high=1e15, unit="", words="per product of its factors", fit=True, spread=1.0
    )
    # the recording of which it is an event; "": of none
    run: str = field(default="", metadata={"ours": True})
    begin: float = param(
        -EVER, low=-EVER, high=EVER, unit="s", words="it begins, on the clock of the recording"
    )
    end: float = param(
        EVER,
        low=-EVER,
        high=EVER,
        unit="s",
        words="it ends; of what fades or swings, one span later",
    )
    wavelength: float = param(
        1.0, low=1e-3, high=1e6, unit="m", words="of a pattern that lies still"
    )
    crest: float = param(
        0.0, low=-1e6, high=1e6, unit="m", words="where it is highest, north or east"
    )
    beyond: float = param(
        0.0, low=0.0, high=1e3, unit="", words="speed [SI] from which a factor beyond_ grows"
    )
    memory: float = param(
        UNSET, low=0.01, high=3600.0, unit="s", words="time constant of a factor recent_, changed_"
    )
    little: float = param(
        UNSET, low=1e-9, high=1e3, unit="", words="speed [SI] within which a sense turns"
    )

    first: float = code("its first factor")
    second: float = code("its second factor")
    third: float = code("its third factor")
    course: float = code("how it acts in time")
    looks_at: float = code("the signal it looks back at")
    looks: float = code("how it looks back")

    def __post_init__(self) -> None:
        super().__post_init__()
        object.__setattr__(self, "of", (self.of,) if isinstance(self.of, str) else tuple(self.of))
        terms.code_of(f"{self.name}: acts", self.acts, terms.COURSES)
        if not self.begin < self.end:
            raise BadInput(
                f"{self.name}: begin = {self.begin:g}, end = {self.end:g} s; allowed is an end after it"
            )

    @property
    def looks_back(self) -> bool:
        """Whether one of its factors is what a signal was of late."""
        return self.stated("memory") and "memory" not in self.filled

    def rules(self, vessel: Boat) -> dict[str, float]:
        """What its words are to the program. Raises BadInput for factors that the vessel has not."""
        first, second, third = terms.codes(self.name, self.of, vessel.described_signals)
        turning = any(terms.UNITS.get(name.removeprefix("sign_")) == "rad/s" for name in self.of)
        little = LITTLE * (GRAVITY / vessel.length if turning else GRAVITY * vessel.length) ** 0.5
        acts = terms.code_of(self.name, self.acts, terms.COURSES)
        looks_at, looks = terms.looks(self.name, self.of, vessel.described_signals)
        if looks_at and not self.stated("memory"):
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

    def by_name(self) -> dict[str, float]:
        """Its numbers but the coefficient, as a program has them, by name."""
        return {n: getattr(self, n) for n in type(self).params() if n != "coefficient"}

    def shape(self) -> dict[str, object]:
        """What its table says of the law, less what has no meaning for it."""
        said: dict[str, object] = {"of": list(self.of), "acts": self.acts}
        if self.acts != "always":
            said |= {"begin": self.begin, "end": self.end}
        if set(self.of) & set(terms.RIPPLES):
            said |= {"wavelength": self.wavelength, "crest": self.crest}
        if set(self.of) & set(terms.BEYOND):
            said["beyond"] = self.beyond
        if self.looks_back:
            said["memory"] = self.memory
        return said
