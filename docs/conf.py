"""Configuration of the site: `python -m sphinx -W --keep-going -n docs docs/_build`.

With `-D run_tutorials=1` the commands of the tutorials are run too, which takes minutes.
"""

import os
import sys
from pathlib import Path

# The plots evaluate laws of effects one by one, for which plain Python is faster than compiling.
os.environ.setdefault("BOATSIM_DEBUG", "1")
sys.path.insert(0, str(Path(__file__).parent / "_ext"))

project = "boatsim"
author = "the authors of boatsim"
extensions = [
    "myst_parser",
    "sphinx.ext.autodoc",
    "sphinx.ext.napoleon",
    "sphinx_copybutton",
    "mathml",
    "navigation",
    "reference",
    "contributing",
    "results_charts",
    "tutorial",
]
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
html_math_renderer = "mathml"
myst_enable_extensions = ["dollarmath"]
myst_heading_anchors = 3
copybutton_exclude = ".linenos, .gp, .go"
copybutton_selector = "div:not(.highlight-text) > div.highlight > pre"  # printed output has none
