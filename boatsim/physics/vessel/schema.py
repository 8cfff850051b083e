"""Schema of a vessel.toml: its tables as pydantic models, and the rules for names of channels."""

import re
from typing import Literal, Self

from pydantic import Field, PositiveFloat, field_validator, model_validator

from boatsim.errors import BadInput
from boatsim.files import Table
from boatsim.physics.facts import first_invalid_fact
from boatsim.physics.signals import COMPONENTS, POSE, RATES
from boatsim.physics.spread import SpreadTable

SMALLEST_HULL = 1e-4  # [m]
LARGEST_HULL = 1e4  # [m]
# The axes of `boatsim.physics.signals.AXES`, as a type
Dof = Literal["surge", "sway", "heave", "roll", "pitch", "yaw"]

# A channel becomes a column of every log
CHANNEL_NAME = re.compile(r"[\w.+-]{1,60}")
RESERVED_COLUMNS = (
    "t_s",
    "contacts",
    "wave_elevation_m",
    "water_north_mps",
    "water_east_mps",
    *POSE,
    *RATES,
    *map("force_{}".format, COMPONENTS.values()),
    *map("wind_{}".format, COMPONENTS.values()),
)
RESERVED_PREFIXES = (
    "sent_",
    "actual_",
    "sensed_",
    "camera_",
    "estimate_",
    "reference_",
    "goal_",
)
# Keys of [diagnosis] that replace a rule and therefore need a reason
OVERRIDES = ("ambient", "horizon", "rate", "noise")


class Body(Table):
    """Rigid body of a vessel: mass, moments of inertia and mass centre.

    Inertia is about the mass centre, which is the origin of motion unless `centre` is given.

    Attributes:
        mass: Mass [kg].
        roll_inertia: Inertia about the longitudinal axis [kg m^2].
        yaw_inertia: Inertia about the vertical axis [kg m^2].
        pitch_inertia: Inertia about the transverse axis [kg m^2]; required for a vessel that is
            free in pitch.
        centre: Mass centre ahead of the origin of motion and below it [m].
    """

    mass: float = Field(gt=0)
    roll_inertia: float = Field(gt=0)
    yaw_inertia: float = Field(gt=0)
    pitch_inertia: float | None = Field(default=None, gt=0)
    centre: tuple[float, float] = (0.0, 0.0)

    def effective_pitch_inertia(self) -> float:
        """Return the pitch inertia of the rigid body [kg m^2].

        Without a value it is the largest of the other two, so that roll causes no other rotation.
        """
        if self.pitch_inertia is None:
            return max(self.roll_inertia, self.yaw_inertia)
        return self.pitch_inertia


class CommandChannel(Table):
    """A command channel of the vessel, such as a thrust or a rudder angle, with its range.

    Attributes:
        low: Smallest allowed value.
        high: Largest allowed value.
        neutral: Value where nothing is sent; required for a channel whose range excludes 0.
        turns: Side to which a positive rudder command turns the vessel. Recordings with the
            opposite sign are converted.
        about: Description.
    """

    low: float
    high: float
    neutral: float = 0.0
    turns: Literal["", "starboard", "port"] = ""
    about: str = ""


class MeasuredChannel(Table):
    """A measured quantity of the environment, such as the wind.

    It is an input of the model but not a command.

    Attributes:
        neutral: Value in a simulation whose scenario gives none.
        about: Description.
    """

    neutral: float = 0.0
    about: str = ""


class DiagnosisTable(Table):
    """Assumptions that a diagnosis makes about this vessel before it has read data.

    Attributes:
        leave_out: Candidate effects that are not tested, each with its reason.
        also: Further candidates, as [[effect]] tables, for example an effect on another channel.
        coefficient_uncertainty: Relative standard deviation of the model's coefficients, by kind.
        ambient: Tolerated unmodelled force by axis, rms [N, N m]; replaces a rule of
            `boatsim.diagnosis.priors`.
        horizon: Length of a free run [s]; replaces a rule.
        rate: Rate of the rows that are used [Hz]; replaces a rule.
        noise: Standard deviation of the instruments by family; replaces a rule.
        reasons: Reason of each key that replaces a rule.
        facts: Facts that hold where a recording gives none, such as `walls_m`.
    """

    leave_out: dict[str, str] = {}
    also: list[dict[str, object]] = []
    coefficient_uncertainty: dict[
        Literal["damping", "thrust", "added_mass", "restoring", "wind", "wave"], PositiveFloat
    ] = {}
    ambient: dict[Dof, PositiveFloat] = {}
    horizon: float | None = Field(default=None, gt=0)
    rate: float | None = Field(default=None, gt=0)
    noise: dict[str, PositiveFloat] = {}
    reasons: dict[str, str] = {}
    facts: dict[str, float | str | bool | list[float]] = {}

    @field_validator("facts")
    @classmethod
    def _check_facts(cls, facts: dict[str, object]) -> dict[str, object]:
        if found := first_invalid_fact(facts):
            raise ValueError(f"{found[0]} = {facts[found[0]]!r}; allowed is {found[1]}")
        return facts

    @model_validator(mode="after")
    def _check_reasons(self) -> Self:
        for key in OVERRIDES:
            if getattr(self, key) and not self.reasons.get(key):
                raise ValueError(f"{key} replaces a rule; give the reason in reasons.{key}")
        return self


class ManoeuvringTable(Table):
    """Table of a vessel file with the commands of the standard manoeuvres.

    Missing values are derived from the vessel's channels.

    Attributes:
        ahead: Commands of the approach.
        astern: Commands of a crash stop.
        steer: Command per rad of helm.
        speed: Speed at which the approach begins [m/s].
    """

    ahead: dict[str, float] = {}
    astern: dict[str, float] = {}
    steer: dict[str, float] = {}
    speed: float | None = Field(default=None, gt=0)


class VesselFile(Table):
    """Content of a vessel file (vessel.toml) as a checked data model.

    `Vessel` has the descriptions of the keys that it shares with this table.

    Attributes:
        based_on: Vessel whose folder holds the hull and the effects' own files; set in a patched
            file.
        found: Names of the effects that a diagnosis identified; set in a patched file.
        spread: Uncertainty of the fitted parameters; set in a patched file.
        freedoms: Degrees of freedom.
        effect: The [[effect]] tables.
        loads: Load conditions: name -> values that differ.
    """

    about: str
    source: str
    based_on: str = ""
    found: list[str] = []
    spread: SpreadTable = SpreadTable()
    hull: str = "hull.xml"
    freedoms: list[Dof]
    length: float = Field(ge=SMALLEST_HULL, le=LARGEST_HULL)
    beam: float = Field(ge=SMALLEST_HULL, le=LARGEST_HULL)
    draught: float = Field(ge=SMALLEST_HULL, le=LARGEST_HULL)
    scale: float | None = Field(default=None, gt=0)
    scales: dict[str, float] = {}
    body: Body
    geometry: dict[str, float] = {}
    marks: dict[str, tuple[float, float]] = {}
    channels: dict[str, CommandChannel] = {}
    measured: dict[str, MeasuredChannel] = {}
    columns: dict[str, str] = {}
    effect: list[dict[str, object]] = []
    loads: dict[str, dict[str, object]] = {}
    diagnosis: DiagnosisTable = DiagnosisTable()
    estimated: dict[str, PositiveFloat] = {}
    manoeuvring: ManoeuvringTable = ManoeuvringTable()

    @field_validator("estimated", mode="before")
    @classmethod
    def _flatten_estimated(cls, table: object) -> object:
        """The table with the keys of its inner tables joined to theirs by a dot."""
        if not isinstance(table, dict):
            return table
        flat: dict[str, object] = {}
        for key, value in table.items():
            if isinstance(value, dict):
                flat |= {f"{key}.{inner}": number for inner, number in value.items()}
            else:
                flat[key] = value
        return flat

    def check_channels(self, label: str) -> None:
        """Check names and ranges of the command channels of a vessel file.

        Args:
            label: Name of the file in messages.

        Raises:
            BadInput: For a reserved or malformed name, an empty range, a neutral value outside the
                range, or a channel that is both commanded and measured.
        """
        for name, channel in self.channels.items():
            _check_name(name, label)
            _check_range(name, channel, label)
        for name in self.measured:
            if name in self.channels:
                raise BadInput(
                    f"{label}: {name} is in both [channels] and [measured]; allowed is one of them"
                )


def _check_name(name: str, label: str) -> None:
    if not CHANNEL_NAME.fullmatch(name):
        reason = "allowed are letters, digits and _ . + -"
    elif name in RESERVED_COLUMNS or name.startswith(RESERVED_PREFIXES):
        reason = "it is reserved for a column of a run's log"
    else:
        return
    raise BadInput(f"{label}: channels: {name!r} is not allowed as a name; {reason}")


def _check_range(name: str, channel: CommandChannel, label: str) -> None:
    low, high, neutral = channel.low, channel.high, channel.neutral
    if not low < high:
        raise BadInput(
            f"{label}: channels.{name}: low = {low:g}, high = {high:g}; low must be below high"
        )
    if low <= neutral <= high:
        return
    found = "neutral is missing and cannot be 0"
    if "neutral" in channel.model_fields_set:
        found = f"neutral = {neutral:g}"
    raise BadInput(f"{label}: channels.{name}: {found}; allowed {low:g} to {high:g}")
