"""Open-set decision: how likely a name is right, given that the cause may not be a candidate."""
