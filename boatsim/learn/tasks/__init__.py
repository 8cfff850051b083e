"""Tasks for a learner, one a file: where an episode begins, what is seen, what is rewarded, when it ends."""
