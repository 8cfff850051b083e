"""The `Vessel` dataclass: a vessel in one load condition, from a file or from Python."""

import dataclasses
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from math import inf
from pathlib import Path
from typing import Any, Self

from boatsim.arguments import (
    check_instance,
    checked_mapping,
    checked_name,
    checked_names,
    checked_number,
    type_error,
)
from boatsim.errors import BadInput, unknown_name_message
from boatsim.files import replace_file, validate_table
from boatsim.physics.content import vessel_reference
from boatsim.physics.estimate.base import HullParticulars
from boatsim.physics.kernel.equations import has_hull_fixed_axes
from boatsim.physics.kinds.effect import Effect
from boatsim.physics.kinds.release import CoefficientChange, CoefficientRelease
from boatsim.physics.param import UNSET
from boatsim.physics.spread import FittedUncertainty
from boatsim.physics.vessel.bindings import ChannelBindings, check_bindings
from boatsim.physics.vessel.effect_tables import effect_from_table, effect_table
from boatsim.physics.vessel.estimated import check_estimated_table
from boatsim.physics.vessel.plain_hull import hull_xml
from boatsim.physics.vessel.schema import (
    LARGEST_HULL,
    SMALLEST_HULL,
    Body,
    CommandChannel,
    DiagnosisTable,
    ManoeuvringTable,
    VesselFile,
)
from boatsim.physics.vessel.wave_axes import warn_of_unforced_axes
from boatsim.physics.vessel.wave_speed import warn_of_excitation_speed

FILE_NAME = "vessel.toml"
# Fields with the same name and type in `Vessel` and `VesselFile`
SAME_IN_FILE = (
    "about",
    "source",
    "hull",
    "length",
    "beam",
    "draught",
    "body",
    "geometry",
    "diagnosis",
    "scale",
    "scales",
    "columns",
    "manoeuvring",
    "marks",
    "measured",
    "estimated",
)


@dataclass(frozen=True, kw_only=True)
class Vessel(ChannelBindings):
    """A vessel in one load condition, with effects that are completed and ready to be compiled.

    `load_vessel` reads one from a file, `Vessel.from_effects` builds one in Python. A vessel is
    immutable: `replace`, `with_effect`, `without_effect` and `with_parameters` return changed
    vessels.

    >>> import boatsim
    >>> barge = boatsim.Vessel.from_effects(
    ...     name="barge",
    ...     dof=("surge", "sway", "yaw"),
    ...     length=2.0,
    ...     beam=0.8,
    ...     draught=0.2,
    ...     body={"mass": 120.0, "roll_inertia": 8.0, "yaw_inertia": 40.0},
    ...     channels={
    ...         "thrust_N": {"low": -50.0, "high": 50.0},
    ...         "angle_rad": {"low": -0.6, "high": 0.6},
    ...     },
    ...     effects=[
    ...         {"use": "added_mass", "surge": 10.0, "sway": 90.0, "yaw": 15.0},
    ...         {"use": "linear_damping", "surge": 12.0, "sway": 60.0, "yaw": 30.0},
    ...         {"use": "thruster", "x": -1.0, "on": {"thrust": "thrust_N", "angle": "angle_rad"}},
    ...     ],
    ... )
    >>> barge.actuators
    ('thrust_N', 'angle_rad')
    >>> windy = barge.with_effect({"use": "current", "north": 0.1})
    >>> heavy = windy.with_parameters({"body": {"mass": 150.0}})
    >>> heavy.body.mass, [effect.name for effect in heavy.effects]
    (150.0, ['added_mass', 'linear_damping', 'thruster', 'current'])
    >>> saved = heavy.save("out/barge")
    >>> boatsim.load_vessel("out/barge") == saved
    True

    Attributes:
        path: Folder of the hull and of the vessel's own effect files.
        file: Its vessel.toml; a file that does not exist for a vessel that was not saved.
        about: Description.
        source: Source of the numbers.
        hull: File name of the hull's MJCF in `path`.
        hull_xml: MJCF text used in place of that file; "" for a vessel from a file.
        geometry: Numbers for the drawing of the hull [m], [kg].
        load: Load conditions in force.
        loads: Names of all load conditions of the file.
        diagnosis: Assumptions of a diagnosis.
        estimated: Relative standard deviations of numbers that were neither measured nor published,
            by group ("damping") or by number ("thrust_lag.time_constant").
        scale: Full-scale length / this length.
        scales: Vessels that are the same hull at another scale -> their scale.
        columns: Signal -> column of the vessel's recordings; "-" in front inverts the sign.
        manoeuvring: Commands of the standard manoeuvres.
        marks: Points that a camera above follows, ahead and to starboard of the mass centre [m].
        found: Names of the effects that a diagnosis identified.
        spread: Uncertainty of the fitted parameters, None where nothing was fitted.
    """

    path: Path
    file: Path
    about: str
    source: str
    hull: str = "hull.xml"
    hull_xml: str = ""
    geometry: dict[str, float]
    load: tuple[str, ...] = ()
    loads: tuple[str, ...] = ()
    diagnosis: DiagnosisTable = DiagnosisTable()
    estimated: Mapping[str, float] = field(default_factory=dict)
    scale: float | None = None
    scales: Mapping[str, float] = field(default_factory=dict)
    columns: Mapping[str, str] = field(default_factory=dict)
    manoeuvring: ManoeuvringTable = ManoeuvringTable()
    marks: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    found: tuple[str, ...] = ()
    spread: FittedUncertainty | None = field(default=None, compare=False)

    # Construction
    # ----------------------------------------------------------------------------------------------

    @classmethod
    def from_file(cls, content: VesselFile, name: str, file: Path, folder: Path) -> Self:
        """Create a vessel from the checked content of a vessel.toml, still without its effects.

        It is in no load condition.

        Args:
            content: Content of the file.
            name: Name of the vessel.
            file: The vessel.toml.
            folder: Folder of the hull and of the vessel's own effect files.
        """
        same = {key: getattr(content, key) for key in SAME_IN_FILE}
        return cls(
            name=name,
            path=folder,
            file=file,
            dof=tuple(content.freedoms),
            commands=content.channels,
            loads=tuple(content.loads),
            found=tuple(content.found),
            spread=FittedUncertainty.from_table(content.spread),
            **same,
        )

    @classmethod
    def from_effects(
        cls,
        *,
        name: str,
        dof: Sequence[str],
        length: float,
        beam: float,
        draught: float,
        body: Body | Mapping[str, object],
        effects: Sequence[Effect | Mapping[str, object]],
        channels: Mapping[str, CommandChannel | Mapping[str, object]],
        **more: object,
    ) -> Self:
        """Build a vessel in Python, without a file. Its hull is drawn as a plain box with a bow.

        Args:
            name: Name of the vessel.
            dof: Degrees of freedom, of "surge", "sway", "heave", "roll", "pitch" and "yaw".
            length: Length [m].
            beam: Beam [m].
            draught: Draught [m].
            body: Mass [kg] and inertia [kg m^2]: `mass`, `roll_inertia`, `yaw_inertia`,
                `pitch_inertia`, `centre`.
            effects: Effects in the order of composition: objects, or tables as in [[effect]] of a
                vessel.toml.
            channels: Command channels: `low`, `high`, `neutral`, `turns`, `about`.
            more: Further keys of a vessel.toml, such as `about`, `geometry`, `measured` and
                `manoeuvring`.

        Raises:
            BadInput: For keys and values that are not allowed, or an effect that names an unknown
                channel.
        """
        name = checked_name("name", name)
        checked_number("length", length, SMALLEST_HULL, LARGEST_HULL, "m")
        table: dict[str, object] = {
            "about": name,
            "source": "Python",
            "freedoms": checked_names("dof", dof),
            "length": length,
            "beam": beam,
            "draught": draught,
            "body": body,
            "channels": channels,
            # The drawing's mass centre is at mid-length and in the water surface
            "geometry": {"cg_from_transom": 0.5 * length, "cg_above_keel": draught},
        }
        content = validate_table(VesselFile, table | more, name)
        content.check_channels(name)
        if content.loads or content.effect:
            raise BadInput(f"{name}: loads and effect are not allowed here; give effects")
        vessel = cls.from_file(content, name, Path(name) / FILE_NAME, Path(name))
        hull = HullParticulars(length, beam, content.body.mass, draught, hulls=1, breadth=beam)
        text = hull_xml(
            hull, name, "Drawn by boatsim from the dimensions; forces are in vessel.toml."
        )
        vessel = dataclasses.replace(vessel, hull_xml=text)._with_effects(effects)
        check_estimated_table(vessel.estimated, vessel, name)
        return vessel

    # Changes
    # ----------------------------------------------------------------------------------------------

    def replace(self, **changes: Any) -> Self:
        """Return a copy of the vessel with other values of its fields, such as `length` or `body`.

        Parameters of effects that a rule computes from these values are computed again.

        Args:
            changes: Fields with their new values.

        Returns:
            The changed vessel.

        Raises:
            BadInput: If an effect names a channel that does not exist then.
        """
        changed = dataclasses.replace(self, **changes)
        changed._check_fields()
        return changed._with_effects(changed.effects)

    def _check_fields(self) -> None:
        """Raise BadInput or TypeError for a field that a file could not have."""
        table = {key: getattr(self, key) for key in SAME_IN_FILE}
        table |= {"channels": self.commands, "freedoms": checked_names("dof", self.dof)}
        for name in ("name", "path", "file"):
            checked_name(name, getattr(self, name))
        check_instance("body", self.body, Body, "a Body")
        check_instance("diagnosis", self.diagnosis, DiagnosisTable, "a DiagnosisTable")
        check_instance("manoeuvring", self.manoeuvring, ManoeuvringTable, "a ManoeuvringTable")
        validate_table(VesselFile, table, self.name)

    def with_effect(self, effect: Effect | Mapping[str, object]) -> Self:
        """Return a copy of the vessel with one more effect.

        Args:
            effect: The effect, or its table as in [[effect]] of a vessel.toml.

        Raises:
            BadInput: If the name of the effect is taken, or it names a channel or an effect that
                does not exist.
        """
        changed = self.with_completed_effect(self._effect_from(effect))
        changed.check(self.name)
        return changed

    def without_effect(self, name: str) -> Self:
        """Return a copy of the vessel without the effects that have a given name or type.

        Args:
            name: Name of an effect, or of a type of effects as in `use`.

        Returns:
            The changed vessel.

        Raises:
            BadInput: If there is no such effect, or another effect needs it.
        """
        check_instance("name", name, str, "a text")
        names = self.names_of(name)
        if not names:
            raise BadInput(unknown_name_message(f"{self.name}: effect", name, self._effect_names()))
        return self._with_effects([e for e in self.effects if e.name not in names])

    def with_parameters(self, parameters: Mapping[str, Mapping[str, object]]) -> Self:
        """Return a copy of the vessel with other values of effect parameters or of the rigid body.

        The table [set] of a scenario does the same.

        Args:
            parameters: Name of an effect, or "body" -> parameter -> value.

        Raises:
            BadInput: For an unknown name, or a value out of bounds.
        """
        changed = self
        values = {}
        for name, table in checked_mapping("parameters", parameters).items():
            values[name] = dict(checked_mapping(f"parameters[{name!r}]", table))
        if "body" in values:
            table = self.body.model_dump(exclude_none=True) | values.pop("body")
            changed = dataclasses.replace(
                self, body=validate_table(Body, table, f"{self.name}: body")
            )
        for name in values:
            if name not in self._effect_names():
                names = ["body", *self._effect_names()]
                raise BadInput(unknown_name_message(f"{self.name}: effect", name, names))
        effects: list[Effect] = []
        for effect in self.effects:
            if effect.name in values:
                effect = self._with_values(effect, values[effect.name])
            effects.append(effect)
        return changed._with_effects(effects)

    def with_measured(self, values: Mapping[str, float]) -> Self:
        """Return a copy of the vessel with other default values of measured signals, such as wind.

        Args:
            values: Value [unit of the channel] by the name of the channel.

        Returns:
            The changed vessel.

        Raises:
            BadInput: For a channel that the vessel does not measure.
        """
        measured = dict(self.measured)
        for name, value in checked_mapping("values", values).items():
            if name not in measured:
                raise BadInput(unknown_name_message(f"{self.name}: measured", name, measured))
            neutral = checked_number(f"values[{name!r}]", value)
            measured[name] = measured[name].model_copy(update={"neutral": neutral})
        return dataclasses.replace(self, measured=measured)

    def with_completed_effect(self, effect: Effect) -> Self:
        """Return a copy of the vessel with one more effect, all of whose parameters get a value.

        The bindings of the effect are not checked. A `CoefficientRelease` is not added: it changes
        the numbers that it names.

        Args:
            effect: The effect.

        Returns:
            The changed vessel.

        Raises:
            BadInput: If a parameter cannot be computed from the vessel's numbers.
        """
        try:
            effect = effect.with_all_parameters(self)
        except (ArithmeticError, ValueError) as error:
            # A rule that divides by zero, or takes the root of a negative number
            raise BadInput(
                f"{self.name}: {effect.name}: a parameter cannot be computed from the vessel "
                f"({error})"
            ) from None
        if not isinstance(effect, CoefficientRelease):
            return dataclasses.replace(self, effects=(*self.effects, effect))
        changed = self
        for change in effect.changes(self):
            changed = changed._with_change(change, getattr(effect, change.parameter))
        return changed

    def _with_change(self, change: CoefficientChange, value: float) -> Self:
        """Return the vessel with one number changed, and all filled-in numbers that follow it."""
        changed = self
        if change.owner == "body":
            new = change.changed_value(getattr(self.body, change.key), value)
            if new <= 0.0:
                raise BadInput(f"{self.name}: body.{change.key} = {new:g}; allowed is more than 0")
            body = self.body.model_copy(update={change.key: new})
            changed = dataclasses.replace(self, body=body)
            source = f"vessel.body.{change.key}"
        else:
            new = change.changed_value(getattr(self.effect(change.owner), change.key), value)
            source = f"{change.owner}.{change.key}"
        effects: list[Effect] = []
        for effect in self.effects:
            params = type(effect).params()
            keys = [n for n in effect.filled if params[n].follows.removesuffix("?") == source]
            if effect.name == change.owner:
                keys.append(change.key)
            effects.append(effect.with_values(dict.fromkeys(keys, new)))
        return dataclasses.replace(changed, effects=tuple(effects))

    def _with_values(self, effect: Effect, values: Mapping[str, object]) -> Effect:
        params = type(effect).params()
        for key in values:
            if key not in params:
                raise BadInput(unknown_name_message(f"{self.name}: {effect.name}", key, params))
        return effect.with_values({**values, "filled": effect.filled - set(values)})

    def _with_effects(self, effects: Sequence[Effect | Mapping[str, object]]) -> Self:
        """Return the vessel with these effects, each completed by those before it, and check it."""
        given: object = effects
        if not isinstance(given, Iterable) or isinstance(given, str | bytes | Mapping):
            raise type_error("effects", given, "a list of effects")
        vessel = dataclasses.replace(self, effects=())
        for effect in effects:
            effect = self._effect_from(effect, "effects")
            if effect.filled:
                unset = dict.fromkeys(effect.filled, UNSET)
                effect = effect.with_values({**unset, "filled": frozenset()})
            vessel = vessel.with_completed_effect(effect)
        vessel.check(self.name)
        return vessel

    def _effect_from(
        self, effect: Effect | Mapping[str, object], argument: str = "effect"
    ) -> Effect:
        if isinstance(effect, Effect):
            return effect
        table = checked_mapping(argument, effect)
        return effect_from_table(table, self.name, self.path)

    def _effect_names(self) -> list[str]:
        return [effect.name for effect in self.effects]

    def check(self, label: str) -> None:
        """Check the channel bindings of all effects, and that the rigid body suits the free axes.

        Waves that exert no force in some degree of freedom cause a warning, and so do loads of
        waves at a forward speed next to a radiation force without its terms of speed.

        Args:
            label: Name of the file in messages.

        Raises:
            BadInput: One line with file, key and what is allowed.
        """
        check_bindings(self, label)
        if "pitch" in self.dof and self.body.pitch_inertia is None:
            raise BadInput(f"{label}: body.pitch_inertia is missing; {self.name} is free in pitch")
        if (
            self.body.centre[1]
            and "roll" in self.dof
            and not has_hull_fixed_axes(frozenset(self.dof))
        ):
            raise BadInput(
                f"{label}: body.centre = {self.body.centre}; allowed is a height of 0 where "
                "pitch is held"
            )
        warn_of_unforced_axes(self.name, self.dof, self.effects)
        warn_of_excitation_speed(self.name, self.effects)

    # Use
    # ----------------------------------------------------------------------------------------------

    @property
    def turns_over(self) -> bool:
        """Whether the vessel may roll to any angle, because an effect of it holds there."""
        return any(type(effect).turns_over for effect in self.effects)

    def recorded_limits(self) -> dict[str, tuple[float, float]]:
        """Return the range (low, high) within which a recording may have each input, by name.

        The direction of a drive that can turn all round (`full_turns`) is unbounded, because a log
        may count its turns on.
        """
        return self.limits() | dict.fromkeys(self.full_turns, (-inf, inf))

    def save(self, folder: Path | str) -> Self:
        """Write the vessel in its present load condition to a vessel.toml file.

        A vessel from a file keeps the hull of its folder by `based_on`. For a vessel without a hull
        file a plain hull.xml is written, unless the folder has one. Load conditions of the file are
        not written.

        Args:
            folder: Folder of the new file; its name is the name of the saved vessel.

        Returns:
            The saved vessel, as `load_vessel` reads it.
        """
        place = Path(checked_name("folder", folder)).resolve()
        import tomlkit  # only here, because every command loads a vessel and few save one

        table = self._table(place)
        with replace_file(place / FILE_NAME) as temporary:
            temporary.write_text(tomlkit.dumps(table), encoding="utf-8")
        own_hull = place / self.hull
        if self.hull_xml and not own_hull.is_file():
            own_hull.write_text(self.hull_xml, encoding="utf-8")
        path = self.path
        if self.hull_xml:
            path = place
        return dataclasses.replace(
            self,
            name=place.name,
            path=path,
            file=place / FILE_NAME,
            hull_xml="",
            load=(),
            loads=(),
        )

    def _table(self, folder: Path) -> dict[str, object]:
        """Content of the vessel.toml in a folder."""
        table: dict[str, object] = {}
        for key in SAME_IN_FILE:
            value = _toml_value(getattr(self, key))
            if value not in (None, {}):
                table[key] = value
        table |= {"freedoms": list(self.dof), "channels": _toml_value(self.commands)}
        if not self.hull_xml and self.path != folder:
            table["based_on"] = vessel_reference(self.path / FILE_NAME)
        if self.found:
            table["found"] = list(self.found)
        if self.spread is not None:
            table["spread"] = self.spread.to_table()
        # Tables come last in TOML
        plain = {key: value for key, value in table.items() if not isinstance(value, dict)}
        return plain | table | {"effect": self._effect_tables()}

    def _effect_tables(self) -> list[dict[str, object]]:
        """Tables of the effects, with filled-in parameters that rules would not reproduce."""
        tables = []
        vessel = dataclasses.replace(self, effects=())
        for effect in self.effects:
            table = effect_table(effect)
            computed = effect_from_table(table, self.name, self.path).with_all_parameters(vessel)
            for name in effect.filled:
                value = getattr(effect, name)
                if value != getattr(computed, name):
                    table[name] = value
            tables.append(table)
            vessel = dataclasses.replace(vessel, effects=(*vessel.effects, effect))
        return tables


def _toml_value(value: object) -> object:
    """A value of a vessel's field as it stands in a file; {} for a table without values."""
    if isinstance(value, Mapping):
        return dict(zip(value, map(_toml_value, value.values()), strict=True))
    if isinstance(value, tuple):
        return list(value)
    if hasattr(value, "model_dump"):
        return value.model_dump(exclude_unset=True, exclude_none=True)
    return value
