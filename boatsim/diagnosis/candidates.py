"""Candidate effects of a diagnosis: those that can act on a vessel, and those excluded.

No vessel has a list of candidates. An effect declares what it needs (degrees of freedom, columns;
by its kind also thrusters, rudders, numbers of the vessel) and which facts exclude it. The vessel
and its recordings decide.
"""

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import count, islice
from typing import NamedTuple

import numpy as np

from boatsim.diagnosis.config import DEFAULT, DescribeConfig, DiagnosisConfig
from boatsim.errors import BadInput, unknown_name_message
from boatsim.physics.base import ChannelEffect, CoefficientRelease, Effect, Measurement
from boatsim.physics.content import load_class, shipped_content_names
from boatsim.physics.facts import WANDER, describe_fact, excluding_fact
from boatsim.physics.program import Program
from boatsim.physics.vessel import Vessel, check_bindings, with_absolute_paths

DRIVE_ROLES = ("thrust", "shaft")  # of the actuators that are drives
FURTHER = "further_"  # prefix of a candidate of which the vessel has one already
# prefix of a candidate that acts on the other side of an actuator's lag than usual
REORDERED = "reordered_"
FEW = 2  # drives from which on one of them can differ from the others
OF_TWO_DRIVES = (
    "an error of one of two drives is tried only where a force stays unexplained, or with --library"
)
RARE = "such an error is rare and is tried only where a force stays unexplained, or with --library"
OF_A_KIND = (
    "an error that the thrusts or directions of two drives share is tried only where a force stays "
    "unexplained, or with --library"
)


class Placeholders(NamedTuple):
    """Effect, name prefix and number of one kind of placeholder effect of a compiled program.

    A placeholder has no law of its own. If symbolic regression finds a force or a change of thrust,
    the parameters of a placeholder are set to that term, so that nothing has to be compiled again.
    """

    effect: str  # its name
    prefix: str  # of their names
    number: int


@dataclass(frozen=True)
class CandidateLibrary:
    """Candidate effects of one diagnosis: those tested, those excluded, and the reasons.

    A candidate effect is a force, actuator fault or sensor error that the vessel model may lack.
    Each one that can act on the vessel is compiled into its program.
    """

    # all candidates that can act on the vessel; they are compiled whatever is known of a run,
    # except errors of single instruments whose columns were not recorded
    entries: tuple[Effect, ...]
    # effects reserved for terms found by symbolic regression; they are compiled, too
    placeholders: tuple[Effect, ...]
    # candidates that are not tested -> the fact, the vessel's reason, or the missing column
    excluded: Mapping[str, str]
    inapplicable: Mapping[str, str]  # effects that cannot act on this vessel -> what is missing
    # excluded ones that are tested where the others leave a force unexplained -> those that
    # recordings hardly distinguish from them
    tried_last: Mapping[str, tuple[str, ...]] = field(default_factory=dict)

    @property
    def compiled_effects(self) -> tuple[Effect, ...]:
        """All effects compiled into the vessel program in addition to the vessel's own effects.

        These are the candidate effects, excluded ones included, and the placeholders for terms
        found by symbolic regression.
        """
        return (*self.entries, *self.placeholders)

    @property
    def tested_names(self) -> tuple[str, ...]:
        """Names of the candidate effects that the diagnosis tests: all that are not excluded."""
        return tuple(e.name for e in self.entries if e.name not in self.excluded)


class _Source(NamedTuple):
    """Where a candidate comes from."""

    table: Mapping[str, object]  # settings
    kind: type[Effect]
    requested: bool  # by the vessel or the user


def candidate_library(
    vessel: Vessel,
    own: Sequence[str] = (),
    facts: Mapping[str, object] | None = None,
    columns: Sequence[str] | None = None,
    config: DiagnosisConfig = DEFAULT,
) -> CandidateLibrary:
    """Return the candidate effects that a diagnosis may test on a vessel.

    Effects that cannot act on the vessel are left out. Effects excluded by a fact, by the vessel
    file or by a missing column are kept with the reason, but are not tested.

    Args:
        vessel: Vessel of the recordings.
        own: Effects that the user requests, by name or file.
        facts: Facts of the recordings in addition to the vessel's.
        columns: Recorded columns; None: unknown. Effects with `needs_columns` are candidates only
            where these columns are known to be recorded.
        config: Numbers of drives and of placeholders.

    Returns:
        The candidate effects with the reasons for each exclusion, and the placeholders.

    Raises:
        BadInput: An effect that is requested does not exist, or has no parameter to fit.
    """
    known: dict[str, object] = {**vessel.diagnosis.facts, **(facts or {})}
    reasons = _exclusions_by_vessel(vessel)
    entries = dict[str, Effect]()
    excluded, inapplicable, last = dict[str, str](), dict[str, str](), dict[str, tuple[str, ...]]()
    fewest = config.select.fewest_instances
    for source in _sources(vessel, own, fewest):
        kind = source.kind
        name = str(source.table.get("name", kind.type_name()))
        if not has_fittable_parameter(kind):
            if source.requested:
                raise BadInput(
                    f"{source.table['use']}: this effect has no parameter that a diagnosis may "
                    "fit (fit=True)"
                )
            continue
        least = min(FEW, fewest)
        asked = source.requested and not kind.once_per  # a request names the kind, not the drive
        missing = missing_requirements(kind, vessel, known, source.table, least, asked)
        missing = missing or _missing_columns(kind, columns)
        one_of_few = _is_error_of_one_of_few(kind, vessel, fewest)
        one_of_few = one_of_few and not source.requested and not _replaces_of_two(kind, vessel)
        if one_of_few and kind.of_two:
            missing = missing or f"{kind.of_two} describes the difference of two"
        later = (kind.tried_last or bool(kind.confounded_with)) and not source.requested
        if missing:
            inapplicable[name] = missing
            continue
        reason = reasons.get(name) or excluding_fact(kind.ruled_out_by, known)
        if one_of_few or later:
            excluded[name] = reason or _reason_not_tested_first(kind, name, one_of_few)
            if not reason and (one_of_few or kind.tried_last):
                last[name] = kind.confounded_with or kind.imitated_by
            continue
        excluded.pop(name, None)
        last.pop(name, None)
        reason = reason or _unrecorded_columns(kind, columns)
        for effect in _both_sides_of_lag(
            instantiate_candidate(kind, vessel, known, source.table), vessel
        ):
            entries[effect.name] = effect
            unusable = reason or _unrecorded_sources(effect, columns)
            if unusable:
                excluded[effect.name] = unusable
    together = replace(vessel, effects=(*vessel.effects, *entries.values()))
    check_bindings(together, f"{vessel.name}: library")
    placeholders = placeholder_effects(vessel, config.describe)
    return CandidateLibrary(tuple(entries.values()), placeholders, excluded, inapplicable, last)


def _replaces_of_two(kind: type[Effect], vessel: Vessel) -> bool:
    """Whether a fault of each drive replaces an effect that cannot act on the vessel (`of_two`)."""
    if not kind.of_two or not _is_error_of_one_of_several(kind, vessel):
        return False
    other = load_class("effect", kind.of_two)
    return bool(missing_requirements(other, vessel, vessel.diagnosis.facts, {"use": kind.of_two}))


def _reason_not_tested_first(kind: type[Effect], name: str, one_of_few: bool) -> str:
    """Why a candidate is tested on request only, or where a force stays unexplained, in words."""
    if one_of_few:
        return OF_A_KIND if kind.jointly else OF_TWO_DRIVES
    if not kind.confounded_with:
        return RARE
    others = " or ".join(kind.confounded_with)
    if kind.tried_last:
        return (
            f"recordings hardly distinguish it from {others}, and it is tried only where a force "
            f"stays unexplained; add --library {name} to test it"
        )
    return f"recordings cannot distinguish it from {others}; add --library {name} to test it"


def _exclusions_by_vessel(vessel: Vessel) -> dict[str, str]:
    """The vessel's own reasons for excluding candidates. Raises BadInput for an unknown name."""
    reasons = {}
    for name, why in vessel.diagnosis.leave_out.items():
        if name not in shipped_content_names("effect"):
            where = f"{vessel.name}: diagnosis.leave_out"
            raise BadInput(unknown_name_message(where, name, shipped_content_names("effect")))
        reasons[name] = f"the vessel's reason: {why}"
    return reasons


def placeholder_effects(
    vessel: Vessel, config: DescribeConfig = DEFAULT.describe
) -> tuple[Effect, ...]:
    """Return placeholder effects that can be set to terms found by symbolic regression.

    Only the kinds that can act on the vessel are returned, at zero effect.

    Args:
        vessel: Vessel of the recordings.
        config: Numbers of placeholders.
    """
    found, taken = list[Effect](), {e.name for e in vessel.effects}
    kinds = (
        Placeholders("described_force", "described_", config.force_placeholders),
        Placeholders("described_thrust", "described_thrust_", config.thrust_placeholders),
    )
    for idea, prefix, number in kinds:
        kind: type[Effect] = load_class("effect", idea)
        if kind.per_instance_of and not vessel.effects_of_type(kind.per_instance_of):
            continue
        free = (f"{prefix}{k}" for k in count(1) if f"{prefix}{k}" not in taken)
        for name in islice(free, number):
            found.append(kind.from_settings({"name": name}).with_all_parameters(vessel))
    return tuple(found)


def _both_sides_of_lag(effect: Effect, vessel: Vessel) -> tuple[Effect, ...]:
    """A candidate, before and after an actuator's lag where both are possible.

    A dead band of the command and one of the shaft differ only where a lag lies between them.
    """
    if not isinstance(effect, ChannelEffect) or not type(effect).either_side:
        return (effect,)
    targets = set(vessel.target_actuators(effect))
    for other in vessel.effects:
        lags = (
            isinstance(other, ChannelEffect) and type(other).slots and other.program_position == 0
        )
        if lags and targets & set(vessel.target_actuators(other)):
            reordered = replace(effect, name=REORDERED + effect.name, other_side=True)
            return effect, reordered
    return (effect,)


def _sources(vessel: Vessel, own: Sequence[str], fewest: int) -> Iterator[_Source]:
    """Every effect of the library, those that the vessel requests, and those of the user.

    From `fewest` instances on, an error of a single one is a candidate for each of them, and from
    two on where the user requests it.
    """
    for name in shipped_content_names("effect"):
        kind: type[Effect] = load_class("effect", name)
        are_single = has_single_candidates(kind, vessel, fewest) and not kind.tried_last
        if are_single or _replaces_of_two(kind, vessel):
            yield from _sources_of_single_ones(name, kind, vessel, False)
        elif name not in own or not _is_error_of_one_of_several(kind, vessel):
            yield _Source({"use": name, **_measured_sources(kind, vessel)}, kind, False)
    for table in vessel.diagnosis.also:
        requested: type[Effect] = load_class("effect", str(table.get("use")), vessel.path)
        yield _Source(with_absolute_paths(requested, table, vessel.path), requested, True)
    for name in own:
        kind = load_class("effect", name, named=True)
        if _is_error_of_one_of_several(kind, vessel):
            yield from _sources_of_single_ones(name, kind, vessel, True)
        else:
            yield _Source({"use": name, **_measured_sources(kind, vessel)}, kind, True)


def _sources_of_single_ones(
    name: str, kind: type[Effect], vessel: Vessel, requested: bool
) -> Iterator[_Source]:
    """An error of each single drive, named after it, or one that all of them have together."""
    if kind.jointly:
        yield _Source({"use": name}, kind, requested)
        return
    fed_by = _measurements_by_actuator(kind, vessel)
    for one in single_subjects(kind, vessel):
        table: dict[str, object] = {"use": name, "name": f"{name}_{one}", "on": [one]}
        if one in fed_by:
            table["fed_by"] = [fed_by[one]]
        yield _Source(table, kind, requested)


def _is_error_of_one_of_several(kind: type[Effect], vessel: Vessel) -> bool:
    """Whether a class is an error of one of several drives of a vessel."""
    return len(single_subjects(kind, vessel)) >= FEW


def _is_error_of_one_of_few(kind: type[Effect], vessel: Vessel, fewest: int) -> bool:
    """Whether a class is an error of one of several drives, which are few on a vessel."""
    several = _is_error_of_one_of_several(kind, vessel)
    return several and not has_single_candidates(kind, vessel, fewest)


def _measured_sources(kind: type[Effect], vessel: Vessel) -> dict[str, object]:
    """Settings that bind an effect to the measured quantities that it takes, if it needs any.

    They are empty where the vessel measures none that matches.
    """
    if kind.recorded_as and not set(kind.recorded_as.values()) - set(vessel.measured):
        return {"on": dict(kind.recorded_as)}
    found = _measurements_by_actuator(kind, vessel)
    if not found:
        return {}
    return {"on": list(found), "fed_by": list(found.values())}


def _measurements_by_actuator(kind: type[Effect], vessel: Vessel) -> dict[str, str]:
    """The measured quantity that feeds a channel effect, by actuator; empty if it needs none."""
    if not issubclass(kind, ChannelEffect) or not kind.measured_unit:
        return {}
    actuators = vessel.target_actuators(instantiate_neutral_effect(kind))
    return dict(vessel.matching_measurements(actuators, kind.measured_unit))


def single_subjects(kind: type[Effect], vessel: Vessel) -> list[str]:
    """Return the names of what an error of a single one may concern: effects, or actuators.

    Args:
        kind: Class of the effect, with `once_per`.
        vessel: Vessel of the recordings.

    Returns:
        Instances of the effect `once_per`; of a channel effect the actuators on which it acts.
        Empty for a class without `once_per`.
    """
    if not kind.once_per:
        return []
    if issubclass(kind, ChannelEffect):
        return list(vessel.target_actuators(instantiate_neutral_effect(kind)))
    if kind.per_instance_of:  # also at effects that can stand for it, as propellers for thrusters
        return [effect.name for effect in vessel.effects_of_type(kind.once_per)]
    return vessel.names_of(kind.once_per)


def has_single_candidates(kind: type[Effect], vessel: Vessel, fewest: int) -> bool:
    """Return whether an error of a single drive is a candidate for each that it may concern.

    The number of drives of the vessel decides: of four drives, two may turn, and each of these may
    turn slowly. Where only one turns, an error of all angles is the same as that of its angle.

    Args:
        kind: Class of the effect, with `once_per`.
        vessel: Vessel of the recordings.
        fewest: Drives from which on an error of a single one can be tested.
    """
    subjects = len(single_subjects(kind, vessel))
    if subjects >= fewest:
        return True
    drives = [name for name in vessel.actuators if vessel.roles[name] in DRIVE_ROLES]
    return subjects >= FEW and len(drives) >= fewest


def has_fittable_parameter(kind: type[Effect]) -> bool:
    """Return whether a class of effects declares a parameter that a diagnosis may fit.

    Effects without such a parameter cannot be candidate effects.
    """
    return not kind.described and any(p.fit for p in kind.params().values())


def _unrecorded_columns(kind: type[Effect], columns: Sequence[str] | None) -> str:
    """The columns in which an error of an instrument would show, if none was recorded."""
    if columns is None or not issubclass(kind, Measurement) or not kind.of_columns:
        return ""
    if set(kind.of_columns) & set(columns):
        return ""
    return f"no column {' or '.join(kind.of_columns)} was recorded"


def _unrecorded_sources(effect: Effect, columns: Sequence[str] | None) -> str:
    """The measured quantities that an effect takes, if they were not recorded, in words."""
    if columns is None:
        return ""
    sources = tuple(type(effect).recorded_as.values())
    if isinstance(effect, ChannelEffect) and type(effect).measured_unit:
        sources = tuple(effect.fed_by)
    missing = [name for name in dict.fromkeys(sources) if name not in columns]
    if not missing:
        return ""
    return f"no column {' and '.join(missing)} was recorded"


def _missing_columns(kind: type[Effect], columns: Sequence[str] | None) -> str:
    """The columns without which an error of an instrument is not even compiled, in words, or ""."""
    if not issubclass(kind, Measurement):
        return ""
    missing = [name for name in kind.needs_columns if name not in (columns or ())]
    if not missing:
        return ""
    return f"no column {' and '.join(missing)} was recorded"


def missing_requirements(
    kind: type[Effect],
    vessel: Vessel,
    facts: Mapping[str, object],
    table: Mapping[str, object],
    fewest: int = DEFAULT.select.fewest_instances,
    requested: bool = False,
) -> str:
    """Return what a vessel lacks for an effect to act on it, in words; "" if nothing is missing.

    Examples are a degree of freedom, a rudder, or a number in the vessel file.

    Args:
        kind: Class of the effect.
        vessel: Vessel of the recordings.
        facts: Facts of the vessel and of the recordings.
        table: Settings of the effect.
        fewest: Instances from which on an error of a single one can be tested.
        requested: Whether the vessel or the user asks for the effect. It is then tested although
            recordings might not show it (`Effect.missing_for_test`).
    """
    missing = [name for name in kind.needs if name not in vessel.dof]
    if missing:
        return f"no degree of freedom in {' and '.join(missing)}"
    if kind.needs_one_of and not set(kind.needs_one_of) & set(vessel.dof):
        return f"no degree of freedom in {' or '.join(kind.needs_one_of)}"
    axes = set()
    for param in kind.params().values():
        if param.fit:
            axes.add(param.axis)
    if "" not in axes and not axes & set(vessel.dof):
        return f"no degree of freedom in {' or '.join(sorted(axes))}"
    for fact in kind.facts:
        if fact not in facts:
            return f"not specified: {describe_fact(fact)}"
    for fact, value in kind.required_facts.items():
        if facts.get(fact) != value:
            return f"only where {fact} = {str(value).lower()}"
    if kind.once_per and not has_single_candidates(kind, vessel, fewest):
        return f"fewer than {fewest} drives that it could concern"
    if issubclass(kind, Measurement) and kind.motion_latency is not None and not vessel.actuators:
        return "no commands relative to which a latency could be estimated"
    if kind.alone and vessel.names_of(kind.type_name()):
        own = vessel.names_of(kind.type_name())[0]
        return f"the vessel has its own {own}, whose parameters other candidates adjust"
    if issubclass(kind, ChannelEffect) and kind.measured_unit and not table.get("fed_by"):
        return (
            f"no measured quantity in {kind.measured_unit} is in [measured], or none can be "
            "assigned to each drive by its name"
        )
    if kind.recorded_as and not table.get("on"):
        return f"{' and '.join(kind.recorded_as.values())} are not in [measured]"
    try:
        found = instantiate_candidate(kind, vessel, facts, table)
    except BadInput as error:
        return str(error).removeprefix(f"{vessel.name}: ")
    usable = {*vessel.roles, *(vessel.measured if kind.recorded_as else ())}
    for role, channel in vessel.specified_inputs(found).items():
        if isinstance(channel, str) and channel not in usable:
            return f"on.{role} = {channel}, which no effect of the vessel itself uses"
    if not requested and (reason := found.missing_for_test(vessel)):
        return reason
    if isinstance(found, ChannelEffect) and found.acts_astern and _is_one_way(vessel, found):
        return "no command is negative"
    if isinstance(found, ChannelEffect) and found.limits_differ and _is_symmetric(vessel, found):
        return "the limits of the commands are the same ahead and astern"
    if isinstance(found, ChannelEffect) and not vessel.target_actuators(found):
        return f"no command of {type(found).acts_on.replace('|', ' or ') or 'any kind'}"
    if isinstance(found, CoefficientRelease) and all(
        c.weight == 0.0 for c in found.changes(vessel)
    ):
        return "none of the parameters that it would adjust"
    return ""


def _is_one_way(vessel: Vessel, effect: ChannelEffect) -> bool:
    """Whether all drives on which an effect acts push in one direction only."""
    targets = [vessel.commands.get(name) for name in vessel.target_actuators(effect)]
    return bool(targets) and all(c is not None and c.low >= 0.0 for c in targets)


def _is_symmetric(vessel: Vessel, effect: ChannelEffect) -> bool:
    """Whether the drives on which an effect acts have the same limits ahead and astern."""
    ahead, astern = effect.largest_commands(vessel)
    return ahead == astern


def instantiate_candidate(
    kind: type[Effect],
    vessel: Vessel,
    facts: Mapping[str, object],
    table: Mapping[str, object] | None = None,
) -> Effect:
    """Return a candidate effect for a vessel, at the parameters at which it has zero effect.

    If the vessel already has an effect of this name, the candidate gets a prefix that makes its
    name unique.

    Args:
        kind: Class of the effect.
        vessel: Vessel of the recordings.
        facts: Facts of the vessel and of the recordings.
        table: Settings of the effect.

    Raises:
        BadInput: The effect cannot act on the vessel.
    """
    given = dict(table or {})
    given.pop("use", None)
    if (
        not given.get("name")
        and vessel.names_of(kind.type_name())
        and not issubclass(kind, CoefficientRelease)
    ):
        given["name"] = FURTHER + kind.type_name()
    effect = instantiate_neutral_effect(kind, facts, given).with_all_parameters(vessel)
    check_bindings(replace(vessel, effects=(*vessel.effects, effect)), vessel.name)
    return effect


def instantiate_neutral_effect(
    kind: type[Effect],
    facts: Mapping[str, object] | None = None,
    given: Mapping[str, object] | None = None,
) -> Effect:
    """Return an instance of an effect at the parameter values at which it changes nothing.

    For example, a force of size zero, or a factor of one.

    Args:
        kind: Class of the effect.
        facts: Facts that set some of its parameters.
        given: Further settings.
    """
    settings: dict[str, object] = {}
    for fact, places in kind.facts.items():
        if facts and fact in facts:
            values = np.atleast_1d(np.array(facts[fact], dtype=float))
            settings |= dict(zip(places, values.tolist(), strict=True))
    for name, param in kind.params().items():
        if param.fit:
            settings[name] = param.inactive_value
    return kind.from_settings(settings | dict(given or {}))


def candidate_names_except(library: CandidateLibrary, without: Sequence[str]) -> tuple[str, ...]:
    """Return the names of the tested candidate effects except the given ones.

    The excluded effects stay in the compiled program, so that nothing has to be compiled again.

    Args:
        library: Candidates of the diagnosis.
        without: Names that are excluded.

    Raises:
        BadInput: A name does not exist.
    """
    tested = library.tested_names
    for name in without:
        if name not in tested and name not in shipped_content_names("effect"):
            raise BadInput(unknown_name_message("--without", name, tested))
    return tuple(n for n in tested if n not in without and name_without_prefixes(n) not in without)


def name_without_prefixes(name: str) -> str:
    """Return the name of a candidate effect without the prefixes that make repeated effects unique.

    For example, `further_wind` becomes `wind`.
    """
    return name.removeprefix(REORDERED).removeprefix(FURTHER)


def without_excluded_effects(vessel: Vessel, facts: Mapping[str, object]) -> Vessel:
    """Return a vessel model without its own effects that facts about the recording exclude.

    For example, a rudder angle measured behind the steering machine already contains the rate limit
    of that machine, so that the limit must not act on the measured angle again.

    Args:
        vessel: Vessel of the recordings.
        facts: Facts of the recordings.
    """
    known = {**vessel.diagnosis.facts, **facts}
    kept = tuple(e for e in vessel.effects if not excluding_fact(type(e).ruled_out_by, known))
    return replace(vessel, effects=kept)


def with_specified_position_drift(vessel: Vessel, facts: Mapping[str, object]) -> Vessel:
    """Add the drift error of position fixes to a vessel model, if facts of the run specify it.

    The facts give the standard deviation and the time constant of the drift.

    Args:
        vessel: Vessel of the recordings.
        facts: Facts of the recordings.

    Returns:
        The vessel with an effect for the drift; the same vessel if no drift is specified.
    """
    known = {**vessel.diagnosis.facts, **facts}
    if not set(WANDER) <= set(known) or not {"surge", "sway"} <= set(vessel.dof):
        return vessel
    sd_fact, time_fact = WANDER
    sd = float(str(known[sd_fact]))
    time = float(str(known[time_fact]))
    error = load_class("effect", "position_wander").from_settings({"position": sd, "time": time})
    return replace(vessel, effects=(*vessel.effects, error.with_all_parameters(vessel)))


def program_to_replay(vessel: Vessel) -> tuple[Program, tuple[str, ...]]:
    """Return the compiled program with which a recording of a vessel is replayed.

    The program of a patched vessel is that of its diagnosis, which was compiled before. For any
    other vessel the program contains its own effects only, and compiles faster.

    Args:
        vessel: Vessel file, or a patched one.

    Returns:
        The program, and the names of the candidate effects in it that are active.
    """
    if vessel.found:
        return diagnosis_program(vessel)
    return Program(vessel), ()


def program_with_candidates(
    vessel: Vessel, names: Collection[str], config: DiagnosisConfig = DEFAULT
) -> Program:
    """Return the compiled program of a vessel with the named candidate effects added.

    Candidates that cannot act on the vessel are left out.

    Args:
        vessel: Vessel file.
        names: Names of candidates.
        config: Numbers of drives and of placeholders.
    """
    library = candidate_library(vessel, config=config)
    return Program(vessel, tuple(e for e in library.compiled_effects if e.name in names))


def diagnosis_program(vessel: Vessel) -> tuple[Program, tuple[str, ...]]:
    """Return the compiled program of a vessel with all candidate effects that a diagnosis tests.

    If the vessel is a patched one, this is the program of its diagnosis with the usual settings,
    without further compilation.

    Args:
        vessel: Vessel file, or a patched one.

    Returns:
        The program, and the names of the candidate effects in it that are active.
    """
    own, found = list[Effect](), dict[str, Effect]()
    for effect in vessel.effects:
        if effect.name in vessel.found:
            found[effect.name] = effect
        else:
            own.append(effect)
    nominal = replace(vessel, effects=tuple(own), found=())
    candidates = {e.name: e for e in candidate_library(nominal).compiled_effects} | found
    program = Program(nominal, tuple(candidates.values()))
    return program, tuple(name for name in candidates if name in found)
