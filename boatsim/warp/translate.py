"""Translates compiled functions to Warp's dialect of Python.

Laws are small functions of numbers, named tuples and rows of arrays. Warp accepts such functions
almost unchanged, but does not mix integers with floats and has neither named tuples nor tuples:
named tuples become structs, and the parts of a tuple become separate variables. What cannot be
translated raises an error with file and line.
"""

import ast
import builtins
import inspect
import re
import textwrap
from collections.abc import Callable, Hashable, Sequence
from typing import Any

from boatsim.errors import BadInput
from boatsim.physics.debugging import python_function
from boatsim.warp.function_names import (
    CASTS,
    MATH,
    OF_TRUTHS,
    OF_TWO,
    OF_WHOLE,
    OF_WHOLES,
    OPERATORS,
    unreserved_name,
)
from boatsim.warp.values import (
    BITS,
    NONE,
    NOTHING,
    REAL,
    ROW,
    TRUTH,
    WHOLE,
    Kind,
    Record,
    Value,
    annotation_of,
    convert_to_bool,
    convert_to_float,
    flatten_tuple,
    make_constant,
    make_tuple,
    make_variable,
)


class NotTranslatable(BadInput):
    """Raised for Python code that cannot be translated to Warp's dialect."""


class Translation:
    """Translates the functions of a vessel's program to Warp's dialect of Python.

    A function is translated when a call of it is found; called functions come first in the text.
    """

    def __init__(self) -> None:
        self.functions: list[str] = []
        self.structs: list[str] = []
        self._known: dict[tuple[Any, tuple[Kind, ...]], tuple[str, Kind]] = {}
        self._records: dict[Any, Record] = {}
        self._names: set[str] = set()

    @property
    def text(self) -> str:
        """Translated source of all structs and functions."""
        return "\n\n".join([*self.structs, *self.functions])

    def struct_of(self, kind: Any, name: str) -> Record:
        """Return the Warp struct into which a type of named tuples is translated.

        Args:
            kind: The type of named tuples.
            name: Name of the type where it is first used.
        """
        if kind not in self._records:
            found = Record(self.unused_name(name), tuple(kind._fields))
            self.structs.append(
                "\n".join(
                    [
                        "@wp.struct",
                        f"class {found.name}:",
                        *(f"    {f}: T" for f in found.fields),
                        "",
                    ]
                )
            )
            self._records[kind] = found
        return self._records[kind]

    def unused_name(self, name: str) -> str:
        """Return a name for a translated function or struct that no other one has.

        Args:
            name: The wanted name.
        """
        found, n = name, 1
        while found in self._names:
            found, n = f"{name}_{n}", n + 1
        self._names.add(found)
        return found

    def translate_function(self, function: Any, kinds: Sequence[Kind]) -> tuple[str, Kind]:
        """Translate a Python function to Warp; return its name and the Warp type of its result.

        Args:
            function: A Python or compiled function.
            kinds: Kinds of its arguments.
        """
        python = python_function(function)
        key = (python, tuple(kinds))
        if key not in self._known:
            body = FunctionTranslator(self, python, kinds)
            self.functions.append(body.text())
            self._known[key] = body.name, body.returned
        return self._known[key]


class FunctionTranslator:
    """Translates the body of one Python function to Warp's dialect, statement by statement."""

    def __init__(
        self, program: Translation, function: Callable[..., Any], kinds: Sequence[Kind]
    ) -> None:
        self.program, self.python = program, function
        self.file, self.first = inspect.getsourcefile(function), function.__code__.co_firstlineno
        tree = ast.parse(textwrap.dedent(inspect.getsource(function))).body[0]
        assert isinstance(tree, ast.FunctionDef)
        self.tree = tree
        self.about = f"{function.__module__.rpartition('.')[2]}.{function.__name__}"
        self.name = program.unused_name(re.sub(r"\W", "_", self.about))
        self.lines: list[str] = []
        self.depth = 1
        self.temporaries = 0
        self.returned: Kind = NOTHING
        floats = {n for n, a in function.__annotations__.items() if a is float or a == "float"}
        self.arguments = {
            arg.arg: make_variable(
                REAL if kind == WHOLE and arg.arg in floats else kind, unreserved_name(arg.arg)
            )
            for arg, kind in zip(tree.args.args, kinds, strict=True)
        }
        self.variables: dict[str, Value] = dict(self.arguments)

    def text(self) -> str:
        """Return the source of the translated function in Warp's dialect."""
        self.translate_block(self.tree.body)
        taken = ", ".join(
            f"{v.text}: {annotation_of(v.kind)}"
            for a in self.arguments.values()
            for v in flatten_tuple(a)
        )
        whole = ["@wp.func", f"def {self.name}({taken}):", f"    {self.about!r}", *self.lines]
        return ast.unparse(ast.parse("\n".join(whole))) + "\n"  # without superfluous brackets

    # Statements
    # ------------------------------------------------------------------------------------------

    def add_line(self, line: str) -> None:
        """Append a line to the translated source, at the present indentation."""
        self.lines.append("    " * self.depth + line)

    def unsupported_error(self, node: ast.AST, what: str) -> NotTranslatable:
        """Return the exception for a node of the syntax tree that cannot be translated to Warp."""
        line = self.first + getattr(node, "lineno", 1) - 1
        return NotTranslatable(f"{self.file}:{line}: {what} has no Warp form")

    def translate_block(self, statements: Sequence[ast.stmt]) -> bool:
        """Translate a list of Python statements to Warp; return whether they end with a return."""
        for statement in statements:
            written_by = getattr(self, f"statement_{type(statement).__name__}", None)
            if written_by is None:
                raise self.unsupported_error(
                    statement, f"'{ast.unparse(statement).splitlines()[0]}'"
                )
            if written_by(statement) or isinstance(statement, ast.Return):
                return True
        return False

    def statement_Pass(self, node: ast.Pass) -> None:
        """Translate the Python statement `pass` to Warp: nothing is written."""

    def statement_Break(self, node: ast.Break) -> None:
        """Translate the Python statement `break` to Warp."""
        self.add_line("break")

    def statement_Expr(self, node: ast.Expr) -> None:
        """Translate a statement that only calls a function to Warp; omit docstrings."""
        if isinstance(node.value, ast.Constant):
            return
        self.add_line(self.translate_expression(node.value).text)

    def statement_Return(self, node: ast.Return) -> None:
        """Translate a Python `return` to Warp, with the parts of a tuple as separate values."""
        value = self.translate_expression(node.value) if node.value else NONE
        declared = str(self.python.__annotations__.get("return", ""))
        if "float" in declared:
            value = (
                make_tuple([convert_to_float(v) for v in value.parts])
                if value.parts
                else convert_to_float(value)
            )
        if self.returned not in (NOTHING, value.kind):
            raise self.unsupported_error(node, "a function that returns values of different kinds")
        self.returned = value.kind
        self.add_line(f"return {', '.join(v.text for v in flatten_tuple(value))}".rstrip())

    def statement_Assign(self, node: ast.Assign) -> None:
        """Translate a Python assignment to names, tuples of names or array entries to Warp."""
        value = self.translate_expression(node.value)
        read = {n.id for n in ast.walk(node.value) if isinstance(n, ast.Name)}
        set_ = {n.id for t in node.targets for n in ast.walk(t) if isinstance(n, ast.Name)}
        if (len(flatten_tuple(value)) > 1 and read & set_) or (
            len(node.targets) > 1 and isinstance(node.value, ast.Call)
        ):
            value = self.copy_to_variables(value)
        for target in node.targets:
            self.translate_assignment(target, value)

    def statement_AugAssign(self, node: ast.AugAssign) -> None:
        """Translate `+=` and similar statements to plain assignments, since Warp's are atomic."""
        before = ast.parse(ast.unparse(node.target), mode="eval").body
        self.translate_assignment(
            node.target,
            self.translate_expression(
                ast.copy_location(ast.BinOp(before, node.op, node.value), node)
            ),
        )

    def translate_assignment(self, target: ast.expr, value: Value) -> None:
        """Write the Warp source that assigns a translated value to a Python assignment target."""
        if isinstance(target, ast.Tuple):
            if len(target.elts) != len(value.parts):
                raise self.unsupported_error(target, f"'{ast.unparse(target)} = ...'")
            for part, of in zip(target.elts, value.parts, strict=True):
                self.translate_assignment(part, of)
        elif isinstance(target, ast.Subscript):
            entry = self.translate_expression(target, store=True)
            self.add_line(f"{entry.text} = {convert_to_float(value).text}")
        elif isinstance(target, ast.Name):
            known = self.variables.get(target.id)
            if known is not None and known.kind == REAL and value.kind in (WHOLE, TRUTH):
                value = convert_to_float(value)
            if known is not None and known.kind != value.kind:
                raise self.unsupported_error(
                    target, f"'{target.id}', which has values of different kinds,"
                )
            own = make_variable(value.kind, unreserved_name(target.id))
            self.variables[target.id] = own
            for to, of in zip(flatten_tuple(own), flatten_tuple(value), strict=True):
                # Warp would take a plain integer for a compile-time constant.
                is_integer = of.kind == WHOLE and of.fixed is not None
                self.add_line(
                    f"{to.text} = int({of.text})" if is_integer else f"{to.text} = {of.text}"
                )
        else:
            raise self.unsupported_error(target, f"'{ast.unparse(target)} = ...'")

    def statement_If(self, node: ast.If) -> bool:
        """Translate a Python `if` to Warp; only one branch if its test is constant."""
        test = convert_to_bool(self.translate_expression(node.test))
        if test.fixed is not None:
            return self.translate_block(node.body if test.fixed else node.orelse)
        self.add_line(f"if {test.text}:")
        self.translate_indented(node.body)
        if node.orelse:
            self.add_line("else:")
            self.translate_indented(node.orelse)
        return False

    def statement_For(self, node: ast.For) -> None:
        """Translate a Python `for` loop over a range to Warp."""
        call = node.iter
        if not (
            isinstance(call, ast.Call)
            and self.resolve_object(call.func) is range
            and isinstance(node.target, ast.Name)
        ):
            raise self.unsupported_error(node, "a loop over anything but a range")
        bounds = ", ".join(self.translate_expression(a).text for a in call.args)
        self.variables[node.target.id] = Value(WHOLE, unreserved_name(node.target.id))
        self.add_line(f"for {unreserved_name(node.target.id)} in range({bounds}):")
        self.translate_indented(node.body)

    def statement_While(self, node: ast.While) -> None:
        """Translate a Python `while` loop to Warp."""
        before = len(self.lines)
        test = convert_to_bool(self.translate_expression(node.test))
        if len(self.lines) != before:
            raise self.unsupported_error(node, f"'while {ast.unparse(node.test)}'")
        self.add_line(f"while {test.text}:")
        self.translate_indented(node.body)

    def translate_indented(self, statements: Sequence[ast.stmt]) -> None:
        """Translate the statements of an indented Python block to Warp."""
        self.depth += 1
        before = len(self.lines)
        self.translate_block(statements)
        if len(self.lines) == before:
            self.add_line("pass")
        self.depth -= 1

    def copy_to_variables(self, value: Value) -> Value:
        """Write Warp source that copies a value to new variables; return the variables."""
        own = self.new_variables(value.kind)
        for to, of in zip(flatten_tuple(own), flatten_tuple(value), strict=True):
            self.add_line(f"{to.text} = {of.text}")
        return own

    def new_variables(self, kind: Kind) -> Value:
        """Return new variables of a Warp type for the translated source, with unused names."""
        self.temporaries += 1
        return make_variable(kind, f"_{self.temporaries}")

    # Expressions
    # ------------------------------------------------------------------------------------------

    def translate_expression(self, node: ast.expr, store: bool = False) -> Value:
        """Translate a Python expression to Warp; lines that must precede it are added first."""
        if isinstance(node, ast.Subscript):
            return self.translate_subscript(node, store)
        written_by = getattr(self, f"of_{type(node).__name__}", None)
        if written_by is None:
            raise self.unsupported_error(node, f"'{ast.unparse(node)}'")
        found: Value = written_by(node)
        return found

    def of_Constant(self, node: ast.Constant) -> Value:
        """Translate a constant in a Python expression to Warp."""
        if not isinstance(node.value, bool | int | float):
            raise self.unsupported_error(node, f"'{ast.unparse(node)}'")
        return make_constant(node.value)

    def of_Name(self, node: ast.Name) -> Value:
        """Translate a name in a Python expression, a variable or module constant, to Warp."""
        if node.id in self.variables:
            return self.variables[node.id]
        return self.module_constant(node)

    def module_constant(self, node: ast.expr) -> Value:
        """Translate a constant of the function's module, or of one that it imports, to Warp."""
        found = self.resolve_object(node)
        if isinstance(found, tuple) and all(isinstance(x, bool | int | float) for x in found):
            return make_tuple([make_constant(x) for x in found])
        if not isinstance(found, bool | int | float):
            raise self.unsupported_error(node, f"'{ast.unparse(node)}'")
        return make_constant(found)

    def resolve_object(self, node: ast.expr) -> Any:
        """Return the Python object to which a name or an attribute of a module refers.

        The result is None if the name is a variable.
        """
        if isinstance(node, ast.Attribute):
            return getattr(self.resolve_object(node.value), node.attr, None)
        if not isinstance(node, ast.Name) or node.id in self.variables:
            return None
        return self.python.__globals__.get(node.id, getattr(builtins, node.id, None))

    def of_Attribute(self, node: ast.Attribute) -> Value:
        """Translate an attribute, a field of a record or a constant of a module, to Warp."""
        if isinstance(node.value, ast.Name) and node.value.id not in self.variables:
            return self.module_constant(node)
        owner = self.translate_expression(node.value)
        if not isinstance(owner.kind, Record) or node.attr not in owner.kind.fields:
            raise self.unsupported_error(node, f"'{ast.unparse(node)}'")
        if not owner.text.isidentifier():
            owner = self.copy_to_variables(owner)
        return Value(REAL, f"{owner.text}.{node.attr}")

    def translate_subscript(self, node: ast.Subscript, store: bool) -> Value:
        """Translate a Python subscript, an entry of an array row, tuple or record, to Warp."""
        owner, index = self.translate_expression(node.value), self.translate_expression(node.slice)
        if owner.kind == ROW and index.kind == WHOLE:
            return Value(REAL, f"{owner.text}[{index.text}]")
        if isinstance(index.fixed, int) and not store:
            if isinstance(owner.kind, tuple):
                return owner.parts[index.fixed]
            if isinstance(owner.kind, Record):
                return Value(REAL, f"{owner.text}.{owner.kind.fields[index.fixed]}")
        if index.kind == WHOLE and isinstance(owner.kind, tuple) and not store:
            found = owner.parts[-1]
            for i, part in reversed(list(enumerate(owner.parts[:-1]))):
                found = Value(part.kind, f"({part.text} if {index.text} == {i} else {found.text})")
            return found
        raise self.unsupported_error(node, f"'{ast.unparse(node)}'")

    def of_Tuple(self, node: ast.Tuple) -> Value:
        """Translate a Python tuple to Warp."""
        return make_tuple([self.translate_expression(e) for e in node.elts])

    def of_UnaryOp(self, node: ast.UnaryOp) -> Value:
        """Translate a sign or `not` in a Python expression to Warp."""
        of = self.translate_expression(node.operand)
        if isinstance(node.op, ast.USub) and isinstance(of.fixed, int | float):
            return make_constant(-of.fixed)
        if isinstance(node.op, ast.Not):
            if of.fixed is not None:
                return make_constant(not of.fixed)
            return Value(TRUTH, f"(not {convert_to_bool(of).text})")
        return Value(of.kind, f"({self.operator_text(node.op)}{of.text})")

    def of_BinOp(self, node: ast.BinOp) -> Value:
        """Translate a binary arithmetic operation in Python to Warp.

        Integers become floats if the other operand is one, and in divisions.
        """
        a, b, op = (
            self.translate_expression(node.left),
            self.translate_expression(node.right),
            self.operator_text(node.op),
        )
        if a.kind == b.kind == TRUTH and op in OF_TRUTHS:
            return Value(TRUTH, f"({a.text} {OF_TRUTHS[op]} {b.text})")
        if op == "/" or not {a.kind, b.kind} <= {WHOLE, BITS}:
            if op == "**":
                return self.translate_power(a, b)
            if op not in "+-*/" or op == "//":
                raise self.unsupported_error(node, f"'{ast.unparse(node)}'")
            return Value(REAL, f"({convert_to_float(a).text} {op} {convert_to_float(b).text})")
        if a.kind != b.kind or op == "**":
            raise self.unsupported_error(node, f"'{ast.unparse(node)}'")
        if op in OF_WHOLES:
            return Value(WHOLE, f"{OF_WHOLES[op]}({a.text}, {b.text})")
        return Value(a.kind, f"({a.text} {op} {b.text})")

    def translate_power(self, base: Value, exponent: Value) -> Value:
        """Translate a Python power to Warp; small integer powers become products.

        The base of a product may be negative.
        """
        if isinstance(exponent.fixed, int) and 2 <= exponent.fixed <= 4:
            return Value(REAL, f"power_{exponent.fixed}_({convert_to_float(base).text})")
        return Value(
            REAL, f"wp.pow({convert_to_float(base).text}, {convert_to_float(exponent).text})"
        )

    def of_Compare(self, node: ast.Compare) -> Value:
        """Translate a Python comparison, or a chain of comparisons, to Warp."""
        ends, parts = [self.translate_expression(e) for e in (node.left, *node.comparators)], []
        for op, a, b in zip(node.ops, ends, ends[1:], strict=False):
            if REAL in (a.kind, b.kind):
                a, b = convert_to_float(a), convert_to_float(b)
            if a.kind != b.kind:
                raise self.unsupported_error(node, f"'{ast.unparse(node)}'")
            parts.append(f"({a.text} {self.operator_text(op)} {b.text})")
        if len(parts) == 1:
            return Value(TRUTH, parts[0])
        return Value(TRUTH, f"({' and '.join(parts)})")

    def of_BoolOp(self, node: ast.BoolOp) -> Value:
        """Translate Python's `and` and `or` to Warp, without constant operands."""
        before = len(self.lines)
        parts = [convert_to_bool(self.translate_expression(v)) for v in node.values]
        if len(self.lines) != before:
            raise self.unsupported_error(node, f"'{ast.unparse(node)}'")
        deciding = isinstance(node.op, ast.Or)
        if any(p.fixed is deciding for p in parts):
            return make_constant(deciding)
        parts = [p for p in parts if p.fixed is None]
        if not parts:
            return make_constant(not deciding)
        return Value(TRUTH, f"({f' {self.operator_text(node.op)} '.join(p.text for p in parts)})")

    def of_IfExp(self, node: ast.IfExp) -> Value:
        """Translate a Python conditional expression to Warp.

        It becomes a branch if a side needs lines before it.
        """
        test = convert_to_bool(self.translate_expression(node.test))
        if test.fixed is not None:
            return self.translate_expression(node.body if test.fixed else node.orelse)
        before, first_temporary = len(self.lines), self.temporaries
        a, b = self.convert_to_same_kind(
            self.translate_expression(node.body), self.translate_expression(node.orelse)
        )
        if len(self.lines) == before and not isinstance(a.kind, tuple):
            return Value(a.kind, f"({a.text} if {test.text} else {b.text})")
        del self.lines[before:]
        self.temporaries = first_temporary
        own = self.new_variables(a.kind)
        for head, branch in ((f"if {test.text}:", node.body), ("else:", node.orelse)):
            self.add_line(head)
            self.depth += 1
            value = self.translate_expression(branch)
            for to, of in zip(flatten_tuple(own), flatten_tuple(value), strict=True):
                self.add_line(
                    f"{to.text} = {convert_to_float(of).text if to.kind == REAL else of.text}"
                )
            self.depth -= 1
        return own

    def convert_to_same_kind(self, a: Value, b: Value) -> tuple[Value, Value]:
        """Convert two translated values to the same Warp type: floats if either is a float."""
        if a.parts and len(a.parts) == len(b.parts):
            pairs = [self.convert_to_same_kind(x, y) for x, y in zip(a.parts, b.parts, strict=True)]
            return make_tuple([x for x, _ in pairs]), make_tuple([y for _, y in pairs])
        if a.kind == b.kind:
            return a, b
        return convert_to_float(a), convert_to_float(b)

    def operator_text(self, op: ast.AST) -> str:
        """Return the Warp source text of a Python operator."""
        if type(op) not in OPERATORS:
            raise self.unsupported_error(op, type(op).__name__)
        return OPERATORS[type(op)]

    # Calls
    # ------------------------------------------------------------------------------------------

    def of_Call(self, node: ast.Call) -> Value:
        """Translate a Python call to Warp: of a function, a named tuple or a conversion."""
        what = self.resolve_object(node.func)
        if isinstance(what, type) and issubclass(what, tuple) and hasattr(what, "_fields"):
            name = ast.unparse(node.func).rpartition(".")[2]
            record, given = (
                self.program.struct_of(what, name),
                self.bind_arguments(node, what.__new__, skip=1),
            )
            return Value(
                record, f"{record.name}({', '.join(convert_to_float(v).text for v in given)})"
            )
        if isinstance(what, Hashable) and what in CASTS:
            return self.convert_kind(CASTS[what], self.translate_expression(node.args[0]))
        if isinstance(what, Hashable) and what in MATH:
            return self.translate_math_call(what, [self.translate_expression(a) for a in node.args])
        if what is len:
            return make_constant(len(self.resolve_object(node.args[0])))
        python = python_function(what)
        if inspect.isfunction(python):
            return self.translate_call(what, self.bind_arguments(node, python))
        raise self.unsupported_error(node, f"'{ast.unparse(node.func)}'")

    def bind_arguments(self, node: ast.Call, python: Any, skip: int = 0) -> list[Value]:
        """Return the translated arguments of a Python call in the order of its parameters.

        Missing ones have the default values.
        """
        parameters = list(inspect.signature(python).parameters.values())[skip:]
        given = {
            p.name: self.translate_expression(a)
            for p, a in zip(parameters, node.args, strict=False)
        }
        given |= {str(k.arg): self.translate_expression(k.value) for k in node.keywords}
        for parameter in parameters:
            if parameter.name not in given:
                given[parameter.name] = make_constant(parameter.default)
        return [given[parameter.name] for parameter in parameters]

    def translate_call(self, what: Any, given: Sequence[Value]) -> Value:
        """Translate a call of a function that is itself translated to Warp.

        A tuple that it returns is assigned to variables.
        """
        python = python_function(what)
        floats = [
            python.__annotations__.get(n) in (float, "float")
            for n in python.__code__.co_varnames[: len(given)]
        ]
        given = [
            convert_to_float(v) if is_float and v.kind in (WHOLE, TRUTH) else v
            for v, is_float in zip(given, floats, strict=True)
        ]
        name, kind = self.program.translate_function(what, [v.kind for v in given])
        text = f"{name}({', '.join(leaf.text for v in given for leaf in flatten_tuple(v))})"
        if not isinstance(kind, tuple):
            return Value(kind, text)
        own = self.new_variables(kind)
        self.add_line(f"{', '.join(v.text for v in flatten_tuple(own))} = {text}")
        return own

    def translate_math_call(self, what: Any, given: Sequence[Value]) -> Value:
        """Translate a call of a mathematical function to Warp.

        `min` and `max` of many arguments are nested.
        """
        name = MATH[what]
        whole = name in OF_WHOLE and all(v.kind == WHOLE for v in given)
        texts = [v.text if whole else convert_to_float(v).text for v in given]
        while name in OF_TWO and len(texts) > 2:
            texts[:2] = [f"{name}({texts[0]}, {texts[1]})"]
        return Value(WHOLE if whole else REAL, f"{name}({', '.join(texts)})")

    def convert_kind(self, kind: Kind, value: Value) -> Value:
        """Convert a translated value to another Warp type, such as an integer to a float."""
        if kind == REAL:
            return convert_to_float(value)
        if value.kind == kind:
            return value
        if kind == TRUTH:
            return convert_to_bool(value)
        if kind == WHOLE and isinstance(value.fixed, int | float):
            return make_constant(int(value.fixed))
        if kind == BITS and isinstance(value.fixed, int):
            # Warp's literals have fewer bits
            parts = (str(value.fixed >> shift & 0xFFFF) for shift in (48, 32, 16, 0))
            return Value(BITS, f"bits_({', '.join(parts)})")
        return Value(kind, f"{kind}({value.text})")
