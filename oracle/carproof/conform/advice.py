"""One sentence of advice for a rule that a planner breaks."""

_ADVICE = {
    "joint/capacity": "Keep each resource for a robot up to the tick at which it leaves, also at its goal.",
    "joint/exchange": "Look at the moves of the robots before, not only at their places.",
    "plan/duration": "Let a robot stay as long as the resource's duration times its pace asks, also at its goal.",
    "plan/start": "Begin the first visit at the robot's start, at its release.",
    "plan/goal": "End at the goal: for ever where robots park, and after the goal's duration where they vanish.",
    "plan/move": "Follow edges only, in their direction if the graph is directed.",
    "plan/resource": "Name only resources of the instance; an id that is a number is another than its digits as text.",
    "plan/contiguous": "Enter each resource at the tick at which the one before is left.",
    "solution/covers": "List each robot once: with a plan, or as unplanned.",
    "query/complete": "Search all free windows of a resource, and waiting in each, before you give up.",
    "query/optimal": "Expand the earliest entry first, and let no later entry into a window replace an earlier one.",
    "query/ties": "Break ties as the rule says.",
    "fleet/history": "Keep what a robot has done by the tick of the request.",
    "program/complete": "Try other orders, or plan the robots in conflict together, before you leave one out.",
    "program/optimal": "Look for a cheaper order, or for plans in which robots make room for each other.",
    "program/alive": "Run the request again, and read the end of standard error.",
    "program/in-time": "Bound the search by a horizon: where no plan exists, it must end as well.",
    "program/response": "Write one line of JSON for each request, flush it, and write all else to standard error.",
    "program/result": "Compare the fields and their types with the schema of the op's result.",
    "program/accepts": "Answer what you do not offer by skipped, or leave the op out of start.",
}


def advice_for(rule: str) -> str:
    """What to look at first."""
    return _ADVICE.get(rule, f"carproof rules {rule} has the statement, its source and the function that decides.")
