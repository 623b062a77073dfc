"""The planner to read: windows, the CARP query, the neighbourhood planner and the baselines.

Read it in this order: `context`, `query`, `orderings`, `neighbourhood`, `polish`; then, as needed, `problem`,
`fixed_paths`, `time_expanded`, `reasons`, `planners`.
"""

from carp_reference.execution import retime
from carp_reference.planners import add, certifier, plan, query
from carp_reference.polish import polish
from carp_reference.reasons import why_unplanned

__all__ = ["add", "certifier", "plan", "polish", "query", "retime", "why_unplanned"]
