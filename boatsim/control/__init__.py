"""Blocks that controllers are made of: plain numbers, no knowledge of the simulator."""
