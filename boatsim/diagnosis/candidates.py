"""What is tried: every entry of the library that can act on a vessel, less what facts or the vessel rule out.

No vessel has a list. An entry says what it needs (freedoms, columns; by its kind also thrusters, rudders, numbers of
the vessel) and which facts rule it out, and the vessel's data decide.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import count, islice

import numpy as np

from boatsim.errors import BadInput, unknown_name
from boatsim.physics.base import Channel, Effect, Measurement, Release
from boatsim.physics.content import load_class, names
from boatsim.physics.facts import WANDER, describe_fact, excluding_fact
from boatsim.physics.program import Program
from boatsim.physics.vessel import Vessel, check_bindings

FURTHER = "further_"  # in front of the name of an entry of which the vessel has one already
SLOTS = {
    "described_force": ("described_", 5),
    "described_thrust": ("described_thrust_", 2),
}  # names, how many
# of one that acts on the other side of an actuator's own lag than it usually does
REORDERED = "reordered_"


@dataclass(frozen=True)
class Library:
    """The entries of one diagnosis."""

    entries: tuple[
        Effect, ...
    ]  # all that can act on the vessel: they are composed, whatever is known of a run
    slots: tuple[Effect, ...]  # composed besides, for laws that the diagnosis writes itself
    left_out: Mapping[
        str, str
    ]  # those of them that are not tried -> the fact, the vessel's reason, the column missing
    idle: Mapping[str, str]  # what can not act on this vessel -> what that lacks

    @property
    def compiled(self) -> tuple[Effect, ...]:
        """All that a diagnosis composes beside the vessel's own effects."""
        return (*self.entries, *self.slots)

    @property
    def tried(self) -> tuple[str, ...]:
        """Names of the entries that are tried."""
        return tuple(e.name for e in self.entries if e.name not in self.left_out)


def library_for(
    vessel: Vessel,
    own: Sequence[str] = (),
    facts: Mapping[str, object] | None = None,
    columns: Sequence[str] | None = None,
) -> Library:
    """The entries for a vessel; `own` are files of the user's, `facts` those of the recordings besides the vessel's.

    `columns` are those recorded; None: all there may be. Raises BadInput for a file, or an entry that the vessel names,
    which does not exist or that no diagnosis could fit.
    """
    known: dict[str, object] = {**vessel.diagnosis.facts, **(facts or {})}
    reasons = {n: f"the vessel's reason: {why}" for n, why in vessel.diagnosis.leave_out.items()}
    for name in reasons:
        if name not in names("effect"):
            raise BadInput(
                unknown_name(f"{vessel.name}: diagnosis.leave_out", name, names("effect"))
            )
    entries, left_out, idle = dict[str, Effect](), dict[str, str](), dict[str, str]()
    for table, kind, asked in _tables(vessel, own):
        called = str(table.get("name", kind.idea()))
        if not fittable(kind):
            if asked:
                raise BadInput(
                    f"{table['use']}: this effect has no parameter that a diagnosis may fit (fit=True)"
                )
            continue
        if lacks := lacking(kind, vessel, known, table):
            idle[called] = lacks
            continue
        if kind.confounded_with and not asked:
            left_out[called] = (
                f"looks the same as {' or '.join(kind.confounded_with)}; --library {called} tries it"
            )
            continue
        left_out.pop(called, None)
        for effect in _either_side(placed(kind, vessel, known, table), vessel):
            entries[effect.name] = effect
            if (
                why := reasons.get(called)
                or excluding_fact(kind.ruled_out_by, known)
                or _unseen(kind, columns)
            ):
                left_out[effect.name] = why
    check_bindings(
        replace(vessel, effects=(*vessel.effects, *entries.values())), f"{vessel.name}: library"
    )
    return Library(tuple(entries.values()), slots(vessel), left_out, idle)


def slots(vessel: Vessel) -> tuple[Effect, ...]:
    """Laws without words yet, in which a diagnosis writes what it describes; of kinds that can act on the vessel."""
    found, taken = list[Effect](), {e.name for e in vessel.effects}
    for idea, (begins, most) in SLOTS.items():
        kind: type[Effect] = load_class("effect", idea)
        if kind.per_instance_of and not vessel.effects_of(kind.per_instance_of):
            continue
        free = (name for k in count(1) if (name := f"{begins}{k}") not in taken)
        found += [
            kind.from_settings({"name": name}).completed(vessel) for name in islice(free, most)
        ]
    return tuple(found)


def _either_side(effect: Effect, vessel: Vessel) -> tuple[Effect, ...]:
    """An entry, and the same on the other side of an actuator of the vessel that takes its time, where it may be there.

    A dead band of the command and one of the shaft differ only where a lag lies between them.
    """
    if not isinstance(effect, Channel) or not type(effect).either_side:
        return (effect,)
    slow = (
        e for e in vessel.effects if isinstance(e, Channel) and type(e).slots and e.standing == 0
    )
    if not any(set(vessel.targets(e)) & set(vessel.targets(effect)) for e in slow):
        return (effect,)
    return effect, replace(effect, name=REORDERED + effect.name, other_side=True)


def _tables(
    vessel: Vessel, own: Sequence[str]
) -> Iterator[tuple[Mapping[str, object], type[Effect], bool]]:
    """Every entry of the shelf, what the vessel asks to be tried besides, the user's files: table, class, asked."""
    for name in names("effect"):
        yield {"use": name}, load_class("effect", name), False
    for table in vessel.diagnosis.also:
        yield table, load_class("effect", str(table.get("use")), vessel.path), True
    for name in own:
        yield {"use": name}, load_class("effect", name, named=True), True


def fittable(kind: type[Effect]) -> bool:
    """Whether an effect has a parameter that a diagnosis may fit."""
    return not kind.described and any(p.fit for p in kind.params().values())


def _unseen(kind: type[Effect], columns: Sequence[str] | None) -> str:
    """What an instrument's entry would show in, if that was not recorded."""
    if columns is None or not issubclass(kind, Measurement) or not kind.of_columns:
        return ""
    return (
        ""
        if set(kind.of_columns) & set(columns)
        else f"no column {' or '.join(kind.of_columns)} was recorded"
    )


def lacking(
    kind: type[Effect], vessel: Vessel, facts: Mapping[str, object], table: Mapping[str, object]
) -> str:
    """What a vessel lacks for an entry to act, in words; "" where nothing is lacking."""
    if missing := [n for n in kind.needs if n not in vessel.dof]:
        return f"no freedom in {' and '.join(missing)}"
    axes = {p.axis for p in kind.params().values() if p.fit}
    if "" not in axes and not axes & set(vessel.dof):
        return f"no freedom in {' or '.join(sorted(axes))}"
    if fact := next((f for f in kind.facts if f not in facts), ""):
        return f"nobody states {describe_fact(fact)}"
    if issubclass(kind, Measurement) and kind.late is not None and not vessel.actuators:
        return "no command to be late behind"
    if kind.alone and (there := vessel.names_of(kind.idea())):
        return f"its own {there[0]}, whose numbers other entries release"
    try:
        found = placed(kind, vessel, facts, table)
    except BadInput as error:
        return str(error).removeprefix(f"{vessel.name}: ")
    if isinstance(found, Channel) and not vessel.targets(found):
        return f"no command of {type(found).acts_on.replace('|', ' or ') or 'any kind'}"
    if isinstance(found, Release) and all(c.weight == 0.0 for c in found.changes(vessel)):
        return "none of the numbers it releases"
    return ""


def placed(
    kind: type[Effect],
    vessel: Vessel,
    facts: Mapping[str, object],
    table: Mapping[str, object] | None = None,
) -> Effect:
    """An entry on a vessel, doing nothing yet; a second of its kind under another name. Raises BadInput."""
    given = {k: v for k, v in (table or {}).items() if k != "use"}
    if not given.get("name") and vessel.names_of(kind.idea()) and not issubclass(kind, Release):
        given["name"] = FURTHER + kind.idea()
    effect = absent(kind, facts, given).completed(vessel)
    check_bindings(replace(vessel, effects=(*vessel.effects, effect)), vessel.name)
    return effect


def absent(
    kind: type[Effect],
    facts: Mapping[str, object] | None = None,
    given: Mapping[str, object] | None = None,
) -> Effect:
    """An entry at the values at which it does nothing, with what stated facts and its own table say of it."""
    named = (
        (places, (facts or {})[fact])
        for fact, places in kind.facts.items()
        if fact in (facts or {})
    )
    told = {
        n: float(x)
        for places, xs in named
        for n, x in zip(places, np.array(xs, dtype=float), strict=True)
    }
    return kind.from_settings(
        told | {n: p.absent for n, p in kind.params().items() if p.fit} | dict(given or {})
    )


def less(library: Library, without: Sequence[str]) -> tuple[str, ...]:
    """Names of what is tried, less those taken out; they stay composed: nothing is compiled anew. Raises BadInput."""
    there = library.tried
    for name in without:
        if name not in there and name not in names("effect"):
            raise BadInput(unknown_name("--without", name, there))
    return tuple(n for n in there if n not in without and called(n) not in without)


def called(name: str) -> str:
    """What an answer calls an entry, be the vessel's own the same idea or not."""
    return name.removeprefix(REORDERED).removeprefix(FURTHER)


def without_ruled_out(vessel: Vessel, facts: Mapping[str, object]) -> Vessel:
    """The vessel without those of its own effects that facts rule out, as they rule entries out.

    A steering angle that was measured is behind the steering machine: a limit of it acts on commands, not once more.
    """
    known = {**vessel.diagnosis.facts, **facts}
    return replace(
        vessel,
        effects=tuple(e for e in vessel.effects if not excluding_fact(type(e).ruled_out_by, known)),
    )


def with_stated_errors(vessel: Vessel, facts: Mapping[str, object]) -> Vessel:
    """The vessel with the wandering error of its fixes that facts state: the filter then knows it from the start."""
    known = {**vessel.diagnosis.facts, **facts}
    if not all(f in known for f in WANDER) or not {"surge", "sway"} <= set(vessel.dof):
        return vessel
    sd, time = (float(str(known[f])) for f in WANDER)
    error = load_class("effect", "position_wander").from_settings({"position": sd, "time": time})
    return replace(vessel, effects=(*vessel.effects, error.completed(vessel)))


def composed(vessel: Vessel) -> tuple[Program, tuple[str, ...]]:
    """A vessel's program as its diagnosis composes it, and which entries act: a patched boat compiles nothing anew."""
    own = tuple(e for e in vessel.effects if e.name not in vessel.found)
    found = {e.name: e for e in vessel.effects if e.name in vessel.found}
    nominal = replace(vessel, effects=own, found=())
    library = library_for(nominal)
    entries = {e.name: e for e in library.compiled} | found
    return Program(nominal, tuple(entries.values())), tuple(n for n in entries if n in found)
