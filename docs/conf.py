"""Configuration of the site: `python -m sphinx -W --keep-going -n docs docs/_build`."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent / "_ext"))

project = "boatsim"
author = "the authors of boatsim"
extensions = ["myst_parser", "reference", "tutorial", "sphinx.ext.autodoc", "sphinx.ext.napoleon"]
exclude_patterns = ["_build"]
nitpicky = True
# Types of libraries in signatures have no pages here.
nitpick_ignore_regex = [("py:.*", ".*")]
autodoc_typehints = "description"
autodoc_member_order = "bysource"
highlight_language = "text"  # for blocks without a language, which show printed output
html_theme = "furo"
html_title = "boatsim"
html_static_path = ["_static"]
html_css_files = ["site.css"]
html_copy_source = False
html_show_copyright = False
pygments_style = "friendly"
pygments_dark_style = "monokai"
myst_heading_anchors = 3
