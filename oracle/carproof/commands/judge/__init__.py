"""Commands that judge plans and planners, and explain the rules."""
