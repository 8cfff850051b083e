"""Access of the tests to the Sphinx extensions in docs/_ext, which are not a package."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1] / "docs" / "_ext"))

import effect_cases as effect_cases  # noqa: E402
import effect_examples as effect_examples  # noqa: E402
import grade_table as grade_table  # noqa: E402
import page_commands as page_commands  # noqa: E402
import reference as reference  # noqa: E402
import results_charts as results_charts  # noqa: E402
from page_commands import MARK as MARK  # noqa: E402
from page_commands import ROOT as ROOT  # noqa: E402
from page_commands import blocks as blocks  # noqa: E402
from page_commands import environment_of_new_user as environment_of_new_user  # noqa: E402
from page_commands import failures as failures  # noqa: E402
from page_commands import figures as figures  # noqa: E402
from page_commands import figures_agree as figures_agree  # noqa: E402
from page_commands import first_difference as first_difference  # noqa: E402
