"""The neighbourhood planner: a robot is planned with its nearest in all orders, asking few queries."""
