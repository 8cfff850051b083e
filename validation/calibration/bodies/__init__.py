"""Bodies whose vessel file lacks nothing, simulated without boatsim."""
