"""Lower bounds: their rules, and the checker of their certificates."""
