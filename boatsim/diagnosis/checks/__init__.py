"""Quality checks of a log, made before a mismatch is attributed to the vessel."""
