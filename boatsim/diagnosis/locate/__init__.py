"""Location of the missing force: axis, time and region of the state."""
