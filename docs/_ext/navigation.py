"""Sphinx extension that renders the side bar's tree of all pages once for the whole site.

Furo renders the tree for each page, which takes most of the time of a build with some hundred
pages. The trees of two pages differ only in relative addresses and in the marks of the current
page and of the pages above it. This extension puts the marks and addresses into a copy of one tree;
the result is the text that furo would have written.
"""

import re
from functools import cache
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from sphinx.application import Sphinx
    from sphinx.builders.html import StandaloneHTMLBuilder

ADDRESS = re.compile(r'(?<= href=")[^"#:]+(?=")')  # of a page, relative to the folder of the site
LEVEL = re.compile(r'<li class="toctree-l(\d+)')
CHILDREN = " has-children"  # class of items with a list in them
BEFORE_FURO, AFTER_FURO = 400, 600  # priorities of events; furo has Sphinx's default of 500
OUTSIDE = "search"  # page that is in no tree, in the folder of the site


def mark_current(tree: str, address: str) -> str:
    """Mark the entry of a page, and the entries above it, as furo does.

    Args:
        tree: Tree of a page that is not in it.
        address: Address of the page whose entry is marked, as it stands in the tree.

    Returns:
        The marked tree. If the page is not in it, the tree as it is.
    """
    link = tree.find(f' href="{address}">')
    if link < 0:
        return tree
    item = tree.rindex("<li ", 0, link)
    (level,) = LEVEL.match(tree, item).groups()  # type: ignore[union-attr]
    start = tree.index("<a ", item)
    tree = tree[:start] + tree[start:].replace('<a class="', '<a class="current ', 1)
    tree = _mark_item(tree, item, " current-page")
    for above in range(int(level) - 1, 0, -1):
        parent = tree.rindex(f'<li class="toctree-l{above}', 0, item)
        tree = _mark_list(tree, tree.index("<ul>", parent, item))
        tree = _mark_item(tree, parent, "")
        item = parent
    return _mark_list(tree, max(tree.rfind("\n<ul>", 0, item) + 1, 0))


def _mark_list(tree: str, start: int) -> str:
    """Mark the list that begins at an index."""
    return f'{tree[:start]}<ul class="current">{tree[start + len("<ul>") :]}'


def _mark_item(tree: str, start: int, further: str) -> str:
    """Mark the item that begins at an index, and open the list in it if it has one.

    Args:
        tree: The tree.
        start: Index of the item.
        further: Text of further classes of the item.
    """
    end = tree.index("</a>", start)
    classes, rest = tree[start:end].split('">', 1)
    rest += tree[end:]
    children = ""
    if classes.endswith(CHILDREN):
        children = CHILDREN
        rest = rest.replace(' class="toctree-checkbox"', ' checked="" class="toctree-checkbox"', 1)
    classes = f"{classes.removesuffix(CHILDREN)} current{children}{further}"
    return f'{tree[:start]}{classes}">{rest}'


@cache
def full_tree(builder: "StandaloneHTMLBuilder") -> str:
    """Return the tree as furo renders it for a page that is not in it."""
    from furo.navigation import get_navigation_tree
    from sphinx.environment.adapters.toctree import global_toctree_for_doc

    nodes = global_toctree_for_doc(
        builder.env,
        OUTSIDE,
        builder,
        tags=builder.tags,
        collapse=False,
        titles_only=True,
        maxdepth=-1,
        includehidden=True,
    )
    return get_navigation_tree(builder.render_partial(nodes)["fragment"])


def tree_of_page(builder: "StandaloneHTMLBuilder", page: str) -> str:
    """Return the tree in the side bar of a page.

    Args:
        builder: The builder of the site.
        page: Name of the page.
    """
    own = builder.get_target_uri(page)
    tree = mark_current(full_tree(builder), own)
    return ADDRESS.sub(lambda match: builder.get_relative_uri(page, match[0][:-5]) or "#", tree)


def before_furo(
    app: "Sphinx", page: str, template: str, context: dict[str, Any], doctree: object
) -> None:
    """Give furo an empty tree."""
    context["toctree_of_sphinx"] = context.get("toctree")
    context["toctree"] = lambda **options: ""


def after_furo(
    app: "Sphinx", page: str, template: str, context: dict[str, Any], doctree: object
) -> None:
    """Write the tree where furo's template expects it."""
    context["toctree"] = context.pop("toctree_of_sphinx")
    context["furo_navigation_tree"] = tree_of_page(app.builder, page)  # type: ignore[arg-type]


def setup(app: "Sphinx") -> dict[str, Any]:
    """Register both steps for the pages of the site."""
    app.connect("html-page-context", before_furo, priority=BEFORE_FURO)
    app.connect("html-page-context", after_furo, priority=AFTER_FURO)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
