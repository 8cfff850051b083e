"""Channel bindings of a vessel: which commands and measured signals each effect acts on."""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from math import inf

from boatsim.errors import BadInput, unknown_name_message
from boatsim.physics.kinds.channel import ChannelEffect
from boatsim.physics.kinds.effect import Effect
from boatsim.physics.kinds.filtered import FilteredSignal
from boatsim.physics.vessel.schema import Body, CommandChannel, MeasuredChannel

FULL_TURN = 6.28  # [rad] range of an angle that spans a full turn, rounded down


@dataclass(frozen=True, kw_only=True)
class ChannelBindings:
    """Dimensions, channels and effects of a vessel, with the channels that each effect is bound to.

    An *actuator* is a command channel that a law uses; other commands only feed actuators (PWM
    feeds thrust). A *reading* is a measured channel that a law uses.

    Attributes:
        name: Name of the vessel.
        dof: Degrees of freedom, of "surge", "sway", "heave", "roll", "pitch" and "yaw".
        length: Length [m].
        beam: Beam [m].
        draught: Draught [m].
        body: Rigid body.
        commands: Command channels by name.
        measured: Measured channels of the environment by name.
        effects: Effects in the order in which they are composed.
    """

    name: str
    dof: tuple[str, ...]
    length: float
    beam: float
    draught: float
    body: Body
    commands: Mapping[str, CommandChannel] = field(default_factory=dict)
    measured: Mapping[str, MeasuredChannel] = field(default_factory=dict)
    effects: tuple[Effect, ...] = ()

    # Channels
    # ----------------------------------------------------------------------------------------------

    @property
    def inputs(self) -> tuple[str, ...]:
        """Names of all inputs of the compiled program: the commands, then the measured channels."""
        return (*self.commands, *self.measured)

    @property
    def actuators(self) -> tuple[str, ...]:
        """Names of the vessel's actuators: commands that an effect's law uses."""
        return tuple(filter(self.roles.__contains__, self.commands))

    @property
    def readings(self) -> tuple[str, ...]:
        """Names of measured environment signals, such as wind, that an effect's law uses."""
        return tuple(filter(self.roles.__contains__, self.measured))

    @property
    def filtered_readings(self) -> Mapping[str, float]:
        """Measured signals that effects filter -> time [s] by which a recorded one has to lead."""
        found: dict[str, float] = {}
        for effect in self.effects:
            if isinstance(effect, FilteredSignal):
                channel = self.bindings(effect).get(next(iter(type(effect).roles)))
                if isinstance(channel, str) and channel in self.readings:
                    found[channel] = max(found.get(channel, 0.0), effect.lookahead)
        return found

    @cached_property
    def roles(self) -> Mapping[str, str]:
        """Role ("thrust", "angle", ...) of each channel of the vessel.

        It is that in which the first effect uses the channel.
        """
        roles: dict[str, str] = {}
        for effect in self.effects:
            for role, channel in self.specified_inputs(effect).items():
                if isinstance(channel, str):
                    roles.setdefault(channel, role)
        return roles

    @cached_property
    def angles(self) -> tuple[str, ...]:
        """Names of the actuators that are angles.

        The laws of effects receive their cosine and sine too.
        """
        return tuple(filter(self._is_angle, self.actuators))

    @cached_property
    def environment_angles(self) -> tuple[str, ...]:
        """Names of the measured environment signals that are angles, such as a wind direction.

        The laws of effects receive their cosine and sine too.
        """
        return tuple(filter(self._is_angle, self.readings))

    @cached_property
    def full_turns(self) -> tuple[str, ...]:
        """Names of the commands that are directions of drives which can turn all round.

        Every law that uses such a command uses only its sine and cosine, and its range spans a
        full turn. Whole turns of the command change nothing.
        """
        found = dict.fromkeys(self.commands, True)
        used = set[str]()
        for effect in self.effects:
            for role, channel in self.specified_inputs(effect).items():
                if channel in found and isinstance(channel, str):
                    used.add(channel)
                    found[channel] &= type(effect).roles[role].direction
        names = []
        for name, command in self.commands.items():
            spans_turn = command.high - command.low >= FULL_TURN
            if name in used and found[name] and spans_turn:
                names.append(name)
        return tuple(names)

    @cached_property
    def law_signals(self) -> tuple[str, ...]:
        """Names of all signals that the laws of the vessel's effects receive.

        They are the actuators, cosines and sines of those that are angles, then likewise the
        measured signals.
        """
        return (
            *self.actuators,
            *_with_cosine_and_sine(self.angles),
            *self.readings,
            *_with_cosine_and_sine(self.environment_angles),
        )

    @cached_property
    def signal_sums(self) -> Mapping[str, tuple[str, ...]]:
        """Groups of actuators with the same role ("thrust", ...), whose sum is a signal of its own.

        Terms of symbolic regression may use the sums. Role -> names of the actuators.
        """
        sums: dict[str, tuple[str, ...]] = {}
        for role in self.roles.values():
            names = self._actuators_of_roles((role,))
            if len(names) > 1 and role not in self.inputs:
                sums[role] = names
        return sums

    @property
    def described_signals(self) -> tuple[str, ...]:
        """Names of the actuator signals that terms of symbolic regression may contain.

        They are the signals of `law_signals`, then sums over actuators of one role.
        """
        return (*self.law_signals, *self.signal_sums)

    def unit(self, channel: str) -> str:
        """Return the unit of an actuator, a measured signal or a sum of actuators.

        Args:
            channel: Name of the channel.

        Returns:
            The unit; "" if no effect uses the channel.
        """
        first, *_ = self.signal_sums.get(channel, (channel,))
        for effect in self.effects:
            for role, bound in self.specified_inputs(effect).items():
                if bound == first:
                    return type(effect).roles[role].unit
        return ""

    def _is_angle(self, channel: str) -> bool:
        return self.unit(channel) == "rad"

    def _actuators_of_roles(self, roles: Sequence[str]) -> tuple[str, ...]:
        """The actuators that are bound to one of some roles."""
        return tuple(name for name in self.actuators if self.roles[name] in roles)

    def _readings_of_role(self, role: str) -> tuple[str, ...]:
        """The measured channels that are bound to a role."""
        return tuple(name for name in self.readings if self.roles[name] == role)

    def side(self, channel: str) -> int:
        """Return the side of the hull on which the thruster or rudder of a command is mounted.

        Args:
            channel: Name of a command; one that feeds an actuator has the side of that actuator.

        Returns:
            -1 for port, +1 for starboard, 0 for the middle.
        """
        for effect in self.effects:
            if channel in self.specified_inputs(effect).values():
                y = float(getattr(effect, "y", 0.0))
                return int(y > 0.0) - int(y < 0.0)
        for effect in self.effects:
            for actuator in self.target_actuators(effect):
                if self.command_for_actuator(effect, actuator) == channel:
                    return self.side(actuator)
        return 0

    def unknown_command_message(self, name: str) -> str:
        """Return the error message for a command that the vessel does not have."""
        return unknown_name_message(f"{self.name}: command", name, self.commands)

    # Effects
    # ----------------------------------------------------------------------------------------------

    def effect(self, name: str) -> Effect | None:
        """Return the vessel's effect with a given name, or its only effect of the type so named.

        Args:
            name: Name of an effect ("port"), or of a type of effects as in `use` ("thruster").

        Returns:
            The effect; None where there is none or several.
        """
        for effect in self.effects:
            if effect.name == name:
                return effect
        same_type = [effect for effect in self.effects if type(effect).type_name() == name]
        if len(same_type) == 1:
            return same_type[0]
        return None

    def names_of(self, name: str) -> list[str]:
        """Return the names of all effects of the vessel that have a given name or type."""
        return [e.name for e in self.effects if name in (e.name, type(e).type_name())]

    def effects_of_type(self, idea: str) -> list[Effect]:
        """Return the vessel's effects of a type, and those that can stand for that type.

        An example is a propeller in place of a thruster.

        Args:
            idea: Name of the type, as in `use`.

        Returns:
            The effects in the order of the vessel.
        """
        return [
            e for e in self.effects if type(e).type_name() == idea or hasattr(type(e), f"as_{idea}")
        ]

    @staticmethod
    def specified_inputs(effect: Effect) -> Mapping[str, str | float]:
        """Return the channels or constants that an effect's own table assigns to its input signals.

        Args:
            effect: An effect.

        Returns:
            Channel or constant by the role of the signal, such as "thrust"; empty if the table has
            none.
        """
        if isinstance(effect.on, Mapping):
            return effect.on
        return {}

    def bindings(self, effect: Effect) -> dict[str, str | float]:
        """Return the channel or constant that each input signal of an effect's law is bound to.

        An effect whose table has no bindings is bound to the vessel's only channel in each role,
        a command or a measured channel that a law uses. An optional role stays unbound then: a
        fixed thruster does not turn with the only rudder.

        Args:
            effect: An effect of the vessel.

        Returns:
            Channel or constant by the role of the signal, such as "thrust".
        """
        bound = dict(self.specified_inputs(effect))
        if bound:
            return bound
        for role, about in type(effect).roles.items():
            candidates = self._actuators_of_roles((role,)) or self._readings_of_role(role)
            if about.fixed is None and len(candidates) == 1:
                bound[role] = candidates[0]
        return bound

    def host_effects(self, effect: Effect) -> list[Effect]:
        """Return the other effects at which an effect acts, such as the propellers of prop walk."""
        carriers = self.effects_of_type(type(effect).per_instance_of)
        return [e for e in carriers if not effect.on or e.name in effect.on]

    def limits(self) -> dict[str, tuple[float, float]]:
        """Return the allowed range (low, high) of each input of the vessel, by name.

        The range of a measured channel is unbounded.
        """
        limits = {name: (channel.low, channel.high) for name, channel in self.commands.items()}
        return limits | dict.fromkeys(self.measured, (-inf, inf))

    def target_actuators(self, effect: Effect) -> tuple[str, ...]:
        """Return the actuators whose signals a channel effect (such as a rate limit) changes.

        They are the named ones, else all actuators with the role on which the effect acts.

        Args:
            effect: An effect of the vessel.

        Returns:
            Names of the actuators; empty if the effect is no channel effect.
        """
        if not isinstance(effect, ChannelEffect):
            return ()
        if effect.on:
            return tuple(filter(effect.on.__contains__, self.actuators))
        roles = type(effect).acts_on.split("|")
        if roles == [""]:
            return self.actuators
        return self._actuators_of_roles(roles)

    def command_for_actuator(self, effect: Effect, actuator: str) -> str | None:
        """Return the name of the raw command that an effect turns into an actuator's signal.

        An example is the PWM command from which a drive curve computes the thrust.

        Args:
            effect: An effect of the vessel.
            actuator: Name of the actuator.

        Returns:
            Name of the command; None if the effect is not fed by a command for this actuator.
        """
        source = self.source_for_actuator(effect, actuator)
        if source in self.commands:
            return source
        return None

    def source_for_actuator(self, effect: Effect, actuator: str) -> str | None:
        """Return the name of the input that feeds an actuator through a channel effect.

        It is a raw command, or a measured quantity such as the voltage of the supply.

        Args:
            effect: An effect of the vessel.
            actuator: Name of the actuator.

        Returns:
            Name of the input; None if nothing feeds the actuator through the effect.
        """
        if not isinstance(effect, ChannelEffect) or actuator not in effect.on:
            return None
        return dict(zip(effect.on, effect.fed_by, strict=False)).get(actuator)

    @property
    def feeding_measurements(self) -> tuple[str, ...]:
        """Names of the measured quantities that feed channel effects of the vessel."""
        fed_by = set[str]()
        for effect in self.effects:
            if isinstance(effect, ChannelEffect):
                fed_by.update(effect.fed_by)
        return tuple(filter(fed_by.__contains__, self.measured))

    def matching_measurements(self, actuators: Sequence[str], unit: str) -> dict[str, str]:
        """Return the measured quantity of a unit that belongs to each of some actuators.

        The only one belongs to all of them. Of several, an actuator has the one with which its name
        shares most words: `battery_port_V` belongs to `thrust_port_N`.

        Args:
            actuators: Names of actuators.
            unit: Unit at the end of the names of the quantities, such as "V".

        Returns:
            Measured quantity by the name of the actuator; empty where one has none, or has two that
            match equally well.
        """
        names = [name for name in self.measured if name.rpartition("_")[2] == unit]
        if len(names) == 1:
            return dict.fromkeys(actuators, names[0])
        found = {}
        for actuator in actuators:
            words = set(actuator.split("_")[:-1])
            shared = {name: len(words & set(name.split("_")[:-1])) for name in names}
            most = max(shared.values(), default=0)
            best = [name for name, count in shared.items() if count == most]
            if most == 0 or len(best) > 1:
                return {}
            found[actuator] = best[0]
        return found

    def neutral_value(self, name: str) -> float:
        """Return the value of an input where nothing is sent or measured.

        Args:
            name: Name of a command or of a measured quantity.

        Raises:
            BadInput: The vessel has no such input.
        """
        if name in self.commands:
            return self.commands[name].neutral
        if name in self.measured:
            return self.measured[name].neutral
        raise BadInput(unknown_name_message(f"{self.name}: channel", name, self.inputs))


def _with_cosine_and_sine(angles: tuple[str, ...]) -> list[str]:
    parts = []
    for angle in angles:
        parts += [f"cos_{angle}", f"sin_{angle}"]
    return parts


def check_bindings(vessel: ChannelBindings, label: str) -> None:
    """Check that a vessel's effects have unique names and refer to existing channels and effects.

    Args:
        vessel: The vessel.
        label: Name of the file in messages.

    Raises:
        BadInput: One line with the effect, the key and the nearest valid name.
    """
    names = [effect.name for effect in vessel.effects]
    for effect in vessel.effects:
        what = f"{label}: effect {effect.name}"
        if names.count(effect.name) > 1:
            raise BadInput(
                f"{what} occurs {names.count(effect.name)} times; each needs a unique name"
            )
        _check_roles(vessel, effect, what)
        if type(effect).sees_held and not effect.has_current_derived_codes(vessel):
            raise BadInput(
                f"{what} stands before an effect by which a channel acts; move it behind all of "
                "these"
            )
        if isinstance(effect, ChannelEffect):
            _check_channel(vessel, effect, what)
        elif type(effect).per_instance_of:
            _check_carriers(vessel, effect, what)


def _check_roles(vessel: ChannelBindings, effect: Effect, what: str) -> None:
    roles = type(effect).roles
    for role, channel in vessel.specified_inputs(effect).items():
        if role not in roles:
            raise BadInput(unknown_name_message(f"{what}: on", role, roles))
        if isinstance(channel, str) and channel not in vessel.inputs:
            raise BadInput(
                unknown_name_message(f"{what}: on.{role} channel", channel, vessel.inputs)
            )
    bound = vessel.bindings(effect)
    for role, about in roles.items():
        if role not in bound and about.fixed is None:
            channels = ", ".join(vessel.inputs)
            raise BadInput(
                f"{what}: on.{role} is missing: the channel of {about.words}; there are: {channels}"
            )


def _check_channel(vessel: ChannelBindings, effect: ChannelEffect, what: str) -> None:
    unit = type(effect).measured_unit
    if unit and not effect.fed_by:
        raise BadInput(
            f"{what}: fed_by is missing: the measured quantity in {unit} of each channel in on; "
            f"there are: {', '.join(vessel.measured) or 'none in [measured]'}"
        )
    sources: Collection[str] = vessel.measured if unit else vessel.commands
    for name in effect.on:
        if name not in vessel.commands:
            raise BadInput(unknown_name_message(f"{what}: channel", name, vessel.commands))
    for name in effect.fed_by:
        if name not in sources:
            raise BadInput(unknown_name_message(f"{what}: channel", name, sources))
    if effect.fed_by and len(effect.fed_by) != len(effect.on):
        raise BadInput(
            f"{what}: fed_by names {len(effect.fed_by)} channels, on {len(effect.on)}; each "
            "needs one"
        )


def _check_carriers(vessel: ChannelBindings, effect: Effect, what: str) -> None:
    idea = type(effect).per_instance_of
    carriers = [carrier.name for carrier in vessel.effects_of_type(idea)]
    for name in effect.on:
        if name not in carriers:
            raise BadInput(unknown_name_message(f"{what}: {idea}", name, carriers))
    if not carriers:
        raise BadInput(f"{what} needs a vessel with {idea}")
