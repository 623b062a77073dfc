"""Plans that get better until the time is over, for robots that move a step a tick (classical MAPF)."""
