"""What a run is: a vessel in its water, steered, stepped and logged."""
