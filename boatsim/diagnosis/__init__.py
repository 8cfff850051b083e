"""When a simulation and a recording differ: where, what physics was left out, and what a model of it gains."""
