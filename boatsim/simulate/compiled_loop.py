"""The closed loop of many boats, compiled: every period sensors, law and commands, then some steps of physics.

It knows neither vessel nor controller: what they compile to comes in as pointers to functions, so that it is compiled
once for each controller, whatever boat it steers.
"""

from functools import cache
from typing import Any

from numba import types

from boatsim.physics.commands import SLACK
from boatsim.physics.kernel.compiling import merged, unlocked
from boatsim.physics.signals import Array
from boatsim.simulate.sensing import disturb

Boats = types.Array(types.int64, 1, "C")
Row = types.Array(types.float64, 1, "C")
Rows = types.Array(types.float64, 2, "C")
Block = types.Array(types.float64, 3, "C")
FEEL = types.void(Boats, Row, Rows, Rows, Rows, Row, Rows, Row, Rows)  # `feel_boats` of a program
ADVANCE = types.void(
    Boats, Row, Rows, Rows, Rows, Rows, types.float64, types.int64, Rows, Row, Rows, Row
)


class Pointer:
    """A compiled function of one signature as an argument of another: numba finds it without a search."""

    def __init__(self, function: Any, signature: Any) -> None:
        """Compiles it, if that was not done before."""
        function.compile(signature.args)
        compiled = function.get_compile_result(signature)
        self._address = compiled.library.get_pointer_to_function(
            compiled.fndesc.llvm_cfunc_wrapper_name
        )
        self._numba_type_ = types.FunctionType(signature)
        self._function = function  # whose code must outlive the address

    def __wrapper_address__(self) -> int:
        return int(self._address)


@unlocked
def disturb_boats(boats: Any, felt: Array, sensors: Array, noise: Array, i: int) -> None:
    """What is felt aboard made what sensors say; noise (boats, periods, 7) of period i."""
    for j in range(len(boats)):
        disturb(felt[boats[j]], sensors, noise[j, i])


@merged
def note_orders(
    boats: Any,
    commands: Array,
    orders: Array,
    places: Any,
    low: Array,
    high: Array,
    steps: int,
    dt: float,
    beyond: Array,
    total: Array,
) -> None:
    """Count what acts over some steps, and whether more was ordered."""
    for b in boats:
        for j in range(len(places)):
            c = places[j]
            total[b, c] += commands[b, c] * (steps * dt)
            if abs(orders[b, j] - commands[b, c]) > SLACK * (high[c] - low[c]):
                beyond[b, c] += steps


def sail(
    law: Any,
    feel: Any,
    advance: Any,
    boats: Any,
    begins: bool,
    periods: int,
    steps: int,
    dt: float,
    t: Array,
    y: Array,
    commands: Array,
    memory: Array,
    act: Array,
    p: Array,
    on: Any,
    k: Array,
    extra: Array,
    settings: Any,
    remembered: Any,
    sense: Any,
    felt: Array,
    sensors: Array,
    noise: Array,
    goal: Any,
    wanted: Array,
    goals: Array,
    sent: Any,
    orders: Array,
    places: Any,
    low: Array,
    high: Array,
    beyond: Array,
    total: Array,
) -> None:
    """So many control periods of `steps` steps of dt [s], in place; all arrays have a row a boat.

    Each begins with the law where `begins`, else it ends with it. `felt`, `wanted` and `orders` are the numbers of the
    records `sense`, `goal` and `sent`; goals (periods, G) are those of all boats; `places` says which input of a vessel
    each order is for, within low and high; noise (boats, periods, 7) is that of `disturb`. `beyond` (n, inputs) counts
    the steps in which more was ordered than a channel takes, `total` sums what acted over time [s].
    """
    for i in range(periods):
        if not begins:
            note_orders(boats, commands, orders, places, low, high, steps, dt, beyond, total)
            advance(boats, t, y, commands, memory, act, dt, steps, p, on, k, extra)
        feel(boats, t, y, act, p, on, k, extra, felt)
        disturb_boats(boats, felt, sensors, noise, i)
        for b in boats:
            for j in range(goals.shape[1]):
                wanted[b, j] = goals[i, j]
        law(boats, settings, remembered, sense, goal, sent)
        for b in boats:
            for j in range(len(places)):
                commands[b, places[j]] = min(max(orders[b, j], low[places[j]]), high[places[j]])
        if begins:
            note_orders(boats, commands, orders, places, low, high, steps, dt, beyond, total)
            advance(boats, t, y, commands, memory, act, dt, steps, p, on, k, extra)


@cache
def sailing(pointers: tuple[Any, ...], records: tuple[Any, ...]) -> Any:
    """`sail` for pointers to law, `feel_boats` and `advance_boats` of these types, and for settings, memory, sense, ...

    Each has one of its own: numba would try every call on the types of the others too.
    """
    settings, remembered, sense, goal, sent = records
    whole, number = types.int64, types.float64
    own: Any = unlocked(sail)
    own.compile(
        (
            *pointers,
            Boats,
            types.boolean,
            whole,
            whole,
            number,
            Row,
            Rows,
            Rows,
            Rows,
            Rows,
            Rows,
            Row,
            Rows,
            Row,
            settings,
            remembered,
            sense,
            Rows,
            Row,
            Block,
            goal,
            Rows,
            Rows,
            sent,
            Rows,
            Boats,
            Row,
            Row,
            Rows,
            Rows,
        )
    )
    own.disable_compile()
    return own
