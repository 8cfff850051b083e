"""Writes compiled functions anew in Warp's Python: the same text, every number and argument with its kind.

Laws are small functions of numbers, named tuples and one row of memory. Warp takes such text almost as it stands, but
mixes no whole numbers with floats, and knows neither named tuples nor tuples: named tuples become structs, the parts of
a tuple variables of their own. What has no form there is refused, with its file and line.
"""

import ast
import builtins
import inspect
import re
import textwrap
from collections.abc import Callable, Hashable, Sequence
from typing import Any

from boatsim.errors import BadInput
from boatsim.warp.function_names import (
    CASTS,
    MATH,
    OF_TRUTHS,
    OF_TWO,
    OF_WHOLE,
    OF_WHOLES,
    OPERATORS,
    safe,
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
    constant,
    flat,
    named,
    real,
    truth,
    tuple_of,
    written,
)


class NoForm(BadInput):
    """Something that Warp, or this translation, does not know."""


class Translation:
    """The functions of one program, translated as they are called; `text` holds them, callees first."""

    def __init__(self) -> None:
        self.functions: list[str] = []
        self.structs: list[str] = []
        self._known: dict[tuple[Any, tuple[Kind, ...]], tuple[str, Kind]] = {}
        self._records: dict[Any, Record] = {}
        self._names: set[str] = set()

    @property
    def text(self) -> str:
        """All structs and functions."""
        return "\n\n".join([*self.structs, *self.functions])

    def record(self, kind: Any, name: str) -> Record:
        """The struct of a named tuple's type, by the name that it has where it is first met."""
        if kind not in self._records:
            found = Record(self.unused(name), tuple(kind._fields))
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

    def unused(self, name: str) -> str:
        """A name of its own for a function or struct."""
        found, n = name, 1
        while found in self._names:
            found, n = f"{name}_{n}", n + 1
        self._names.add(found)
        return found

    def function(self, function: Any, kinds: Sequence[Kind]) -> tuple[str, Kind]:
        """Name and returned kind of a Python or compiled function for arguments of these kinds."""
        python = getattr(function, "py_func", function)
        key = (python, tuple(kinds))
        if key not in self._known:
            body = Body(self, python, kinds)
            self.functions.append(body.text())
            self._known[key] = body.name, body.returned
        return self._known[key]


class Body:
    """One function on its way."""

    def __init__(
        self, program: Translation, function: Callable[..., Any], kinds: Sequence[Kind]
    ) -> None:
        self.program, self.python = program, function
        self.file, self.first = inspect.getsourcefile(function), function.__code__.co_firstlineno
        tree = ast.parse(textwrap.dedent(inspect.getsource(function))).body[0]
        assert isinstance(tree, ast.FunctionDef)
        self.tree = tree
        self.about = f"{function.__module__.rpartition('.')[2]}.{function.__name__}"
        self.name = program.unused(re.sub(r"\W", "_", self.about))
        self.lines: list[str] = []
        self.depth = 1
        self.temporaries = 0
        self.returned: Kind = NOTHING
        floats = {n for n, a in function.__annotations__.items() if a is float or a == "float"}
        self.arguments = {
            arg.arg: named(REAL if kind == WHOLE and arg.arg in floats else kind, safe(arg.arg))
            for arg, kind in zip(tree.args.args, kinds, strict=True)
        }
        self.variables: dict[str, Value] = dict(self.arguments)

    def text(self) -> str:
        """The function in Warp's Python."""
        self.block(self.tree.body)
        taken = ", ".join(
            f"{v.text}: {written(v.kind)}" for a in self.arguments.values() for v in flat(a)
        )
        whole = ["@wp.func", f"def {self.name}({taken}):", f"    {self.about!r}", *self.lines]
        return (
            ast.unparse(ast.parse("\n".join(whole))) + "\n"
        )  # without the brackets that nobody needs

    # Statements
    # ------------------------------------------------------------------------------------------

    def say(self, line: str) -> None:
        """One line at the present depth."""
        self.lines.append("    " * self.depth + line)

    def refuse(self, node: ast.AST, what: str) -> NoForm:
        """What stands at a node has no form."""
        line = self.first + getattr(node, "lineno", 1) - 1
        return NoForm(f"{self.file}:{line}: {what} has no Warp form")

    def block(self, statements: Sequence[ast.stmt]) -> bool:
        """Statements one after another; whether they end by going back, so that nothing behind them is reached."""
        for statement in statements:
            written_by = getattr(self, f"say_{type(statement).__name__}", None)
            if written_by is None:
                raise self.refuse(statement, f"'{ast.unparse(statement).splitlines()[0]}'")
            if written_by(statement) or isinstance(statement, ast.Return):
                return True
        return False

    def say_Pass(self, node: ast.Pass) -> None:
        """Nothing."""

    def say_Break(self, node: ast.Break) -> None:
        """Out of a loop."""
        self.say("break")

    def say_Expr(self, node: ast.Expr) -> None:
        """A call for what it does; docstrings are left out."""
        if isinstance(node.value, ast.Constant):
            return
        self.say(self.value(node.value).text)

    def say_Return(self, node: ast.Return) -> None:
        """Back, with the parts of a tuple."""
        value = self.value(node.value) if node.value else NONE
        declared = str(self.python.__annotations__.get("return", ""))
        if "float" in declared:
            value = tuple_of([real(v) for v in value.parts]) if value.parts else real(value)
        if self.returned not in (NOTHING, value.kind):
            raise self.refuse(node, "a function that returns now one kind, now another,")
        self.returned = value.kind
        self.say(f"return {', '.join(v.text for v in flat(value))}".rstrip())

    def say_Assign(self, node: ast.Assign) -> None:
        """To names, tuples of names and entries of rows."""
        value = self.value(node.value)
        read = {n.id for n in ast.walk(node.value) if isinstance(n, ast.Name)}
        set_ = {n.id for t in node.targets for n in ast.walk(t) if isinstance(n, ast.Name)}
        if (len(flat(value)) > 1 and read & set_) or (
            len(node.targets) > 1 and isinstance(node.value, ast.Call)
        ):
            value = self.kept(value)
        for target in node.targets:
            self.assign(target, value)

    def say_AugAssign(self, node: ast.AugAssign) -> None:
        """Read, and then written: Warp's own would be atomic."""
        before = ast.parse(ast.unparse(node.target), mode="eval").body
        self.assign(
            node.target, self.value(ast.copy_location(ast.BinOp(before, node.op, node.value), node))
        )

    def assign(self, target: ast.expr, value: Value) -> None:
        """A value to what stands on the left."""
        if isinstance(target, ast.Tuple):
            if len(target.elts) != len(value.parts):
                raise self.refuse(target, f"'{ast.unparse(target)} = ...'")
            for part, of in zip(target.elts, value.parts, strict=True):
                self.assign(part, of)
        elif isinstance(target, ast.Subscript):
            self.say(f"{self.value(target, store=True).text} = {real(value).text}")
        elif isinstance(target, ast.Name):
            known = self.variables.get(target.id)
            if known is not None and known.kind == REAL and value.kind in (WHOLE, TRUTH):
                value = real(value)
            if known is not None and known.kind != value.kind:
                raise self.refuse(
                    target, f"'{target.id}', which is now of one kind, now of another,"
                )
            own = named(value.kind, safe(target.id))
            self.variables[target.id] = own
            for to, of in zip(flat(own), flat(value), strict=True):
                # a constant of its own: Warp would take the bare one for fixed for good
                self.say(
                    f"{to.text} = {f'int({of.text})' if of.kind == WHOLE and of.fixed is not None else of.text}"
                )
        else:
            raise self.refuse(target, f"'{ast.unparse(target)} = ...'")

    def say_If(self, node: ast.If) -> bool:
        """A branch; of one that is decided beforehand the other is not written at all."""
        test = truth(self.value(node.test))
        if test.fixed is not None:
            return self.block(node.body if test.fixed else node.orelse)
        self.say(f"if {test.text}:")
        self.deeper(node.body)
        if node.orelse:
            self.say("else:")
            self.deeper(node.orelse)
        return False

    def say_For(self, node: ast.For) -> None:
        """A loop over a range."""
        call = node.iter
        if not (
            isinstance(call, ast.Call)
            and self.found(call.func) is range
            and isinstance(node.target, ast.Name)
        ):
            raise self.refuse(node, "a loop over anything but a range")
        bounds = ", ".join(self.value(a).text for a in call.args)
        self.variables[node.target.id] = Value(WHOLE, safe(node.target.id))
        self.say(f"for {safe(node.target.id)} in range({bounds}):")
        self.deeper(node.body)

    def say_While(self, node: ast.While) -> None:
        """A loop while something holds."""
        before = len(self.lines)
        test = truth(self.value(node.test))
        if len(self.lines) != before:
            raise self.refuse(node, f"'while {ast.unparse(node.test)}'")
        self.say(f"while {test.text}:")
        self.deeper(node.body)

    def deeper(self, statements: Sequence[ast.stmt]) -> None:
        """A block of its own."""
        self.depth += 1
        before = len(self.lines)
        self.block(statements)
        if len(self.lines) == before:
            self.say("pass")
        self.depth -= 1

    def kept(self, value: Value) -> Value:
        """A value in variables of its own, as it is now."""
        own = self.temporary(value.kind)
        for to, of in zip(flat(own), flat(value), strict=True):
            self.say(f"{to.text} = {of.text}")
        return own

    def temporary(self, kind: Kind) -> Value:
        """Variables that the text does not name."""
        self.temporaries += 1
        return named(kind, f"_{self.temporaries}")

    # Expressions
    # ------------------------------------------------------------------------------------------

    def value(self, node: ast.expr, store: bool = False) -> Value:
        """An expression; what must come before it is said first."""
        if isinstance(node, ast.Subscript):
            return self.entry(node, store)
        written_by = getattr(self, f"of_{type(node).__name__}", None)
        if written_by is None:
            raise self.refuse(node, f"'{ast.unparse(node)}'")
        found: Value = written_by(node)
        return found

    def of_Constant(self, node: ast.Constant) -> Value:
        """A number."""
        if not isinstance(node.value, bool | int | float):
            raise self.refuse(node, f"'{ast.unparse(node)}'")
        return constant(node.value)

    def of_Name(self, node: ast.Name) -> Value:
        """A variable, or a number of the file."""
        if node.id in self.variables:
            return self.variables[node.id]
        return self.outside(node)

    def outside(self, node: ast.expr) -> Value:
        """A number from the file, or from what it imports."""
        found = self.found(node)
        if isinstance(found, tuple) and all(isinstance(x, bool | int | float) for x in found):
            return tuple_of([constant(x) for x in found])
        if not isinstance(found, bool | int | float):
            raise self.refuse(node, f"'{ast.unparse(node)}'")
        return constant(found)

    def found(self, node: ast.expr) -> Any:
        """What a name, or an attribute of a module, means in the function's file."""
        if isinstance(node, ast.Attribute):
            return getattr(self.found(node.value), node.attr, None)
        if not isinstance(node, ast.Name) or node.id in self.variables:
            return None
        return self.python.__globals__.get(node.id, getattr(builtins, node.id, None))

    def of_Attribute(self, node: ast.Attribute) -> Value:
        """A field of a record, or a number of a module."""
        if isinstance(node.value, ast.Name) and node.value.id not in self.variables:
            return self.outside(node)
        owner = self.value(node.value)
        if not isinstance(owner.kind, Record) or node.attr not in owner.kind.fields:
            raise self.refuse(node, f"'{ast.unparse(node)}'")
        if not owner.text.isidentifier():
            owner = self.kept(owner)
        return Value(REAL, f"{owner.text}.{node.attr}")

    def entry(self, node: ast.Subscript, store: bool) -> Value:
        """An entry of a row, of a tuple or of a record."""
        owner, index = self.value(node.value), self.value(node.slice)
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
        raise self.refuse(node, f"'{ast.unparse(node)}'")

    def of_Tuple(self, node: ast.Tuple) -> Value:
        """Values beside one another."""
        return tuple_of([self.value(e) for e in node.elts])

    def of_UnaryOp(self, node: ast.UnaryOp) -> Value:
        """A sign, or not."""
        of = self.value(node.operand)
        if isinstance(node.op, ast.USub) and isinstance(of.fixed, int | float):
            return constant(-of.fixed)
        if isinstance(node.op, ast.Not):
            return (
                constant(not of.fixed)
                if of.fixed is not None
                else Value(TRUTH, f"(not {truth(of).text})")
            )
        return Value(of.kind, f"({self.operator(node.op)}{of.text})")

    def of_BinOp(self, node: ast.BinOp) -> Value:
        """Arithmetic; whole numbers become floats beside floats, and where they are divided."""
        a, b, op = self.value(node.left), self.value(node.right), self.operator(node.op)
        if a.kind == b.kind == TRUTH and op in OF_TRUTHS:
            return Value(TRUTH, f"({a.text} {OF_TRUTHS[op]} {b.text})")
        if op == "/" or not {a.kind, b.kind} <= {WHOLE, BITS}:
            if op == "**":
                return self.power(a, b)
            if op not in "+-*/" or op == "//":
                raise self.refuse(node, f"'{ast.unparse(node)}'")
            return Value(REAL, f"({real(a).text} {op} {real(b).text})")
        if a.kind != b.kind or op == "**":
            raise self.refuse(node, f"'{ast.unparse(node)}'")
        if op in OF_WHOLES:
            return Value(WHOLE, f"{OF_WHOLES[op]}({a.text}, {b.text})")
        return Value(a.kind, f"({a.text} {op} {b.text})")

    def power(self, base: Value, exponent: Value) -> Value:
        """Small whole powers by products, as they may have a negative base."""
        if isinstance(exponent.fixed, int) and 2 <= exponent.fixed <= 4:
            return Value(REAL, f"power_{exponent.fixed}_({real(base).text})")
        return Value(REAL, f"wp.pow({real(base).text}, {real(exponent).text})")

    def of_Compare(self, node: ast.Compare) -> Value:
        """One comparison, or several in a row."""
        ends, parts = [self.value(e) for e in (node.left, *node.comparators)], []
        for op, a, b in zip(node.ops, ends, ends[1:], strict=False):
            if REAL in (a.kind, b.kind):
                a, b = real(a), real(b)
            if a.kind != b.kind:
                raise self.refuse(node, f"'{ast.unparse(node)}'")
            parts.append(f"({a.text} {self.operator(op)} {b.text})")
        return Value(TRUTH, " and ".join(parts) if len(parts) == 1 else f"({' and '.join(parts)})")

    def of_BoolOp(self, node: ast.BoolOp) -> Value:
        """And, or: as far as needed."""
        before = len(self.lines)
        parts = [truth(self.value(v)) for v in node.values]
        if len(self.lines) != before:
            raise self.refuse(node, f"'{ast.unparse(node)}'")
        deciding = isinstance(node.op, ast.Or)
        if any(p.fixed is deciding for p in parts):
            return constant(deciding)
        parts = [p for p in parts if p.fixed is None]
        if not parts:
            return constant(not deciding)
        return Value(TRUTH, f"({f' {self.operator(node.op)} '.join(p.text for p in parts)})")

    def of_IfExp(self, node: ast.IfExp) -> Value:
        """One or the other; as a branch where either needs more than an expression."""
        test = truth(self.value(node.test))
        if test.fixed is not None:
            return self.value(node.body if test.fixed else node.orelse)
        before, begun = len(self.lines), self.temporaries
        a, b = self.alike(self.value(node.body), self.value(node.orelse))
        if len(self.lines) == before and not isinstance(a.kind, tuple):
            return Value(a.kind, f"({a.text} if {test.text} else {b.text})")
        del self.lines[before:]
        self.temporaries = begun
        own = self.temporary(a.kind)
        for head, branch in ((f"if {test.text}:", node.body), ("else:", node.orelse)):
            self.say(head)
            self.depth += 1
            value = self.value(branch)
            for to, of in zip(flat(own), flat(value), strict=True):
                self.say(f"{to.text} = {real(of).text if to.kind == REAL else of.text}")
            self.depth -= 1
        return own

    def alike(self, a: Value, b: Value) -> tuple[Value, Value]:
        """Two values of one kind, floats if either is one."""
        if a.parts and len(a.parts) == len(b.parts):
            pairs = [self.alike(x, y) for x, y in zip(a.parts, b.parts, strict=True)]
            return tuple_of([x for x, _ in pairs]), tuple_of([y for _, y in pairs])
        return (a, b) if a.kind == b.kind else (real(a), real(b))

    def operator(self, op: ast.AST) -> str:
        """How an operator is written."""
        if type(op) not in OPERATORS:
            raise self.refuse(op, type(op).__name__)
        return OPERATORS[type(op)]

    # Calls
    # ------------------------------------------------------------------------------------------

    def of_Call(self, node: ast.Call) -> Value:
        """A function of ours, of mathematics, a named tuple or a cast."""
        what = self.found(node.func)
        if isinstance(what, type) and issubclass(what, tuple) and hasattr(what, "_fields"):
            name = ast.unparse(node.func).rpartition(".")[2]
            record, given = self.program.record(what, name), self.bound(node, what.__new__, skip=1)
            return Value(record, f"{record.name}({', '.join(real(v).text for v in given)})")
        if isinstance(what, Hashable) and what in CASTS:
            return self.cast(CASTS[what], self.value(node.args[0]))
        if isinstance(what, Hashable) and what in MATH:
            return self.mathematics(what, [self.value(a) for a in node.args])
        if what is len:
            return constant(len(self.found(node.args[0])))
        python = getattr(what, "py_func", what)
        if inspect.isfunction(python):
            return self.call(what, self.bound(node, python))
        raise self.refuse(node, f"'{ast.unparse(node.func)}'")

    def bound(self, node: ast.Call, python: Any, skip: int = 0) -> list[Value]:
        """Arguments in the order of a function's own, what is left out at its default."""
        parameters = list(inspect.signature(python).parameters.values())[skip:]
        given = {p.name: self.value(a) for p, a in zip(parameters, node.args, strict=False)}
        given |= {str(k.arg): self.value(k.value) for k in node.keywords}
        return [given[p.name] if p.name in given else constant(p.default) for p in parameters]

    def call(self, what: Any, given: Sequence[Value]) -> Value:
        """A call of a function of ours; a tuple that it returns goes into variables."""
        python = getattr(what, "py_func", what)
        floats = [
            python.__annotations__.get(n) in (float, "float")
            for n in python.__code__.co_varnames[: len(given)]
        ]
        given = [
            real(v) if is_float and v.kind in (WHOLE, TRUTH) else v
            for v, is_float in zip(given, floats, strict=True)
        ]
        name, kind = self.program.function(what, [v.kind for v in given])
        text = f"{name}({', '.join(leaf.text for v in given for leaf in flat(v))})"
        if not isinstance(kind, tuple):
            return Value(kind, text)
        own = self.temporary(kind)
        self.say(f"{', '.join(v.text for v in flat(own))} = {text}")
        return own

    def mathematics(self, what: Any, given: Sequence[Value]) -> Value:
        """A function of numbers; `min` and `max` of many by twos."""
        name = MATH[what]
        whole = name in OF_WHOLE and all(v.kind == WHOLE for v in given)
        texts = [v.text if whole else real(v).text for v in given]
        while name in OF_TWO and len(texts) > 2:
            texts[:2] = [f"{name}({texts[0]}, {texts[1]})"]
        return Value(WHOLE if whole else REAL, f"{name}({', '.join(texts)})")

    def cast(self, kind: Kind, value: Value) -> Value:
        """A number as another kind."""
        if kind == REAL:
            return real(value)
        if value.kind == kind:
            return value
        if kind == TRUTH:
            return truth(value)
        if kind == WHOLE and isinstance(value.fixed, int | float):
            return constant(int(value.fixed))
        if kind == BITS and isinstance(value.fixed, int):
            parts = (
                str(value.fixed >> shift & 0xFFFF) for shift in (48, 32, 16, 0)
            )  # Warp's literals are shorter
            return Value(BITS, f"bits_({', '.join(parts)})")
        return Value(kind, f"{kind}({value.text})")
