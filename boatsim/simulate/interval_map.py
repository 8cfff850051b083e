"""Motion of a vessel over one interval with held commands, as a function of the state at its begin.

Linearisations and searches of steady motions take their derivatives from it.
"""

from collections.abc import Mapping

import numpy as np

from boatsim.physics.effects.rate_limit import RateLimit
from boatsim.physics.effects.servo import Servo
from boatsim.physics.kinds.channel import WHOLE, ChannelEffect
from boatsim.physics.kinds.effect import Effect
from boatsim.physics.kinds.filtered import FilteredSignal
from boatsim.physics.kinds.motion_memory import MotionMemory
from boatsim.physics.signals import AXES, Array
from boatsim.physics.vessel import Vessel
from boatsim.simulate.open_water import OpenWater
from boatsim.simulate.stepper import State

SUBSTEPS = 8  # integration steps per interval, 10 ms for the joystick controllers
DELAY = "command_delay"  # effect that enters a linear model as a delay of its inputs
POSITION = ("x", "y")


class IntervalMap:
    """Motion of a vessel over one interval with held commands.

    Delays and play of the commands, and pauses between ahead and astern, are left out. Rate limits
    act on large motions only and are lifted: without a lag even a small change of a command would
    meet them.

    Attributes:
        vessel: The vessel without the effects that are left out.
        length: Length of the interval [s].
        fields: Fields of `State` that belong to the state.
        memory_names: Names of the further entries of the state, the memory of effects: effect and
            actuator. "" for an unused entry.
        memory_actuators: Actuator of each of these entries, "" for none.
        delay: Dead time of the commands that is left out [s].
        ignored: Names of the effects without a derivative, such as play, that are left out.
        delayed: Actuators with the dead time, if it does not act on all.
    """

    def __init__(self, vessel: Vessel, length: float, position: bool = False) -> None:
        """Compile the vessel.

        Args:
            vessel: The vessel.
            length: Length of the interval [s].
            position: Whether x and y belong to the state.
        """
        self.length, self.delay = length, 0.0
        self.ignored: list[str] = []
        self.delayed: list[str] = []
        for effect in vessel.effects:
            kind = type(effect).type_name()
            if kind == DELAY:
                self.delay += effect.values()[list(type(effect).params()).index("delay")]
                delayed = vessel.target_actuators(effect)
                if set(delayed) != set(vessel.actuators):
                    self.delayed += delayed
            if not has_derivative(effect):
                self.ignored.append(effect.name)
            if kind == DELAY or not has_derivative(effect):
                vessel = vessel.without_effect(effect.name)
        self.vessel = _without_rate_limits(vessel)
        self._engine = OpenWater(self.vessel, length / SUBSTEPS)
        fleet = self._engine.batch.fleet
        self._memory, self._force = fleet.memory[0], fleet.force
        shown = [State._fields[1:][i] for i in self._engine.code.SHOWS]
        self.fields = [name for name in shown if position or name not in POSITION]
        self.memory_names, self.memory_actuators = self._memory_entries()

    def __len__(self) -> int:
        """Number of entries of the state."""
        return len(self.fields) + len(self._memory)

    @property
    def force_axes(self) -> list[str]:
        """Names of the degrees of freedom in which a further body force can act."""
        return [axis for axis in AXES if axis in self.vessel.dof]

    def settled_state(self, start: State, commands: Mapping[str, float]) -> Array:
        """Return the state (n,) with actuators settled at their commands.

        Args:
            start: Motion.
            commands: Commands by channel.
        """
        self._engine.reset(start, commands)
        return self._present_state()

    def advance(
        self,
        start: State,
        change: Array,
        commands: Mapping[str, float],
        settled: Mapping[str, float] | None = None,
        force: Array | None = None,
    ) -> Array:
        """Return the state (n,) at the end of the interval.

        Args:
            start: Motion at the begin, to which the first entries of `change` are added.
            change: Change (n,) of the state at the begin; the last entries change the memory of
                settled actuators.
            commands: Commands that are held over the interval, by channel.
            settled: Commands at which the actuators have settled at the begin; default: the same.
            force: Further constant body force (number of degrees of freedom,) [N, N m].
        """
        values = {}
        for name, by in zip(self.fields, change, strict=False):
            values[name] = getattr(start, name) + by
        if settled is None:
            settled = commands
        self._engine.reset(start._replace(**values), settled)
        self._memory[:] += change[len(self.fields) :]
        self._engine.command(commands)
        if force is not None:
            self._force[:] = force
        self._engine.advance(SUBSTEPS)
        self._force[:] = 0.0
        return self._present_state()

    def _present_state(self) -> Array:
        state = self._engine.state
        motion = [getattr(state, name) for name in self.fields]
        return np.array([*motion, *self._memory])

    def _memory_entries(self) -> tuple[list[str], list[str]]:
        """Name and actuator of each entry of the memory."""
        program = self._engine.program.composition
        size = len(self._memory)
        names, actuators = [""] * size, [""] * size
        for number, effect in enumerate(program.effects):
            if isinstance(effect, ChannelEffect):
                slots = type(effect).slots
                for actuator in program.target_actuators(number):
                    at = program.memory_offset(number, actuator)
                    for k in range(slots):
                        names[at + k] = f"{effect.name}.{actuator}"
                        if slots > 1:
                            names[at + k] += f".{k + 1}"
                        actuators[at + k] = actuator
                continue
            if isinstance(effect, MotionMemory):
                slots = effect.memory_states
            elif isinstance(effect, FilteredSignal):
                slots = type(effect).filter_states
            else:
                continue
            at = program.memory_offset(number, WHOLE)
            for k in range(slots):
                names[at + k] = f"{effect.name}.{k + 1}"
        for i in range(program.memory_size):  # of effects that store a signal
            if not names[i]:
                names[i] = f"memory.{i + 1}"
        return names, actuators


def has_derivative(effect: Effect) -> bool:
    """Return whether a linear model of a vessel can contain an effect.

    Args:
        effect: Effect of the vessel.
    """
    return not isinstance(effect, ChannelEffect) or type(effect).has_derivative


def _without_rate_limits(vessel: Vessel) -> Vessel:
    """The vessel with the largest rates that its servos and rate limits accept."""
    rates = {}
    for effect in vessel.effects:
        if isinstance(effect, Servo | RateLimit):
            most = type(effect).params()["rate"].high
            # from the rate `instant` on, a rate limit has no lag either
            if isinstance(effect, RateLimit) and effect.lag > 0.0:
                most = min(most, 0.5 * effect.instant)
            rates[effect.name] = {"rate": most}
    if not rates:
        return vessel
    return vessel.with_parameters(rates)
