"""Mutants of the compiled planner, run uncompiled, each in a process forked from one that has loaded all but it.

`python -m tests.mutation.forking` lists the mutants that no check notices; with names of modules, of these alone. The
checks are those of tests/optimized that fit into a few seconds: random small questions and fleets to which robots are
added, whose answers by the reference are known before the first fork; crowds; and test_replanning.py and
test_reuse.py. Beside a mutant that survives stands how many queries it asks of the fleets, where it asks other ones:
more cost time alone, fewer want a reason. The check that noticed the last mutants is the first that the next one has to
pass. Starting pytest and numba for each mutant would take ten times as long.
"""

import os
import resource
import signal
import struct
import sys
import warnings
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from difflib import ndiff
from functools import partial
from importlib import import_module
from importlib.abc import Loader, MetaPathFinder
from importlib.machinery import ModuleSpec
from importlib.util import spec_from_loader
from itertools import product
from mmap import mmap
from pathlib import Path
from types import ModuleType
from typing import TypeAlias

os.environ["NUMBA_DISABLE_JIT"] = "1"  # numba looks when it is loaded
os.environ["HYPOTHESIS_PROFILE"] = "mutation"

import numpy as np
import tests.conftest  # noqa: F401 - the profile
from cosmic_ray.commands.init import _all_work_items
from cosmic_ray.mutating import mutate_code
from cosmic_ray.plugins import get_operator
from tests.optimized.arrivals import Arrivals, arrivals, convoy, scaled
from tests.optimized.towns import TOWNS

import carp_reference
from carp_experiments.small_questions import question
from carp_spec import Instance, Neighbourhood, Planner, Solution

ROOT = Path(__file__).parents[2]
FOLDER = ROOT / "optimized" / "carp_optimized"
MODULES = ("replanning", "order_search", "answers", "neighbourhood", "orders", "distances", "passes", "windows")
LEFT_OUT = ("_BitAnd", "_BitOr", "_BitXor", "_Div", "_FloorDiv", "_LShift", "_Mod", "_Pow", "_RShift", "_Is", "_IsNot")
QUESTIONS = 150
FLEETS = (*range(120), 157, 202, 209, 307, 330, 381, 435, 466, 596, 935)  # the last ones notice what others do not
CONVOYS = 10
SECONDS = 4  # of the processor, for one case
BYTES = 4 << 30
KINDS = ("kept", "unchanged", "prefixes", "shared", "bounds")
CHOICES = list(product((True, False), repeat=len(KINDS)))
TESTS: Sequence[tuple[str, str, tuple[object, ...]]] = (
    *(("test_replanned_robots", "test_the_robots_behind_get_the_plans_of_the_reference", (name,)) for name in TOWNS),
    (
        "test_replanned_robots",
        "test_a_plan_alone_is_not_taken_over_from_before_a_round_that_left_a_robot_outside_without_a_plan",
        (),
    ),
    ("test_replanned_robots", "test_orders_are_drawn_in_a_round_too_in_which_a_member_has_no_plan", ()),
    ("test_same_plans", "test_crowds_are_planned_alike", ()),
    ("test_replanning", "test_a_query_is_repeated_only_where_the_lemma_says_and_else_finds_the_same", ()),
    ("test_reuse", "test_orders_that_begin_alike_share_the_queries_of_their_beginning", (4, 64, 96)),
    ("test_reuse", "test_without_reuse_every_query_is_asked", ()),
    *(("test_reuse", "test_each_kind_avoids_queries_and_counts_them", (kind,)) for kind in KINDS),
    ("test_reuse", "test_sampled_orders_share_their_beginnings_too", ()),
)


@dataclass(frozen=True, slots=True)
class Mutant:
    """One change of one module."""

    module: str
    operator: str
    occurrence: int
    line: int

    def source(self, original: str) -> str | None:
        """The changed source."""
        mutated: str | None = mutate_code(original, get_operator(self.operator)(), self.occurrence)
        return mutated

    def change(self, original: str) -> str:
        """The lines that differ, on one line."""
        lines = ndiff(original.splitlines(), (self.source(original) or "").splitlines())
        return "  ".join(" ".join(line.split()) for line in lines if line[0] in "+-")


class Changed(MetaPathFinder, Loader):
    """Loads a module from another source than its file."""

    def __init__(self, name: str, source: str) -> None:
        self.name, self.source = name, source

    def find_spec(self, name: str, path: object, target: object = None) -> ModuleSpec | None:
        del path, target
        return spec_from_loader(name, self) if name == self.name else None

    def exec_module(self, module: ModuleType) -> None:
        module.__file__ = str(FOLDER / f"{self.name.rpartition('.')[2]}.py")
        exec(compile(self.source, module.__file__, "exec"), module.__dict__)  # noqa: S102 - a mutant is to be run


def mutants(module: str) -> Iterator[Mutant]:
    for item in _all_work_items([FOLDER / f"{module}.py"], {}):
        for each in item.mutations:
            if not each.operator_name.endswith(LEFT_OUT) and "BitOr_" not in each.operator_name:
                yield Mutant(module, each.operator_name, each.occurrence, each.start_pos[0])


Case: TypeAlias = Callable[[], int]


def cases() -> list[Case]:
    """What a right planner passes, with the reference's answers; each loads the planner, and counts queries asked."""
    asked: list[Case] = []
    for number in range(QUESTIONS):
        subject, planner = question(1, number)
        expected = ask(carp_reference.plan, carp_reference.add, subject, planner)
        choices = {CHOICES[0], CHOICES[number % len(CHOICES)]} if isinstance(planner, Neighbourhood) else {CHOICES[0]}
        asked += [partial(ask_question, subject, planner, choice, expected) for choice in choices]
    fleets = (*map(arrivals, FLEETS), *map(convoy, range(CONVOYS)), *(scaled(arrivals(k), 2**26, 1) for k in range(5)))
    return [*asked, *(partial(ask_fleet, fleet, fleet.by_reference()) for fleet in fleets), *map(as_case, TESTS)]


def ask_question(subject: object, planner: Planner, choice: Sequence[bool], expected: Solution) -> int:
    import carp_optimized
    from carp_optimized import Reuse

    reuse = Reuse(*choice)
    plan, add = partial(carp_optimized.plan, reuse=reuse), partial(carp_optimized.add, reuse=reuse)
    assert ask(plan, add, subject, planner) == expected
    return 0


def ask_fleet(fleet: Arrivals, expected: Solution) -> int:
    solution, queries = fleet.by_fleet()
    assert solution == expected
    return queries.asked


def as_case(test: tuple[str, str, tuple[object, ...]]) -> Case:
    """A test of a module of tests/optimized, called with arguments."""
    module, name, arguments = test

    def case() -> int:
        getattr(import_module(f"tests.optimized.{module}"), name)(*arguments)
        return 0

    return case


def ask(plan: Callable[..., Solution], add: Callable[..., Solution], subject: object, planner: Planner) -> Solution:
    if isinstance(subject, Instance):
        return plan(subject, planner)
    fleet = subject
    return add(fleet.instance, fleet.solution, fleet.robot, fleet.now, planner)  # type: ignore[attr-defined]


def asked_by(mutant: Mutant | None, cases: list[Case]) -> int | None:
    """How many queries are asked of the fleets, `None` if a case notices the mutant; in a process of its own.

    The case that notices it goes to the front.
    """
    place = mmap(-1, 1 << 12)
    child = os.fork()
    if child:
        is_noticed = os.waitpid(child, 0)[1] != 0
        number, asked = struct.unpack_from("qq", place)
        place.close()
        if is_noticed:
            cases.insert(0, cases.pop(number))
        return None if is_noticed else asked
    try:
        resource.setrlimit(resource.RLIMIT_AS, (BYTES, BYTES))
        sys.stderr = sys.stdout = Path(os.devnull).open("w", encoding="utf-8")  # noqa: SIM115 - until the end
        for name in [name for name in sys.modules if name.startswith(("carp_optimized", "tests.optimized.test_"))]:
            del sys.modules[name]
        if mutant is not None:
            source = mutant.source((FOLDER / f"{mutant.module}.py").read_text(encoding="utf-8"))
            sys.meta_path.insert(0, Changed(f"carp_optimized.{mutant.module}", source or ""))
        asked = 0
        for number, case in enumerate(cases):
            struct.pack_into("qq", place, 0, number, asked)
            signal.setitimer(signal.ITIMER_PROF, SECONDS)
            asked += case()
        struct.pack_into("qq", place, 0, 0, asked)
        os._exit(0)
    finally:
        os._exit(1)


def main(names: Sequence[str]) -> int:
    warnings.simplefilter("ignore")
    np.seterr(all="ignore")
    all_cases = cases()
    usual = asked_by(None, all_cases)
    if usual is None:
        sys.exit("the planner fails the checks without any mutation")
    count = survivors = 0
    for module in names or MODULES:
        original = (FOLDER / f"{module}.py").read_text(encoding="utf-8")
        for mutant in mutants(module):
            count += 1
            asked = asked_by(mutant, all_cases)
            if asked is not None:
                survivors += 1
                queries = "" if asked == usual else f"  ({asked - usual:+} queries)"
                print(f"{module}:{mutant.line}  {mutant.change(original)}{queries}", flush=True)  # noqa: T201 - a report
    print(f"{survivors} of {count} mutants survived")  # noqa: T201
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
