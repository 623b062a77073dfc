"""Dense instances: branching over first moves, with a bound by prices for each part."""
