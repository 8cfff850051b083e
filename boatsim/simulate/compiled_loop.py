"""The compiled closed loop of many vessels: sensors, law, commands and physics.

It depends neither on the vessel nor on the controller: their compiled functions are passed as
pointers, so that it is compiled once for each kind of controller, whatever vessel it steers.
"""

from functools import cache
from typing import Any, NamedTuple

import numba
import numpy as np
from numba import types

from boatsim.physics.commands import SLACK
from boatsim.physics.compiler_internals import FunctionPointer, NativePointer
from boatsim.physics.debugging import DEBUG
from boatsim.physics.kernel.compiling import merged, unlocked
from boatsim.physics.kernel.records import FleetArrays, StepRecord
from boatsim.physics.native.calls import NativeFunction
from boatsim.physics.signals import Array
from boatsim.simulate.sensing import add_sensor_errors


class Call(NamedTuple):
    """A function of a vessel's program with its arguments, for compiled code."""

    function: Any  # a pointer
    given: Any  # its arguments
    kept: Any = 0  # memory that must live as long as the call is used


class Periods(NamedTuple):
    """Number and length of the control periods in one call of the compiled loop."""

    number: int
    steps: int  # integration steps of a period


class Control(NamedTuple):
    """Arrays of records with settings, memory, inputs and outputs of each vessel's controller."""

    settings: Any
    memory: Any
    sense: Any
    goal: Any
    sent: Any


class Sensing(NamedTuple):
    """Arrays for simulated instruments: true readings, parameters of sensor errors, and noise."""

    felt: Array  # (n, 11) numbers of the records `sense`
    sensors: Array  # `Sensors.error_parameters`
    noise: Array  # (boats, periods, 7) standard normal numbers


class Goals(NamedTuple):
    """Arrays with the goals that controllers follow: the present ones, and those of each period."""

    wanted: Array  # (n, G) numbers of the records `goal`
    values: Array  # (periods, G) the same for all vessels


class Orders(NamedTuple):
    """Arrays with the commands that the controllers of n vessels send, and their limits."""

    values: Array  # (n, orders) numbers of the records `sent`
    places: Any  # (orders,) input of the vessel that each order is for
    low: Array  # (inputs,) lowest and
    high: Array  # (inputs,) highest value of each input
    saturated: Array  # (n, inputs) number of steps in which more was ordered than the range allows


class Loop(NamedTuple):
    """Arrays of the compiled closed loop: controllers, sensors, goals and commands of vessels."""

    control: Control
    sensing: Sensing
    goals: Goals
    orders: Orders


class History(NamedTuple):
    """Arrays of what a controller received, sent and remembers after each of several periods."""

    felt: Array  # (periods, 11) sensor readings
    orders: Array  # (periods, orders) commands as sent
    commands: Array  # (periods, inputs) commands in force
    memory: Array  # (periods, M) numbers of the controller's memory


Boats = types.Array(types.int64, 1, "C")
Row = types.Array(types.float64, 1, "C")
Rows = types.Array(types.float64, 2, "C")
FLEET = types.NamedTuple([Row, Rows, Rows, Rows, Rows, Rows, Row, Rows, Row], FleetArrays)
FEEL = types.void(Boats, FLEET, Rows)  # `read_instruments_of_boats` of a program
ADVANCE = types.void(Boats, FLEET, types.float64, types.int64)  # `advance_boats` of a program
WORDS = types.float64(types.int64, types.int64)  # of functions in C, `native.exports`
RECORD = types.NamedTuple([Boats] * 3 + [Rows] * 5, StepRecord)
RECORD_STEPS = types.void(FLEET, types.float64, RECORD)  # `record_steps` of a program
HISTORY = types.NamedUniTuple(Rows, 4, History)
PERIODS = types.NamedUniTuple(types.int64, 2, Periods)


@unlocked
def add_sensor_errors_to_boats(
    boats: Any, felt: Array, sensors: Array, noise: Array, i: int
) -> None:
    """Add sensor errors to the true readings of vessels, in place.

    The errors are those of control period i; `noise` has the shape (boats, periods, 7).
    """
    for j in range(len(boats)):
        add_sensor_errors(felt[boats[j]], sensors, noise[j, i])


@merged
def count_saturated_steps(boats: Any, commands: Array, orders: Orders, steps: int) -> None:
    """Count the saturated steps of each command over some steps.

    A step is saturated if the controller ordered more than the range of the channel allows.
    """
    low, high = orders.low, orders.high
    for b in boats:
        for j in range(len(orders.places)):
            c = orders.places[j]
            if abs(orders.values[b, j] - commands[b, c]) > SLACK * (high[c] - low[c]):
                orders.saturated[b, c] += steps


def run_periods(
    law: Any, feel: Call, advance: Call, boats: Any, periods: Periods, commands: Array, loop: Loop
) -> None:
    """Simulate vessels with their controllers over control periods, in place.

    Each period begins with the sensors and the control law; then the physics is integrated.

    Args:
        law: Law of the controllers.
        feel: Reads the instruments of the vessels.
        advance: Integrates the physics of the vessels over the steps of one period.
        boats: Rows of the vessels to work on.
        periods: Number and length of the periods.
        commands: Commands (B, inputs) of all vessels.
        loop: Records and arrays of the controllers.
    """
    control, sensing, goals, orders = loop
    places, low, high = orders.places, orders.low, orders.high
    for i in range(periods.number):
        feel.function(*feel.given)
        add_sensor_errors_to_boats(boats, sensing.felt, sensing.sensors, sensing.noise, i)
        for b in boats:
            for j in range(goals.values.shape[1]):
                goals.wanted[b, j] = goals.values[i, j]
        law(boats, control.settings, control.memory, control.sense, control.goal, control.sent)
        for b in boats:
            for j in range(len(places)):
                order = orders.values[b, j]
                commands[b, places[j]] = min(max(order, low[places[j]]), high[places[j]])
        count_saturated_steps(boats, commands, orders, periods.steps)
        advance.function(*advance.given)


@merged
def copy_row(source: Array, target: Array, i: int) -> None:
    """Copy the first row of an array to row i of another one."""
    for j in range(target.shape[1]):
        target[i, j] = source[0, j]


def run_recorded_periods(
    law: Any,
    feel: Call,
    advance: Call,
    boats: Any,
    commands: Array,
    loop: Loop,
    memory: Array,
    history: History,
) -> None:
    """Simulate one vessel with its controller over control periods, in place, and record it.

    The physics is integrated over each period; at its end the sensors are read and the control law
    computes commands.

    Args:
        law: Law of the controller.
        feel: Reads the instruments of the vessel.
        advance: Integrates the physics over the next period and records each step.
        boats: Row of the vessel, 0.
        commands: Commands (1, inputs) in force.
        loop: Records and arrays of the controller.
        memory: Numbers (1, M) of the controller's memory.
        history: Receives what is recorded of each period; its length is the number of periods.
    """
    control, sensing, goals, orders = loop
    places, low, high = orders.places, orders.low, orders.high
    for i in range(len(history.felt)):
        advance.function(*advance.given)
        feel.function(*feel.given)
        add_sensor_errors(sensing.felt[0], sensing.sensors, sensing.noise[0, i])
        for j in range(goals.values.shape[1]):
            goals.wanted[0, j] = goals.values[i, j]
        law(boats, control.settings, control.memory, control.sense, control.goal, control.sent)
        for j in range(len(places)):
            order = orders.values[0, j]
            commands[0, places[j]] = min(max(order, low[places[j]]), high[places[j]])
            history.orders[i, j] = order
        copy_row(sensing.felt, history.felt, i)
        copy_row(commands, history.commands, i)
        copy_row(memory, history.memory, i)


class ProgramFunction:
    """A function of a vessel's program as the compiled loop calls it.

    It is a pointer to the function in C or to that of numba, in debugging mode the function.
    """

    def __init__(self, function: Any, call: Any) -> None:
        """Make the pointer.

        Args:
            function: The function.
            call: Its signature for numba.
        """
        self._function, self._pointer = function, function
        if isinstance(function, NativeFunction):
            self._pointer = NativePointer(function.address, WORDS)
        elif not DEBUG:
            self._pointer = FunctionPointer(function, call)

    def bind_arguments(self, *given: Any) -> Call:
        """Bind arguments to the function; return the call as the compiled loop takes it.

        Args:
            *given: Its arguments, whose arrays must live as long as the call is used.
        """
        if isinstance(self._function, NativeFunction):
            words = np.frombuffer(self._function.pack_arguments(*given), dtype=np.int64)
            return Call(self._pointer, (words.ctypes.data, 0), words)
        return Call(self._pointer, given)


def law_pointer(law: Any, records: tuple[Any, ...]) -> Any:
    """Return a control law as an argument of `run_periods`.

    It is a pointer to the compiled function, in debugging mode the function.

    Args:
        law: Law of the controllers.
        records: Types of the five records in `Control`.
    """
    if DEBUG:
        return law
    return FunctionPointer(law, types.void(Boats, *records))


@cache
def compile_loop(kinds: tuple[Any, ...], loop: Any) -> Any:
    """Return the compiled simulation of control periods, `run_periods`, for given argument types.

    Each combination of types has its own function: numba would try every call on the types of the
    others too.

    Args:
        kinds: Types of the control law and of the calls for sensing and physics.
        loop: Type of the record `Loop`.
    """
    own: Any = unlocked(run_periods)
    own.compile((*kinds, Boats, PERIODS, Rows, loop))
    own.disable_compile()
    return own


def recorded_loop(law: Any, feel: Call, advance: Call, loop: Loop) -> tuple[Any, Any]:
    """Return a control law as an argument of `run_recorded_periods`, and this function, compiled.

    Each combination of types of arguments is compiled once.

    Args:
        law: Law of the controller.
        feel: Reads the instruments of the vessel.
        advance: Integrates the physics and records each step.
        loop: Records and arrays of the controller.
    """
    # the types of records are slow to find out
    key = (law, tuple(records.dtype for records in loop.control), type(feel.function))
    if key not in _RECORDED_LOOPS:
        pointer = law_pointer(law, tuple(map(numba.typeof, loop.control)))
        own: Any = run_recorded_periods
        if not DEBUG:
            own = unlocked(run_recorded_periods)
            kinds = pointer.kind, numba.typeof(feel), numba.typeof(advance)
            own.compile((*kinds, Boats, Rows, numba.typeof(loop), Rows, HISTORY))
            own.disable_compile()
        _RECORDED_LOOPS[key] = pointer, own
    return _RECORDED_LOOPS[key]


_RECORDED_LOOPS: dict[Any, tuple[Any, Any]] = {}  # laws and loops that are compiled
