"""Better plans: repair of unplanned robots, large neighbourhood search, annealing, LaCAM."""
