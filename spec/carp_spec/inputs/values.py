"""Instances and plans.

`Instance.sound` is empty until the instance is known to be right. From then on it has the plans last known to break no
rule together, the empty ones first.
"""

from collections.abc import Sequence
from typing import Any, cast

from carp_spec.inputs.shapes import require_shape
from carp_spec.instance_rules import instance_faults
from carp_spec.model import Instance, Plan
from carp_spec.refusal import Refusal


def require_instance(instance: Instance) -> None:
    """Raise `Refusal` with the first fault, unless the instance is known to be right."""
    if type(instance) is not Instance or not instance.sound:
        require_shape(instance, Instance)
        for fault in instance_faults(instance):
            raise Refusal("document", fault.path, fault.rule, fault.message)
        instance.sound.append(())


def require_plans(plans: Sequence[Plan], path: str = "$.plans") -> tuple[Plan, ...]:
    """The plans of any sequence; raises `Refusal` if it has something else."""
    found: Any = plans
    if isinstance(found, Sequence):
        found = tuple(found)
    require_shape(found, tuple[Plan, ...], path)
    return cast("tuple[Plan, ...]", found)


def require_known(instance: Instance, plans: Sequence[Plan], path: str = "$.plans") -> None:
    """Raise `Refusal` for a plan of a robot that the instance does not have."""
    for place, plan in enumerate(plans):
        if plan.robot not in instance.robot:
            raise Refusal("request", f"{path}[{place}]", "solution/covers", "the instance has no such robot")
