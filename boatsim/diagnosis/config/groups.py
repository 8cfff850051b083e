"""All settings of a diagnosis, by group and by dotted name."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import Field, dataclass, fields, replace
from math import isfinite
from typing import Any, TypeAlias

from boatsim.arguments import short_repr
from boatsim.diagnosis.config.answer import AnswerConfig
from boatsim.diagnosis.config.checks import ChecksConfig
from boatsim.diagnosis.config.decide import DecideConfig
from boatsim.diagnosis.config.describe import DescribeConfig
from boatsim.diagnosis.config.filter import FilterConfig
from boatsim.diagnosis.config.fit import FitConfig
from boatsim.diagnosis.config.load import LoadConfig
from boatsim.diagnosis.config.locate import LocateConfig
from boatsim.diagnosis.config.plan import PlanConfig
from boatsim.diagnosis.config.select import SelectConfig
from boatsim.diagnosis.config.setting import Number
from boatsim.diagnosis.config.simulate import SimulateConfig
from boatsim.diagnosis.config.validate import ValidateConfig
from boatsim.diagnosis.config.work import WorkConfig
from boatsim.errors import BadInput, unknown_name_message

Plain: TypeAlias = Number | list[Number]  # a setting as JSON has it
Given: TypeAlias = str | Number | Sequence[Number]  # a setting as a user may give it


@dataclass(frozen=True)
class DiagnosisConfig:
    """All settings of a diagnosis (thresholds, priors, tolerances, limits), grouped by stage.

    The groups `filter` and `locate` belong to methods that several stages use, and `work` to the
    whole diagnosis.
    """

    load: LoadConfig = LoadConfig()
    checks: ChecksConfig = ChecksConfig()
    fit: FitConfig = FitConfig()
    select: SelectConfig = SelectConfig()
    decide: DecideConfig = DecideConfig()
    describe: DescribeConfig = DescribeConfig()
    plan: PlanConfig = PlanConfig()
    simulate: SimulateConfig = SimulateConfig()
    validate: ValidateConfig = ValidateConfig()
    answer: AnswerConfig = AnswerConfig()
    filter: FilterConfig = FilterConfig()
    locate: LocateConfig = LocateConfig()
    work: WorkConfig = WorkConfig()


DEFAULT = DiagnosisConfig()


def from_settings(settings: Mapping[str, Given]) -> DiagnosisConfig:
    """Return the default configuration of a diagnosis with some settings changed.

    Args:
        settings: Values by dotted name, such as {"select.odds": 3.0}; text is read as a number.

    Raises:
        BadInput: A name does not exist, or a value has the wrong type or is out of range.
    """
    declared = {f"{group}.{one.name}": (group, one) for group, one in _all_settings()}
    config = DEFAULT
    for name, given in settings.items():
        if name not in declared:
            raise BadInput(unknown_name_message("setting", name, declared))
        group, one = declared[name]
        changed = replace(getattr(config, group), **{one.name: _check_value(name, one, given)})
        config = replace(config, **{group: changed})
    return config


def settings_by_name(config: DiagnosisConfig) -> dict[str, Plain]:
    """Return all settings of a diagnosis as a dictionary from dotted names to values.

    For example, "select.odds" is the key of the setting `odds` in the group `select`. Tuples become
    lists.
    """
    plain: dict[str, Plain] = {}
    for group, one in _all_settings():
        value = getattr(getattr(config, group), one.name)
        if isinstance(value, tuple):
            value = list(value)
        plain[f"{group}.{one.name}"] = value
    return plain


def _all_settings() -> Iterator[tuple[str, "Field[Any]"]]:
    """Yield the name of the group and the field of every setting."""
    for group in fields(DiagnosisConfig):
        for one in fields(getattr(DEFAULT, group.name)):
            yield group.name, one


def _check_value(name: str, one: "Field[Any]", given: Given) -> Number | tuple[Number, ...]:
    """Return a given value in the type of its setting. Raises BadInput."""
    if not isinstance(one.default, tuple):
        return _check_number(name, one, given)
    values: Sequence[str | Number]
    if isinstance(given, str):
        values = given.strip("[]()").split(",")
    elif isinstance(given, Sequence):
        values = given
    else:
        values = [given]
    if len(values) != len(one.default):
        needed = f"{len(one.default)} numbers are needed"
        raise BadInput(f"setting {name} = {short_repr(given)}: {needed}")
    return tuple(_check_number(name, one, value) for value in values)


def _check_number(name: str, one: "Field[Any]", given: object) -> Number:
    """Return a number of a setting in its type and range. Raises BadInput."""
    first = one.default[0] if isinstance(one.default, tuple) else one.default
    whole = isinstance(first, int)
    about = one.metadata
    allowed = f"{'an integer' if whole else 'a number'} from {about['low']:g} to {about['high']:g}"
    allowed = f"{allowed} [{about['unit']}]"
    refused = BadInput(f"setting {name} = {short_repr(given)}: allowed is {allowed}")
    if isinstance(given, bool) or not isinstance(given, str | int | float):
        raise refused
    try:
        value = float(given)
    except (ValueError, OverflowError):
        raise refused from None
    if not isfinite(value) or not about["low"] <= value <= about["high"]:
        raise refused
    if not whole:
        return value
    if value != int(value):
        raise refused
    return int(value)
