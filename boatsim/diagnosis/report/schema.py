"""What diagnosis.json holds, table by table."""

from typing import Literal, NotRequired, TypedDict

from boatsim.diagnosis.config import Plain

Family = Literal[
    "position_rms_m", "heading_rms_rad", "roll_rms_rad"
]  # of signals whose error on unseen data is told


class ParameterEntry(TypedDict):
    """A fitted parameter of an effect that was found."""

    value: float
    sd: float
    unit: str
    at_bound: NotRequired[bool]  # as far as the entry allows: the data may want more


class Acting(TypedDict, total=False):
    """What an effect acts on, where its table says so."""

    on: list[str]


class EffectEntry(Acting):
    """An effect that was found."""

    name: str
    kind: str  # "physics" or "measurement"
    probability: float
    gain_nats: float
    words: str
    tied_with: list[str]  # look-alikes
    parameters: dict[str, ParameterEntry]  # by name with unit


class TermEntry(TypedDict):
    """One term of a described law."""

    of: str  # what it goes with, in words
    value: float
    sd: float
    # of the value: force or moment per product of what it goes with; "" for a share of the thrust
    unit: str
    gain_nats: float
    run: NotRequired[str]  # the recording of which it is an event


class DescribedEntry(TypedDict):
    """A law written down for what no entry of the library explains, along one axis."""

    axis: str  # "surge" ... "yaw", "north", "east", or "thrust"
    statement: str
    terms: list[TermEntry]
    carries_over: bool  # free runs over unseen recordings get better by it


class StructureEntry(TypedDict):
    """What the force left over goes with."""

    axis: str
    goes_with: str  # in words
    gain_nats: float
    p_value: float  # corrected for all that were tried
    tried: int


class UnknownEntry(TypedDict):
    """Whether something is missing that no entry of the library explains."""

    flag: bool
    gain_nats: float
    told_from_nats: float  # the gain from which it is flagged: more where entries explained much
    rest: NotRequired[
        dict[str, "StrengthEntry"]
    ]  # force that the named effects leave over, where something is missing
    structure: NotRequired[StructureEntry]  # where that force goes with something, be it weak


class CandidateEntry(TypedDict):
    """An entry of the library, tried alone."""

    name: str
    gain_nats: float
    probability: float


class StrengthEntry(TypedDict):
    """The missing force of one axis over all runs."""

    rms: float
    sd: float
    unit: str


class MeanEntry(TypedDict):
    """A force that pushes the same way all along and stays in the patched vessel, along one axis of the hull."""

    mean: float
    sd: float
    unit: str
    share_of_full_thrust: NotRequired[float]  # of a force, where the vessel's drives push ahead


class IntervalEntry(TypedDict):
    """A stretch of a run in which the force of an axis is missing."""

    run: str
    from_s: float
    to_s: float
    axis: str


class RegionEntry(TypedDict):
    """A state region in which a force is missing."""

    variable: str
    statement: str
    p_value: float


class WhereEntry(TypedDict):
    """Where what is missing shows."""

    axes: dict[str, StrengthEntry]
    intervals: list[IntervalEntry]
    region: list[RegionEntry]


class FitEntry(TypedDict):
    """Rms error on unseen data by model, for each family of signals."""

    horizon_s: float
    held_out: list[str]
    position_rms_m: dict[str, float]
    heading_rms_rad: dict[str, float]
    roll_rms_rad: NotRequired[dict[str, float]]


class NextEntry(TypedDict, total=False):
    """What to record next; empty where no manoeuvre would tell more."""

    manoeuvre: str
    scenario: str
    separates: list[str]
    expected_gain_nats: float


class LeftOutEntry(TypedDict):
    """An entry of the library that was not tried."""

    name: str
    reason: str  # the fact, the column that is missing, or the vessel's own reason


class AmbientEntry(TypedDict):
    """The unmodelled force of one axis that is nobody's fault."""

    rms: float
    unit: str
    share_of_full_thrust: NotRequired[float]  # of a force, where the vessel's drives push ahead


class RulesEntry(TypedDict):
    """What was taken for granted before any data were seen, by one rule for every boat or by the file's own word."""

    ambient: dict[str, AmbientEntry]
    time_constant_s: float
    horizon_s: float
    effect_gain_nats: float  # that an effect needs, for so many tried
    overridden: dict[str, str]  # rule -> the vessel's reason


class OtherwiseEntry(TypedDict):
    """What explains a log as well as a finding on it does."""

    words: str
    lines: list[str]


class LogEntry(TypedDict):
    """What was found wrong with a log."""

    run: str  # file
    name: str
    kind: (
        str  # "fault": put the file right; "mended": left out by itself; "limit": nothing is wrong
    )
    evidence: str
    sure: float
    spans_s: list[list[float]]  # where it shows; empty: all along
    lines: list[str]  # to write into recording.toml
    alternatives: list[OtherwiseEntry]
    remedy: NotRequired[str]
    words: NotRequired[str]  # "probably your log, not your boat"


class Answer(TypedDict):
    """The whole of diagnosis.json."""

    verdict: str  # "named", "ambiguous", "described", "unknown" or "nothing_missing"
    sentence: str
    seconds: float
    version: str
    effects: list[EffectEntry]
    unknown: UnknownEntry
    described: list[DescribedEntry]
    mean_left: NotRequired[dict[str, MeanEntry]]  # by axis; empty where no mean force stays
    log: NotRequired[list[LogEntry]]  # what is wrong with the recordings themselves
    candidates: list[CandidateEntry]
    tried: NotRequired[list[str]]
    left_out: NotRequired[list[LeftOutEntry]]
    facts: NotRequired[dict[str, object]]
    rules: NotRequired[RulesEntry]
    upper_limits: dict[str, dict[str, float]]
    where: WhereEntry
    fit: FitEntry
    next_experiment: NextEntry
    patch: str
    # all settings of the diagnosis by dotted name, such as "select.odds"
    config: NotRequired[dict[str, Plain]]
