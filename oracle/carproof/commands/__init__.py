"""The commands, one per module; a module is loaded when its command is used.

To add one, write the module and put it under a heading here. Another package adds a command by an entry point of the
group `carproof.commands`, as `carp_experiments` does.
"""

from collections.abc import Mapping

HERE = __name__
SECTIONS: Mapping[str, Mapping[str, str]] = {
    "Judge plans": {
        "check": f"{HERE}.judge.check",
        "check-log": f"{HERE}.judge.check_log",
        "audit": f"{HERE}.judge.audit",
        "verify": f"{HERE}.judge.verify",
        "view": f"{HERE}.judge.view",
        "rules": f"{HERE}.judge.rules",
        "theorems": f"{HERE}.judge.theorems",
    },
    "Test a planner": {"conform": f"{HERE}.judge.conform", "serve": f"{HERE}.run.serve"},
    "Plan": {
        "plan": f"{HERE}.plan.plan",
        "add": f"{HERE}.plan.add",
        "assign": f"{HERE}.plan.assign",
        "query": f"{HERE}.plan.query",
        "polish": f"{HERE}.plan.polish",
    },
    "Tell the best possible": {
        "bound": f"{HERE}.plan.bound",
        "optimum": f"{HERE}.plan.optimum",
        "gap": f"{HERE}.plan.gap",
    },
    "Late robots": {"execution": f"{HERE}.execution.group", "release": f"{HERE}.execution.release"},
    "Make instances": {"generate": f"{HERE}.run.generate", "convert": f"{HERE}.run.convert"},
    "Start and measure": {"demo": f"{HERE}.run.demo", "warm": f"{HERE}.run.warm"},
}
"""The modules of the commands by purpose, in the order in which help lists them."""

EXECUTION: Mapping[str, str] = {
    "simulate": f"{HERE}.execution.simulate",
    "check": f"{HERE}.execution.check",
    "dependencies": f"{HERE}.execution.dependencies",
    "retime": f"{HERE}.execution.retime",
    "untangle": f"{HERE}.execution.untangle",
    "give-way": f"{HERE}.execution.give_way",
}
"""The modules of the commands of `carproof execution`."""

RENAMED: Mapping[str, tuple[str, ...]] = {
    "verify-bound": ("verify",),
    "verify-query": ("verify",),
    "verify-proof": ("verify",),
    "certify": ("check", "--z3"),
    "check-trace": ("execution", "check"),
    "execute": ("execution", "simulate"),
    "dependencies": ("execution", "dependencies"),
    "retime": ("execution", "retime"),
    "untangle": ("execution", "untangle"),
    "give-way": ("execution", "give-way"),
    "bench": ("dev", "bench"),
    "crosscheck": ("dev", "crosscheck"),
}
"""Names of commands before 0.2, which keep working until 0.3."""

COMMANDS = tuple(name for names in SECTIONS.values() for name in names)
