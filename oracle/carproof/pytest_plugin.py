"""The pytest fixture `carproof`, with which a project tests a planner of its own.

    def test_my_planner_is_sound(carproof):
        carproof.conforms(my_planner, level="sound")

pytest loads this module whenever it starts; the modules that judge planners are loaded by the first test that does.
"""

import re
import shlex
from collections.abc import Callable, Collection
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

from carproof.conform.levels import EXAMPLES, LARGE_SECONDS

if TYPE_CHECKING:
    from carp_spec import Instance, Solution
    from carproof.conform.python import LevelName
    from carproof.conform.run import Report

FOLDER = "conform-failure"


class Conformance:
    """Judges planners for a test, and saves failing cases into its folder."""

    def __init__(self, folder: Path, test: str) -> None:
        self._folder = folder
        self._test = test

    def conforms(  # noqa: PLR0913 - the options of the command
        self,
        planner: "Callable[[Instance], Solution] | Callable[[dict[str, Any]], dict[str, Any]]",
        level: "LevelName" = "sound",
        examples: int = EXAMPLES,
        seed: int = 0,
        documents: bool = False,
        *,
        without: Collection[str] = (),
        solvable: bool = False,
        groups: bool = False,
        stops: bool = False,
        large: float = LARGE_SECONDS,
    ) -> None:
        """Fail the test if the planner does not conform to the level.

        The planner takes a `carp_spec.Instance` and returns a `carp_spec.Solution`; with `documents=True` it takes and
        returns the documents, as dictionaries. `without` names features that it is not asked, like `carproof conform
        --without`. With `solvable=True` all robots can have plans. Only with `groups=True` instances have groups, and
        only with `stops=True` robots have several stops or service. For `large` seconds it is also asked about 10 to
        1,000 robots; no other time limits it.
        """
        __tracebackhide__ = True
        from click import ClickException  # noqa: PLC0415 - only a test that judges loads these

        from carp_spec import Refusal  # noqa: PLC0415
        from carproof.conform.python import conforms  # noqa: PLC0415
        from carproof.conform.reporting.saved import own_folder, read_saved, save_all  # noqa: PLC0415
        from carproof.conform.reporting.saving import Origin  # noqa: PLC0415
        from carproof.extras import advice  # noqa: PLC0415

        name = getattr(planner, "__name__", type(planner).__name__)
        origin = Origin(f"{name} at level {level}", shlex.join(["pytest", self._test]))
        folder = own_folder(self._folder, name, origin.judged)
        before = read_saved(folder, whole=True)
        if before.stale is not None:
            print(before.stale)  # noqa: T201 - pytest shows it
        asked = (level, examples, seed, documents)
        try:
            claims: dict[str, Any] = {"without": without, "solvable": solvable, "groups": groups, "stops": stops}
            report = conforms(planner, *asked, **claims, large=large, saved=before.cases)
        except ModuleNotFoundError as error:
            raise pytest.fail.Exception(f"carproof.conforms {advice(error) or error}", pytrace=False) from None
        except Refusal as refusal:
            raise pytest.fail.Exception(str(refusal), pytrace=False) from None
        if report.interrupted:
            raise KeyboardInterrupt
        try:
            save_all(report.failures, folder, origin, before.not_asked(report.outcomes))
        except ClickException as error:
            print(f"Nothing is saved: {error.message}")  # noqa: T201 - pytest shows it
        if not report.conforms:
            pytest.fail(_told(report, folder), pytrace=False)


def _told(report: "Report", folder: Path) -> str:
    """The finding, the size of the instance, and the folder in which it was saved."""
    from carproof.command_line.tables import counted  # noqa: PLC0415
    from carproof.conform.reporting.saving import picture_of  # noqa: PLC0415

    level = report.options.level
    verdict = "is not shown to" if report.conforms is None else "does not"
    head = f"{report.program} {verdict} conform to level {level.label}: {level.statement}"
    if not report.failures:
        reasons = [*(fault.message for fault in report.faults), *report.shortfalls]
        return "\n".join([head, *(reasons or ["no random case decided it"])])
    smallest, *others = report.failures
    finding, instance = smallest.fault, smallest.case.instance
    size = f"{counted(len(instance.robots), 'robot')} and {counted(len(instance.graph.resources), 'resource')}"
    lines = [
        head,
        f"{finding.category}: {finding.message} [{finding.rule}]",
        f"on an instance of {size}, saved in {folder}" + (f", with {len(others)} more" if others else ""),
        *(f"  {robot}" for robot in instance.robots),
        picture_of(smallest),
        finding.stderr,
    ]
    return "\n".join(lines).rstrip()


@pytest.fixture
def carproof(request: pytest.FixtureRequest) -> Conformance:
    """Judge planners: `carproof.conforms(planner, level="sound", examples=200, seed=0)`."""
    test = re.sub(r"[^\w.-]+", "-", request.node.name).strip("-")
    return Conformance(request.config.rootpath / FOLDER / test, request.node.nodeid)
