"""Lagrangian relaxation: prices of resources at ticks, and the cheapest path of each robot under them."""
