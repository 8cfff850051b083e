"""The configuration of a diagnosis: the settings of each stage, with unit and reason."""

from boatsim.diagnosis.config.answer import AnswerConfig
from boatsim.diagnosis.config.checks import ChecksConfig
from boatsim.diagnosis.config.decide import DecideConfig
from boatsim.diagnosis.config.describe import DescribeConfig
from boatsim.diagnosis.config.diagnosis import (
    DEFAULT,
    DiagnosisConfig,
    Given,
    Plain,
    from_settings,
    settings_by_name,
)
from boatsim.diagnosis.config.filter import FilterConfig
from boatsim.diagnosis.config.fit import FitConfig
from boatsim.diagnosis.config.load import LoadConfig
from boatsim.diagnosis.config.locate import LocateConfig
from boatsim.diagnosis.config.plan import PlanConfig
from boatsim.diagnosis.config.select import SelectConfig
from boatsim.diagnosis.config.setting import Number, setting
from boatsim.diagnosis.config.validate import ValidateConfig

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
    "Number",
    "Plain",
    "PlanConfig",
    "SelectConfig",
    "ValidateConfig",
    "from_settings",
    "setting",
    "settings_by_name",
]
