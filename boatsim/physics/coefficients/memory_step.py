"""Compiled steps of the memory of the radiation force: oscillators driven by the velocity.

The table of the effect has the numbers of sections of both sets of axes (surge, heave, pitch and
sway, roll, yaw), then for each section b, a and the upper triangles of M and N. Each section has
one oscillator x'' + a x' + b x = nu for each axis of its set, and the force M x' + N x. Between two
steps the velocity is taken as linear in time, for which the steps of the oscillators are exact.

The momentum of the memory is the integral of this force over time. As the sum of N / b over all
sections is zero, it is a function of the same states, M x - N (x' + a x) / b.
"""

from math import cos, exp, sin, sqrt
from typing import Any

from numba import njit

from boatsim.physics.signals import Array

SECTION = 14  # floats of the table for each section
HEAD = 8  # floats of the memory before the sections: last step, step of the factors, six velocities
FACTORS = 16  # floats for each section that depend on the length of the step only
OSCILLATORS = 6  # floats for each section: place and rate of its oscillators
FORCES = 18  # floats of a row: six forces at rest, two symmetric matrices of force per velocity
SIGNALS = 26  # and momentum of the memory in heave and sway: two at rest, six per velocity


@njit
def oscillator_factors(a: float, b: float, h: float, memory: Array, at: Any) -> None:
    """Store the factors of one step of an oscillator x'' + a x' + b x = u.

    They are the four of the state (x, x') and two each of the input at begin and end of the step,
    between which it is linear.

    Args:
        a: Damping [1/s].
        b: Stiffness [1/s^2], above zero.
        h: Length of the step [s].
        memory: States of all effects.
        at: Index of the first factor.
    """
    half = 0.5 * a
    rest = b - half * half
    if rest > 0.0:
        turn, decay = sqrt(rest), exp(-half * h)
        c, s = decay * cos(turn * h), decay * sin(turn * h) / turn
    elif rest < 0.0:
        turn = sqrt(-rest)
        slow, fast = exp((turn - half) * h), exp(-(turn + half) * h)
        c, s = 0.5 * (slow + fast), 0.5 * (slow - fast) / turn
    else:
        decay = exp(-half * h)
        c, s = decay, decay * h
    memory[at] = c + half * s
    memory[at + 1] = s
    memory[at + 2] = -b * s
    memory[at + 3] = c - half * s
    held, moved = (1.0 - memory[at]) / b, s  # place and rate after a constant unit input
    ramp, ramped = (h - moved - a * held) / (b * h), held / h  # after one that grows from 0 to 1
    memory[at + 4] = held - ramp
    memory[at + 5] = moved - ramped
    memory[at + 6] = ramp
    memory[at + 7] = ramped


@njit
def add_product(act: Array, place: Any, p: Array, entry: Any, x: float, y: float, z: float) -> None:
    """Add the product of a symmetric matrix and a vector to three entries of an array.

    Args:
        act: Array to which it is added.
        place: Index of the first of the three entries.
        p: Array that holds the upper triangle of the matrix.
        entry: Index of its first entry.
        x: First component of the vector.
        y: Second component.
        z: Third component.
    """
    act[place] += p[entry] * x + p[entry + 1] * y + p[entry + 2] * z
    act[place + 1] += p[entry + 1] * x + p[entry + 3] * y + p[entry + 4] * z
    act[place + 2] += p[entry + 2] * x + p[entry + 4] * y + p[entry + 5] * z


@njit
def add_row(
    act: Array,
    row: Any,
    group: Any,
    p: Array,
    section: Any,
    memory: Array,
    factors: Any,
    states: Any,
    speeds: Any,
) -> None:
    """Add the force of one section in the middle or at the end of the coming step to a row.

    It is a force for a velocity of zero there, and a matrix of force per velocity.

    Args:
        act: Signals of the laws.
        row: Index of the first signal of the row.
        group: 0 for surge, heave and pitch, 1 for sway, roll and yaw.
        p: Parameters and tables.
        section: Index of the section in them.
        memory: States of all effects.
        factors: Index of the factors of the step to this row.
        states: Index of the section's oscillators.
        speeds: Index of the three velocities at the begin of the step.
    """
    f1, f2, f3, f4 = memory[factors], memory[factors + 1], memory[factors + 2], memory[factors + 3]
    g1, g2 = memory[factors + 4], memory[factors + 5]
    x0, x1, x2 = memory[states], memory[states + 2], memory[states + 4]
    v0, v1, v2 = memory[states + 1], memory[states + 3], memory[states + 5]
    u0, u1, u2 = memory[speeds], memory[speeds + 1], memory[speeds + 2]
    add_product(
        act,
        row + 3 * group,
        p,
        section + 2,
        f3 * x0 + f4 * v0 + g2 * u0,
        f3 * x1 + f4 * v1 + g2 * u1,
        f3 * x2 + f4 * v2 + g2 * u2,
    )
    add_product(
        act,
        row + 3 * group,
        p,
        section + 8,
        f1 * x0 + f2 * v0 + g1 * u0,
        f1 * x1 + f2 * v1 + g1 * u1,
        f1 * x2 + f2 * v2 + g1 * u2,
    )
    level, rate = memory[factors + 6], memory[factors + 7]
    for i in range(6):
        act[row + 6 + 6 * group + i] += rate * p[section + 2 + i] + level * p[section + 8 + i]


@njit
def advance_oscillators(memory: Array, factors: Any, states: Any, speeds: Any, now: Any) -> None:
    """Advance the three oscillators of one section over the last step.

    Args:
        memory: States of all effects.
        factors: Index of the factors of that step.
        states: Index of the section's oscillators.
        speeds: Index of the three velocities at its begin.
        now: The three velocities at its end.
    """
    for i in range(3):
        x, v, u = memory[states + 2 * i], memory[states + 2 * i + 1], memory[speeds + i]
        place = memory[factors] * x + memory[factors + 1] * v
        rate = memory[factors + 2] * x + memory[factors + 3] * v
        memory[states + 2 * i] = place + memory[factors + 4] * u + memory[factors + 6] * now[i]
        memory[states + 2 * i + 1] = rate + memory[factors + 5] * u + memory[factors + 7] * now[i]


@njit
def advance_sections(
    speeds: Any,
    act: Array,
    held: Any,
    own: Any,
    memory: Array,
    at: Any,
    dt: float,
    p: Array,
    first: Any,
) -> None:
    """Advance all oscillators to the begin of a step, and store the forces of the step.

    Args:
        speeds: Velocities through the water in the order of the sets: surge, heave, pitch, sway,
            roll, yaw [m/s, rad/s].
        act: Signals of the laws.
        held: Number of signals in a row.
        own: Index of the first signal of the effect.
        memory: States of all effects.
        at: Index of the first state of the effect.
        dt: Length of the step that begins [s].
        p: Parameters and tables.
        first: Index of the effect's table.
    """
    for row in range(3):
        for i in range(FORCES):
            act[row * held + own + i] = 0.0
    last = memory[at]
    section = first + 2
    place = at + HEAD
    for group in range(2):
        before = at + 2 + 3 * group
        now = (speeds[3 * group], speeds[3 * group + 1], speeds[3 * group + 2])
        for _ in range(int(p[first + group])):
            states = place + FACTORS
            if last > 0.0:
                advance_oscillators(memory, place, states, before, now)
            if dt != memory[at + 1]:
                oscillator_factors(p[section + 1], p[section], dt, memory, place)
                oscillator_factors(p[section + 1], p[section], 0.5 * dt, memory, place + 8)
            section += SECTION
            place = states + OSCILLATORS
        for i in range(3):
            memory[before + i] = now[i]
    section = first + 2
    place = at + HEAD
    for group in range(2):
        before = at + 2 + 3 * group
        for _ in range(int(p[first + group])):
            states = place + FACTORS
            rates = (memory[states + 1], memory[states + 3], memory[states + 5])
            levels = (memory[states], memory[states + 2], memory[states + 4])
            begin = own + 3 * group
            add_product(act, begin, p, section + 2, rates[0], rates[1], rates[2])
            add_product(act, begin, p, section + 8, levels[0], levels[1], levels[2])
            add_row(act, held + own, group, p, section, memory, place + 8, states, before)
            add_row(act, 2 * held + own, group, p, section, memory, place, states, before)
            section += SECTION
            place = states + OSCILLATORS
    memory[at] = dt
    memory[at + 1] = dt


@njit
def add_momentum(
    act: Array, row: Any, group: Any, p: Array, section: Any, places: Any, rates: Any
) -> None:
    """Add the momentum of one section, in heave or in sway, to a row.

    Args:
        act: Signals of the laws.
        row: Index of the first signal of the row.
        group: 0 for surge, heave and pitch, 1 for sway, roll and yaw.
        p: Parameters and tables.
        section: Index of the section in them.
        places: Places of the section's three oscillators.
        rates: Their rates.
    """
    b, a = p[section], p[section + 1]
    # row of heave, the second axis of its set, or of sway, the first one, in an upper triangle
    i, j, k = 1 - group, 3 - 2 * group, 4 - 2 * group
    x, y, z = places[0], places[1], places[2]
    act[row + FORCES + group] += (
        p[section + 2 + i] * x
        + p[section + 2 + j] * y
        + p[section + 2 + k] * z
        - p[section + 8 + i] * (rates[0] + a * x) / b
        - p[section + 8 + j] * (rates[1] + a * y) / b
        - p[section + 8 + k] * (rates[2] + a * z) / b
    )


@njit
def add_momentum_row(
    act: Array,
    row: Any,
    group: Any,
    p: Array,
    section: Any,
    memory: Array,
    factors: Any,
    states: Any,
    speeds: Any,
) -> None:
    """Add the momentum of one section in the middle or at the end of the coming step to a row.

    It is a momentum for a velocity of zero there, and momentum per velocity of the three axes.

    Args:
        act: Signals of the laws.
        row: Index of the first signal of the row.
        group: 0 for surge, heave and pitch, 1 for sway, roll and yaw.
        p: Parameters and tables.
        section: Index of the section in them.
        memory: States of all effects.
        factors: Index of the factors of the step to this row.
        states: Index of the section's oscillators.
        speeds: Index of the three velocities at the begin of the step.
    """
    f1, f2, f3, f4 = memory[factors], memory[factors + 1], memory[factors + 2], memory[factors + 3]
    g1, g2 = memory[factors + 4], memory[factors + 5]
    x0, x1, x2 = memory[states], memory[states + 2], memory[states + 4]
    v0, v1, v2 = memory[states + 1], memory[states + 3], memory[states + 5]
    u0, u1, u2 = memory[speeds], memory[speeds + 1], memory[speeds + 2]
    places = (f1 * x0 + f2 * v0 + g1 * u0, f1 * x1 + f2 * v1 + g1 * u1, f1 * x2 + f2 * v2 + g1 * u2)
    rates = (f3 * x0 + f4 * v0 + g2 * u0, f3 * x1 + f4 * v1 + g2 * u1, f3 * x2 + f4 * v2 + g2 * u2)
    add_momentum(act, row, group, p, section, places, rates)
    level, rate = memory[factors + 6], memory[factors + 7]
    held = (rate + p[section + 1] * level) / p[section]
    first = row + FORCES + 2 + 3 * group
    i, j, k = 1 - group, 3 - 2 * group, 4 - 2 * group
    act[first] += level * p[section + 2 + i] - held * p[section + 8 + i]
    act[first + 1] += level * p[section + 2 + j] - held * p[section + 8 + j]
    act[first + 2] += level * p[section + 2 + k] - held * p[section + 8 + k]


@njit
def store_momentum(
    act: Array, held: Any, own: Any, memory: Array, at: Any, p: Array, first: Any
) -> None:
    """Store the momentum of the memory in heave and sway for the step that begins.

    `advance_sections` has advanced the oscillators to its begin.

    Args:
        act: Signals of the laws.
        held: Number of signals in a row.
        own: Index of the first signal of the effect.
        memory: States of all effects.
        at: Index of the first state of the effect.
        p: Parameters and tables.
        first: Index of the effect's table.
    """
    for row in range(3):
        for i in range(FORCES, SIGNALS):
            act[row * held + own + i] = 0.0
    section = first + 2
    place = at + HEAD
    for group in range(2):
        before = at + 2 + 3 * group
        for _ in range(int(p[first + group])):
            states = place + FACTORS
            places = (memory[states], memory[states + 2], memory[states + 4])
            rates = (memory[states + 1], memory[states + 3], memory[states + 5])
            add_momentum(act, own, group, p, section, places, rates)
            add_momentum_row(act, held + own, group, p, section, memory, place + 8, states, before)
            add_momentum_row(act, 2 * held + own, group, p, section, memory, place, states, before)
            section += SECTION
            place = states + OSCILLATORS
