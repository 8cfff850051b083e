"""Channel: a signal on its way from command to actuator."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from typing import ClassVar

from boatsim.errors import BadInput
from boatsim.physics.kinds.effect import Composed, Kind, Part, Station
from boatsim.physics.signals import Course

WHOLE = "*"  # the station behind those of all actuators


def actuators(program: Composed) -> Sequence[Station]:
    """Each signal begins as its command or reading, held over the step, and ends in the rows of `act`."""
    stations = []
    for name in program.signals:
        place = program.held.index(name)
        rows = (("", "begin"), ("held + ", "middle"), ("2 * held + ", "end"))
        end = [f"act[{row}{place}] = x.{when}" for row, when in rows]
        turned = [
            program.held.index(f"{part}_{name}")
            for part in ("cos", "sin")
            if f"{part}_{name}" in program.held
        ]
        if turned:  # first: it looks at the end of the step before, which the rows still hold
            places = ", ".join(f"np.int64({k})" for k in (place, *turned))
            end.insert(0, f"hold_turned(x, act, held, {places})")
        begin = (f"c = commands[{program.commands.index(name)}]", "x = Course(c, c, c)")
        stations.append(Station(begin, tuple(end), name))
    return [*stations, Station(tuple(sums(program)), (), WHOLE)]


def sums(program: Composed) -> Iterator[str]:
    """What several actuators come to together."""
    for name, parts in program.sums.items():
        for row in ("", "held + ", "2 * held + "):
            total = " + ".join(f"act[{row}{program.held.index(part)}]" for part in parts)
            yield f"act[{row}{program.held.index(name)}] = {total}"


def pausing(program: Composed) -> Sequence[Station]:
    """Each signal's command or reading."""
    begins = {name: (f"x = commands[{program.commands.index(name)}]",) for name in program.signals}
    return [*(Station(begin, (), name) for name, begin in begins.items()), Station(channel=WHOLE)]


# Stages: what is wrong with a command comes before the actuator that follows it, what is wrong with
# its deed after it
MAPS = -3  # what makes a signal out of a raw command, at once
# what shifts a command in time: what follows sees it arrive, and it sees commands alone
DELAYS = -2
# what the actuator never hears of: a dead band, play in the linkage; the actuator itself is 0
COMMANDS = -1
DEEDS = 1  # what an actuator that has followed gives: weak astern, uneven, askew
INSTANT = "1e-9"  # [s] of a signal that is asked for as it is now
ACTUATE = Part(
    "actuate", "commands, memory, dt, p, on, act, held", ("pass",), "", stations=actuators
)
PAUSE = Part("pause", "commands, memory, p, on", ("left = np.inf",), "left", stations=pausing)


@dataclass(frozen=True)
class Channel(Kind):
    """What happens to each signal in `on`: compiled `channel(x, side, source, memory, at, dt, values) -> Course`.

    x is the signal so far over the step dt [s] that begins now; side -1 port, +1 starboard, 0 middle of what it
    drives; source the raw command of `fed_by` for it; memory[at:at + slots] this actuator's own memory.
    `pause(x, memory, at, values)`, where there is one, says for how many s the three points of a `Course` tell the
    signal while x, what reaches it now, stands still: until it jumps or bends (a delayed command arrives, a ramp
    ends), or over one lag (`followed`). No step reaches beyond. `passes(x, memory, at, values)` is what it passes on
    now; without it the law is asked, and its memory put back.
    """

    parts: ClassVar = (ACTUATE, PAUSE)
    laws: ClassVar[tuple[str, ...]] = ("channel", "pause", "passes")
    # roles (a|b) of the signals it acts on where `on` names none; "": all
    acts_on: ClassVar[str] = "thrust"
    slots: ClassVar[int] = 0
    # of the actuator that follows: some have it in the command, some in the deed
    either_side: ClassVar[bool] = False
    pause: ClassVar[Callable[..., float] | None] = None
    passes: ClassVar[Callable[..., float] | None] = None
    channel: ClassVar[Callable[..., Course]]

    # commands that feed the channels in `on`, one for each
    fed_by: Sequence[str] = field(default=(), kw_only=True)
    # of the actuator than is usual, for what may be on either
    other_side: bool = field(default=False, kw_only=True)

    def __post_init__(self) -> None:
        super().__post_init__()
        object.__setattr__(
            self, "fed_by", (self.fed_by,) if isinstance(self.fed_by, str) else tuple(self.fed_by)
        )
        if self.other_side not in ((False, True) if type(self).either_side else (False,)):
            allowed = "true or false" if type(self).either_side else "false: it has its place"
            raise BadInput(f"{self.name}: other_side = {self.other_side!r}; allowed is {allowed}")

    @property
    def standing(self) -> int:
        """Before or behind the actuator that follows, by its stage or the other way round."""
        return (
            (DEEDS if type(self).stage < 0 else COMMANDS) if self.other_side else type(self).stage
        )

    @classmethod
    def lines(cls, part: Part, station: Station, number: int, program: Composed) -> Iterator[str]:
        """Pass the actuator's signal on, if the effect acts on it."""
        effect = program.effects[number]
        if not isinstance(effect, Channel) or station.channel not in program.targets(number):
            return
        at = f"np.int64({program.memory(number, station.channel)})"  # plain integers count as types
        site = program.sites(number)[0]
        source = program.source(number, station.channel)
        raw = f"commands[{program.commands.index(source)}]" if source else "0.0"
        side = str(program.side(station.channel))
        if part is ACTUATE:
            yield f"x = {site.call('channel', 'x', side, raw, 'memory', at, 'dt')}"
        if part is PAUSE:
            if type(effect).pause is not None:
                yield f"left = min(left, {site.call('pause', 'x', 'memory', at)})"
            if not any(_asks(program, i, station.channel) for i in program.behind(number)):
                return
            if type(effect).passes is not None:
                yield f"x = {site.call('passes', 'x', 'memory', at)}"
                return
            slots = [f"memory[{at} + {i}]" for i in range(type(effect).slots)]
            yield from (f"kept{i} = {slot}" for i, slot in enumerate(slots))
            yield f"x = {site.call('channel', 'Course(x, x, x)', side, raw, 'memory', at, INSTANT)}.begin"
            yield from (f"{slot} = kept{i}" for i, slot in enumerate(slots))


def _asks(program: Composed, number: int, actuator: str) -> bool:
    """Whether an effect of the program is a channel with a `pause` on an actuator."""
    effect = program.effects[number]
    if not isinstance(effect, Channel) or type(effect).pause is None:
        return False
    return actuator in program.targets(number)
