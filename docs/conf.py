"""The site: `python -m sphinx -W --keep-going -n docs docs/_build`."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent / "_ext"))

project = "boatsim"
author = "the authors of boatsim"
extensions = ["myst_parser", "reference", "tutorial"]
exclude_patterns = ["_build"]
nitpicky = True
highlight_language = "text"  # of blocks without a language: what commands print
html_theme = "furo"
html_title = "boatsim"
html_static_path, html_css_files = ["_static"], ["site.css"]
html_copy_source = False
html_show_copyright = False
pygments_style, pygments_dark_style = "friendly", "monokai"
myst_heading_anchors = 3
