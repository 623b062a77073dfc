"""The libraries that a base installation lacks, and which extra of carproof installs each."""

from importlib.util import find_spec

from carp_spec.rule import DESIGN
from carproof.input_rules import Code

EXTRAS = {
    "defusedxml": ("defusedxml", "layouts"),
    "distributed": ("distributed", "experiments"),
    "fpdf": ("fpdf2", "experiments"),
    "highspy": ("highspy", "prove"),
    "hypothesis": ("hypothesis", "test"),
    "joblib": ("joblib", "experiments"),
    "markdown": ("Markdown", "experiments"),
    "matplotlib": ("matplotlib", "experiments"),
    "pysat": ("python-sat", "prove"),
    "z3": ("z3-solver", "prove"),
}
"""By module: the distribution that has it, and the extra."""


INSTALLED = Code(
    "limit/extra",
    "The libraries that an op needs are installed; an extra of carproof brings those of some ops.",
    DESIGN,
)


def advice(error: ModuleNotFoundError) -> str | None:
    """Advice for a missing module, as the end of a sentence; `None` if no extra has it."""
    module = (error.name or "").partition(".")[0]
    if module not in EXTRAS:
        return None
    distribution, extra = EXTRAS[module]
    return f"needs {distribution} of the extra {extra}: run pip install '.[{extra}]' in a copy of carproof"


def require(*modules: str) -> None:
    """Raise `ModuleNotFoundError` before long work that would end with it."""
    for module in modules:
        if find_spec(module) is None:
            missing = ModuleNotFoundError(name=module)
            raise ModuleNotFoundError(f"carproof {advice(missing)}", name=module)
