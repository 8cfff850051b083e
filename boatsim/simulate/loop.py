"""The closed loop of many boats, compiled: every period sensors, law and commands, then some steps of physics.

It knows neither vessel nor controller: what they compile to comes in as pointers to functions, so that it is compiled
once for each controller, whatever boat it steers.
"""

from functools import cache
from typing import Any

from numba import types

from boatsim.physics.commands import SLACK
from boatsim.physics.kernel.compiling import unlocked
from boatsim.physics.signals import Array
from boatsim.simulate.sensing import disturb

Boats = types.Array(types.int64, 1, "C")
Row = types.Array(types.float64, 1, "C")
Rows = types.Array(types.float64, 2, "C")
Block = types.Array(types.float64, 3, "C")
FEEL = types.void(Boats, Row, Rows, Rows, Rows, Row, Rows, Row, Rows)  # `feel_boats` of a program
ADVANCE = types.void(Boats, Row, Rows, Rows, Rows, Rows, types.float64, types.int64, Rows, Row, Rows, Row)


@unlocked
def disturb_boats(boats: Any, felt: Array, sensors: Array, noise: Array, i: int) -> None:
    """What is felt aboard made what sensors say; noise (boats, periods, 7) of period i."""
    for j in range(len(boats)):
        disturb(felt[boats[j]], sensors, noise[j, i])


def sail(
    law: Any, feel: Any, advance: Any, boats: Any, periods: int, steps: int, dt: float, t: Array, y: Array,
    commands: Array, memory: Array, act: Array, p: Array, on: Any, k: Array, extra: Array, settings: Any,
    remembered: Any, sense: Any, felt: Array, sensors: Array, noise: Array, goal: Any, sent: Any, orders: Array,
    places: Any, low: Array, high: Array, beyond: Array,
) -> None:  # fmt: skip
    """So many control periods of `steps` steps of dt [s], in place; all arrays have a row a boat.

    `felt` and `orders` are the numbers of the records `sense` and `sent`; `places` says which input of a vessel each
    order is for, within low and high; noise (boats, periods, 7) is that of `disturb`. `beyond` (n, inputs) counts the
    steps in which more was ordered than a channel takes.
    """
    for i in range(periods):
        feel(boats, t, y, act, p, on, k, extra, felt)
        disturb_boats(boats, felt, sensors, noise, i)
        law(boats, settings, remembered, sense, goal, sent)
        for b in boats:
            for j in range(len(places)):
                c = places[j]
                commands[b, c] = min(max(orders[b, j], low[c]), high[c])
                if abs(orders[b, j] - commands[b, c]) > SLACK * (high[c] - low[c]):
                    beyond[b, c] += steps
        advance(boats, t, y, commands, memory, act, dt, steps, p, on, k, extra)


@cache
def sailing(law: Any, pointers: tuple[Any, ...], records: tuple[Any, ...]) -> Any:
    """`sail` for a law: compiled for pointers to functions of these types, and for settings, memory, sense, goal, sent.

    Called with the functions as they are, it would be compiled for these very ones, which no other process knows again.
    Each law has one of its own: a second one would be tried on the types of the first.
    """
    settings, remembered, sense, goal, sent = records
    whole, number = types.int64, types.float64
    own: Any = unlocked(sail)
    own.compile(
        (
            *pointers, Boats, whole, whole, number, Row, Rows, Rows, Rows, Rows, Rows, Row, Rows, Row,
            settings, remembered, sense, Rows, Row, Block, goal, sent, Rows, Boats, Row, Row, Rows,
        )
    )  # fmt: skip
    own.disable_compile()
    return own
