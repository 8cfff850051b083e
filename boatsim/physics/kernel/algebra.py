"""Sums of products of named numbers, from which equations without zero terms are written."""

from collections.abc import Iterable
from operator import mul

Terms = dict[tuple[str, ...], int]  # names of the factors, in order -> coefficient of the product


class SymbolicSum:
    """Symbolic expression: a sum of products of named variables with integer coefficients.

    Zero has no terms. Immutable.
    """

    __slots__ = ("terms",)

    def __init__(self, terms: Terms) -> None:
        self.terms = {factors: n for factors, n in terms.items() if n}

    def __add__(self, other: "SymbolicSum") -> "SymbolicSum":
        terms = dict(self.terms)
        for factors, n in other.terms.items():
            terms[factors] = terms.get(factors, 0) + n
        return SymbolicSum(terms)

    def __neg__(self) -> "SymbolicSum":
        return SymbolicSum({factors: -n for factors, n in self.terms.items()})

    def __sub__(self, other: "SymbolicSum") -> "SymbolicSum":
        return self + -other

    def __mul__(self, other: "SymbolicSum") -> "SymbolicSum":
        terms: Terms = {}
        for a, m in self.terms.items():
            for b, n in other.terms.items():
                terms[a + b] = terms.get(a + b, 0) + m * n
        return SymbolicSum(terms)

    def __bool__(self) -> bool:
        return bool(self.terms)

    def __str__(self) -> str:
        """Python source of the sum."""
        if not self.terms:
            return "0.0"
        text = ""
        for factors, n in self.terms.items():
            sign = " - " if n < 0 else " + "
            if abs(n) != 1 or not factors:
                factors = (f"{abs(n)}.0", *factors)
            text += sign + " * ".join(factors)
        if text.startswith(" - "):
            return "-" + text.removeprefix(" - ")
        return text.removeprefix(" + ")


ZERO = SymbolicSum({})
ONE = SymbolicSum({(): 1})


def symbol(text: str) -> SymbolicSum:
    """Return a symbolic expression that consists of one named variable.

    Args:
        text: Name of the variable.
    """
    return SymbolicSum({(text,): 1})


def sum_expressions(parts: Iterable[SymbolicSum]) -> SymbolicSum:
    """Return the sum of symbolic expressions.

    Args:
        parts: The expressions.
    """
    found = ZERO
    for part in parts:
        found = found + part
    return found


def dot_product(a: Iterable[SymbolicSum], b: Iterable[SymbolicSum]) -> SymbolicSum:
    """Return the scalar product of two vectors of symbolic expressions."""
    return sum_expressions(map(mul, a, b))


class CodeLines:
    """Source lines of a generated function, with variables for intermediate results."""

    def __init__(self) -> None:
        self.text: list[str] = []

    def append_line(self, line: str) -> None:
        """Append a line to the source of a generated function.

        Args:
            line: Python source.
        """
        self.text.append(line)

    def generate_assignment(self, called: str, value: SymbolicSum) -> SymbolicSum:
        """Generate an assignment of a symbolic expression to a variable; return the variable.

        Zero, one or a single variable needs no assignment and is returned unchanged.

        Args:
            called: Name of the variable.
            value: The symbolic expression.
        """
        if not value or (len(value.terms) == 1 and max(map(len, value.terms)) <= 1):
            return value
        self.append_line(f"{called} = {value}")
        return symbol(called)

    def generate_assignments(self, prefix: str, values: Iterable[SymbolicSum]) -> list[SymbolicSum]:
        """Generate assignments of symbolic expressions to numbered variables; return the variables.

        Args:
            prefix: Name of the variables without the number.
            values: The symbolic expressions.
        """
        return [self.generate_assignment(f"{prefix}{i}", value) for i, value in enumerate(values)]
