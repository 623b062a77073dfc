"""Robots that move a step a tick (classical MAPF): their paths by SIPP, and rounds of large neighbourhood search."""
