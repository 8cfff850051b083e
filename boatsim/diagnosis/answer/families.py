"""Families of signals whose errors on held-out recordings are reported."""

from boatsim.diagnosis.answer.schema import Family

FAMILIES: dict[Family, tuple[str, str]] = {  # key of `fit` -> its signal in words, SI unit
    "position_rms_m": ("position", "m"),
    "heading_rms_rad": ("heading", "rad"),
    "roll_rms_rad": ("roll", "rad"),
    "heave_rms_m": ("heave", "m"),
}
