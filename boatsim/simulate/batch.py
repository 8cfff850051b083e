"""Many boats at once on all cores, each with its own parameters, state and actuators; without MuJoCo and its walls.

A boat in a batch moves to the last bit as it would alone in a batch of one, whatever the number of threads.
"""

import os
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from functools import cache, cached_property
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from boatsim.errors import BadInput, unknown_name
from boatsim.physics.commands import clip, clipped_row
from boatsim.physics.kernel.records import Fleet
from boatsim.physics.kinds.effect import Effect
from boatsim.physics.param import Param
from boatsim.physics.program import Program
from boatsim.physics.signals import Array
from boatsim.physics.vessel import Vessel

Boats: TypeAlias = NDArray[np.int64]  # numbers of boats
BODY = {  # numbers of the rigid body, and where they stand in `Program.body`
    f"body.{name}": (place, Param(1e-9, 1e18, unit, f"{name.replace('_', ' ')} of the rigid body"))
    for place, name, unit in (
        (0, "mass", "kg"),
        (3, "roll_inertia", "kg m^2"),
        (4, "pitch_inertia", "kg m^2"),
        (5, "yaw_inertia", "kg m^2"),
    )
}
TURN = 256  # boats that a thread steps in one go: what they need then stays in its core's cache


class Batch:
    """Boats in open water. `advance` steps them under commands; what actuators remember is kept from call to call.

    States, SNAME [m, rad, m/s, rad/s], are as those of `Twin`: (x, y, psi, u, v, r) for boats in the plane.
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
        """Boat i is the vessel i modulo their number, at rest at the origin; `step` [s] of the integration.

        `seeds` draw the random courses of boats in waves. Raises BadInput for vessels that differ in more than numbers.
        """
        self.vessels = [vessels] if isinstance(vessels, Vessel) else list(vessels)
        self.n = len(self.vessels) if n is None else n
        if not self.vessels or self.n < 1:
            raise BadInput(
                f"a batch of {self.n} boats of {len(self.vessels)} vessels; allowed is at least one of each"
            )
        if not step > 0.0:
            raise BadInput(f"step = {step:g} s; allowed is more than 0")
        self.step, self.threads = step, threads or len(os.sched_getaffinity(0))
        self.programs = [Program(v) for v in self.vessels]
        self.program = self.programs[0]
        self.code = self.program.module
        self._check_alike()
        self._values = [p.values() for p in self.programs]
        self._on, self._none = self.program.switches(), np.zeros(self.code.NQ)
        self._seeds = np.zeros(self.n, dtype=int) if seeds is None else np.asarray(seeds, dtype=int)
        if self._seeds.shape != (self.n,):
            raise BadInput(f"{self._seeds.size} seeds for {self.n} boats; allowed is one for each")
        self.t = np.zeros(self.n)  # [s]
        self._y = np.zeros((self.n, 2 * self.code.NQ))
        self._commands = np.tile(clipped_row(self.vessels[0], {}), (self.n, 1))
        self._memory = np.zeros((self.n, self.program.memory_size))
        self._act = np.zeros((self.n, self.program.held_size))
        self._p = np.zeros((self.n, len(self.program.values())))
        self._body, self._k = np.zeros((self.n, 6)), np.zeros((self.n, self.code.K))
        self.assign(np.arange(self.n) % len(self.vessels))
        self.reset()

    def __len__(self) -> int:
        return self.n

    @property
    def fleet(self) -> Fleet:
        """States and parameters of all boats as compiled functions take them; views, not copies."""
        return Fleet(
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
        """Memory that a boat takes, whatever their number."""
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
        """(n, 2 NQ) present states, body rates over ground."""
        return self.program.body_rates(self._y)

    @property
    def actuators(self) -> Array:
        """(n, A) actuators now, in the order of `vessel.actuators`."""
        last = 2 * self.code.HELD
        return self._act[:, last : last + len(self.vessels[0].actuators)].copy()

    @property
    def commands(self) -> Array:
        """(n, C) commands in force, in the order of `vessel.inputs`."""
        return self._commands.copy()

    @property
    def lost(self) -> NDArray[np.bool_]:
        """(n,) boats whose motion is no longer finite; the others go on."""
        return np.asarray(~np.isfinite(self._y).all(axis=1))

    def reset(
        self,
        states: ArrayLike | None = None,
        commands: ArrayLike | Mapping[str, float] | None = None,
        boats: ArrayLike | None = None,
    ) -> None:
        """Put boats (numbers or a mask; all) at states (2 NQ,) or (k, 2 NQ), actuators settled at commands, t = 0.

        Default: at rest at the origin, commands neutral. Raises BadInput.
        """
        chosen = self._chosen(boats)
        self._y[chosen] = (
            0.0 if states is None else self.program.joint_rates(self._rows(states, chosen))
        )
        self._commands[chosen] = self._taken(commands if commands is not None else {}, chosen)
        self.t[chosen] = 0.0
        self.shared(lambda some: self.code.settle_boats(some, self.fleet), chosen)

    def advance(
        self, commands: ArrayLike | Mapping[str, float] | None = None, steps: int = 1
    ) -> None:
        """Steps of all boats with the commands held: (n, C), (C,) or by name; None: those in force.

        Commands act within their channels' ranges; (..., C) without what is measured keeps that as it is.
        Raises BadInput for one that is not finite.
        """
        everyone = np.arange(self.n)
        if commands is not None:
            self._commands[:] = self._taken(commands, everyone)
        self.shared(lambda some: self._stepped(some, steps))

    def set(self, parameter: str, values: ArrayLike, boats: ArrayLike | None = None) -> None:
        """Give boats other values, one or (k,), of "effect.parameter" or "body.mass"; what a file derives stays.

        Raises BadInput for a name that is unknown and a value out of bounds.
        """
        chosen, (rows, place, about) = self._chosen(boats), self._known(parameter)
        given = self._each(parameter, np.asarray(values, dtype=float), chosen)
        if not ((given >= about.low) & (given <= about.high)).all():
            wrong = given[~((given >= about.low) & (given <= about.high))][0]
            raise BadInput(
                f"{parameter} = {wrong:g}; allowed {about.low:g} to {about.high:g} {about.unit}".rstrip()
            )
        rows[chosen, place] = given
        self._weigh(chosen)

    def get(self, parameter: str) -> Array:
        """(n,) values of "effect.parameter"."""
        rows, place, _ = self._known(parameter)
        return rows[:, place].copy()

    def assign(self, vessel: ArrayLike, boats: ArrayLike | None = None) -> None:
        """Make boats the vessel of that number, one or (k,), with all parameters as its file has them.

        Raises BadInput for a number that none has.
        """
        chosen = self._chosen(boats)
        numbers = self._each("vessel", np.asarray(vessel, dtype=int), chosen)
        if strange := [
            number for number in np.unique(numbers) if not 0 <= number < len(self.vessels)
        ]:
            raise BadInput(f"vessel {strange[0]}; allowed 0 to {len(self.vessels) - 1}")
        for number in np.unique(numbers):
            program, some = self.programs[number], chosen[numbers == number]
            self._p[some], self._body[some] = self._values[number], program.body
            self._draw(program, some)
        self._weigh(chosen)

    def _draw(self, program: Program, boats: Boats) -> None:
        """Random courses by each boat's seed."""
        for effect, first in zip(program.effects, program.offsets, strict=True):
            if type(effect).seeded is not Effect.seeded:
                for b in boats:
                    values = effect.seeded(int(self._seeds[b])).values()
                    self._p[b, first : first + len(values)] = values

    def _stepped(self, boats: Boats, steps: int) -> None:
        self.code.advance_boats(boats, self.fleet, self.step, steps)

    def _weigh(self, boats: Boats) -> None:
        self.code.weigh_boats(boats, self._body, self._p, self._on, self._k)

    def shared(self, work: Callable[[Boats], None], boats: Boats | None = None) -> None:
        """Work on boats (all), by turns of some, on all threads."""
        chosen = np.arange(self.n) if boats is None else boats
        turns = [chosen[i : i + TURN] for i in range(0, len(chosen), TURN)]
        if self.threads == 1 or len(turns) == 1:
            for some in turns:
                work(some)
            return
        for _ in pool(self.threads, os.getpid()).map(work, turns):
            pass

    def feel(self, felt: Array) -> None:
        """What instruments without noise would say, a row (11,) a boat, in the order of `control.compiled.SENSE_FIELDS`."""
        self.shared(lambda some: self.code.feel_boats(some, self.fleet, felt))

    def _chosen(self, boats: ArrayLike | None) -> Boats:
        """Numbers of the boats that are meant. Raises BadInput."""
        if boats is None:
            return np.arange(self.n)
        given = np.asarray(boats)
        chosen = (
            np.flatnonzero(given) if given.dtype == bool else np.atleast_1d(given).astype(np.int64)
        )
        if len(chosen) and not (0 <= chosen.min() and chosen.max() < self.n):
            raise BadInput(
                f"boat {chosen.max() if chosen.min() >= 0 else chosen.min()}; allowed 0 to {self.n - 1}"
            )
        return chosen

    @staticmethod
    def _each(what: str, given: NDArray[Any], boats: Boats) -> NDArray[Any]:
        """A value a boat. Raises BadInput."""
        if given.shape not in ((), (1,), boats.shape):
            raise BadInput(
                f"{what}: values of shape {given.shape}; allowed are one, or one for each of {len(boats)} boats"
            )
        return np.broadcast_to(given, boats.shape)

    def _rows(self, states: ArrayLike, boats: Boats) -> Array:
        """A state a boat. Raises BadInput."""
        given = np.asarray(states, dtype=float)
        if (
            given.shape not in ((self._y.shape[1],), (len(boats), self._y.shape[1]))
            or not np.isfinite(given).all()
        ):
            raise BadInput(
                f"states of shape {given.shape}; allowed are {self._y.shape[1]} finite numbers a boat"
            )
        return np.broadcast_to(given, (len(boats), self._y.shape[1]))

    def _taken(self, commands: ArrayLike | Mapping[str, float], boats: Boats) -> Array:
        """(k, C) commands that act when these are sent. Raises BadInput."""
        boat = self.vessels[0]
        if isinstance(commands, Mapping):
            return clipped_row(boat, commands)
        given, width = np.asarray(commands, dtype=float), len(boat.commands)
        fits = given.shape[:-1] in ((), (1,), boats.shape)
        if not (given.ndim and fits and given.shape[-1] in (width, len(boat.inputs))):
            raise BadInput(
                f"commands of shape {given.shape}; allowed are {width} a boat: {', '.join(boat.commands)}"
            )
        rows = self._commands[boats]
        rows[:, : given.shape[-1]] = given
        return clip(boat, rows)

    @cached_property
    def _parameters(self) -> dict[str, tuple[int, Param]]:
        """Where each number of an effect lies, and what is known of it."""
        program = self.program
        return {
            f"{effect.name}.{name}": (first + i, about)
            for effect, first in zip(program.effects, program.offsets, strict=True)
            for i, (name, about) in enumerate(type(effect).params().items())
        }

    def _known(self, parameter: str) -> tuple[Array, int, Param]:
        """Rows of all boats in which a number stands, where, and what is known of it."""
        if parameter in BODY:
            return (self._body, *BODY[parameter])
        if parameter not in self._parameters:
            names = [*self._parameters, *BODY]
            raise BadInput(unknown_name(f"{self.vessels[0].name}: parameter", parameter, names))
        return (self._p, *self._parameters[parameter])

    def _check_alike(self) -> None:
        """Raises BadInput for vessels of which one program does not serve all."""
        first = self.vessels[0]
        for i, (boat, program) in enumerate(zip(self.vessels, self.programs, strict=True)):
            if program.module is not self.code or boat.inputs != first.inputs:
                raise BadInput(
                    f"vessel {i} of a batch ({boat.name}) has other effects, freedoms or channels than the first "
                    f"({first.name}); allowed are other numbers"
                )


@cache
def pool(threads: int, process: int) -> ThreadPoolExecutor:
    """Threads that step boats, shared by all batches of a process; one that was forked has none of its parent's."""
    return ThreadPoolExecutor(threads, "boats")
