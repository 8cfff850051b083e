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
    convert_to_bool,
    convert_to_double,
    number_value,
)


class _KindChanged(Exception):
    """Raised where a variable turns out to be a float after it was translated as an integer."""


class Translation(Declarations):
    """Translates functions when they are asked for; called functions come first in the text."""

    def __init__(self, wrap_indices: bool = False) -> None:
        """Begin without functions.

        Args:
            wrap_indices: Whether a negative index of an array that is no constant counts from the
                end, as in Python. The programs of vessels have no such indices and are faster
                without.
        """
        super().__init__(wrap_indices)
        self._functions: dict[tuple[Any, tuple[Kind, ...]], tuple[str, Kind]] = {}

    def translate_function(self, function: Any, kinds: Sequence[Kind]) -> tuple[str, Kind]:
        """Translate a Python function to C; return its C name and the kind of its result.

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
                    text = body.function_source(name, _inlined(function))
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

    def function_source(self, name: str, inline: bool) -> str:
        """Return the C source of the translated function.

        Args:
            name: Its name.
            inline: Whether every call of it is inlined.
        """
        self.translate_block(self.tree.body)
        taken = ", ".join(f"{v.kind.c} {v.text}" for v in self.arguments)
        parameters = {v.text for v in self.arguments}
        own = [f"    {k.c} {v};" for v, k in self.declared.items() if v not in parameters]
        own += [f"    {line}" for line in self.arrays]
        result = (self.returned or NOTHING).c
        head = f"{'INLINE' if inline else 'static'} {result} {name}({taken or 'void'})"
        return "\n".join([head, "{", *own, *self.lines, "}", ""])

    def translate_block(self, statements: Sequence[ast.stmt]) -> bool:
        """Translate Python statements to C; return whether they end with a return."""
        for statement in statements:
            write = getattr(self, f"statement_{type(statement).__name__}", None)
            if write is None:
                raise self.unsupported_error(
                    statement, f"'{ast.unparse(statement).splitlines()[0]}'"
                )
            if write(statement):
                return True
        return False

    def translate_indented(self, statements: Sequence[ast.stmt]) -> bool:
        """Translate the statements of an indented Python block to C."""
        self.depth += 1
        ends = self.translate_block(statements)
        self.depth -= 1
        return ends

    def statement_Pass(self, node: ast.Pass) -> None:
        """Translate the Python statement `pass` to C: nothing is written."""

    def statement_Break(self, node: ast.Break) -> bool:
        """Translate the Python statement `break` to C."""
        self.add_line("break;")
        return True

    def statement_Continue(self, node: ast.Continue) -> bool:
        """Translate the Python statement `continue` to C."""
        self.add_line("continue;")
        return True

    def statement_Expr(self, node: ast.Expr) -> None:
        """Translate a statement that only calls a function to C; omit docstrings."""
        if not isinstance(node.value, ast.Constant):
            self.add_line(f"{self.translate_expression(node.value).text};")

    def statement_Return(self, node: ast.Return) -> bool:
        """Translate a Python `return` to C; a float if any return of the function is one."""
        if node.value is None or (
            isinstance(node.value, ast.Constant) and node.value.value is None
        ):
            self.add_line("return;")
            return True
        value = self.translate_expression(node.value)
        declared = str(self.python.__annotations__.get("return", ""))
        if "return" in self.floats or declared in ("float", "<class 'float'>"):
            value = convert_to_double(value) if isinstance(value.kind, Scalar) else value
        if isinstance(value.kind, Struct) and "return" in self.floats:
            value = self.convert_to_floats(value)
        if self.returned not in (None, value.kind):
            if "return" in self.floats:
                raise self.unsupported_error(
                    node, "a function that returns values of different kinds"
                )
            self.floats.add("return")
            raise _KindChanged
        self.returned = value.kind
        self.add_line(f"return {value.text};")
        return True

    def convert_to_floats(self, value: Value) -> Value:
        """Convert the numbers of a translated tuple to floats in C."""
        assert isinstance(value.kind, Struct)
        if all(k == REAL for k in value.kind.kinds):
            return value
        own = self.declare_variable(value.kind)
        self.add_line(f"{own} = {value.text};")
        parts = []
        for f, k in zip(value.kind.fields, value.kind.kinds, strict=True):
            part = Value(k, f"{own}.{f}")
            parts.append(convert_to_double(part) if k in (WHOLE, TRUTH) else part)
        return self.make_tuple(parts)

    def statement_Assign(self, node: ast.Assign) -> None:
        """Translate a Python assignment to names, array entries or tuples of these to C."""
        targets = node.targets
        if (
            len(targets) == 1
            and isinstance(targets[0], ast.Tuple)
            and isinstance(node.value, ast.Tuple)
            and len(targets[0].elts) == len(node.value.elts)
        ):
            self.translate_parallel_assignment(targets[0].elts, node.value.elts)
            return
        value = self.translate_expression(node.value)
        if len(targets) > 1 and value.fixed is None:
            value = self.copy_to_variable(value)
        for target in targets:
            self.translate_assignment(target, value)

    def translate_parallel_assignment(
        self, targets: Sequence[ast.expr], values: Sequence[ast.expr]
    ) -> None:
        """Translate `a, b = c, d` to C; all values are read before any is written."""
        found = [self.translate_expression(v) for v in values]
        set_ = {n.id for t in targets for n in ast.walk(t) if isinstance(n, ast.Name)}
        read = {n.id for v in values[1:] for n in ast.walk(v) if isinstance(n, ast.Name)}
        stores = any(isinstance(t, ast.Subscript | ast.Attribute) for t in targets)
        if set_ & read or stores:
            found = [v if v.fixed is not None else self.copy_to_variable(v) for v in found]
        for target, value in zip(targets, found, strict=True):
            self.translate_assignment(target, value)

    def statement_AnnAssign(self, node: ast.AnnAssign) -> None:
        """Translate an assignment to an annotated Python name to C."""
        if node.value is not None:
            self.translate_assignment(node.target, self.translate_expression(node.value))

    def statement_AugAssign(self, node: ast.AugAssign) -> None:
        """Translate `+=` and similar statements to plain assignments in C."""
        before = ast.parse(ast.unparse(node.target), mode="eval").body
        new = ast.copy_location(ast.BinOp(before, node.op, node.value), node)
        self.translate_assignment(node.target, self.translate_expression(new))

    def translate_assignment(self, target: ast.expr, value: Value) -> None:
        """Write the C source that assigns a translated value to a Python assignment target."""
        if isinstance(target, ast.Tuple):
            if not isinstance(value.kind, Struct) or len(value.kind.kinds) != len(target.elts):
                raise self.unsupported_error(target, f"'{ast.unparse(target)} = ...'")
            whole = value if value.text.isidentifier() else self.copy_to_variable(value)
            for i, part in enumerate(target.elts):
                self.translate_assignment(part, self.tuple_field(whole, i))
        elif isinstance(target, ast.Subscript):
            self.assign_array_entry(target, value)
        elif isinstance(target, ast.Attribute):
            self.assign_record_field(target, value)
        elif isinstance(target, ast.Name):
            self.assign_variable(target, value)
        else:
            raise self.unsupported_error(target, f"'{ast.unparse(target)} = ...'")

    def assign_array_entry(self, target: ast.Subscript, value: Value) -> None:
        """Write the C source that assigns to an entry or a slice of an array."""
        place = self.translate_expression(target)
        if place.kind == VECTOR:
            if isinstance(value.kind, ArrayKind):
                self.add_line(f"copy1({place.text}, {value.text});")
            else:
                self.add_line(f"fill1({place.text}, {convert_to_double(value).text});")
        elif place.kind in (REAL, WHOLE):
            text = convert_to_double(value).text if place.kind == REAL else value.text
            self.add_line(f"{place.text} = {text};")
        else:
            raise self.unsupported_error(target, f"'{ast.unparse(target)} = ...'")

    def assign_record_field(self, target: ast.Attribute, value: Value) -> None:
        """Write the C source that assigns to a number of a record."""
        place = self.translate_expression(target)
        if place.kind != REAL or not isinstance(value.kind, Scalar):
            raise self.unsupported_error(target, f"'{ast.unparse(target)} = ...'")
        self.add_line(f"{place.text} = {convert_to_double(value).text};")

    def assign_variable(self, target: ast.Name, value: Value) -> None:
        """Write the C source that assigns to a variable, a float if any assignment is one."""
        name, known = target.id, self.variables.get(target.id)
        numeric = value.kind in (WHOLE, TRUTH)
        if name in self.floats and numeric:
            value = convert_to_double(value)
        elif known is not None and {known.kind, value.kind} & {REAL} and known.kind != value.kind:
            if numeric:
                value = convert_to_double(value)
            elif known.kind in (WHOLE, TRUTH):
                self.floats.add(name)
                raise _KindChanged
        own = f"v_{name}"
        n = 1
        while self.declared.get(own, value.kind) != value.kind:
            own, n = f"v_{name}_{n}", n + 1
        self.declared[own] = value.kind
        self.variables[name] = Value(value.kind, own)
        self.add_line(f"{own} = {value.text};")

    def statement_If(self, node: ast.If) -> bool:
        """Translate a Python `if` to C; only one branch if its test is constant."""
        test = convert_to_bool(self.translate_expression(node.test))
        if isinstance(test.fixed, bool):
            return self.translate_block(node.body if test.fixed else node.orelse)
        before = dict(self.variables)
        self.add_line(f"if ({test.text}) {{")
        ended = self.translate_indented(node.body)
        first = self.variables
        self.variables = dict(before)
        self.add_line("} else {")
        ended_too = self.translate_indented(node.orelse)
        self.add_line("}")
        if ended:
            return ended_too
        second, self.variables = self.variables, dict(first)
        if not ended_too:
            for name, other in second.items():
                mine = first.setdefault(name, other)
                if mine.text != other.text:
                    raise self.unsupported_error(
                        node, f"'{name}', which has values of different kinds,"
                    )
            self.variables = dict(first)
        return False

    def statement_For(self, node: ast.For) -> None:
        """Translate a Python `for` over a range or an array of integers to C."""
        if not isinstance(node.target, ast.Name) or node.orelse:
            raise self.unsupported_error(node, "this loop")
        counter, end = self.declare_variable(WHOLE), self.declare_variable(WHOLE)
        call = node.iter
        if isinstance(call, ast.Call) and self.resolve_object(call.func) is range:
            given = [self.translate_integer(a) for a in call.args]
            start, stop, step = number_value(0), given[0], number_value(1)
            if len(given) > 1:
                start, stop = given[:2]
            if len(given) > 2:
                step = given[2]
            if not isinstance(step.fixed, int):
                raise self.unsupported_error(node, "a loop with a variable step")
            less = "<" if step.fixed > 0 else ">"
            head = f"{counter} = {start.text}, {end} = {stop.text}; {counter} {less} {end}"
            self.add_line(f"for ({head}; {counter} += {step.text}) {{")
            item = Value(WHOLE, counter)
        else:
            of = self.translate_expression(call)
            if of.kind != ROWS:
                raise self.unsupported_error(node, "a loop over anything but a range or integers")
            of = self.copy_to_variable(of)
            self.add_line(
                f"for ({counter} = 0, {end} = {of.text}.n0; {counter} < {end}; {counter}++) {{"
            )
            item = Value(WHOLE, f"{of.text}.d[{counter}]")
        before = dict(self.variables)
        self.depth += 1
        self.assign_variable(node.target, item)
        self.depth -= 1
        self.loops += 1
        self.translate_indented(node.body)
        self.loops -= 1
        self.add_line("}")
        self.check_kinds_in_loop(node, before)

    def statement_While(self, node: ast.While) -> None:
        """Translate a Python `while` loop to C."""
        before, lines = dict(self.variables), len(self.lines)
        test = convert_to_bool(self.translate_expression(node.test))
        if len(self.lines) != lines:
            raise self.unsupported_error(node, f"'while {ast.unparse(node.test)}'")
        self.add_line(f"while ({test.text}) {{")
        self.loops += 1
        self.translate_indented(node.body)
        self.loops -= 1
        self.add_line("}")
        self.check_kinds_in_loop(node, before)

    def check_kinds_in_loop(self, node: ast.stmt, before: dict[str, Value]) -> None:
        """Check that no variable changes its C type within a loop."""
        for name, old in before.items():
            if self.variables[name].text != old.text:
                raise self.unsupported_error(
                    node, f"'{name}', which has values of different kinds,"
                )
