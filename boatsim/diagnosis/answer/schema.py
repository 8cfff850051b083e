"""Schema of diagnosis.json: one typed dictionary for each table."""

from typing import Literal, NotRequired, TypedDict

from boatsim.diagnosis.config import Plain

# signals whose rms error on held-out recordings is reported
Family = Literal["position_rms_m", "heading_rms_rad", "roll_rms_rad", "heave_rms_m"]


class ParameterEntry(TypedDict):
    """Fitted value, standard deviation and unit of an effect's parameter, in diagnosis.json."""

    value: float
    sd: float
    unit: str
    at_bound: NotRequired[bool]  # at a bound of its range: the true value may lie outside
    statement: NotRequired[str]  # sentence on a ratio in per cent


AloneEntry = TypedDict("AloneEntry", {"without": float, "with": float})
"""Rms errors of free runs over held-out recordings without and with one effect [m or rad]."""


class InGroup(TypedDict, total=False):
    """Group of recordings in which alone an effect acts, in diagnosis.json, if any."""

    group: str  # in which alone it acts, or differs from the others
    same_recordings: list[str]  # further groups of exactly the same recordings


class Acting(InGroup, total=False):
    """Signals on which an effect acts, and the group of recordings, in diagnosis.json, if any."""

    on: list[str]
    # other groups in which the same effect explains the recordings as well in its place
    tied_groups: list[str]


class EffectEntry(Acting):
    """An effect identified by the diagnosis, with its evidence, probability and parameters.

    It is one entry of `effects` in diagnosis.json.
    """

    name: str
    kind: str  # "physics" or "measurement"
    probability: float  # that it is a true cause
    gain_nats: float  # log Bayes factor
    words: str
    tied_with: list[str]  # look-alikes
    parameters: dict[str, ParameterEntry]  # by name with unit
    # errors without it, all else refitted, and with it
    alone: NotRequired[dict[Family, AloneEntry]]
    # whether held-out recordings confirm it; else they could not show it
    confirmed: NotRequired[bool]


class RefinedEntry(Acting):
    """A better value of a number that the vessel file calls an estimate, in diagnosis.json.

    It comes from an identified effect, whose keys it has too, or from a refitted coefficient. An
    effect that refines several numbers has an entry for each.
    """

    name: str  # of the effect, or "effect.number" of a coefficient
    number: str  # in words
    before: float  # in the vessel file, 0 if the file does not have the number
    after: float  # in the patched vessel
    sd: float  # of `after`
    unit: str
    off: float | None  # change relative to `before`; None where that is 0
    kind: NotRequired[str]
    probability: NotRequired[float]
    gain_nats: NotRequired[float]
    words: NotRequired[str]
    tied_with: NotRequired[list[str]]
    parameters: NotRequired[dict[str, ParameterEntry]]
    alone: NotRequired[dict[Family, AloneEntry]]
    confirmed: NotRequired[bool]


class PossibleEntry(InGroup):
    """An effect that may act, but that these recordings do not confirm, in diagnosis.json."""

    name: str
    probability: float
    gain_nats: float
    words: str
    why: str  # reason why it is not among the identified effects
    in_patch: NotRequired[bool]  # whether the patched vessel contains it, as a description; it
    # does not if such effects make simulations of held-out recordings worse
    parameters: NotRequired[dict[str, "ParameterEntry"]]
    alone: NotRequired[dict[Family, AloneEntry]]
    confirmed: NotRequired[bool]
    together_with: NotRequired[str]  # effect that balances it; free runs require both or neither


class AddedEntry(InGroup):
    """An effect that the corrected vessel has for better simulations alone, in diagnosis.json.

    Nothing is stated about whether it is a cause.
    """

    name: str
    kind: str  # "physics" or "measurement"
    words: str
    parameters: dict[str, ParameterEntry]


class FactorEntry(TypedDict):
    """Size of an effect on a part of the data relative to its fitted size, in diagnosis.json."""

    value: float
    sd: float


class VariationEntry(TypedDict):
    """How much the size of an effect varies between parts of the data, in diagnosis.json."""

    excess: float  # sd between the parts beyond their own sd, as a share of the fitted size
    chi_square: float  # of the hypothesis that the size is the same
    dof: int
    precision: float  # mean inverse variance of the size on a part, as a share of the fitted size


class ConsistencyEntry(TypedDict):
    """Statistics of an effect that tell a true cause from a stand-in, in diagnosis.json.

    A stand-in is an effect that only imitates an unmodelled cause.
    """

    recordings: list[FactorEntry]  # on each fitted recording
    held_out: FactorEntry
    between_times: VariationEntry
    between_ranges: VariationEntry  # of the quantity with the largest variation
    quantity: str
    parts_that_gain: float  # share of the parts in time whose likelihood increases
    held_out_gain: float  # [nats]
    axes: list[str]  # along which it acts
    alternative_gain: float  # [nats] of the best single-term force along them in its place
    # largest distance from zero effect, in prior sds; 0 for an effect of the surroundings
    prior_distance: float
    at_bound: bool


class EffectSignsEntry(TypedDict):
    """Statistics and resulting probability that an identified effect is a true cause.

    It is an entry of diagnosis.json.
    """

    name: str
    gain_nats: float
    stochastic: bool
    refines: bool
    tied_with: list[str]
    probability: float  # that it, or one of its look-alikes, is a true cause
    signs: ConsistencyEntry


class LogSignsEntry(TypedDict):
    """Statistics of the recordings that indicate a cause outside the candidate effects.

    It is an entry of diagnosis.json.
    """

    coefficient_shift: float  # rms, in prior sds
    force_ratio: float  # of the fitted to the assumed level of the latent force
    unexplained: float  # evidence as a share of the threshold of an unknown cause
    structure_gain: float  # [nats]
    effects_gain: float  # [nats]
    effects: int
    held_out_unexplained: float  # the share `unexplained` on held-out recordings
    held_out_structure: float  # [nats]
    held_out_structured: bool  # whether that structure is significant
    unexplained_gain: float  # evidence for a force beyond the assumed disturbance [nats]
    structured: bool  # whether the dependence with the evidence structure_gain is significant
    estimated: bool  # whether the vessel file calls any of its numbers estimated


class SignsEntry(TypedDict):
    """All statistics from which the probabilities of identified effects are computed.

    It is the table `signs` of diagnosis.json.
    """

    effects: list[EffectSignsEntry]
    log: LogSignsEntry


class TermEntry(TypedDict):
    """One term of a formula that symbolic regression found, in diagnosis.json."""

    of: str  # what it varies with, in words
    value: float
    sd: float
    unit: str  # force or moment per product of the factors; "" for a share of the thrust
    gain_nats: float
    run: NotRequired[str]  # recording of which it is an event


class DescribedEntry(TypedDict):
    """A formula for a force along one axis that no candidate effect explains, in diagnosis.json."""

    axis: str  # "surge" ... "yaw", "north", "east", or "thrust"
    statement: str
    terms: list[TermEntry]
    carries_over: bool  # it reduces the errors on held-out recordings


class StructureEntry(TypedDict):
    """The quantity that the unexplained force correlates with most, in diagnosis.json."""

    axis: str
    goes_with: str  # in words
    gain_nats: float
    p_value: float  # corrected for the number of quantities tested
    tried: int  # number of quantities tested


class DivergenceEntry(TypedDict):
    """Time and axis at which the vessel model stops following a recording, in diagnosis.json."""

    run: str
    from_s: float
    axis: str  # of the largest missing force there
    rms: float  # of that force from then on
    unit: str


class UnknownEntry(TypedDict):
    """Whether a force is missing that no candidate effect explains, with its evidence.

    It is the table `unknown` of diagnosis.json.
    """

    flag: bool
    gain_nats: float
    told_from_nats: float  # threshold of the gain; it increases with the evidence explained
    rest: NotRequired[dict[str, "StrengthEntry"]]  # force that the identified effects leave
    structure: NotRequired[StructureEntry]  # if that force varies with any quantity
    # effects that explain the force, but that are probably not its cause, if none of it remains
    stand_ins: NotRequired[list[str]]
    # whether only held-out recordings require the force
    held_out_only: NotRequired[bool]
    # if fits diverge: no candidate effect was ranked
    diverges: NotRequired[list[DivergenceEntry]]


class CandidateEntry(TypedDict):
    """Evidence and probability of one candidate effect tested alone, in diagnosis.json."""

    name: str
    gain_nats: float
    probability: float


class StrengthEntry(TypedDict):
    """Rms of the missing force of one axis over all recordings, in diagnosis.json."""

    rms: float
    sd: float
    unit: str


class MeanEntry(TypedDict):
    """The mean force along one body axis that the patched vessel leaves unexplained.

    It is an entry of diagnosis.json.
    """

    mean: float
    sd: float
    unit: str
    share_of_full_thrust: NotRequired[float]  # of a force, if drives push the vessel ahead


class IntervalEntry(TypedDict):
    """A time interval of a recording in which the vessel model lacks a force along an axis.

    It is an entry of diagnosis.json.
    """

    run: str
    from_s: float
    to_s: float
    axis: str


class RegionEntry(TypedDict):
    """A condition under which a force is missing, such as thrust astern, in diagnosis.json."""

    variable: str
    statement: str
    p_value: float


class WhereEntry(TypedDict):
    """Along which axes, when and under which conditions the vessel model lacks a force.

    It is the table `where` of diagnosis.json.
    """

    axes: dict[str, StrengthEntry]
    intervals: list[IntervalEntry]
    region: list[RegionEntry]


class FitEntry(TypedDict):
    """Rms errors of simulations of held-out recordings, by family of signals and by model.

    It is the table `fit` of diagnosis.json. The simulations use the recorded commands alone.
    """

    horizon_s: float
    held_out: list[str]
    position_rms_m: dict[str, float]
    heading_rms_rad: dict[str, float]
    roll_rms_rad: NotRequired[dict[str, float]]
    heave_rms_m: NotRequired[dict[str, float]]


class RecalibrationEntry(TypedDict):
    """Which refitted coefficients of the vessel model were adopted, in diagnosis.json."""

    adopted: bool  # else all coefficients have the value of the vessel file
    by_free_runs: NotRequired[bool]  # they minimise errors of free runs, not of the Kalman filter
    undetermined: list[str]  # "effect.number" of those that keep that value in any case
    refitted: dict[Family, float]  # rms errors on held-out recordings with refitted coefficients


class NextEntry(TypedDict, total=False):
    """The manoeuvre to record next, in diagnosis.json; empty if none would add evidence."""

    manoeuvre: str
    scenario: str
    separates: list[str]
    expected_gain_nats: float


class LeftOutEntry(TypedDict):
    """A candidate effect that was not tested, with the reason, in diagnosis.json."""

    name: str
    reason: str  # a fact, a missing column, or the vessel's own reason


class DisturbanceLevelEntry(TypedDict):
    """The assumed disturbance level (rms force) of one axis, in diagnosis.json."""

    rms: float
    unit: str
    share_of_full_thrust: NotRequired[float]  # of a force, if drives push the vessel ahead


class RulesEntry(TypedDict):
    """Assumptions made before any recording was evaluated, by rules or by the vessel file.

    It is the table `rules` of diagnosis.json.
    """

    ambient: dict[str, DisturbanceLevelEntry]
    time_constant_s: float
    horizon_s: float
    effect_gain_nats: float  # required for an effect, given the number of candidates
    overridden: dict[str, str]  # rule -> the vessel's reason


class OtherwiseEntry(TypedDict):
    """An alternative correction of a fault of a recording, in diagnosis.json."""

    words: str
    lines: list[str]


class LogEntry(TypedDict):
    """One finding of the quality checks of a recording, in diagnosis.json."""

    run: str  # file
    name: str
    # "fault": correct the file; "mended": corrected by the diagnosis; "limit": nothing is wrong;
    # "drive": how a drive answers its orders or how it reports; "unchecked": a check failed
    kind: str
    evidence: str
    sure: float  # probability
    spans_s: list[list[float]]  # intervals [s] in which it occurs; empty: everywhere
    lines: list[str]  # to write into recording.toml
    alternatives: list[OtherwiseEntry]
    remedy: NotRequired[str]
    words: NotRequired[str]  # "probably your log, not your boat", or "not checked"


class Answer(TypedDict):
    """The complete content of diagnosis.json, the machine-readable result of a diagnosis."""

    verdict: str  # "named", "ambiguous", "described", "unknown" or "nothing_missing"
    sentence: str
    seconds: float
    version: str
    effects: list[EffectEntry]
    refined: NotRequired[list[RefinedEntry]]  # empty for a vessel file without [estimated]
    also_possible: NotRequired[list[PossibleEntry]]
    # effects that were added to the corrected vessel because simulations get better by them
    added: NotRequired[list[AddedEntry]]
    # whether the corrected vessel minimises errors of free runs, not of the Kalman filter
    by_free_runs: NotRequired[bool]
    signs: NotRequired[SignsEntry]
    unknown: UnknownEntry
    described: list[DescribedEntry]
    mean_left: NotRequired[dict[str, MeanEntry]]  # by axis; empty if no mean force remains
    log: NotRequired[list[LogEntry]]  # problems of the recordings
    candidates: list[CandidateEntry]
    tried: NotRequired[list[str]]
    left_out: NotRequired[list[LeftOutEntry]]
    # what was not tried because the search's budget was spent, and late stages that failed, one
    # clause each; usually empty
    skipped: NotRequired[list[str]]
    facts: NotRequired[dict[str, object]]
    rules: NotRequired[RulesEntry]
    upper_limits: dict[str, dict[str, float]]
    # of parameters that limit a quantity, such as a rate: an effect is weaker with larger ones
    lower_limits: NotRequired[dict[str, dict[str, float]]]
    where: WhereEntry
    fit: FitEntry
    recalibration: NotRequired[RecalibrationEntry]  # absent if nothing could be fitted
    next_experiment: NextEntry
    patch: str
    config: NotRequired[dict[str, Plain]]  # all settings by dotted name, such as "select.odds"
