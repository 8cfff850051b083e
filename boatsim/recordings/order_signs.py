"""Orders to drives that lost their sign, next to the force and the moment they were computed from.

A program that turns a force and a moment into shaft rates takes a square root. Some log its size
only, or zero for a drive that should push astern. Others compute the orders for the size of the
force and turn its direction afterwards, so that the sides are exchanged while it is astern. The
force and the moment in the same log show what was asked for.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from boatsim.physics.base import Array

# Kind of an asked-for force ahead or moment to starboard -> its usual column of a recording
EFFORT_COLUMNS = {"effort_x": "force_x_N", "effort_n": "force_n_Nm"}
EXACT = 0.01  # of the range: a computed order differs from its law by rounding only
MIN_EXACT_SHARE = 0.8  # of the rows with a positive order, that the law must meet
REFITS = 10  # at most, each to the rows that the law before met
MIN_ROWS = 20  # of a fit
MIRRORED = 0.05  # of a coefficient, by which the laws of two drives at equal distance may differ
MIN_NEGATIVE = 5  # rows in which an order should be negative: single ones may be faulty cells


@dataclass(frozen=True)
class OrderLaw:
    """An order as a function of a force ahead and a moment: c |c| or c is a X + b N.

    Attributes:
        a: Coefficient of the force.
        b: Coefficient of the moment.
        squared: Whether the order enters as its square, as a shaft rate does.
        sums: a X + b N (N,) in the rows of the order.
        range: Largest size of the order, squared if it enters so.
        exact: Share of the rows with a positive order and a positive law that it meets.
    """

    a: float
    b: float
    squared: bool
    sums: Array
    range: float
    exact: float

    @property
    def negative(self) -> NDArray[np.bool_]:
        """Rows (N,) in which the order should be negative."""
        return np.asarray(self.sums < -EXACT * self.range)

    def force(self, values: Array) -> Array:
        """Return what orders (N,) are proportional to: their signed squares, or themselves."""
        if self.squared:
            return values * np.abs(values)
        return values

    def with_sign(self, values: Array, rows: NDArray[np.bool_]) -> Array:
        """Return orders (N,), by the law in those of the given rows (N,) that differ from it."""
        lawful = self.sums
        if self.squared:
            lawful = np.sign(lawful) * np.sqrt(np.abs(lawful))
        differs = np.abs(self.force(values) - self.sums) > EXACT * self.range
        return np.where(differs & rows, lawful, values)


def laws_of_unsigned_orders(
    orders: Mapping[str, Array], force: Array, moment: Array
) -> dict[str, OrderLaw]:
    """Return the laws of orders that are never negative, though their force and moment ask for it.

    Args:
        orders: Name -> orders of a drive (N,).
        force: Force ahead (N,) that was asked for; nan where unknown.
        moment: Moment to starboard (N,); nan where unknown.

    Returns:
        Name -> law. It is empty unless all orders follow from the force and the moment, none of
        them is negative, and one of them should be in at least `MIN_NEGATIVE` rows.
    """
    laws = {}
    for name, values in orders.items():
        if not len(values) or not float(np.min(values)) >= 0.0:
            return {}
        law = order_law(values, force, moment)
        if law.exact < MIN_EXACT_SHARE or law.a <= 0.0:
            return {}
        laws[name] = law
    if not laws or rows_without_sign(laws).sum() < MIN_NEGATIVE:
        return {}
    return laws


def rows_without_sign(laws: Mapping[str, OrderLaw]) -> NDArray[np.bool_]:
    """Return the rows (N,) in which an order should be negative.

    Args:
        laws: Name of each order -> its law, at least one.
    """
    return np.asarray(np.any([law.negative for law in laws.values()], axis=0))


def order_law(values: Array, force: Array, moment: Array) -> OrderLaw:
    """Return the law by which an order that may have lost its sign follows from a force and moment.

    Args:
        values: Orders (N,), none negative.
        force: Force ahead (N,); nan where unknown.
        moment: Moment to starboard (N,); nan where unknown.
    """
    laws = [_fitted_law(values, force, moment, squared) for squared in (True, False)]
    return max(laws, key=lambda law: law.exact)


def signed_orders(
    orders: Mapping[str, Array], laws: Mapping[str, OrderLaw], force: Array
) -> dict[str, dict[str, Array]]:
    """Return what the drives may have done with orders that lost their sign.

    Args:
        orders: Name -> orders as logged (N,), none negative.
        laws: Name -> the law of these orders.
        force: Force ahead (N,) that was asked for; nan where unknown.

    Returns:
        Possibility -> name -> signed orders (N,):

        - `computed`: the law holds in each row in which an order should be negative.
        - `signed`: sizes as logged; those that should be negative are, and zero stays.
        - `idle`: the drives do not push astern and stand still instead.
        - `exchanged`: where the force is astern all orders are negative, and drives opposite each
          other have exchanged theirs. It is there only if each drive has one opposite.
    """
    rows = rows_without_sign(laws)
    possible = {
        "computed": {name: law.with_sign(orders[name], rows) for name, law in laws.items()},
        "signed": {
            name: np.where(law.negative, -orders[name], orders[name]) for name, law in laws.items()
        },
        "idle": {name: np.where(law.negative, 0.0, orders[name]) for name, law in laws.items()},
    }
    opposite = _opposite_drives(laws)
    if len(opposite) == len(laws):
        astern = force < 0.0
        possible["exchanged"] = {
            name: np.where(astern, -orders[opposite[name]], orders[name]) for name in laws
        }
    return possible


def _opposite_drives(laws: Mapping[str, OrderLaw]) -> dict[str, str]:
    """Name of a drive -> the one whose law has the same force and the opposite moment."""
    opposite = {}
    for name, law in laws.items():
        for other, its in laws.items():
            same_force = abs(its.a - law.a) <= MIRRORED * abs(law.a)
            if same_force and abs(its.b + law.b) <= MIRRORED * max(abs(law.b), abs(its.b)):
                opposite[name] = other
    return opposite


def effort_of_orders(
    orders: Mapping[str, Array], laws: Mapping[str, OrderLaw]
) -> tuple[Array, Array]:
    """Return the force ahead and the moment (N,) each to which signed orders add up, by their laws.

    Args:
        orders: Name -> signed orders (N,).
        laws: Name -> law of these orders.
    """
    shares = np.array([[law.a, law.b] for law in laws.values()])  # (drives, 2)
    forces = np.array([law.force(orders[name]) for name, law in laws.items()])  # (drives, N)
    force, moment = np.linalg.pinv(shares) @ forces
    return force, moment


def _fitted_law(values: Array, force: Array, moment: Array, squared: bool) -> OrderLaw:
    """Least squares over the rows that the law meets best; the others may lack their sign."""
    wanted = values**2 if squared else values
    design = np.column_stack([force, moment])
    top = float(np.max(wanted))
    rows = np.flatnonzero((wanted > EXACT * top) & np.isfinite(design).all(axis=1))
    if len(rows) < MIN_ROWS:
        return OrderLaw(0.0, 0.0, squared, np.zeros(len(values)), top, 0.0)
    # the largest forces first, with which drives hardly ever push astern; then what the law meets
    kept = rows[force[rows] >= np.median(force[rows])]
    found = np.zeros(2)
    for _ in range(REFITS):
        before = kept
        solved = np.linalg.lstsq(design[kept], wanted[kept], rcond=None)[0]
        found = np.array(solved, dtype=np.float64)
        error = np.abs(wanted[rows] - design[rows] @ found)
        scatter = max(float(np.median(error)), EXACT * top)
        kept = rows[error <= scatter]
        if len(kept) < MIN_ROWS or np.array_equal(kept, before):
            break
    sums = design @ found
    sums = np.where(np.isfinite(sums), sums, wanted)  # unknown: as logged
    positive = (wanted > EXACT * top) & (sums > 0.0) & np.isfinite(design).all(axis=1)
    exact = np.abs(wanted - sums)[positive] < EXACT * top
    share = float(exact.mean()) if positive.sum() >= MIN_ROWS else 0.0
    return OrderLaw(float(found[0]), float(found[1]), squared, sums, top, share)
