"""A base installation does what checking and planning need; a command whose extra is missing names it."""

import json
import re
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest
from tests.oracle.running import TWO, line

from carproof.extras import EXTRAS

ROOT = Path(__file__).parents[3]
WITHOUT_EXTRAS = f"import sys\nsys.modules.update(dict.fromkeys({[*EXTRAS]}))\n"
COMMAND = "from carproof.entry.cli import main\nsys.exit(main(sys.argv[1:]))"
COMMANDS = (
    "import json\nfrom carproof.entry.cli import main\nprint(any([main(each) for each in json.loads(sys.argv[1])]))"
)
FINDS = {
    "check --z3 town.json plans.json": "z3-solver",
    "theorems": "z3-solver",
    "convert plant.xml": "defusedxml",
    "verify .": "z3-solver",
    "optimum town.json": "python-sat",
    "bound town.json": "python-sat",
    "gap town.json": "python-sat",
    f"conform --level complete -- {sys.executable} -m carproof serve": "python-sat",
    "experiment quality --quick": "joblib",
}
DEPOT = ROOT / "oracle/carproof/examples/depot"
BASE = [
    "--help",
    "plan town.json -o made.json",
    "plan town.json --engine reference -o made.json",
    "check town.json plans.json",
    "add town.json one.json r2 -o added.json",
    "polish town.json plans.json --iterations 10 -o polished.json",
    "query town.json plans.json r1 --certificate r1.json",
    "verify town.json plans.json r1.json",
    "audit town.json plans.json",
    "view town.json plans.json -o view.html",
    "generate grid --width 3 --height 3 --robots 2 -o grid.json",
    f"convert {DEPOT}.map {DEPOT}.scen -o depot.json",
    "rules",
    "dev crosscheck --examples 3",
]


def run(program: str, folder: Path, *arguments: str, stdin: bytes = b"") -> subprocess.CompletedProcess[bytes]:
    command = [sys.executable, "-c", WITHOUT_EXTRAS + program, *arguments]
    return subprocess.run(command, cwd=folder, input=stdin, capture_output=True, check=False)


def test_each_extra_is_one_of_the_project_and_has_the_distribution() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    bounded = re.compile("[<>=!~;].*")
    extras = {
        extra: [bounded.sub("", each).strip() for each in listed]
        for extra, listed in project["optional-dependencies"].items()
    }
    assert [each for each in EXTRAS.values() if each[0] not in extras[each[1]]] == []
    optional = {name for extra in ("layouts", "prove", "experiments", "test") for name in extras[extra]}
    assert optional == {distribution for distribution, _ in EXTRAS.values()}
    assert not optional & {bounded.sub("", each).strip() for each in project["dependencies"]}


def test_checking_and_planning_need_no_extra(folder: Path) -> None:
    done = run(COMMANDS, folder, json.dumps([each.split() for each in BASE]))
    assert done.stdout.endswith(b"\nFalse\n"), done.stderr.decode()


@pytest.mark.parametrize("command", FINDS)
def test_a_command_without_its_extra_names_it_and_does_nothing(command: str, folder: Path) -> None:
    (folder / "plant.xml").write_text("<model/>")
    before = sorted(folder.iterdir())
    done = run(COMMAND, folder, *command.split())
    assert (done.returncode, done.stdout) == (2, b"")
    extra = dict(EXTRAS.values())[FINDS[command]]
    assert done.stderr.decode().startswith(f"Error: carproof {command.split(maxsplit=1)[0]} needs {FINDS[command]}")
    assert f"pip install '.[{extra}]'" in done.stderr.decode()
    assert sorted(folder.iterdir()) == before


def test_an_op_without_its_extra_names_it_and_the_server_goes_on(folder: Path) -> None:
    requests = line(id=1, op="optimum", instance=TWO) + line(id=2, op="stop")
    done = run(COMMAND, folder, "serve", stdin=requests)
    refused, stopped = map(json.loads, done.stdout.splitlines())
    assert (refused["error"]["kind"], refused["error"]["rule"]) == ("limit", "limit/extra")
    assert "the op optimum needs python-sat of the extra prove" in refused["error"]["message"]
    assert stopped == {"id": 2, "result": {}}
    assert done.stderr == b""


def test_another_projects_tests_need_no_extra_but_where_they_compare_optima(folder: Path) -> None:
    (folder / "pytest.ini").write_text("[pytest]\n")
    (folder / "test_mine.py").write_text(
        "from carproof import plan\n"
        "def test_plan(carproof):\n    carproof.conforms(plan, 'complete-in-context', examples=20, large=0)\n"
        "def test_all(carproof):\n    carproof.conforms(plan, 'complete')\n"
    )
    done = run(
        "import os, pytest\nos.environ['PYTEST_DISABLE_PLUGIN_AUTOLOAD'] = '1'  # hypothesis' own\n"
        "sys.exit(pytest.main(['-q', '-p', 'carproof.pytest_plugin', '-p', 'no:cacheprovider']))",
        folder,
    )
    assert b"1 failed, 1 passed" in done.stdout, done.stdout.decode()
    assert b"carproof.conforms needs python-sat" in done.stdout
