"""Large fleets on mujoco_warp: the compiled program of a vessel written anew for Warp, on a GPU or on Warp's CPU device."""
