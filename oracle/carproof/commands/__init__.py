"""The commands, one a module; its `command` is loaded when somebody asks for it.

To add one, write the module and its name here. A `-` in a command's name is a `_` in its module's. A package of its own
adds a command by an entry point of the group `carproof.commands`, as `carp_experiments` does.
"""

COMMANDS = (
    "demo",
    "plan",
    "add",
    "polish",
    "query",
    "check",
    "view",
    "generate",
    "convert",
    "serve",
    "certify",
    "theorems",
    "conform",
    "optimum",
    "verify-proof",
    "bound",
    "verify-bound",
    "verify-query",
    "check-trace",
    "dependencies",
    "execute",
    "retime",
    "untangle",
    "give-way",
    "audit",
    "gap",
    "crosscheck",
    "bench",
    "warm",
    "rules",
)
