"""Names in Warp of functions and operators of Python, `math` and numpy that laws use."""

import ast
import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from boatsim.warp.values import BITS, REAL, TRUTH, WHOLE, Kind

ALIKE = ("cos", "sin", "tan", "exp", "log", "sqrt", "tanh", "floor")
MATH: Mapping[Any, str] = {
    **{getattr(source, name): f"wp.{name}" for source in (math, np) for name in ALIKE},
    math.atan2: "wp.atan2",
    np.arctan2: "wp.atan2",
    math.acos: "wp.acos",
    math.asin: "wp.asin",
    math.atan: "wp.atan",
    math.hypot: "hypotenuse_",
    np.hypot: "hypotenuse_",
    math.copysign: "with_sign_",
    np.copysign: "with_sign_",
    np.sign: "sign_of_",
    np.abs: "wp.abs",
    abs: "wp.abs",
    math.fabs: "wp.abs",
    math.pow: "wp.pow",
    min: "wp.min",
    max: "wp.max",
    np.minimum: "wp.min",
    np.maximum: "wp.max",
}
OF_WHOLE = ("wp.min", "wp.max", "wp.abs")  # functions that map integers to integers
OF_TWO = ("wp.min", "wp.max")  # functions of two arguments in Warp, of any number in Python
CASTS: Mapping[Any, Kind] = {
    float: REAL,
    np.float64: REAL,
    int: WHOLE,
    np.int64: WHOLE,
    np.uint64: BITS,
    bool: TRUTH,
}
OPERATORS: Mapping[type[ast.AST], str] = {
    ast.Add: "+",
    ast.Sub: "-",
    ast.Mult: "*",
    ast.Div: "/",
    ast.Pow: "**",
    ast.Mod: "%",
    ast.FloorDiv: "//",
    ast.BitXor: "^",
    ast.BitAnd: "&",
    ast.BitOr: "|",
    ast.LShift: "<<",
    ast.RShift: ">>",
    ast.Lt: "<",
    ast.LtE: "<=",
    ast.Gt: ">",
    ast.GtE: ">=",
    ast.Eq: "==",
    ast.NotEq: "!=",
    ast.And: "and",
    ast.Or: "or",
    ast.USub: "-",
    ast.UAdd: "+",
    ast.Not: "not",
}
OF_TRUTHS = {"&": "and", "|": "or"}  # operators of two bools
OF_WHOLES = {"%": "remainder_", "//": "quotient_"}  # of integers, rounded down as in Python
RESERVED = ("T", "wp", "int", "float", "bool", "range", "lambda")


def unreserved_name(name: str) -> str:
    """Return a variable's name with an underscore appended if the name is reserved in Warp."""
    return f"{name}_" if name in RESERVED else name
