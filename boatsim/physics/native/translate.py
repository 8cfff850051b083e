"""Translates the functions of a vessel's program to C.

Laws and kernel are small Python functions of numbers, tuples and contiguous arrays, which numba
compiles. C has the same operations. A function is translated for the kinds of its arguments when a
call of it is found. What cannot be translated raises `NotTranslatable` with file and line, and the
caller uses numba instead.
"""

import ast
from collections.abc import Sequence
from typing import Any

from boatsim.physics.debugging import python_function
from boatsim.physics.native.declarations import Declarations
from boatsim.physics.native.expressions import ExpressionTranslator
from boatsim.physics.native.kinds import (
    NOTHING,
    REAL,
    ROWS,
    TRUTH,
    VECTOR,
    WHOLE,
    ArrayKind,
    Kind,
    Scalar,
    Struct,
    Value,
    as_real,
    as_truth,
    constant,
)


class _KindChanged(Exception):
    """Raised where a variable turns out to be a float after it was translated as an integer."""


class Translation(Declarations):
    """Translates functions when they are asked for; called functions come first in the text."""

    def __init__(self) -> None:
        """Begin without functions."""
        super().__init__()
        self._functions: dict[tuple[Any, tuple[Kind, ...]], tuple[str, Kind]] = {}

    def function(self, function: Any, kinds: Sequence[Kind]) -> tuple[str, Kind]:
        """Translate a function for arguments of given kinds; return its name and result's kind.

        Args:
            function: A Python or compiled function.
            kinds: Kinds of its arguments.
        """
        python = python_function(function)
        key = (python, tuple(kinds))
        if key not in self._functions:
            name = self.unused_name(f"fn_{python.__name__}")  # none of the C library's
            floats: set[str] = set()
            while True:
                body = FunctionTranslator(self, python, kinds, floats)
                try:
                    text = body.text(name, _inlined(function))
                    break
                except _KindChanged:
                    floats = body.floats
            self.functions.append(text)
            self._functions[key] = name, body.returned or NOTHING
        return self._functions[key]


def _inlined(function: Any) -> bool:
    """Whether numba, too, inlines every call of a function."""
    options = getattr(function, "targetoptions", {})
    return options.get("inline") == "always" or bool(options.get("forceinline"))


class FunctionTranslator(ExpressionTranslator):
    """Translates the body of one function, statement by statement."""

    def text(self, name: str, inline: bool) -> str:
        """Return the C function.

        Args:
            name: Its name.
            inline: Whether every call of it is inlined.
        """
        self.block(self.tree.body)
        taken = ", ".join(f"{v.kind.c} {v.text}" for v in self.arguments)
        parameters = {v.text for v in self.arguments}
        own = [f"    {k.c} {v};" for v, k in self.declared.items() if v not in parameters]
        own += [f"    {line}" for line in self.arrays]
        result = (self.returned or NOTHING).c
        head = f"{'INLINE' if inline else 'static'} {result} {name}({taken or 'void'})"
        return "\n".join([head, "{", *own, *self.lines, "}", ""])

    def block(self, statements: Sequence[ast.stmt]) -> bool:
        """Translate statements; return whether they end with a return."""
        for statement in statements:
            write = getattr(self, f"statement_{type(statement).__name__}", None)
            if write is None:
                raise self.refusal(statement, f"'{ast.unparse(statement).splitlines()[0]}'")
            if write(statement):
                return True
        return False

    def indented(self, statements: Sequence[ast.stmt]) -> bool:
        """Translate an indented block."""
        self.depth += 1
        ends = self.block(statements)
        self.depth -= 1
        return ends

    def statement_Pass(self, node: ast.Pass) -> None:
        """Write nothing."""

    def statement_Break(self, node: ast.Break) -> bool:
        """Leave a loop."""
        self.add("break;")
        return True

    def statement_Continue(self, node: ast.Continue) -> bool:
        """Go on with a loop."""
        self.add("continue;")
        return True

    def statement_Expr(self, node: ast.Expr) -> None:
        """Call a function; docstrings are left out."""
        if not isinstance(node.value, ast.Constant):
            self.add(f"{self.expression(node.value).text};")

    def statement_Return(self, node: ast.Return) -> bool:
        """Return a value: floats where any return of the function is a float."""
        if node.value is None or (
            isinstance(node.value, ast.Constant) and node.value.value is None
        ):
            self.add("return;")
            return True
        value = self.expression(node.value)
        declared = str(self.python.__annotations__.get("return", ""))
        if "return" in self.floats or declared in ("float", "<class 'float'>"):
            value = as_real(value) if isinstance(value.kind, Scalar) else value
        if isinstance(value.kind, Struct) and "return" in self.floats:
            value = self.struct_of_floats(value)
        if self.returned not in (None, value.kind):
            if "return" in self.floats:
                raise self.refusal(node, "a function that returns values of different kinds")
            self.floats.add("return")
            raise _KindChanged
        self.returned = value.kind
        self.add(f"return {value.text};")
        return True

    def struct_of_floats(self, value: Value) -> Value:
        """Convert the numbers of a tuple to floats."""
        assert isinstance(value.kind, Struct)
        if all(k == REAL for k in value.kind.kinds):
            return value
        own = self.temporary(value.kind)
        self.add(f"{own} = {value.text};")
        parts = []
        for f, k in zip(value.kind.fields, value.kind.kinds, strict=True):
            part = Value(k, f"{own}.{f}")
            parts.append(as_real(part) if k in (WHOLE, TRUTH) else part)
        return self.tuple_of(parts)

    def statement_Assign(self, node: ast.Assign) -> None:
        """Assign to names, entries of arrays, or tuples of these."""
        targets = node.targets
        if (
            len(targets) == 1
            and isinstance(targets[0], ast.Tuple)
            and isinstance(node.value, ast.Tuple)
            and len(targets[0].elts) == len(node.value.elts)
        ):
            self.parallel_assignment(targets[0].elts, node.value.elts)
            return
        value = self.expression(node.value)
        if len(targets) > 1 and value.fixed is None:
            value = self.kept(value)
        for target in targets:
            self.assign(target, value)

    def parallel_assignment(self, targets: Sequence[ast.expr], values: Sequence[ast.expr]) -> None:
        """Assign entries one by one; all of them are read before any is written."""
        found = [self.expression(v) for v in values]
        set_ = {n.id for t in targets for n in ast.walk(t) if isinstance(n, ast.Name)}
        read = {n.id for v in values[1:] for n in ast.walk(v) if isinstance(n, ast.Name)}
        stores = any(isinstance(t, ast.Subscript) for t in targets)
        if set_ & read or stores:
            found = [v if v.fixed is not None else self.kept(v) for v in found]
        for target, value in zip(targets, found, strict=True):
            self.assign(target, value)

    def statement_AnnAssign(self, node: ast.AnnAssign) -> None:
        """Assign to an annotated name."""
        if node.value is not None:
            self.assign(node.target, self.expression(node.value))

    def statement_AugAssign(self, node: ast.AugAssign) -> None:
        """Translate `+=` and similar statements to assignments."""
        before = ast.parse(ast.unparse(node.target), mode="eval").body
        new = ast.copy_location(ast.BinOp(before, node.op, node.value), node)
        self.assign(node.target, self.expression(new))

    def assign(self, target: ast.expr, value: Value) -> None:
        """Assign a value to a name, an entry of an array, or a tuple of these."""
        if isinstance(target, ast.Tuple):
            if not isinstance(value.kind, Struct) or len(value.kind.kinds) != len(target.elts):
                raise self.refusal(target, f"'{ast.unparse(target)} = ...'")
            whole = value if value.text.isidentifier() else self.kept(value)
            for i, part in enumerate(target.elts):
                self.assign(part, self.entry(whole, i))
        elif isinstance(target, ast.Subscript):
            self.store(target, value)
        elif isinstance(target, ast.Name):
            self.set_variable(target, value)
        else:
            raise self.refusal(target, f"'{ast.unparse(target)} = ...'")

    def store(self, target: ast.Subscript, value: Value) -> None:
        """Assign to an entry or a part of an array."""
        place = self.expression(target)
        if place.kind == VECTOR:
            if isinstance(value.kind, ArrayKind):
                self.add(f"copy1({place.text}, {value.text});")
            else:
                self.add(f"fill1({place.text}, {as_real(value).text});")
        elif place.kind in (REAL, WHOLE):
            text = as_real(value).text if place.kind == REAL else value.text
            self.add(f"{place.text} = {text};")
        else:
            raise self.refusal(target, f"'{ast.unparse(target)} = ...'")

    def set_variable(self, target: ast.Name, value: Value) -> None:
        """Assign to a variable, which is a float if any assignment is one."""
        name, known = target.id, self.variables.get(target.id)
        numeric = value.kind in (WHOLE, TRUTH)
        if name in self.floats and numeric:
            value = as_real(value)
        elif known is not None and {known.kind, value.kind} & {REAL} and known.kind != value.kind:
            if numeric:
                value = as_real(value)
            elif known.kind in (WHOLE, TRUTH):
                self.floats.add(name)
                raise _KindChanged
        own = f"v_{name}"
        n = 1
        while self.declared.get(own, value.kind) != value.kind:
            own, n = f"v_{name}_{n}", n + 1
        self.declared[own] = value.kind
        self.variables[name] = Value(value.kind, own)
        self.add(f"{own} = {value.text};")

    def statement_If(self, node: ast.If) -> bool:
        """Write one branch if the test is constant, else both."""
        test = as_truth(self.expression(node.test))
        if isinstance(test.fixed, bool):
            return self.block(node.body if test.fixed else node.orelse)
        before = dict(self.variables)
        self.add(f"if ({test.text}) {{")
        ended = self.indented(node.body)
        first = self.variables
        self.variables = dict(before)
        self.add("} else {")
        ended_too = self.indented(node.orelse)
        self.add("}")
        if ended:
            return ended_too
        second, self.variables = self.variables, dict(first)
        if not ended_too:
            for name, other in second.items():
                mine = first.setdefault(name, other)
                if mine.text != other.text:
                    raise self.refusal(node, f"'{name}', which has values of different kinds,")
            self.variables = dict(first)
        return False

    def statement_For(self, node: ast.For) -> None:
        """Loop over a range, or over the entries of an array of integers."""
        if not isinstance(node.target, ast.Name) or node.orelse:
            raise self.refusal(node, "this loop")
        counter, end = self.temporary(WHOLE), self.temporary(WHOLE)
        call = node.iter
        if isinstance(call, ast.Call) and self.resolve(call.func) is range:
            given = [self.whole(a) for a in call.args]
            start, stop, step = constant(0), given[0], constant(1)
            if len(given) > 1:
                start, stop = given[:2]
            if len(given) > 2:
                step = given[2]
            if not isinstance(step.fixed, int):
                raise self.refusal(node, "a loop with a variable step")
            less = "<" if step.fixed > 0 else ">"
            head = f"{counter} = {start.text}, {end} = {stop.text}; {counter} {less} {end}"
            self.add(f"for ({head}; {counter} += {step.text}) {{")
            item = Value(WHOLE, counter)
        else:
            of = self.expression(call)
            if of.kind != ROWS:
                raise self.refusal(node, "a loop over anything but a range or integers")
            of = self.kept(of)
            self.add(
                f"for ({counter} = 0, {end} = {of.text}.n0; {counter} < {end}; {counter}++) {{"
            )
            item = Value(WHOLE, f"{of.text}.d[{counter}]")
        before = dict(self.variables)
        self.depth += 1
        self.set_variable(node.target, item)
        self.depth -= 1
        self.loops += 1
        self.indented(node.body)
        self.loops -= 1
        self.add("}")
        self.check_loop(node, before)

    def statement_While(self, node: ast.While) -> None:
        """Loop while a condition holds."""
        before, lines = dict(self.variables), len(self.lines)
        test = as_truth(self.expression(node.test))
        if len(self.lines) != lines:
            raise self.refusal(node, f"'while {ast.unparse(node.test)}'")
        self.add(f"while ({test.text}) {{")
        self.loops += 1
        self.indented(node.body)
        self.loops -= 1
        self.add("}")
        self.check_loop(node, before)

    def check_loop(self, node: ast.stmt, before: dict[str, Value]) -> None:
        """Refuse a variable that changes its kind within a loop."""
        for name, old in before.items():
            if self.variables[name].text != old.text:
                raise self.refusal(node, f"'{name}', which has values of different kinds,")
