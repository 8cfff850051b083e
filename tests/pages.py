"""What docs/_ext knows of the pages, for the tests: it lies beside the pages because Sphinx loads it from there."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1] / "docs" / "_ext"))

import reference as reference  # noqa: E402
from shown import MARK as MARK  # noqa: E402
from shown import ROOT as ROOT  # noqa: E402
from shown import blocks as blocks  # noqa: E402
from shown import difference as difference  # noqa: E402
from shown import numbers as numbers  # noqa: E402
from shown import same as same  # noqa: E402
from shown import wrong as wrong  # noqa: E402
