"""Plans of any instance, for programs that are no planners: orders for robots, and tables."""
