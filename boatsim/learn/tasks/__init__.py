"""Tasks of a learner, one in each file: start, observations, reward and end of an episode."""
