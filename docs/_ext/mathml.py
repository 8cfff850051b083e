"""Sphinx extension that writes formulas as MathML, which browsers show without a script.

A page with formulas therefore needs no other server, also when it is read from a folder.
"""

from html import escape
from typing import Any

from docutils import nodes
from docutils.utils.math import MathError
from docutils.utils.math.latex2mathml import tex2mathml
from sphinx.application import Sphinx
from sphinx.util import logging

# The bar of an absolute value, which browsers would set apart like a relation.
BAR = '<mo stretchy="false">|</mo>'
CLOSE_BAR = '<mo stretchy="false" lspace="0" rspace="0">|</mo>'
log = logging.getLogger(__name__)


def convert(latex: str, node: nodes.Node, as_block: bool) -> str:
    """Return a formula as MathML; one that cannot be converted is a warning.

    Args:
        latex: The formula in LaTeX.
        node: Node of the formula, for the place of the warning.
        as_block: Whether the formula stands on lines of its own.
    """
    try:
        formula = str(tex2mathml(latex, as_block=as_block))
    except MathError as error:
        log.warning("formula %r: %s", latex, error, location=node)
        return f"<code>{escape(latex)}</code>"
    return formula.replace(BAR, CLOSE_BAR)


def visit_math(translator: Any, node: nodes.math) -> None:
    """Write a formula in a line of text."""
    translator.body.append(convert(node.astext(), node, as_block=False))
    raise nodes.SkipNode


def visit_math_block(translator: Any, node: nodes.math_block) -> None:
    """Write a formula on lines of its own."""
    formula = convert(node.astext(), node, as_block=True)
    translator.body.append(f'<div class="formula">{formula}</div>')
    raise nodes.SkipNode


def setup(app: Sphinx) -> dict[str, Any]:
    """Register the extension."""
    app.add_html_math_renderer("mathml", (visit_math, None), (visit_math_block, None))
    return {"parallel_read_safe": True}
