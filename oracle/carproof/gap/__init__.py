"""The distance of planners from the optimum, over families of instances."""
