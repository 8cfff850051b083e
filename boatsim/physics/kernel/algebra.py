"""Sums of products of named numbers: enough algebra to write equations of motion out and leave out what is zero."""

from collections.abc import Iterable

Terms = dict[tuple[str, ...], int]  # names of the factors, in order -> how often the product occurs


class Sum:
    """A sum of products with whole coefficients; zero has no terms. Immutable."""

    __slots__ = ("terms",)

    def __init__(self, terms: Terms) -> None:
        self.terms = {factors: n for factors, n in terms.items() if n}

    def __add__(self, other: "Sum") -> "Sum":
        terms = dict(self.terms)
        for factors, n in other.terms.items():
            terms[factors] = terms.get(factors, 0) + n
        return Sum(terms)

    def __neg__(self) -> "Sum":
        return Sum({factors: -n for factors, n in self.terms.items()})

    def __sub__(self, other: "Sum") -> "Sum":
        return self + -other

    def __mul__(self, other: "Sum") -> "Sum":
        terms: Terms = {}
        for a, m in self.terms.items():
            for b, n in other.terms.items():
                terms[a + b] = terms.get(a + b, 0) + m * n
        return Sum(terms)

    def __bool__(self) -> bool:
        return bool(self.terms)

    def __str__(self) -> str:
        """As Python."""
        if not self.terms:
            return "0.0"
        text = ""
        for factors, n in self.terms.items():
            one = " * ".join((*([f"{abs(n)}.0"] if abs(n) != 1 or not factors else []), *factors))
            text += (" - " if n < 0 else " + ") + one
        return (
            text.removeprefix(" + ") if text.startswith(" + ") else "-" + text.removeprefix(" - ")
        )


ZERO = Sum({})
ONE = Sum({(): 1})


def name(text: str) -> Sum:
    """A number by its name."""
    return Sum({(text,): 1})


def total(parts: Iterable[Sum]) -> Sum:
    """Sum of many."""
    found = ZERO
    for part in parts:
        found = found + part
    return found


class Lines:
    """Lines of a function body; what deserves a name gets one."""

    def __init__(self) -> None:
        self.text: list[str] = []

    def say(self, line: str) -> None:
        """A line as it is."""
        self.text.append(line)

    def let(self, called: str, value: Sum) -> Sum:
        """`called = value`, unless it is zero, one or a plain name already."""
        if not value or (len(value.terms) == 1 and max(map(len, value.terms)) <= 1):
            return value
        self.say(f"{called} = {value}")
        return name(called)
