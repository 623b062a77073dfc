"""The planner to read: windows, the CARP query, the neighbourhood planner and the baselines."""

from carp_reference.execution import retime
from carp_reference.planners import add, assign, certifier, find, plan, query
from carp_reference.polish import polish

__all__ = ["add", "assign", "certifier", "find", "plan", "polish", "query", "retime"]
