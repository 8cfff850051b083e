"""The same sea, loads and motions in boatsim and in other programs."""
