"""Where the missing force is: axis, time, region of the state."""
