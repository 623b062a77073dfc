"""The state of a fleet as flat arrays of ints: what compiled functions read and write."""
