"""Many runs of scenarios: grids and draws, in processes or on a cluster, one table of all of them."""
