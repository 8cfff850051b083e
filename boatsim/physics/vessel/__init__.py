"""Vessels: file schema, the `Vessel` dataclass, its channel bindings, and loading."""

from boatsim.physics.vessel.bindings import check_bindings
from boatsim.physics.vessel.effect_tables import (
    effect_from_table,
    effect_name,
    with_absolute_paths,
)
from boatsim.physics.vessel.estimated import estimated_number_sd, sd_of_corrected_estimates
from boatsim.physics.vessel.loading import load_vessel, merge_load_conditions, with_effect_tables
from boatsim.physics.vessel.loads import apply_load_values
from boatsim.physics.vessel.model import Vessel
from boatsim.physics.vessel.schema import (
    Body,
    CommandChannel,
    DiagnosisTable,
    ManoeuvringTable,
    MeasuredChannel,
    VesselFile,
)

__all__ = [
    "Body",
    "CommandChannel",
    "DiagnosisTable",
    "ManoeuvringTable",
    "MeasuredChannel",
    "Vessel",
    "VesselFile",
    "check_bindings",
    "effect_from_table",
    "effect_name",
    "with_absolute_paths",
    "load_vessel",
    "merge_load_conditions",
    "estimated_number_sd",
    "apply_load_values",
    "sd_of_corrected_estimates",
    "with_effect_tables",
]
