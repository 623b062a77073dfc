"""All rules of carproof: the specification's, then those of requests, formats and searches, with their codes."""

from typing import Any

from carp_spec import Rule
from carp_spec.limits import goals_stand_alone
from carp_spec.planners import ticks_are_held
from carp_verify.bound.rules import BOUND_RULES
from carp_verify.footprint.rules import FOOTPRINT_RULES
from carp_verify.kernel import KERNEL_RULES
from carp_verify.optimum.rules import OPTIMUM_RULES
from carp_verify.query.rules import QUERY_CERTIFICATE_RULES
from carp_verify.release.rules import RELEASE_RULES
from carproof.conform.findings import PROGRAM_RULES
from carproof.execution.simulation import delays_are_right
from carproof.extras import INSTALLED
from carproof.formats import ADAPTER_RULES
from carproof.formats.movingai import MOVINGAI_RULES
from carproof.generate.headings import CELLS_SIDE_BY_SIDE
from carproof.generate.options import GENERATE_RULES
from carproof.input_rules import Code
from carproof.layouts import LAYOUT_RULES
from carproof.protocol.lines import PROTOCOL_RULES
from carproof.protocol.ops.keeping import FLEET_RULES
from carproof.registry import RULES
from carproof.requests import REQUEST_RULES
from carproof.viewer.limits import VIEW_RULES

ALL_RULES: tuple[Rule[..., Any] | Code, ...] = (
    *RULES,
    ticks_are_held,
    goals_stand_alone,
    INSTALLED,
    *REQUEST_RULES,
    delays_are_right,
    *GENERATE_RULES,
    CELLS_SIDE_BY_SIDE,
    *MOVINGAI_RULES,
    *ADAPTER_RULES,
    *LAYOUT_RULES,
    *PROTOCOL_RULES,
    *FLEET_RULES,
    *PROGRAM_RULES,
    *VIEW_RULES,
    *OPTIMUM_RULES,
    *BOUND_RULES,
    *QUERY_CERTIFICATE_RULES,
    *FOOTPRINT_RULES,
    *RELEASE_RULES,
    *KERNEL_RULES,
)
