"""Drawing random instances and broken solutions, for tests of planners."""
