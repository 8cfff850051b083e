"""Channel effects: changes of a signal between command and actuator."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from math import isfinite
from typing import ClassVar

from boatsim.errors import BadInput
from boatsim.physics.kinds.effect import (
    Boat,
    EffectKind,
    InsertionPoint,
    ProgramFunction,
    ProgramLayout,
)
from boatsim.physics.signals import SignalSegment

WHOLE = "*"  # channel of the insertion point after those of all actuators


def actuator_insertion_points(program: ProgramLayout) -> Sequence[InsertionPoint]:
    """Return the places at which effects add code to the generated function `advance_channels`.

    There is one place for each actuator or sensor signal, then one after all of them. Each signal
    starts as its command or reading, constant over the time step; after the code of the effects its
    values at begin, middle and end of the step are stored in the array `act`.

    Args:
        program: Layout of the program that is generated for the vessel.
    """
    stations = []
    for name in program.signals:
        place = program.law_signals.index(name)
        rows = (("", "begin"), ("held + ", "middle"), ("2 * held + ", "end"))
        end = [f"act[{row}{place}] = x.{when}" for row, when in rows]
        parts = (f"cos_{name}", f"sin_{name}")
        turned = [program.law_signals.index(part) for part in parts if part in program.law_signals]
        if turned:  # before the others, because it reads the end of the previous step from the rows
            places = ", ".join(f"np.int64({k})" for k in (place, *turned))
            end.insert(0, f"write_cosine_and_sine(x, act, held, {places})")
        begin = (f"c = commands[{program.commands.index(name)}]", "x = SignalSegment(c, c, c)")
        stations.append(InsertionPoint(begin, tuple(end), name))
    return [*stations, InsertionPoint(tuple(signal_sum_lines(program)), (), WHOLE)]


def signal_sum_lines(program: ProgramLayout) -> Iterator[str]:
    """Yield source lines that store sums of actuator signals (such as total thrust) in `act`.

    The generated function `advance_channels` of a vessel's compiled program contains them. The sums
    are signals for terms of symbolic regression.

    Args:
        program: Layout of the program that is generated for the vessel.
    """
    for name, parts in program.signal_sums.items():
        for row in ("", "held + ", "2 * held + "):
            total = " + ".join(f"act[{row}{program.law_signals.index(part)}]" for part in parts)
            yield f"act[{row}{program.law_signals.index(name)}] = {total}"


def discontinuity_insertion_points(program: ProgramLayout) -> Sequence[InsertionPoint]:
    """Return the places at which effects add code to the generated `time_to_discontinuity`.

    There is one place for each actuator or sensor signal, then one after all of them. Each signal
    starts as its present command or reading.

    Args:
        program: Layout of the program that is generated for the vessel.
    """
    stations = []
    for name in program.signals:
        begin = (f"x = commands[{program.commands.index(name)}]",)
        stations.append(InsertionPoint(begin, (), name))
    return [*stations, InsertionPoint(channel=WHOLE)]


# Stages: errors of a command come before the actuator that follows it, errors of its output
# after it
MAPS = -3  # static curves from a raw command to a signal
# delays of a command, which act on commands only; later effects see the delayed command
DELAYS = -2
# errors between command and actuator: dead band, play in the linkage; an actuator has stage 0
COMMANDS = -1
DEEDS = 1  # errors of the output of an actuator: weak astern, imbalance, offset
INSTANT = "1e-9"  # [s] step with which the present signal is evaluated
ADVANCE = ProgramFunction(
    "advance_channels",
    "commands, memory, dt, p, on, act, held",
    ("pass",),
    "",
    compiled="merged",
    stations=actuator_insertion_points,
)
TIME_TO_DISCONTINUITY = ProgramFunction(
    "time_to_discontinuity",
    "commands, memory, p, on",
    ("left = np.inf",),
    "left",
    compiled="merged",
    stations=discontinuity_insertion_points,
)


@dataclass(frozen=True)
class ChannelEffect(EffectKind):
    """Base class of effects that change a signal between its command and the actuator.

    Examples are dead time, rate limit, dead band and offset. The effect acts on each signal that
    its setting `on` names.

    `transform_signal(x, side, source, memory, at, dt, values)`, compiled, returns a
    `SignalSegment`. x is the signal so far over the step dt [s] that begins now; side is -1 port,
    +1 starboard, 0 on the centreline; source is the raw command, or the measured quantity, of
    `fed_by` for the signal;
    memory[at:at + slots] is the memory of this actuator.

    `time_to_discontinuity(x, memory, at, values)`, if defined, is the time [s] for which the three
    points of a `SignalSegment` describe the signal while the signal x that reaches it now is
    constant: until it jumps or has a kink (a delayed command arrives, a ramp ends), or over one
    time constant (`longest_lag_step`). No step is longer. `present_output(x, memory, at, values)`
    is the present output; without it the law is evaluated and its memory restored.
    """

    parts: ClassVar = (ADVANCE, TIME_TO_DISCONTINUITY)
    laws: ClassVar[tuple[str, ...]] = (
        "transform_signal",
        "time_to_discontinuity",
        "present_output",
    )
    # roles (a|b) of the signals it acts on where `on` names none; "": all
    acts_on: ClassVar[str] = "thrust"
    slots: ClassVar[int] = 0
    # whether the effect may act on the command or on the output of the actuator
    either_side: ClassVar[bool] = False
    # whether it changes nothing of a drive that pushes in one direction only
    acts_astern: ClassVar[bool] = False
    # whether a small change of the command changes the signal smoothly; a linear model leaves out
    # an effect such as play, which acts on changes of direction
    has_derivative: ClassVar[bool] = True
    # whether it differs from another effect only if the limits ahead and astern are not the same
    limits_differ: ClassVar[bool] = False
    # unit of the measured quantities that feed it, as in the names of their columns ("V"); "":
    # commands feed it
    measured_unit: ClassVar[str] = ""
    time_to_discontinuity: ClassVar[Callable[..., float] | None] = None
    present_output: ClassVar[Callable[..., float] | None] = None
    channel: ClassVar[Callable[..., SignalSegment]]

    # commands that feed the channels in `on`, one for each; of an effect with `measured_unit`
    # measured quantities
    fed_by: Sequence[str] = field(default=(), kw_only=True)
    # acts on the other side of the actuator than by default
    other_side: bool = field(default=False, kw_only=True)

    def __post_init__(self) -> None:
        super().__post_init__()
        fed_by = [self.fed_by] if isinstance(self.fed_by, str) else self.fed_by
        object.__setattr__(self, "fed_by", tuple(fed_by))
        if type(self).either_side:
            accepted: tuple[bool, ...] = (False, True)
            allowed = "true or false"
        else:
            accepted = (False,)
            allowed = "false: its side is fixed"
        if self.other_side not in accepted:
            raise BadInput(f"{self.name}: other_side = {self.other_side!r}; allowed is {allowed}")

    @property
    def program_position(self) -> int:
        """Position of a channel effect in the compiled program relative to the actuator.

        Negative: the effect changes the command before the actuator follows it; positive: it
        changes the output of the actuator. It is the class's `stage`, or lies on the opposite side
        of the actuator if the effect was set to act there (`other_side`).
        """
        if not self.other_side:
            return type(self).stage
        return DEEDS if type(self).stage < 0 else COMMANDS

    def largest_commands(self, vessel: Boat) -> tuple[float, float]:
        """Return the largest commands, ahead and astern, of the actuators on which it acts.

        Both are positive, in the unit of the command. Where actuators act in one direction only,
        the largest command of that direction is returned for both; 1 where there are no limits.

        Args:
            vessel: Vessel on which the effect acts.
        """
        limits = vessel.limits()
        ahead, astern = 0.0, 0.0
        for name in vessel.target_actuators(self):
            low, high = limits[name]
            if isfinite(high):
                ahead = max(ahead, high)
            if isfinite(low):
                astern = max(astern, -low)
        largest = max(ahead, astern) or 1.0
        return ahead or largest, astern or largest

    @classmethod
    def program_lines(
        cls, part: ProgramFunction, station: InsertionPoint, number: int, program: ProgramLayout
    ) -> Iterator[str]:
        """Yield the source lines that pass an actuator's signal through a channel effect.

        There are none if the effect does not act on this actuator.

        Args:
            part: Function of the compiled program that receives the lines.
            station: Insertion point in that function; there is one for each actuator.
            number: Index of the effect among all effects of the program.
            program: Layout of the program that is generated for the vessel.
        """
        effect = program.effects[number]
        if not isinstance(effect, ChannelEffect) or station.channel not in program.target_actuators(
            number
        ):
            return
        # a typed integer, because numba compiles literal integers as types
        at = f"np.int64({program.memory_offset(number, station.channel)})"
        site = program.law_calls(number)[0]
        source = program.source_for_actuator(number, station.channel)
        raw = f"commands[{program.commands.index(source)}]" if source else "0.0"
        side = str(program.side(station.channel))
        if part is ADVANCE:
            yield f"x = {site.text('transform_signal', 'x', side, raw, 'memory', at, 'dt')}"
        if part is TIME_TO_DISCONTINUITY:
            if type(effect).time_to_discontinuity is not None:
                yield f"left = min(left, {site.text('time_to_discontinuity', 'x', 'memory', at)})"
            if not any(
                _has_discontinuities(program, i, station.channel)
                for i in program.indices_of_later_effects(number)
            ):
                return
            if type(effect).present_output is not None:
                yield f"x = {site.text('present_output', 'x', 'memory', at)}"
                return
            for i in range(type(effect).slots):
                yield f"kept{i} = memory[{at} + {i}]"
            now = site.text(
                "transform_signal", "SignalSegment(x, x, x)", side, raw, "memory", at, INSTANT
            )
            yield f"x = {now}.begin"
            for i in range(type(effect).slots):
                yield f"memory[{at} + {i}] = kept{i}"


def _has_discontinuities(program: ProgramLayout, number: int, actuator: str) -> bool:
    """Return whether an effect is a channel with a `time_to_discontinuity` on an actuator."""
    effect = program.effects[number]
    if not isinstance(effect, ChannelEffect) or type(effect).time_to_discontinuity is None:
        return False
    return actuator in program.target_actuators(number)
