"""Output-error method: parameters and effects that make simulations follow the recordings."""
