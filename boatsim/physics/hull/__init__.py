"""Closed meshes of hulls: submerged part, equilibrium on still water, and panels of laws."""
