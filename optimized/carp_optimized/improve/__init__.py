"""Plans that get better until the time is over."""
