"""The compiled engine: many vessels in open water on all cores, without MuJoCo.

Each vessel has its own parameters, state and actuators. Its motion does not depend on the number of
vessels and threads, to the last bit. One vessel is a batch of n = 1.
"""

import os
from collections.abc import Callable, Iterable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from functools import cache, cached_property, partial
from operator import index
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from boatsim.arguments import (
    check_instance,
    checked_integer,
    checked_mapping,
    checked_number,
    float_array,
    integer_array,
    short_repr,
    type_error,
)
from boatsim.errors import BadInput, unknown_name_message
from boatsim.physics.commands import clip_to_channel_ranges, clipped_commands
from boatsim.physics.kernel.records import FleetArrays, VesselNumbers
from boatsim.physics.kinds.effect import Effect
from boatsim.physics.native.calls import pack_named_tuple
from boatsim.physics.param import Param
from boatsim.physics.program import Program
from boatsim.physics.signals import Array
from boatsim.physics.vessel import Vessel

Boats: TypeAlias = NDArray[np.int64]  # numbers of vessels
# parameters of the rigid body -> place in `Program.body` and description
BODY = {
    "body.mass": (0, Param(1e-9, 1e18, "kg", "mass of the rigid body")),
    "body.roll_inertia": (3, Param(1e-9, 1e18, "kg m^2", "roll inertia of the rigid body")),
    "body.pitch_inertia": (4, Param(1e-9, 1e18, "kg m^2", "pitch inertia of the rigid body")),
    "body.yaw_inertia": (5, Param(1e-9, 1e18, "kg m^2", "yaw inertia of the rigid body")),
}
UNINTERRUPTED = 1_000_000  # steps of all vessels together between two chances to interrupt
MOST_STEPS = 10**12  # more would take days for a single vessel
MOST_BOATS = 10**8  # a boat takes 1 kB
MOST_THREADS = 4096  # a computer has fewer
SHORTEST_STEP, LONGEST_STEP = 1e-9, 86400.0  # [s]
FAR = 10.0  # widths of a channel's range outside it from which a command is an error
TURN = 256  # vessels that a thread steps at a time, so that their data stay in its core's cache
# Turns of each thread over steps alone, which need the data of a vessel once: few, because a turn
# takes some microseconds of Python, and several, so that threads end at about the same time.
TURNS = 8


def _checked_steps(steps: int) -> int:
    """The number of steps. Raises BadInput."""
    try:
        count = index(steps)
    except TypeError:
        raise BadInput(f"steps = {steps!r}; allowed is a whole number") from None
    if not 0 <= count <= MOST_STEPS:
        raise BadInput(f"steps = {count}; allowed 0 to {MOST_STEPS:g}")
    return count


def _check_command(vessel: Vessel, name: str, values: ArrayLike) -> None:
    """Check that commands of a channel are in its unit. Raises BadInput."""
    limits = vessel.limits()
    if name not in limits:
        return
    given = float_array(f"{vessel.name}: {name}", values)
    low, high = limits[name]
    reach = FAR * (high - low)
    far = (given < low - reach) | (given > high + reach)
    if far.any():
        raise BadInput(f"{vessel.name}: {name} = {given[far][0]:g}; allowed {low:g} to {high:g}")


def checked_vessels(vessels: object) -> list[Vessel]:
    """Return the argument `vessels`, one or several, as a list.

    Raises:
        TypeError: It is something else.
        BadInput: It is empty.
    """
    if isinstance(vessels, Vessel):
        return [vessels]
    if not isinstance(vessels, Iterable):
        raise type_error("vessels", vessels, "a Vessel or a list of them")
    several = list(vessels)
    for one in several:
        check_instance("vessels", one, Vessel, "a Vessel or a list of them")
    if not several:
        raise BadInput("vessels is empty; allowed is at least one")
    return several


class Batch:
    """Many vessels in open water, simulated together by compiled code on all cores.

    `advance` steps them; the actuators keep their memory between calls.

    States are SNAME [m, rad, m/s, rad/s]: the coordinates (x, y, z, phi, theta, psi) and the body
    rates over ground (u, v, w, p, q, r) of the degrees of freedom of the vessel, (x, y, psi, u, v,
    r) in the plane.

    Attributes:
        vessels: The different vessels.
        n: Number of vessels that are simulated.
        step: Integration step [s].
        threads: Number of threads.
        program: Compiled program, the same for all.
        code: Its compiled functions.
        t: Times (n,) [s].
    """

    def __init__(
        self,
        vessels: Vessel | Sequence[Vessel],
        n: int | None = None,
        step: float = 0.02,
        *,
        threads: int | None = None,
        seeds: Sequence[int] | None = None,
    ) -> None:
        """Put the vessels at the origin, at rest; number i is vessel i modulo their number.

        Args:
            vessels: Vessels that differ in numbers only.
            n: How many to simulate; default: one of each.
            step: Integration step [s].
            threads: Number of threads; default: one per core.
            seeds: Seeds (n,) of effects with random parameters, such as waves; default: 0.

        Raises:
            BadInput: If the vessels differ in more than numbers, or a number is not valid.
        """
        self.vessels = checked_vessels(vessels)
        self.n = len(self.vessels) if n is None else checked_integer("n", n, 1, MOST_BOATS)
        self.step = checked_number("step", step, SHORTEST_STEP, LONGEST_STEP, "s")
        self.threads = len(os.sched_getaffinity(0))
        if threads is not None:
            self.threads = checked_integer("threads", threads, 1, MOST_THREADS)
        self.programs = [Program(v) for v in self.vessels]
        self.program = self.programs[0]
        self.code = self.program.simulation_functions
        self._check_same_program()
        self._values = [p.values() for p in self.programs]
        self._on, self._none = self.program.effect_switches(), np.zeros(self.code.NQ)
        self._seeds = np.zeros(self.n, dtype=int)
        if seeds is not None:
            self._seeds = integer_array("seeds", seeds)
            if self._seeds.min(initial=0) < 0:
                raise BadInput(f"seeds = {short_repr(seeds)}; allowed are numbers from 0")
        if self._seeds.shape != (self.n,):
            raise BadInput(f"{self._seeds.size} seeds for {self.n} boats; allowed is one for each")
        self.t = np.zeros(self.n)  # [s]
        self._y = np.zeros((self.n, 2 * self.code.NQ))
        self._commands = np.tile(clipped_commands(self.vessels[0], {}), (self.n, 1))
        self._memory = np.zeros((self.n, self.program.memory_size))
        self._act = np.zeros((self.n, self.program.actuator_signal_size))
        self._p = np.zeros((self.n, len(self.program.values())))
        self._body, self._k = np.zeros((self.n, 6)), np.zeros((self.n, self.code.K))
        self._given = pack_named_tuple(self.code, self.fleet)
        self.assign(np.arange(self.n) % len(self.vessels))
        self.reset()

    def __len__(self) -> int:
        return self.n

    @property
    def fleet(self) -> FleetArrays:
        """Arrays with the states and parameters of all vessels, as compiled functions take them.

        The arrays are views of the batch, not copies.
        """
        return FleetArrays(
            self.t,
            self._y,
            self._commands,
            self._memory,
            self._act,
            self._p,
            self._on,
            self._k,
            self._none,
        )

    @property
    def bytes_per_boat(self) -> int:
        """Memory that the batch uses per simulated vessel [bytes]."""
        held = (
            self.t,
            self._y,
            self._commands,
            self._memory,
            self._act,
            self._p,
            self._body,
            self._k,
            self._seeds,
        )
        return sum(a.nbytes for a in held) // self.n

    @property
    def states(self) -> Array:
        """Present states of all vessels (n, 2 NQ): coordinates and body rates over ground."""
        return self.program.to_body_velocities(self._y)

    @property
    def actuators(self) -> Array:
        """Present actuator positions of all vessels (n, A), in the order of `vessel.actuators`."""
        last = 2 * self.code.HELD
        return self._act[:, last : last + len(self.vessels[0].actuators)].copy()

    @property
    def commands(self) -> Array:
        """Commands in force for all vessels (n, C), in the order of `vessel.inputs`."""
        return self._commands.copy()

    @property
    def lost(self) -> NDArray[np.bool_]:
        """Whether the motion of each vessel (n,) has diverged; other vessels are unaffected."""
        return np.asarray(~np.isfinite(self._y).all(axis=1))

    def reset(
        self,
        states: ArrayLike | None = None,
        commands: ArrayLike | Mapping[str, float] | None = None,
        boats: ArrayLike | None = None,
    ) -> None:
        """Set the state of some or all simulated vessels at t = 0, with actuators settled.

        Args:
            states: State (2 NQ,) or states (k, 2 NQ); default: at rest at the origin.
            commands: Commands by channel, (C,) or (k, C); default: neutral.
            boats: Numbers (k,) or a mask (n,) of the vessels; default: all.

        Raises:
            BadInput: If a shape, name or value is not valid.
        """
        chosen = self._boat_numbers(boats)
        self._y[chosen] = (
            0.0 if states is None else self.program.to_joint_rates(self._state_rows(states, chosen))
        )
        self._commands[chosen] = self._clip({} if commands is None else commands, chosen)
        self.t[chosen] = 0.0
        self.run_on_threads(
            lambda some: self.code.settle_actuators_of_boats(some, self._given), chosen
        )

    def advance(
        self, commands: ArrayLike | Mapping[str, float] | None = None, steps: int = 1
    ) -> None:
        """Integrate the motion of all vessels over some steps with constant commands.

        Args:
            commands: Commands by channel, (C,) or (n, C), which act within their ranges; without
                the measured inputs, these do not change. None: the commands in force. A command
                that is farther outside than ten times the width of its range is an error.
            steps: Number of steps, 0 to 1e12.

        Raises:
            BadInput: If a shape, name or value is not valid.
            KeyboardInterrupt: When it is interrupted; all vessels have made the same steps.
        """
        remaining = _checked_steps(steps)
        everyone = np.arange(self.n)
        if commands is not None:
            self._commands[:] = self._clip(commands, everyone)
        most = max(UNINTERRUPTED // max(self.n, 1), 1)
        while remaining:
            some = min(remaining, most)
            self.run_on_threads(
                partial(self._step_boats, steps=some),
                turn=max(TURN, self.n // (TURNS * self.threads)),
            )
            remaining -= some

    def set(self, parameter: str, values: ArrayLike, boats: ArrayLike | None = None) -> None:
        """Change one model parameter of some or all vessels.

        Parameters that a vessel file derives from the changed one keep their values.

        Args:
            parameter: "effect.parameter" or "body.mass".
            values: One value or (k,).
            boats: Numbers (k,) or a mask (n,) of the vessels; default: all.

        Raises:
            BadInput: If the name is unknown or a value out of bounds.
        """
        chosen, (rows, place, about) = self._boat_numbers(boats), self._find_parameter(parameter)
        given = self._value_per_boat(parameter, float_array(parameter, values), chosen)
        if not ((given >= about.low) & (given <= about.high)).all():
            wrong = given[~((given >= about.low) & (given <= about.high))][0]
            allowed = f"{about.low:g} to {about.high:g} {about.unit}".rstrip()
            raise BadInput(f"{parameter} = {wrong:g}; allowed {allowed}")
        rows[chosen, place] = given
        self._update_masses(chosen)

    def get(self, parameter: str) -> Array:
        """Return the value of one model parameter of each vessel.

        Args:
            parameter: Name of the parameter, as "effect.parameter".

        Returns:
            Values (n,) in the unit of the parameter.

        Raises:
            BadInput: If the name is unknown.
        """
        rows, place, _ = self._find_parameter(parameter)
        return rows[:, place].copy()

    def assign(self, vessel: ArrayLike, boats: ArrayLike | None = None) -> None:
        """Give simulated vessels all model parameters of one of the different vessels of the batch.

        Args:
            vessel: Number of the different vessel, or numbers (k,).
            boats: Numbers (k,) or a mask (n,) of the vessels that change; default: all.

        Raises:
            BadInput: If a number does not exist.
        """
        chosen = self._boat_numbers(boats)
        numbers = self._value_per_boat("vessel", integer_array("vessel", vessel), chosen)
        for number in np.unique(numbers):
            if not 0 <= number < len(self.vessels):
                raise BadInput(f"vessel {number}; allowed 0 to {len(self.vessels) - 1}")
        for number in np.unique(numbers):
            program, some = self.programs[number], chosen[numbers == number]
            self._p[some], self._body[some] = self._values[number], program.body
            self._sample(program, some)
        self._update_masses(chosen)

    def rollout(
        self,
        start: Sequence[float],
        commands: Array,
        interval: float,
        values: Array | None = None,
        t0: float = 0.0,
    ) -> Array:
        """Simulate the first vessel from a given state under a sequence of commands.

        The state of the batch does not change.

        Args:
            start: State (2 NQ,).
            commands: Rows (N, C) in the order of the vessel's inputs, each held for an interval,
                within the ranges of their channels; actuators start settled at the first row.
            interval: Length of an interval [s].
            values: Parameters of all effects in place of the vessel's.
            t0: Time at the start [s].

        Returns:
            States (N + 1, 2 NQ) at the ends of the intervals.

        Raises:
            BadInput: If the step does not divide the interval, or a command is not finite.
        """
        interval = checked_number("interval", interval, 0.0, LONGEST_STEP, "s")
        t0 = checked_number("t0", t0)
        substeps = round(interval / self.step)
        if substeps < 1 or abs(substeps * self.step - interval) > 1e-9 * interval:
            raise BadInput(f"step {self.step:g} s does not divide the interval {interval:g} s")
        p = self._values[0]
        if values is not None:
            p = np.ascontiguousarray(self._shaped("values", values, self._values[0].shape))
        rows = float_array("commands", commands)
        width = len(self.vessels[0].inputs)
        if rows.ndim != 2 or not len(rows) or rows.shape[1] != width:
            raise BadInput(f"commands of shape {rows.shape}; allowed is (N, {width})")
        commands = np.ascontiguousarray(clip_to_channel_ranges(self.vessels[0], rows))
        begin = self._shaped("start", start, (self._y.shape[1],))
        model = VesselNumbers(self.program.body, p, self._on)
        plant = self.program.vessel_state(self.program.to_joint_rates(begin))
        self.code.settle_actuators(commands[0], plant.memory, p, self._on, plant.act)
        out = np.empty((len(commands) + 1, len(plant.y)))
        self.code.rollout(model, plant, commands, t0, self.step, substeps, out)
        return self.program.to_body_velocities(out)

    def hold_commands(
        self, start: Sequence[float], commands: Mapping[str, float], steps: int
    ) -> Array:
        """Return the state of the first vessel after some steps with constant commands.

        The state of the batch does not change.

        Args:
            start: State (2 NQ,).
            commands: Commands by channel, at which the actuators are settled; others are neutral.
            steps: Number of steps.

        Returns:
            State (2 NQ,).

        Raises:
            BadInput: If a channel does not exist.
        """
        steps = _checked_steps(steps)
        begin = self._shaped("start", start, (self._y.shape[1],))
        for name, value in checked_mapping("commands", commands).items():
            self._shaped(f"commands: {name}", value, ())
        p = self._values[0]
        act = np.zeros(self.program.actuator_signal_size)
        k = np.zeros(self.code.K)
        memory = np.zeros(self.program.memory_size)
        self.code.settle_actuators(self.program.command_array(commands), memory, p, self._on, act)
        self.code.compute_mass_constants(self.program.body, p, self._on, k)
        y = self.program.to_joint_rates(begin)
        self.code.steps(0.0, y, self.step, steps, act, p, self._on, k)
        state: Array = self.program.to_body_velocities(y[None])[0]
        return state

    @staticmethod
    def _shaped(argument: str, value: object, shape: tuple[int, ...]) -> Array:
        """An argument that is an array of numbers of a shape. Raises BadInput."""
        given = float_array(argument, value)
        if given.shape != shape:
            raise BadInput(f"{argument} of shape {given.shape}; allowed is {shape}")
        return given

    def _sample(self, program: Program, boats: Boats) -> None:
        """Parameters of effects with random parameters, by the seed of each vessel."""
        for effect, first in zip(program.effects, program.offsets, strict=True):
            if type(effect).with_seed is not Effect.with_seed:
                for b in boats:
                    values = effect.with_seed(int(self._seeds[b])).values()
                    self._p[b, first : first + len(values)] = values

    def _step_boats(self, boats: Boats, steps: int) -> None:
        self.code.advance_boats(boats, self._given, self.step, steps)

    def _update_masses(self, boats: Boats) -> None:
        self.code.compute_mass_constants_of_boats(boats, self._body, self._p, self._on, self._k)

    def run_on_threads(
        self, work: Callable[[Boats], None], boats: Boats | None = None, turn: int = TURN
    ) -> None:
        """Call a function for groups of vessels in parallel, on all threads of the batch.

        Args:
            work: Function that is called with the numbers of a group of vessels.
            boats: Numbers of the vessels that are divided into groups; default: all.
            turn: Number of vessels of a group.
        """
        chosen = np.arange(self.n) if boats is None else boats
        turns = [chosen[i : i + turn] for i in range(0, len(chosen), turn)]
        if self.threads == 1 or len(turns) == 1:
            for some in turns:
                work(some)
            return
        for _ in shared_thread_pool(self.threads, os.getpid()).map(work, turns):
            pass

    def sense(self, felt: Array) -> None:
        """Compute the error-free readings of the instruments of all vessels, in place.

        Args:
            felt: Rows (n, 11) in the order of `control.compiled.SENSE_FIELDS`; they are changed.
        """
        self.run_on_threads(
            lambda some: self.code.read_instruments_of_boats(some, self._given, felt)
        )

    def _boat_numbers(self, boats: ArrayLike | None) -> Boats:
        """Numbers of vessels, from numbers or a mask. Raises BadInput."""
        if boats is None:
            return np.arange(self.n)
        try:
            given = np.asarray(boats)
        except ValueError:  # rows of different lengths
            given = np.zeros((0, 0))
        if given.ndim > 1:
            raise BadInput(f"boats = {short_repr(boats)}; allowed are numbers or a mask of boats")
        if given.dtype == bool:
            if given.shape != (self.n,):
                raise BadInput(f"boats is a mask of shape {given.shape}; allowed is ({self.n},)")
            chosen = np.flatnonzero(given)
        else:
            chosen = np.atleast_1d(integer_array("boats", boats))
        for number in (chosen.min(initial=0), chosen.max(initial=0)):
            if not 0 <= number < self.n:
                raise BadInput(f"boat {number}; allowed 0 to {self.n - 1}")
        return chosen

    @staticmethod
    def _value_per_boat(what: str, given: NDArray[Any], boats: Boats) -> NDArray[Any]:
        """One value per vessel. Raises BadInput."""
        if given.shape not in ((), (1,), boats.shape):
            raise BadInput(
                f"{what}: values of shape {given.shape}; "
                f"allowed are one, or one for each of {len(boats)} boats"
            )
        return np.broadcast_to(given, boats.shape)

    def _state_rows(self, states: ArrayLike, boats: Boats) -> Array:
        """One state per vessel. Raises BadInput."""
        given = float_array("states", states)
        if (
            given.shape not in ((self._y.shape[1],), (len(boats), self._y.shape[1]))
            or not np.isfinite(given).all()
        ):
            raise BadInput(
                f"states of shape {given.shape}; "
                f"allowed are {self._y.shape[1]} finite numbers a boat"
            )
        return np.broadcast_to(given, (len(boats), self._y.shape[1]))

    def _clip(self, commands: ArrayLike | Mapping[str, float], boats: Boats) -> Array:
        """Commands (k, C) in force when these are sent. Raises BadInput."""
        vessel = self.vessels[0]
        if isinstance(commands, Mapping):
            checked_mapping("commands", commands)
            for name, value in commands.items():
                _check_command(vessel, name, value)
                if np.ndim(value) > 0:
                    raise BadInput(f"commands: {name} = {short_repr(value)}; allowed is one number")
            return clipped_commands(vessel, commands)
        given, width = float_array("commands", commands), len(vessel.commands)
        fits = given.shape[:-1] in ((), (1,), boats.shape)
        if not (given.ndim and fits and given.shape[-1] in (width, len(vessel.inputs))):
            raise BadInput(
                f"commands of shape {given.shape}; "
                f"allowed are {width} a boat: {', '.join(vessel.commands)}"
            )
        rows = np.empty((len(boats), len(vessel.inputs)))
        rows[:, : given.shape[-1]] = given
        rows[:, given.shape[-1] :] = self._commands[boats, given.shape[-1] :]
        if np.isfinite(rows).all():
            clipped = clip_to_channel_ranges(vessel, rows)
            if np.array_equal(clipped, rows):
                return clipped
        for name, column in zip(vessel.inputs, np.moveaxis(given, -1, 0), strict=False):
            _check_command(vessel, name, column)
        return clip_to_channel_ranges(vessel, rows)

    @cached_property
    def _parameters(self) -> dict[str, tuple[int, Param]]:
        """Place and description of each parameter of an effect."""
        found: dict[str, tuple[int, Param]] = {}
        for effect, first in zip(self.program.effects, self.program.offsets, strict=True):
            for place, (name, about) in enumerate(type(effect).params().items(), first):
                found[f"{effect.name}.{name}"] = (place, about)
        return found

    def _find_parameter(self, parameter: str) -> tuple[Array, int, Param]:
        """Array of a parameter, its column there, and its description. Raises BadInput."""
        check_instance("parameter", parameter, str, "a text such as 'body.mass'")
        if parameter in BODY:
            return (self._body, *BODY[parameter])
        if parameter not in self._parameters:
            names = [*self._parameters, *BODY]
            raise BadInput(
                unknown_name_message(f"{self.vessels[0].name}: parameter", parameter, names)
            )
        return (self._p, *self._parameters[parameter])

    def _check_same_program(self) -> None:
        """Raises BadInput if the vessels need different programs."""
        first = self.vessels[0]
        for i, (vessel, program) in enumerate(zip(self.vessels, self.programs, strict=True)):
            if program.module is not self.program.module or vessel.inputs != first.inputs:
                raise BadInput(
                    f"vessel {i} of a batch ({vessel.name}) has other effects, degrees of freedom "
                    f"or channels than the first ({first.name}); allowed are other numbers"
                )


@cache
def shared_thread_pool(threads: int, process: int) -> ThreadPoolExecutor:
    """Return the pool of threads that all batches of a process share.

    Args:
        threads: Number of threads.
        process: Id of the process; a forked one does not have its parent's threads.
    """
    return ThreadPoolExecutor(threads, "boats")
