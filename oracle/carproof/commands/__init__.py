"""The commands, one per module; a module is loaded when its command is used.

To add one, write the module and put its name into a group here. A `-` in a command's name is a `_` in its module's.
Another package adds a command by an entry point of the group `carproof.commands`, as `carp_experiments` does.
"""

from collections.abc import Mapping

GROUPS: Mapping[str, tuple[str, ...]] = {
    "Check": ("check", "audit", "conform", "view", "rules"),
    "Plan": ("plan", "add", "query", "polish", "generate", "convert"),
    "Prove": ("optimum", "verify-proof", "bound", "verify-bound", "verify-query", "certify", "theorems"),
    "Execute": ("check-trace", "dependencies", "execute", "retime", "untangle", "give-way"),
    "Compare": ("gap", "crosscheck", "bench"),
    "Run": ("demo", "serve", "warm"),
}
"""The commands by purpose, in the order in which help lists them."""

COMMANDS = tuple(name for names in GROUPS.values() for name in names)
