"""C source of operators and functions of Python, `math` and numpy that laws use."""

import ast
import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from boatsim.physics.native.kinds import BITS, REAL, TRUTH, WHOLE, Scalar

ALIKE = ("cos", "sin", "tan", "exp", "log", "sqrt", "tanh", "sinh", "cosh", "floor", "ceil")
MATH: Mapping[Any, str] = {
    **{getattr(source, name): name for source in (math, np) for name in ALIKE},
    **{
        getattr(math, name): name for name in ("atan2", "acos", "asin", "atan", "hypot", "copysign")
    },
    math.degrees: "degrees_of",
    math.radians: "radians_of",
    np.rint: "rint",
    math.fabs: "fabs",
    math.pow: "pow",
    np.arctan2: "atan2",
    np.hypot: "hypot",
    np.copysign: "copysign",
    np.sign: "sign_of",
    np.minimum: "lesser",
    np.maximum: "greater",
}
WHOLE_RESULT = (math.floor, math.ceil)  # of which Python returns an integer
CASTS: Mapping[Any, Scalar] = {
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
    ast.And: "&&",
    ast.Or: "||",
    ast.USub: "-",
    ast.UAdd: "+",
}
