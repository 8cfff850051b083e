"""Writes a vessel's effects out as the source of one program: `laws.py`, what they add up to, unrolled.

Kinds say what they add (`boatsim.physics.kinds`); this module gathers their lines, part by part. The text is meant to
be read: `python -m boatsim.physics.program VESSEL` prints it.
"""

import re
from collections.abc import Iterator, Mapping, Sequence
from functools import cached_property
from inspect import getsourcefile
from math import cos, sin

from boatsim.errors import BadInput
from boatsim.physics.content import address, load_class, module_of, names
from boatsim.physics.debugging import is_compiled
from boatsim.physics.kinds.channel import WHOLE, Channel
from boatsim.physics.kinds.effect import Effect, Kind, Part, Site
from boatsim.physics.kinds.recall import Recall
from boatsim.physics.vessel import Vessel


def kinds() -> list[type[Kind]]:
    """All kinds of effects, one a file of `boatsim/physics/kinds`."""
    found: list[type[Kind]] = []
    for name in names("kind"):
        module = module_of("kind", name)
        found += [
            k
            for k in vars(module).values()
            if isinstance(k, type)
            and issubclass(k, Kind)
            and k is not Kind
            and k.__module__ == module.__name__
        ]
    return found


class Composition:
    """Effects in their places: what each is called with, which signals pass through it."""

    def __init__(self, vessel: Vessel, effects: Sequence[Effect], offsets: Sequence[int]) -> None:
        """Effects beyond the vessel's own stand behind switches; `offsets` says where each one's parameters begin."""
        self.vessel, self.offsets = vessel, tuple(offsets)
        self.effects = tuple(effects)
        self.signals, self.commands = (*vessel.actuators, *vessel.readings), vessel.inputs
        self.sums: Mapping[str, Sequence[str]] = (
            vessel.sums if any(type(e).sees_held for e in self.effects) else {}
        )
        looking = [
            i
            for i, e in enumerate(self.effects)
            if isinstance(e, Recall) and self._may_look_back(i, e)
        ]
        shown = (*vessel.held, *self.sums)
        self._own = {i: len(shown) + k for k, i in enumerate(looking)}
        self.held: Sequence[str] = (
            *shown,
            *(f"recalled by {self.effects[i].name}" for i in looking),
        )

    # What kinds may ask
    # -----------------------------------------------------------------------------------------------

    def sites(self, number: int) -> Sequence[Site]:
        """The calls of an effect's laws: one, or one for each instance on which it acts."""
        effect = self.effects[number]
        own = self._values(number)
        held = ("act", "at", f"np.int64({self.own(number)})") if type(effect).sees_held else ()
        if type(effect).per_instance_of:
            carriers = [self.effects.index(e) for e in self.vessel.carriers(effect)]
            return [
                Site(
                    number,
                    own,
                    (self._carried(i, type(effect).per_instance_of), self._values(i), *held),
                )
                for i in carriers
            ]
        return [Site(number, own, ((self._signals(number),) if type(effect).roles else ()) + held)]

    def targets(self, number: int) -> Sequence[str]:
        """Actuators that a channel effect acts on."""
        return self.vessel.targets(self.effects[number])

    def source(self, number: int, actuator: str) -> str | None:
        """The command that feeds an actuator through a channel effect, if it takes one."""
        return self.vessel.feeding_command(self.effects[number], actuator)

    def side(self, actuator: str) -> float:
        """-1 port, +1 starboard, 0 middle of what an actuator drives."""
        return self.vessel.side(actuator)

    def memory(self, number: int, actuator: str) -> int:
        """Where an effect's memory of an actuator begins."""
        return self._memory[number, actuator]

    def own(self, number: int) -> int:
        """Place in `held` of what an effect recalls; 0 of one that does not look back."""
        return self._own.get(number, 0)

    def _may_look_back(self, number: int, effect: Recall) -> bool:
        """A slot of a diagnosis may come to, whatever is written into it; the vessel's own do or do not."""
        return number >= len(self.vessel.effects) or effect.looks_back

    def behind(self, number: int) -> Sequence[int]:
        """The effects that come after one in the program."""
        return self._order[self._order.index(number) + 1 :]

    @cached_property
    def _order(self) -> list[int]:
        """Effects by stage, else as they stand."""
        return sorted(range(len(self.effects)), key=lambda i: self.effects[i].standing)

    @cached_property
    def memory_size(self) -> int:
        """Floats that all channels, and laws that look back, together remember."""
        channels = ((i, e) for i, e in enumerate(self.effects) if isinstance(e, Channel))
        return sum(type(e).slots * len(self.targets(i)) for i, e in channels) + len(self._own)

    @cached_property
    def _memory(self) -> dict[tuple[int, str], int]:
        found, at = {}, 0
        for actuator in self.signals:
            for i, effect in enumerate(self.effects):
                if isinstance(effect, Channel) and actuator in self.targets(i):
                    found[i, actuator], at = at, at + type(effect).slots
        return found | {(i, WHOLE): at + k for k, i in enumerate(self._own)}

    def _values(self, i: int) -> str:
        """`V3(p[7], p[8])`: an effect's parameters as its law receives them."""
        first = self.offsets[i]
        return f"V{i}({', '.join(f'p[{first + j}]' for j in range(len(type(self.effects[i]).params())))})"

    def _signals(self, i: int) -> str:
        """`S3(act[at], act[at + 4], ...)`: the signals bound to an effect's roles."""
        effect, texts = self.effects[i], []
        bound = self.vessel.bindings(effect)
        for role, about in type(effect).roles.items():
            texts.append(self._signal(bound.get(role, about.fixed)))
        for role, about in type(effect).roles.items():
            if about.unit == "rad":
                channel = bound.get(role, about.fixed)
                for part, of in (("cos", cos), ("sin", sin)):
                    held = isinstance(channel, str)
                    texts.append(
                        self._signal(f"{part}_{channel}" if held else of(float(channel or 0.0)))
                    )
        return f"S{i}({', '.join(texts)})"

    def _carried(self, i: int, idea: str) -> str:
        """Signals of an instance that is ridden on, as those of the idea that the rider knows."""
        if type(self.effects[i]).idea() == idea:
            return self._signals(i)
        return f"as_{idea}{i}({self._signals(i)}, {self._values(i)})"

    def _signal(self, bound: str | float | None) -> str:
        """A held signal by its place, a fixed one by its number."""
        if isinstance(bound, str):
            return f"act[at + {self.held.index(bound)}]"
        if bound is None:
            raise BadInput(f"{self.vessel.name}: a signal is bound to no channel")
        return repr(float(bound))

    # The text
    # ---------------------------------------------------------------------------------------------------------

    def source_text(self) -> str:
        """`laws.py`."""
        functions: list[str] = []
        used: set[str] = set()
        constants = [f"HELD, MEMORY = {max(len(self.held), 1)}, {max(self.memory_size, 1)}"]
        everything = kinds()
        for part in (part for kind in everything for part in kind.parts):
            body, busy = self._body(part, everything)
            functions.append(
                "\n".join(
                    [
                        f"@{part.compiled}",
                        f"def {part.name}({part.arguments}):",
                        *(f"    {line}" for line in body),
                        f"    return {part.result}".rstrip(),
                        "",
                        "",
                    ]
                )
            )
            constants.append(f"HAS_{part.name.upper()} = {busy}")
            used |= {word for line in body for word in _calls(line)}
        return "\n".join([*self._head(used), *constants, "", "", *functions])

    def _head(self, used: set[str]) -> Iterator[str]:
        """Imports, and the compiled functions and types that the text below calls by number."""
        # without the vessel's name: one that is patched, or another with the same effects, is not
        # compiled anew
        yield '"""Effects of a vessel, composed by boatsim; not meant to be edited."""'
        yield ""
        yield "import numpy as np"
        yield ""
        yield "from boatsim.physics.compose import classes_of"
        yield "from boatsim.physics.kernel.compiling import inlined, merged, shared"
        yield "from boatsim.physics.kernel.rotation import hold_turned"
        yield "from boatsim.physics.signals import Course, Swell, Wander, Wrench"
        yield ""
        yield f"E = classes_of({[address(type(e)) for e in self.effects]!r})"
        for i, effect in enumerate(self.effects):
            if f"V{i}" in used:
                yield f"V{i} = E[{i}].values_type()  # {_remark(effect.name)}"
            if f"S{i}" in used:
                yield f"S{i} = E[{i}].signals_type()"
            for law in dict.fromkeys(
                law for kind in type(effect).__mro__ for law in getattr(kind, "laws", ())
            ):
                if f"{law}{i}" in used:
                    _check_compiled(type(effect), law)
                    yield f"{law}{i} = shared(E[{i}].{law})"

    def _body(self, part: Part, everything: Sequence[type[Kind]]) -> tuple[list[str], bool]:
        """Lines of a part, and whether any effect adds to it."""
        body, busy = list(part.begin), False
        for station in part.stations(self):
            body += station.begin
            for i in self._order:
                effect = self.effects[i]
                lines = [
                    line
                    for kind in everything
                    if isinstance(effect, kind)
                    for line in kind.lines(part, station, i, self)
                ]
                busy = busy or bool(lines)
                if lines and i >= len(
                    self.vessel.effects
                ):  # behind the switch of an effect that is optional
                    lines = [f"if on[{i}] != 0.0:", *(f"    {line}" for line in lines)]
                body += lines
            body += station.end
        return body, busy


def _remark(name: str) -> str:
    """A name of the user's as it may stand in a comment or a docstring of a program: it must end neither."""
    return re.sub(r"[^\w .+-]", "?", name)


def _check_compiled(kind: type[Effect], law: str) -> None:
    """Raises BadInput for a law that is missing, or that numba does not know."""
    if not is_compiled(getattr(kind, law, None)):
        raise BadInput(
            f"{getsourcefile(kind)}: class {kind.__name__} has no compiled {law}; it needs {law}: ClassVar = {law} of "
            f'a function under @njit(inline="always")'
        )


def _calls(line: str) -> Iterator[str]:
    """Names that a line calls."""
    for piece in line.split("(")[:-1]:
        word = piece
        for mark in " ,=":
            word = word.rsplit(mark, 1)[-1]
        yield word


def classes_of(addresses: Sequence[str]) -> list[type[Effect]]:
    """Effect classes of a composed program, for the program's own use."""
    return [load_class("effect", a) for a in addresses]
