"""Translates Python expressions to C."""

import ast
import builtins
import inspect
import math
import operator
import textwrap
from collections.abc import Callable, Hashable, Mapping, Sequence
from typing import Any

import numpy as np

from boatsim.physics.debugging import python_function
from boatsim.physics.native.declarations import NUMBERS, Declarations, NotTranslatable
from boatsim.physics.native.functions import CASTS, MATH, OPERATORS, WHOLE_RESULT
from boatsim.physics.native.kinds import (
    BITS,
    REAL,
    TRUTH,
    WHOLE,
    ArrayKind,
    Kind,
    Record,
    RecordArray,
    Scalar,
    Struct,
    Value,
    convert_to_bool,
    convert_to_double,
    number_value,
)

COMPARISONS: Mapping[type[ast.cmpop], Callable[[Any, Any], Any]] = {
    ast.Lt: operator.lt,
    ast.LtE: operator.le,
    ast.Gt: operator.gt,
    ast.GtE: operator.ge,
    ast.Eq: operator.eq,
    ast.NotEq: operator.ne,
}
FOLDED: Mapping[type[ast.operator], Callable[[Any, Any], Any]] = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
}
ALLOCATIONS: tuple[Any, ...] = (np.zeros, np.empty)
PREDICATES: Mapping[Any, str] = {
    getattr(source, name): name for source in (math, np) for name in ("isnan", "isfinite", "isinf")
}
ROW_FUNCTIONS = {(2, 1): "row_of2", (3, 1): "row_of3", (3, 2): "line_of3"}


class ExpressionTranslator:
    """Translates the expressions of one function, whose variables have known kinds."""

    def __init__(
        self,
        program: Declarations,
        function: Callable[..., Any],
        kinds: Sequence[Kind],
        floats: set[str],
    ) -> None:
        self.program, self.python, self.floats = program, function, set(floats)
        self.file, self.first = inspect.getsourcefile(function), function.__code__.co_firstlineno
        tree = ast.parse(textwrap.dedent(inspect.getsource(function))).body[0]
        assert isinstance(tree, ast.FunctionDef)
        self.tree = tree
        self.lines: list[str] = []
        self.depth, self.loops = 1, 0
        self.declared: dict[str, Kind] = {}
        self.arrays: list[str] = []
        self.temporaries = 0
        self.returned: Kind | None = None
        self.variables: dict[str, Value] = {}
        self.counters = self._counters()
        self.arguments: list[Value] = []
        for arg, kind in zip(tree.args.args, kinds, strict=True):
            if arg.arg in self.floats and kind in (WHOLE, TRUTH):
                kind = REAL
            own = Value(kind, f"v_{arg.arg}")
            self.arguments.append(own)
            self.variables[arg.arg] = own
            self.declared[own.text] = kind

    def _counters(self) -> set[str]:
        """Return the names that only loops over numbers from zero on, or over boats, assign."""
        arguments = {argument.arg for argument in self.tree.args.args}
        counters: set[str] = set()
        targets: set[ast.expr] = set()
        for loop in ast.walk(self.tree):
            if not isinstance(loop, ast.For) or not isinstance(loop.target, ast.Name):
                continue
            over_boats = isinstance(loop.iter, ast.Name) and loop.iter.id in arguments
            if over_boats or self._counts_from_zero(loop.iter):
                counters.add(loop.target.id)
                targets.add(loop.target)
        for node in ast.walk(self.tree):
            if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store):
                if node not in targets:  # assigned by another statement, too
                    counters.discard(node.id)
        return counters - arguments

    def _counts_from_zero(self, node: ast.expr) -> bool:
        """Whether an expression is a range of numbers that are surely not negative."""
        if not isinstance(node, ast.Call) or self.resolve_object(node.func) is not range:
            return False
        rest = [node.args[0], *node.args[2:]] if len(node.args) > 1 else []
        for number in rest:
            if not isinstance(number, ast.Constant) or not isinstance(number.value, int):
                return False
            if number.value < 0:
                return False
        return True

    def add_line(self, line: str) -> None:
        """Append a line to the C source, at the present indentation."""
        self.lines.append("    " * self.depth + line)

    def unsupported_error(self, node: ast.AST, what: str) -> NotTranslatable:
        """Return the exception for a node of the syntax tree that has no C form."""
        line = self.first + getattr(node, "lineno", 1) - 1
        return NotTranslatable(f"{self.file}:{line}: {what} has no C form")

    def declare_variable(self, kind: Kind) -> str:
        """Declare a new C variable of a kind; return its name."""
        self.temporaries += 1
        name = f"t_{self.temporaries}"
        self.declared[name] = kind
        return name

    def copy_to_variable(self, value: Value) -> Value:
        """Write C source that copies a value to a new variable; return the variable."""
        own = self.declare_variable(value.kind)
        self.add_line(f"{own} = {value.text};")
        return Value(value.kind, own)

    # Names, numbers and tuples
    # ------------------------------------------------------------------------------------------

    def translate_expression(self, node: ast.expr) -> Value:
        """Translate a Python expression to C; lines that must precede it are added first."""
        write = getattr(self, f"of_{type(node).__name__}", None)
        if write is None:
            raise self.unsupported_error(node, f"'{ast.unparse(node)}'")
        found: Value = write(node)
        return found

    def translate_integer(self, node: ast.expr) -> Value:
        """Translate a Python expression that must be an integer to C."""
        value = self.translate_expression(node)
        if value.kind == TRUTH:
            return Value(WHOLE, f"((int64_t){value.text})")
        if value.kind != WHOLE:
            raise self.unsupported_error(node, f"'{ast.unparse(node)}' as an integer")
        return value

    def of_Constant(self, node: ast.Constant) -> Value:
        """Translate a number in a Python expression to C."""
        if not isinstance(node.value, NUMBERS):
            raise self.unsupported_error(node, f"'{ast.unparse(node)}'")
        return number_value(node.value)

    def of_Name(self, node: ast.Name) -> Value:
        """Translate a name in a Python expression, a variable or module constant, to C."""
        if node.id in self.variables:
            return self.variables[node.id]
        return self.translate_module_constant(node)

    def translate_module_constant(self, node: ast.expr) -> Value:
        """Translate a constant of the function's module, or of one that it imports, to C."""
        try:
            return self.program.constant_value(self.resolve_object(node))
        except TypeError:
            raise self.unsupported_error(node, f"'{ast.unparse(node)}'") from None

    def resolve_object(self, node: ast.expr) -> Any:
        """Return the Python object to which a name or an attribute of a module refers."""
        if isinstance(node, ast.Attribute):
            return getattr(self.resolve_object(node.value), node.attr, None)
        if not isinstance(node, ast.Name) or node.id in self.variables:
            return None
        free = dict(
            zip(self.python.__code__.co_freevars, self.python.__closure__ or (), strict=True)
        )
        if node.id in free:
            return free[node.id].cell_contents
        return self.python.__globals__.get(node.id, getattr(builtins, node.id, None))

    def of_Attribute(self, node: ast.Attribute) -> Value:
        """Translate an attribute, a field, an array's size or a module constant, to C."""
        if isinstance(node.value, ast.Name) and node.value.id not in self.variables:
            return self.translate_module_constant(node)
        owner = self.translate_expression(node.value)
        if isinstance(owner.kind, Struct) and f"f_{node.attr}" in owner.kind.fields:
            field = f"f_{node.attr}"
            return Value(owner.kind.field_kind(field), f"{owner.text}.{field}")
        if isinstance(owner.kind, ArrayKind) and node.attr == "size" and owner.kind.dimensions == 1:
            return Value(WHOLE, f"{owner.text}.n0")
        if isinstance(owner.kind, Record) and node.attr in owner.kind.names:
            return self.record_field(owner.text, owner.kind, node.attr)
        raise self.unsupported_error(node, f"'{ast.unparse(node)}'")

    def record_field(self, owner: str, kind: Record, name: str) -> Value:
        """Return the C expression of a field of a record."""
        i = kind.names.index(name)
        field, place = kind.kinds[i], kind.places[i]
        if field == REAL:
            return Value(REAL, f"{owner}[{place}]")
        if isinstance(field, ArrayKind):
            sizes = ", ".join(map(str, kind.sizes[i]))
            return Value(field, f"(({field.c}){{{owner} + {place}, {sizes}}})")
        return Value(field, f"({owner} + {place})")

    def tuple_field(self, owner: Value, i: int) -> Value:
        """Return the C expression of one entry of a translated tuple."""
        assert isinstance(owner.kind, Struct)
        if isinstance(owner.fixed, tuple):
            return self.program.constant_value(owner.fixed[i])
        kind, field = owner.kind.kinds[i], owner.kind.fields[i]
        return Value(kind, f"{owner.text}.{field}")

    def of_Subscript(self, node: ast.Subscript) -> Value:
        """Translate a Python subscript, an entry or slice of an array or tuple, to C."""
        if isinstance(node.value, ast.Attribute) and node.value.attr == "shape":
            owner, place = (
                self.translate_expression(node.value.value),
                self.translate_expression(node.slice),
            )
            if not isinstance(owner.kind, ArrayKind) or not isinstance(place.fixed, int):
                raise self.unsupported_error(node, f"'{ast.unparse(node)}'")
            axis = place.fixed % owner.kind.dimensions
            return Value(WHOLE, f"{owner.text}.n{axis}")
        owner = self.translate_expression(node.value)
        if isinstance(owner.kind, Struct):
            return self.translate_tuple_entry(owner, node)
        if isinstance(owner.kind, RecordArray):
            place = self.translate_integer(node.slice)
            if not self.is_counted(node.slice, place):
                # the number of records, from whose end it may count, is unknown
                raise self.unsupported_error(node, f"'{ast.unparse(node)}'")
            record = owner.kind.item
            return Value(record, f"({owner.text} + {place.text} * {record.words})")
        if not isinstance(owner.kind, ArrayKind):
            raise self.unsupported_error(node, f"'{ast.unparse(node)}'")
        places = [node.slice]
        if isinstance(node.slice, ast.Tuple):
            places = node.slice.elts
        if isinstance(places[-1], ast.Slice):
            return self.translate_array_slice(owner, places, node)
        indices = self.translate_indices(owner, places, node)
        return self.translate_array_entry(owner, indices, node)

    def is_counted(self, node: ast.expr, value: Value) -> bool:
        """Return whether an index is surely not negative: a constant or the counter of a loop."""
        if isinstance(value.fixed, int):
            return value.fixed >= 0
        return isinstance(node, ast.Name) and node.id in self.counters

    def translate_indices(
        self, owner: Value, places: Sequence[ast.expr], node: ast.Subscript
    ) -> list[str]:
        """Translate the indices of an array to C; negative ones count from the end."""
        found = []
        for axis, place in enumerate(places):
            value = self.translate_integer(place)
            text = value.text
            if isinstance(value.fixed, int) and value.fixed < 0:
                text = f"({owner.text}.n{axis} - {-value.fixed})"
            elif self.program.wrap_indices and not self.is_counted(place, value):
                if any(isinstance(part, ast.Call) for part in ast.walk(node.value)):
                    # the array would be computed twice
                    raise self.unsupported_error(node, f"'{ast.unparse(node)}'")
                text = f"wrapped({text}, {owner.text}.n{axis})"
            found.append(text)
        return found

    def translate_array_entry(self, owner: Value, indices: Sequence[str], node: ast.expr) -> Value:
        """Return the C expression of an entry, a row or a plane of an array."""
        assert isinstance(owner.kind, ArrayKind)
        inside, size, n = ", ".join([owner.text, *indices]), owner.kind.dimensions, len(indices)
        if n == size:
            more = "" if owner.kind.item == REAL else "_rows"
            return Value(owner.kind.item, f"(*at{size}{more}({inside}))")
        if (size, n) not in ROW_FUNCTIONS:
            raise self.unsupported_error(node, f"'{ast.unparse(node)}'")
        return Value(ArrayKind(REAL, size - n), f"{ROW_FUNCTIONS[size, n]}({inside})")

    def translate_array_slice(
        self, owner: Value, places: Sequence[ast.expr], node: ast.Subscript
    ) -> Value:
        """Return the C expression of consecutive entries of a vector or rows of a matrix."""
        if len(places) > 1:
            indices = self.translate_indices(owner, places[:-1], node)
            owner = self.translate_array_entry(owner, indices, node)
        part, kind = places[-1], owner.kind
        assert isinstance(part, ast.Slice) and isinstance(kind, ArrayKind)
        if part.step is not None or kind.dimensions > 2 or kind.item != REAL:
            raise self.unsupported_error(node, f"'{ast.unparse(node)}'")
        owner = owner if owner.text.isidentifier() else self.copy_to_variable(owner)
        low, high = "0", f"{owner.text}.n0"
        if part.lower:
            low = self.translate_integer(part.lower).text
        if part.upper:
            high = self.translate_integer(part.upper).text
        return Value(kind, f"part_of{kind.dimensions}({owner.text}, {low}, {high})")

    def translate_tuple_entry(self, owner: Value, node: ast.Subscript) -> Value:
        """Return the C expression of a tuple's entry; a variable index needs equal kinds."""
        assert isinstance(owner.kind, Struct)
        place = self.translate_integer(node.slice)
        if not owner.kind.kinds:
            raise self.unsupported_error(
                node, f"'{ast.unparse(node)}', an entry of an empty tuple,"
            )
        if isinstance(place.fixed, int):
            return self.tuple_field(owner, place.fixed % len(owner.kind.kinds))
        kind = owner.kind.common_field_kind
        if kind is None:
            raise self.unsupported_error(node, f"'{ast.unparse(node)}'")
        if self.program.wrap_indices and not self.is_counted(node.slice, place):
            place = Value(WHOLE, f"wrapped({place.text}, {len(owner.kind.kinds)})")
        if owner.text.isidentifier():
            return Value(kind, f"((const {kind.c} *)&{owner.text})[{place.text}]")
        inside = f"{owner.kind.c} whole_ = {owner.text}; ((const {kind.c} *)&whole_)[{place.text}];"
        return Value(kind, f"({{ {inside} }})")

    def of_Tuple(self, node: ast.Tuple) -> Value:
        """Translate a Python tuple to a C struct."""
        return self.make_tuple(self.translate_arguments(node.elts))

    def make_tuple(self, parts: Sequence[Value]) -> Value:
        """Return the C struct value that holds translated values as a tuple."""
        kind = self.program.declare_struct(None, [p.kind for p in parts])
        return Value(kind, f"(({kind.c}){{{', '.join(p.text for p in parts)}}})")

    def of_UnaryOp(self, node: ast.UnaryOp) -> Value:
        """Translate a sign or `not` in a Python expression to C."""
        of = self.translate_expression(node.operand)
        if isinstance(node.op, ast.Not):
            truth = convert_to_bool(of)
            if isinstance(truth.fixed, bool):
                return number_value(not truth.fixed)
            return Value(TRUTH, f"(!{truth.text})")
        if isinstance(node.op, ast.USub) and isinstance(of.fixed, int | float):
            return number_value(-of.fixed)
        if isinstance(node.op, ast.USub | ast.UAdd) and isinstance(of.kind, Scalar):
            return Value(of.kind, f"({OPERATORS[type(node.op)]}{of.text})")
        raise self.unsupported_error(node, f"'{ast.unparse(node)}'")

    def of_BinOp(self, node: ast.BinOp) -> Value:
        """Translate a binary arithmetic operation in Python to C."""
        a, b = self.translate_expression(node.left), self.translate_expression(node.right)
        return self.translate_arithmetic(node, node.op, a, b)

    def translate_arithmetic(self, node: ast.expr, op: ast.operator, a: Value, b: Value) -> Value:
        """Return the C expression of an arithmetic operator applied to two numbers."""
        if not (isinstance(a.kind, Scalar) and isinstance(b.kind, Scalar)):
            raise self.unsupported_error(node, f"'{ast.unparse(node)}'")
        if isinstance(op, ast.Pow):
            return self.translate_power(node, a, b)
        real = REAL in (a.kind, b.kind) or isinstance(op, ast.Div)
        if isinstance(op, ast.Mod | ast.FloorDiv):
            return self.translate_remainder(node, op, a, b, real)
        if type(op) not in OPERATORS:
            raise self.unsupported_error(node, f"'{ast.unparse(node)}'")
        sign = OPERATORS[type(op)]
        if real:
            a, b = convert_to_double(a), convert_to_double(b)
            return fold_constants(op, a, b) or Value(REAL, f"({a.text} {sign} {b.text})")
        if a.kind == b.kind == TRUTH and sign in "&|":
            return Value(TRUTH, f"({a.text} {sign} {b.text})")
        a, b = self.convert_bool_to_integer(a), self.convert_bool_to_integer(b)
        if BITS in (a.kind, b.kind):
            return Value(BITS, f"((uint64_t){a.text} {sign} (uint64_t){b.text})")
        return fold_constants(op, a, b) or Value(WHOLE, f"({a.text} {sign} {b.text})")

    def convert_bool_to_integer(self, value: Value) -> Value:
        """Convert a translated bool to an integer in C; other values are returned unchanged."""
        if value.kind != TRUTH:
            return value
        if isinstance(value.fixed, bool):
            return number_value(int(value.fixed))
        return Value(WHOLE, f"((int64_t){value.text})")

    def translate_remainder(
        self, node: ast.expr, op: ast.operator, a: Value, b: Value, real: bool
    ) -> Value:
        """Return the C expression of `a % b` or `a // b`, rounded down as in Python."""
        if real:
            if isinstance(op, ast.FloorDiv):
                raise self.unsupported_error(node, f"'{ast.unparse(node)}'")
            return Value(
                REAL, f"remainder_real({convert_to_double(a).text}, {convert_to_double(b).text})"
            )
        name = "quotient" if isinstance(op, ast.FloorDiv) else "remainder_whole"
        a, b = self.convert_bool_to_integer(a), self.convert_bool_to_integer(b)
        return Value(WHOLE, f"{name}({a.text}, {b.text})")

    def translate_power(self, node: ast.expr, base: Value, exponent: Value) -> Value:
        """Return the C expression of a power; small integer powers become products."""
        if base.kind == REAL and exponent.fixed in (2, 3, 4) and isinstance(exponent.fixed, int):
            return Value(REAL, f"power{exponent.fixed}({base.text})")
        if base.kind == REAL and exponent.kind == REAL:
            return Value(REAL, f"pow({base.text}, {exponent.text})")
        raise self.unsupported_error(node, f"'{ast.unparse(node)}'")

    def of_Compare(self, node: ast.Compare) -> Value:
        """Translate a Python comparison, or a chain of comparisons, to C."""
        ends = [self.translate_expression(e) for e in (node.left, *node.comparators)]
        parts = []
        for op, a, b in zip(node.ops, ends, ends[1:], strict=False):
            if type(op) not in OPERATORS or not isinstance(a.kind, Scalar):
                raise self.unsupported_error(node, f"'{ast.unparse(node)}'")
            sign = OPERATORS[type(op)]
            if isinstance(a.fixed, NUMBERS) and isinstance(b.fixed, NUMBERS):
                parts.append(number_value(bool(COMPARISONS[type(op)](a.fixed, b.fixed))))
                continue
            if REAL in (a.kind, b.kind):
                a, b = convert_to_double(a), convert_to_double(b)
            parts.append(Value(TRUTH, f"({a.text} {sign} {b.text})"))
        return self.join_conditions(parts, ast.And())

    def of_BoolOp(self, node: ast.BoolOp) -> Value:
        """Translate Python's `and` and `or` to C, without constant operands."""
        before = len(self.lines)
        found = self.join_conditions(
            [convert_to_bool(self.translate_expression(v)) for v in node.values], node.op
        )
        if len(self.lines) != before:
            raise self.unsupported_error(node, f"'{ast.unparse(node)}'")
        return found

    def join_conditions(self, parts: Sequence[Value], op: ast.boolop) -> Value:
        """Return the C expression that joins translated conditions by `and` or `or`."""
        deciding = isinstance(op, ast.Or)
        if any(p.fixed is deciding for p in parts):
            return number_value(deciding)
        left = [p for p in parts if p.fixed is None]
        if not left:
            return number_value(not deciding)
        if len(left) == 1:
            return left[0]
        return Value(TRUTH, f"({f' {OPERATORS[type(op)]} '.join(p.text for p in left)})")

    def of_IfExp(self, node: ast.IfExp) -> Value:
        """Translate a conditional expression in Python to C."""
        test = convert_to_bool(self.translate_expression(node.test))
        if isinstance(test.fixed, bool):
            return self.translate_expression(node.body if test.fixed else node.orelse)
        before = len(self.lines)
        a, b = self.translate_expression(node.body), self.translate_expression(node.orelse)
        if len(self.lines) != before:
            raise self.unsupported_error(node, f"'{ast.unparse(node)}'")
        if a.kind != b.kind:
            if not (isinstance(a.kind, Scalar) and isinstance(b.kind, Scalar)):
                raise self.unsupported_error(node, f"'{ast.unparse(node)}'")
            if REAL in (a.kind, b.kind):
                a, b = convert_to_double(a), convert_to_double(b)
            else:
                a, b = self.convert_bool_to_integer(a), self.convert_bool_to_integer(b)
        return Value(a.kind, f"({test.text} ? {a.text} : {b.text})")

    # Calls
    # ------------------------------------------------------------------------------------------

    def of_Call(self, node: ast.Call) -> Value:
        """Translate a Python call to C: of a function, a named tuple or a conversion."""
        what = self.resolve_object(node.func)
        if isinstance(what, type) and issubclass(what, tuple) and hasattr(what, "_fields"):
            return self.translate_named_tuple(node, what)
        if isinstance(what, Hashable):
            if what in CASTS:
                return self.convert_kind(CASTS[what], self.translate_expression(node.args[0]))
            if what in (min, max):
                return self.translate_min_or_max("least" if what is min else "most", node)
            if what in (abs, np.abs):
                return self.translate_absolute(self.translate_expression(node.args[0]))
            if what in PREDICATES:
                of = convert_to_double(self.translate_expression(node.args[0]))
                return Value(TRUTH, f"((bool){PREDICATES[what]}({of.text}))")
            if what is round and len(node.args) == 1:
                of = convert_to_double(self.translate_expression(node.args[0]))
                return Value(WHOLE, f"((int64_t)rint({of.text}))")
            if what in ALLOCATIONS:
                return self.allocate_array(node)
            if what in MATH:
                given = ", ".join(
                    convert_to_double(self.translate_expression(a)).text for a in node.args
                )
                text = f"{MATH[what]}({given})"
                if what in WHOLE_RESULT:
                    return Value(WHOLE, f"((int64_t){text})")
                return Value(REAL, text)
        if what is len:
            return self.translate_length(node)
        python = python_function(what)
        if inspect.isfunction(python):
            return self.translate_call(what, self.bind_arguments(node, python))
        raise self.unsupported_error(node, f"'{ast.unparse(node.func)}'")

    def translate_named_tuple(self, node: ast.Call, what: Any) -> Value:
        """Translate the construction of a named tuple to C; declared floats are converted."""
        given = self.bind_arguments(node, what.__new__, skip=1)
        parts = []
        for name, value in zip(what._fields, given, strict=True):
            declared = what.__annotations__.get(name, float)
            if declared in (float, "float") and isinstance(value.kind, Scalar):
                value = convert_to_double(value)
            parts.append(value)
        kind = self.program.declare_struct(what, [p.kind for p in parts])
        return Value(kind, f"(({kind.c}){{{', '.join(p.text for p in parts)}}})")

    def bind_arguments(self, node: ast.Call, python: Any, skip: int = 0) -> list[Value]:
        """Return the translated arguments of a Python call in the order of its parameters."""
        parameters = list(inspect.signature(python).parameters.values())[skip:]
        given: dict[str, Value] = {}
        for parameter, value in zip(parameters, self.translate_arguments(node.args), strict=False):
            given[parameter.name] = value
        for keyword in node.keywords:
            given[str(keyword.arg)] = self.translate_expression(keyword.value)
        for parameter in parameters:
            if parameter.name not in given:
                given[parameter.name] = number_value(parameter.default)
        return [given[parameter.name] for parameter in parameters]

    def translate_arguments(self, nodes: Sequence[ast.expr]) -> list[Value]:
        """Translate arguments of a call to C; a tuple with a star counts as its entries."""
        found: list[Value] = []
        for node in nodes:
            if not isinstance(node, ast.Starred):
                found.append(self.translate_expression(node))
                continue
            whole = self.translate_expression(node.value)
            if not isinstance(whole.kind, Struct):
                raise self.unsupported_error(node, f"'{ast.unparse(node)}'")
            found += [self.tuple_field(whole, i) for i in range(len(whole.kind.kinds))]
        return found

    def translate_call(self, what: Any, given: Sequence[Value]) -> Value:
        """Translate a call of a function that is itself translated to C."""
        python = python_function(what)
        names = python.__code__.co_varnames[: len(given)]
        passed = []
        for name, value in zip(names, given, strict=True):
            is_float = python.__annotations__.get(name) in (float, "float")
            if is_float and isinstance(value.kind, Scalar):
                value = convert_to_double(value)
            elif value.kind == TRUTH and python.__annotations__.get(name) not in (bool, "bool"):
                value = self.convert_bool_to_integer(value)
            passed.append(value)
        name, kind = self.program.translate_function(what, [v.kind for v in passed])
        return Value(kind, f"{name}({', '.join(v.text for v in passed)})")

    def convert_kind(self, kind: Scalar, value: Value) -> Value:
        """Convert a translated number to another C type."""
        if kind == REAL:
            return convert_to_double(value)
        if kind == TRUTH:
            return convert_to_bool(value)
        if value.kind == kind:
            return value
        if isinstance(value.fixed, int | float) and kind == WHOLE:
            return number_value(int(value.fixed))
        if isinstance(value.fixed, int) and kind == BITS:
            return Value(BITS, f"UINT64_C({value.fixed})")
        return Value(kind, f"(({kind.c}){value.text})")

    def translate_min_or_max(self, name: str, node: ast.Call) -> Value:
        """Translate a call of `min` or `max` with two or more numbers to C."""
        given = [self.translate_expression(a) for a in node.args]
        real = any(v.kind == REAL for v in given)
        given = [convert_to_double(v) if real else self.convert_bool_to_integer(v) for v in given]
        text = given[0].text
        for value in given[1:]:
            text = f"{name}_{'real' if real else 'whole'}({text}, {value.text})"
        return Value(REAL if real else WHOLE, text)

    def translate_absolute(self, value: Value) -> Value:
        """Return the C expression of the absolute value of a number."""
        if value.kind == REAL:
            return Value(REAL, f"fabs({value.text})")
        return Value(WHOLE, f"magnitude({self.convert_bool_to_integer(value).text})")

    def translate_length(self, node: ast.Call) -> Value:
        """Translate `len` of an array or a tuple to C."""
        known = self.resolve_object(node.args[0])
        if isinstance(known, tuple):
            return number_value(len(known))
        of = self.translate_expression(node.args[0])
        if isinstance(of.kind, Struct):
            return number_value(len(of.kind.kinds))
        if not isinstance(of.kind, ArrayKind):
            raise self.unsupported_error(node, f"'{ast.unparse(node)}'")
        return Value(WHOLE, f"{of.text}.n0")

    def allocate_array(self, node: ast.Call) -> Value:
        """Write C source that allocates an array of zeros, freed when the function returns."""
        if self.loops:
            raise self.unsupported_error(node, "an array that is allocated within a loop")
        wanted, item = node.args[0], REAL
        for keyword in node.keywords:
            if keyword.arg != "dtype" or self.resolve_object(keyword.value) not in CASTS:
                raise self.unsupported_error(node, f"'{ast.unparse(node)}'")
            item = CASTS[self.resolve_object(keyword.value)]
        size = self.translate_expression(wanted)
        sizes = [size]
        if isinstance(size.kind, Struct):
            whole, count = self.copy_to_variable(size), len(size.kind.kinds)
            sizes = [self.tuple_field(whole, i) for i in range(count)]
        kind = ArrayKind(item, len(sizes))
        total = " * ".join(s.text for s in sizes)
        self.temporaries += 1
        own = f"m_{self.temporaries}"
        release = "real" if item == REAL else "whole"
        self.arrays.append(f"{item.c} *{own} RELEASED({release}) = NULL;")
        self.add_line(f"{own} = calloc({total}, sizeof({item.c}));")
        return Value(kind, f"(({kind.c}){{{own}, {', '.join(s.text for s in sizes)}}})")


def fold_constants(op: ast.operator, a: Value, b: Value) -> Value | None:
    """Return the constant result of an operator on two constants; None if one is no constant.

    Args:
        op: The operator.
        a: First operand.
        b: Second operand, of the same kind.
    """
    if type(op) in FOLDED and isinstance(a.fixed, NUMBERS) and isinstance(b.fixed, NUMBERS):
        return number_value(FOLDED[type(op)](a.fixed, b.fixed))
    return None
