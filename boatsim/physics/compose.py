"""Generates `laws.py` of a vessel's program, whose functions call the laws of all effects.

Each kind of effect contributes its own lines (`boatsim.physics.kinds`), which this module collects.
The text is meant to be read: `python -m boatsim.physics.program VESSEL` prints it.
"""

import re
from collections.abc import Iterator, Mapping, Sequence
from functools import cache, cached_property
from inspect import getsourcefile
from itertools import chain
from math import cos, sin
from textwrap import indent

from boatsim.errors import BadInput
from boatsim.physics.content import (
    effect_reference,
    import_library_module,
    load_class,
    shipped_content_names,
)
from boatsim.physics.debugging import is_compiled
from boatsim.physics.kinds.channel import WHOLE, ChannelEffect
from boatsim.physics.kinds.effect import Effect, EffectKind, LawCall, ProgramFunction
from boatsim.physics.kinds.filtered import FilteredSignal
from boatsim.physics.kinds.force import Force
from boatsim.physics.kinds.motion_memory import MotionMemory
from boatsim.physics.kinds.recall import SignalHistory
from boatsim.physics.vessel import Vessel


@cache
def effect_kinds() -> tuple[type[EffectKind], ...]:
    """Return the base classes of all kinds of effects (force, inertia, channel, ...).

    There is one for each file of `boatsim/physics/kinds`.
    """
    found: list[type[EffectKind]] = []
    for name in shipped_content_names("kind"):
        module = import_library_module("kind", name)
        for value in vars(module).values():
            is_kind = (
                isinstance(value, type)
                and issubclass(value, EffectKind)
                and value is not EffectKind
            )
            if is_kind and value.__module__ == module.__name__:
                found.append(value)
    return tuple(found)


def further_readings(vessel: Vessel, effects: Sequence[Effect]) -> dict[str, bool]:
    """Return the measured channels that candidates use and no effect of the vessel itself.

    Their signals follow those of the vessel, whose places do not depend on the candidates.

    Args:
        vessel: The vessel.
        effects: The vessel's own effects, then candidates.

    Returns:
        Name of the channel -> whether it is an angle.
    """
    found: dict[str, bool] = {}
    for effect in effects:
        for role, channel in vessel.specified_inputs(effect).items():
            if channel in vessel.measured and channel not in vessel.readings:
                found[str(channel)] = type(effect).roles[role].unit == "rad"
    return found


class Composition:
    """Composes the source of a vessel's program that calls the laws of all its effects.

    It assigns to each effect's parameters, signals and states their indices in the program's flat
    arrays.
    """

    def __init__(
        self,
        vessel: Vessel,
        effects: Sequence[Effect],
        offsets: Sequence[int],
        table_offsets: Sequence[int],
    ) -> None:
        """Assign places to signals and states.

        Args:
            vessel: The vessel.
            effects: The vessel's own effects, then candidates, which act where their switch is on.
            offsets: Place of each effect's first parameter in the flat array.
            table_offsets: Place of the first entry of each effect's table in it.
        """
        self.vessel, self.offsets = vessel, tuple(offsets)
        self.table_offsets = tuple(table_offsets)
        self.effects = tuple(effects)
        further = further_readings(vessel, self.effects)
        self.signals = (*vessel.actuators, *vessel.readings, *further)
        self.commands = vessel.inputs
        self.signal_sums: Mapping[str, Sequence[str]] = {}
        if any(type(e).sees_held and not isinstance(e, MotionMemory) for e in self.effects):
            self.signal_sums = vessel.signal_sums
        held = [*vessel.law_signals, *self.signal_sums]
        for name, is_angle in further.items():
            held.append(name)
            if is_angle:
                held += [f"cos_{name}", f"sin_{name}"]
        self._own: dict[int, int] = {}
        for i, effect in enumerate(self.effects):
            if isinstance(effect, SignalHistory) and self._may_use_history(i, effect):
                self._own[i] = len(held)
                held.append(f"recalled by {effect.name}")
            elif isinstance(effect, FilteredSignal):
                self._own[i] = len(held)
                held += [f"{value} by {effect.name}" for value in type(effect).filtered]
            elif isinstance(effect, MotionMemory):
                self._own[i] = len(held)
                count = type(effect).memory_signals
                held += [f"memory {k} of {effect.name}" for k in range(count)]
        self.law_signals: Sequence[str] = tuple(held)

    # Used by the kinds of effects
    # ------------------------------------------------------------------------------------------

    def law_calls(self, number: int) -> Sequence[LawCall]:
        """Return the source texts of the calls to an effect's law in the generated program.

        There is one call, or one for each instance of the other effect on which it acts.

        Args:
            number: Index of the effect in the program.
        """
        effect = self.effects[number]
        own = self._parameters_text(number)
        held: tuple[str, ...] = ()
        if type(effect).sees_held:
            held = ("act", "at", f"np.int64({self.history_index(number)})")
        if type(effect).sees_table:
            held += ("p", f"np.int64({self.table_offsets[number]})")
        if not type(effect).per_instance_of:
            signals = (self._signals_text(number),) if type(effect).roles else ()
            return [LawCall(number, own, signals + held)]
        carriers = {}
        for carrier in self.vessel.effects_of_type(type(effect).per_instance_of):
            i = self.effects.index(carrier)
            carried = self._carrier_signals(i, type(effect).per_instance_of)
            carriers[carrier.name] = carried, self._parameters_text(i)
        hosts = [carrier.name for carrier in self.vessel.host_effects(effect)]
        influencing = list(carriers) if type(effect).influenced_by_all else hosts
        calls = []
        for name in hosts:
            others = [carriers[other] for other in influencing if other != name]
            total = self._influence_text(number, own, carriers[name], others)
            calls.append(LawCall(number, own, (*carriers[name], *held, *total)))
        return calls

    def _influence_text(
        self,
        number: int,
        own: str,
        carrier: tuple[str, str],
        others: Sequence[tuple[str, str]],
    ) -> tuple[str, ...]:
        """`influence3(...) + influence3(...)`: the sum of the influences of other instances.

        Empty for an effect whose instances do not act on each other.
        """
        effect = self.effects[number]
        if not isinstance(effect, Force) or type(effect).influence is None:
            return ()
        terms = []
        for other in others:
            terms.append(f"influence{number}({', '.join((own, *carrier, *other))})")
        return (" + ".join(terms) or "0.0",)

    def target_actuators(self, number: int) -> Sequence[str]:
        """Return the names of the actuators whose signals a given channel effect changes.

        Args:
            number: Index of the effect in the program.
        """
        return self.vessel.target_actuators(self.effects[number])

    def source_for_actuator(self, number: int, actuator: str) -> str | None:
        """Return the input that feeds an actuator through a channel effect, or None.

        Examples are the PWM command from which a drive curve computes the thrust, and the measured
        voltage of its supply.

        Args:
            number: Index of the effect in the program.
            actuator: Name of the actuator.
        """
        return self.vessel.source_for_actuator(self.effects[number], actuator)

    def side(self, actuator: str) -> float:
        """Return the side of the hull on which an actuator acts: -1 port, 0 middle, +1 starboard.

        Args:
            actuator: Name of the actuator.
        """
        return self.vessel.side(actuator)

    def memory_offset(self, number: int, actuator: str) -> int:
        """Return the index in the program's memory array of an effect's state for one actuator.

        Args:
            number: Index of the effect in the program.
            actuator: Name of the actuator.
        """
        return self._memory_offsets[number, actuator]

    def history_index(self, number: int) -> int:
        """Return the index in `law_signals` of the past signal value that an effect uses.

        It is 0 for an effect that uses none.

        Args:
            number: Index of the effect in the program.
        """
        return self._own.get(number, 0)

    def table_place(self, number: int) -> int:
        """Return the place of the first entry of an effect's table among all parameters.

        Args:
            number: Index of the effect in the program.
        """
        return self.table_offsets[number]

    def filtered_signal_index(self, number: int) -> int:
        """Return the place among the signals of the force laws of the one that an effect filters.

        Args:
            number: Place of the effect among the effects of the program.

        Raises:
            BadInput: The vessel file does not state a signal for the effect's first input.
        """
        effect = self.effects[number]
        role = next(iter(type(effect).roles))
        channel = self.vessel.bindings(effect).get(role)
        if not isinstance(channel, str):
            raise BadInput(f"{self.vessel.name}: {effect.name}: {role} is bound to no channel")
        return self.law_signals.index(channel)

    def _may_use_history(self, number: int, effect: SignalHistory) -> bool:
        """Whether an effect may use the history of a signal.

        A placeholder of symbolic regression may.
        """
        return number >= len(self.vessel.effects) or effect.uses_history

    def indices_of_later_effects(self, number: int) -> Sequence[int]:
        """Return the indices of the effects that are evaluated after a given effect.

        Args:
            number: Index of the effect in the program.
        """
        return self._effect_order[self._effect_order.index(number) + 1 :]

    @cached_property
    def _effect_order(self) -> list[int]:
        """Places of the effects, by stage, then in the order of the vessel file."""
        return sorted(range(len(self.effects)), key=lambda i: self.effects[i].program_position)

    @cached_property
    def memory_size(self) -> int:
        """Number of floats that hold the state of all actuators and signal lags of the program."""
        size = sum(map(self._history_size, self._own))
        for i, effect in enumerate(self.effects):
            if isinstance(effect, ChannelEffect):
                size += type(effect).slots * len(self.target_actuators(i))
        return size

    @cached_property
    def _memory_offsets(self) -> dict[tuple[int, str], int]:
        found: dict[tuple[int, str], int] = {}
        at = 0
        for actuator in self.signals:
            for i, effect in enumerate(self.effects):
                if isinstance(effect, ChannelEffect) and actuator in self.target_actuators(i):
                    found[i, actuator] = at
                    at += type(effect).slots
        for i in self._own:
            found[i, WHOLE] = at
            at += self._history_size(i)
        return found

    def _history_size(self, i: int) -> int:
        """Number of states that an effect stores of the past of a signal or of the motion."""
        effect = self.effects[i]
        if isinstance(effect, MotionMemory):
            return effect.memory_states
        return type(effect).filter_states or 1

    def _parameters_text(self, i: int) -> str:
        """`V3(p[7], p[8])`: an effect's parameters as its law receives them."""
        first, count = self.offsets[i], len(type(self.effects[i]).params())
        return f"V{i}({', '.join(map('p[{}]'.format, range(first, first + count)))})"

    def _signals_text(self, i: int) -> str:
        """`S3(act[at], ...)`: signals of an effect's roles, then cosine and sine of angles."""
        effect = self.effects[i]
        texts: list[str] = []
        angles: list[str] = []
        bound = self.vessel.bindings(effect)
        for role, about in type(effect).roles.items():
            channel = bound.get(role, about.fixed)
            texts.append(self._signal_text(channel))
            if about.unit != "rad":
                continue
            if isinstance(channel, str):
                angles += [self._signal_text(f"cos_{channel}"), self._signal_text(f"sin_{channel}")]
            else:
                angle = float(channel or 0.0)
                angles += [self._signal_text(cos(angle)), self._signal_text(sin(angle))]
        first = self.history_index(i)
        results = [f"act[at + {first + k}]" for k in range(len(type(effect).filtered))]
        return f"S{i}({', '.join([*texts, *angles, *results])})"

    def _carrier_signals(self, i: int, idea: str) -> str:
        """Signals of an effect that another one acts on, as the other's law takes them."""
        if type(self.effects[i]).type_name() == idea:
            return self._signals_text(i)
        return f"as_{idea}{i}({self._signals_text(i)}, {self._parameters_text(i)})"

    def _signal_text(self, bound: str | float | None) -> str:
        """A signal by its place, a fixed one by its value."""
        if isinstance(bound, str):
            return f"act[at + {self.law_signals.index(bound)}]"
        if bound is None:
            raise BadInput(f"{self.vessel.name}: a signal is bound to no channel")
        return repr(float(bound))

    # Generated text
    # ------------------------------------------------------------------------------------------

    def source_text(self) -> str:
        """Return the generated Python source of `laws.py`, which calls the laws of all effects."""
        functions: list[str] = []
        used: set[str] = set()
        constants = [f"HELD, MEMORY = {max(len(self.law_signals), 1)}, {max(self.memory_size, 1)}"]
        constants.append(f"CANDIDATES = {len(self.effects) - len(self.vessel.effects)}")
        for part in chain.from_iterable(kind.parts for kind in effect_kinds()):
            body, has_effects = self._function_lines(part)
            head = f"@{part.compiled}\ndef {part.name}({part.arguments}):\n"
            lines = [*body, f"return {part.result}".rstrip()]
            functions.append(head + indent("\n".join(lines), "    ") + "\n\n")
            constants.append(f"HAS_{part.name.upper()} = {has_effects}")
            used.update(*map(_called_functions, body))
        return "\n".join([*self._module_head(used), *constants, "", "", *functions])

    def _module_head(self, used: set[str]) -> Iterator[str]:
        """Imports, and the compiled functions and types that the text below calls."""
        # Without the name of the vessel, so that vessels with the same effects share a program.
        yield '"""Effects of a vessel, composed by boatsim; not meant to be edited."""'
        yield ""
        yield "import numpy as np"
        yield ""
        yield "from boatsim.physics.compose import effect_classes"
        yield "from boatsim.physics.kernel.compiling import compile_shared_law, inlined, merged"
        yield "from boatsim.physics.kernel.rotation import write_cosine_and_sine"
        yield "from boatsim.physics.signals import ("
        yield "    InstrumentDrift,"
        yield "    OscillatingForce,"
        yield "    SignalSegment,"
        yield "    Wrench,"
        yield ")"
        yield ""
        yield f"E = effect_classes({[effect_reference(type(e)) for e in self.effects]!r})"
        for i, effect in enumerate(self.effects):
            if f"V{i}" in used:
                yield f"V{i} = E[{i}].values_type()  # {_comment_text(effect.name)}"
            if f"S{i}" in used:
                yield f"S{i} = E[{i}].signals_type()"
            laws = chain.from_iterable(getattr(kind, "laws", ()) for kind in type(effect).__mro__)
            for law in dict.fromkeys(laws):
                if f"{law}{i}" in used:
                    _check_compiled(type(effect), law)
                    yield f"{law}{i} = compile_shared_law(E[{i}].{law})"

    @cached_property
    def _kinds_of_effects(self) -> list[list[type[EffectKind]]]:
        """Kinds to which each effect belongs."""
        found: list[list[type[EffectKind]]] = []
        for effect in self.effects:
            found.append([kind for kind in effect_kinds() if isinstance(effect, kind)])
        return found

    def _function_lines(self, part: ProgramFunction) -> tuple[list[str], bool]:
        """Lines of a part, and whether any effect contributes to it."""
        body, has_effects = list(part.begin), False
        for station in part.stations(self):
            body += station.begin
            for i in self._effect_order:
                lines: list[str] = []
                for kind in self._kinds_of_effects[i]:
                    lines += kind.program_lines(part, station, i, self)
                has_effects = has_effects or bool(lines)
                if lines and i >= len(self.vessel.effects):  # a candidate has a switch
                    lines = [f"if on[{i}] != 0.0:", *map("    ".__add__, lines)]
                body += lines
            body += station.end
        return body, has_effects


def _comment_text(name: str) -> str:
    """A user's name without characters that could end a comment or a docstring."""
    return re.sub(r"[^\w .+-]", "?", name)


def _check_compiled(kind: type[Effect], law: str) -> None:
    """Raise BadInput for a law that is missing or not compiled."""
    if not is_compiled(getattr(kind, law, None)):
        raise BadInput(
            f"{getsourcefile(kind)}: class {kind.__name__} has no compiled {law}; "
            f'it needs {law}: ClassVar = {law} of a function under @njit(inline="always")'
        )


def _called_functions(line: str) -> Iterator[str]:
    """Names of the functions that a line calls."""
    for piece in line.split("(")[:-1]:
        word = piece
        for mark in " ,=":
            word = word.rsplit(mark, 1)[-1]
        yield word


def effect_classes(addresses: Sequence[str]) -> list[type[Effect]]:
    """Return the classes of effects with given addresses, for use in generated programs.

    Args:
        addresses: Name of each effect in the library, or path of its file
            (`content.effect_reference`).
    """
    return [load_class("effect", a) for a in addresses]
