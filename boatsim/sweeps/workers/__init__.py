"""Who carries out the tasks of a campaign, one way a file."""
