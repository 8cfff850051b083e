"""The configuration of a diagnosis: all thresholds, priors, tolerances and limits of its stages.

A `DiagnosisConfig` holds frozen groups of settings, named after the stages of
`boatsim.diagnosis.pipeline`: load, check (`checks`), fit, select, decide, describe, plan, adopt,
simulate, validate and answer. The stage adopt has no group; it uses `fit.undetermined_sd` and
`validate.harmful`. The groups `filter` and `locate` belong to methods that several stages use, and
`work` to the whole diagnosis.

Each setting has a default, a unit and the reason for its value. Users change settings by their
dotted names, such as `select.odds`: with `boatsim diagnose --set`, or with the argument `settings`
of `boatsim.diagnose`. The values used are written into diagnosis.json. Numbers that only guard
against rounding, define a unit or describe a format stay in the modules that use them.
"""

from boatsim.diagnosis.config.answer import AnswerConfig
from boatsim.diagnosis.config.checks import ChecksConfig
from boatsim.diagnosis.config.decide import DecideConfig
from boatsim.diagnosis.config.describe import DescribeConfig
from boatsim.diagnosis.config.filter import FilterConfig
from boatsim.diagnosis.config.fit import FitConfig
from boatsim.diagnosis.config.groups import (
    DEFAULT,
    DiagnosisConfig,
    Given,
    Plain,
    from_settings,
    settings_by_name,
)
from boatsim.diagnosis.config.load import LoadConfig
from boatsim.diagnosis.config.locate import LocateConfig
from boatsim.diagnosis.config.plan import PlanConfig
from boatsim.diagnosis.config.select import SelectConfig
from boatsim.diagnosis.config.simulate import SimulateConfig
from boatsim.diagnosis.config.validate import ValidateConfig
from boatsim.diagnosis.config.work import WorkConfig

__all__ = [
    "AnswerConfig",
    "ChecksConfig",
    "DEFAULT",
    "DecideConfig",
    "DescribeConfig",
    "DiagnosisConfig",
    "FilterConfig",
    "FitConfig",
    "Given",
    "LoadConfig",
    "LocateConfig",
    "Plain",
    "PlanConfig",
    "SelectConfig",
    "SimulateConfig",
    "ValidateConfig",
    "WorkConfig",
    "from_settings",
    "settings_by_name",
]
