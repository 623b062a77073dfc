"""The planner to read: windows, the CARP query, the neighbourhood planner and the baselines.

Read it in this order: `problem`, `context`, `query`, `orderings`, `neighbourhood`, `polish`; then, as needed,
`fixed_paths`, `time_expanded`, `execution`, `certifying`, `planners`.
"""

from carp_reference.execution import retime
from carp_reference.planners import add, certifier, plan, query
from carp_reference.polish import polish

__all__ = ["add", "certifier", "plan", "polish", "query", "retime"]
