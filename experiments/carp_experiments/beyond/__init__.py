"""Experiments on what the paper leaves out: late robots, people, streams, polish."""
