"""Further sensors, which `[[sensor]]` in a scenario adds by name; one per file, named after it."""
