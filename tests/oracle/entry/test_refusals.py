"""Refusals of the command line: exit code 2, one sentence that names the place, and nothing printed or written."""

from pathlib import Path

import pytest
from tests.oracle.formats.foreign_files import INSTANCE, LACAM, MAP, SCENARIO
from tests.oracle.running import HEAD_ON, TWO, TWO_PLANNED, Run, corridor, save, solution, town

from carproof import write_instance

EMPTY_VERDICT = {"format": "carproof-verdict/1", "valid": True, "cost": 0, "unplanned": 0, "violations": []}
EAST, BEHIND = TWO["robots"]
TRACE = {"format": "carproof-trace/1", "now": 3, "plans": [{"robot": "r1", "visits": [["a", 0, None]]}]}
BOUND = {"format": "carproof-bound/1", "instance": "", "bound": 5, "scale": 1, "horizon": 0} | {
    name: [] for name in ("resources", "exchanges", "cuts", "robots")
}
SLOW_END = {**TWO["graph"], "nodes": [*TWO["graph"]["nodes"][:4], {"id": "e", "duration": 2**62}]}
ALIKE = {
    "nodes": [{"id": 1}, {"id": "1"}, {"id": 2}],
    "edges": [{"source": 1, "target": 2}, {"source": "1", "target": 2}],
}
DOCUMENTS: dict[str, object] = {
    "verdict": EMPTY_VERDICT,
    "nothing": {},
    "extra": {**TWO, "extra": 1},
    "served": corridor([{"id": "r1", "start": "a", "stops": [{"resource": "c", "service": 1}]}]),
    "astray": corridor([{**EAST, "goal": "q"}]),
    "stays": corridor([EAST], "stay"),
    "three": corridor([EAST, BEHIND, HEAD_ON]),
    "numbered": corridor([{**EAST, "id": 7}, {**BEHIND, "id": "7"}]),
    "alike": {**town("xy", [{"id": "r", "start": 2, "goal": 2}], "park"), "graph": ALIKE},
    "alike-plans": solution({"r": [[2, 0, None]]}),
    "none": {**TWO_PLANNED, "plans": [], "order": [], "unplanned": ["r1", "r2"]},
    "slow": {**TWO, "graph": {**TWO["graph"], "nodes": [{"id": "a", "duration": 2**40}, *TWO["graph"]["nodes"][1:]]}},
    "slow-e": {**corridor([EAST]), "graph": SLOW_END},
    "trace": TRACE,
    "park": corridor([EAST], "park"),
    "park-plans": solution({"r1": [["a", 0, 1], ["b", 1, 2], ["c", 2, None]]}),
    "long-plans": solution({"r1": [["a", 0, 2**40], ["b", 2**40, 2**41], ["c", 2**41, None]]}),
    "late": corridor([{**EAST, "release": 2**70}]),
    "unordered": {**TWO_PLANNED, "order": ["r1"]},
    "far": {**TWO_PLANNED, "plans": [{"robot": "r1", "visits": [["a", 0, 10**9]]}], "order": ["r1"]},
    "bound-scale": {**BOUND, "scale": 1.5},
    "bound-high": {**BOUND, "bound": 6},
    "east": corridor([EAST]),
    "east-plans": {**TWO_PLANNED, "plans": TWO_PLANNED["plans"][:1], "order": ["r1"]},
    "trace-early": {**TRACE, "plans": [{"robot": "r1", "visits": [["a", 0, 4], ["b", 4, None]]}]},
    "delays-nobody": [["r9", 0, 1]],
    "delays-zero": [["r1", 0, 0]],
    "route": [["b", 0, 1], ["c", 1, 2]],
}
SLOW = "$.graph.nodes[0].duration: "
SLOW_E = "$.graph.nodes[4].duration: the duration must be at most "
NOW = (
    "query town.json one.json r2",
    "query town.json one.json r2 --certificate out",
    "add town.json none.json r2",
    "polish town.json plans.json",
    "assign park.json park-plans.json r1 b",
    "execution give-way town.json plans.json r1",
)
"""Commands that ask at a tick."""
CAPACITY = "$.plans[0].visits[1]: resource b in [1,2): robots r1, r2 (capacity 1) [joint/capacity]"
MAPS = "--map m.map --scen m.scen"
LAYOUTS = {
    "plant.xml": '<?xml version="1.0"?>\n<model version="0.0.4" name="Plant">\n<point name="P1"/>\n</model>\n',
    "office.building.yaml": "levels:\n  L1:\n    lanes:\n      - [0, 1]\n    vertices:\n      - [1.0, 2.0, 0, a]\n",
    "graph.yaml": "building_name: b\nlevels:\n  L1:\n    lanes:\n    - [0, 1]\n    vertices:\n    - [1.0, 2.0]\n",
    "lif.json": '{"metaInformation": {}, "layouts": [{"layoutId": "1", "nodes": [], "edges": []}]}',
    "site.json": '{"type": "FeatureCollection", "features": []}',
    "room.yaml": "image: room.pgm\nresolution: 0.05\norigin: [0.0, 0.0, 0.0]\n",
}
KINDS = {
    "plant.xml": "an openTCS plant model",
    "office.building.yaml": "an Open-RMF building",
    "graph.yaml": "navigation graph",
    "lif.json": "LIF",
    "site.json": "GeoJSON",
    "room.yaml": "a map for ROS",
}
ASSIGN = "assign town.json plans.json --now 1 -o next.json --instance after.json"
OTHERS = tuple(
    (command.replace("FILE", file), f"{file}: this is ", kind, "carproof convert")
    for file, kind in KINDS.items()
    for command in ("plan FILE", "check FILE plans.json", "check town.json FILE", "convert FILE m.scen")
)
REFUSED = (
    # commands and options
    ("chek", "No such command 'chek'", "Did you mean check?"),
    ("zzz", "No such command 'zzz'", "carproof --help lists them"),
    ("check", "Missing argument"),
    ("check --jsn", "No such option"),
    ("rules joint/capacty", "the nearest are joint/capacity"),
    ("theorems earliest_entry_wins", "earliest_entry_dominates"),
    ("conform -- ./no-such-planner", "there is no such program"),
    ("bound town.json --seconds 0", "--seconds"),
    ("optimum town.json --limit 0", "--limit"),
    ("gap town.json --limit x", "--limit"),
    (f"optimum town.json --limit 1{'0' * 400}", "Error: --limit: it must be a number of at least 0, not 1000"),
    (
        f"bound town.json --seconds 1{'0' * 400} --steps 0",
        "Error: --seconds: it must be a number of at least 0, not 1000",
    ),
    (f"bound town.json --steps 1{'0' * 400}", "Error: --steps: it must be a whole number of at least 0, not 1000"),
    # files
    ("plan comma.json", "comma.json: $: ", "line 2, column 9", "[document/json]"),
    ("plan stays.json", "$.after_goal: ", "'stay'", "it must be park or vanish [document/shape]"),
    ("plan verdict.json", "verdict.json: $.format: ", "[document/format]"),
    ("plan -", "standard input: $: ", "line 1, column 1", "[document/json]"),
    ("plan extra.json", "extra.json: $: object contains unknown field extra [document/shape]"),
    ("plan astray.json", "$.robots[0].goal: the goal must be the id of a resource, and 'q' is not [instance/endpoint]"),
    ("plan missing.json", "missing.json: there is no such file."),
    ("plan .", ".: it is a folder."),
    ("plan /proc/self/mem", "/proc/self/mem: it cannot be read: Input/output error"),
    ("plan town.json -o none/out.json", "there is no folder "),
    ("plan town.json -o /proc/x", "/proc/x: it "),
    (f"check {'x' * 300} plans.json", "xxx: there is no such file."),
    (f"plan town.json -o {'x' * 300}", "xxx: it cannot be written: File name too long"),
    ("check - -", "Only one of the files can be standard input."),
    ("demo town.json", "town.json"),
    # planners and robots
    ("plan town.json --planner best", "--planner: there is no planner 'best'; the planners are carp, shuffled"),
    ("plan town.json --planner neighborhood", "did you mean neighbourhood? The planners are carp, shuffled"),
    ("plan town.json --planner carp --m 3", "--m: the planner carp has no option m; it has none"),
    ("plan town.json --m two", "'two' is not a valid integer"),
    ("plan town.json --engine fastest", "'fastest' is not"),
    ("plan slow.json --engine optimized", f"Error: slow.json: {SLOW}"),
    ("plan slow.json --engine optimized --planner time-expanded", "Error: --planner: "),
    ("query town.json plans.json r9", "ROBOT: the instance must have the robot, and has no 'r9' [request/robot]"),
    ("add town.json plans.json r1", "ROBOT: the robot to add must have no plan, and 'r1' has one [request/robot]"),
    ("query numbered.json none.json 7", "2 print as 7"),
    (
        "assign alike.json alike-plans.json r 2 1:3",
        "Error: STOP 2: a resource's id must differ",
        "2 print as 1 [instance/stops]",
    ),
    ("query three.json broken.json r3", f"Error: broken.json: {CAPACITY}"),
    ("polish town.json plans.json --seconds 0", "--seconds: the seconds must be a number above 0, not 0.0 [polish/opt"),
    ("polish town.json plans.json --seconds 1 --iterations 1", "there must be either iterations or seconds, not both"),
    ("polish town.json plans.json --now -1", "[request/now]"),
    ("polish town.json plans.json --bound bound-high.json", "bound-high.json: $."),
    ("execution give-way town.json plans.json r1 --route route.json --engine reference", "[plan/start]"),
    ("plan served.json --planner fixed-paths", "$.robots: each robot must have a goal alone here"),
    ("plan town.json --seconds 1 --planner carp", "[planner/options]"),
    ("plan town.json --iterations 1 --m 3", "[planner/options]"),
    ("plan town.json --seconds 1 --engine reference", "[planner/options]"),
    # further stops
    (f"{ASSIGN} r2 d:-1 a", "Error: STOP 1: the service must be a whole number of at least 0, not -1 [instance/stops]"),
    (f"{ASSIGN} r2 d b:x", "Error: STOP 2: it must be the id of a resource, and 'b:x' is not [instance/stops]"),
    (f"{ASSIGN} r2 d:9999999999", "Error: STOP: the services must be at most 1073741823 together, and are more; "),
    (f"{ASSIGN} r2 d:{'9' * 5000}", "Error: STOP 1: it must be the id of a resource, and "),
    (f"{ASSIGN} r9 d", "Error: ROBOT: the instance must have the robot, and has no 'r9' [request/robot]"),
    (f"{ASSIGN} r2 d -o ./after.json", "another option writes there too"),
    (f"{ASSIGN} r2 d -o - --instance -", "another option writes there too"),
    # standard output
    ("plan town.json --json -o -", "'-o': -: another option writes there too."),
    ("plan town.json -o - --json", "'--json': another option writes to standard output too."),
    ("check town.json plans.json --json -o -", "another option writes there too"),
    ("generate grid --json -o -", "another option writes there too"),
    ("query town.json one.json r2 --certificate - --json", "another option writes to standard output too"),
    (f"{ASSIGN.replace('after.json', '-')} r2 d --json", "another option writes to standard output too"),
    ("execution simulate town.json plans.json --driver order --trace - --json", "another option writes to standard"),
    # executions
    ("execution retime east.json east-plans.json trace-early.json", "trace-early.json: $.", "[trace/ticks]"),
    ("execution retime east.json east-plans.json east-plans.json", "east-plans.json: $.", "[document/format]"),
    ("execution simulate east.json east-plans.json --delays=x", "[request/delays]"),
    ("execution simulate east.json east-plans.json --delays=0.1:x", "[request/delays]"),
    ("execution simulate east.json east-plans.json --delays=0.00000001", "[request/delays]"),
    ("execution simulate east.json east-plans.json --delays=", "--delays: '' must be a file of delays, or a chance"),
    ("execution simulate east.json east-plans.json --delays .", "--delays: '.' must be a file of delays, or a chance"),
    (
        "execution simulate east.json east-plans.json --delays :3",
        "--delays: ':3' must be a file of delays, or a chance",
    ),
    (
        "execution simulate east.json east-plans.json --delays 0.1:1000000",
        "must be a whole number from 1 to 999999, not",
    ),
    ("execution simulate east.json east-plans.json --delays /proc/self/mem", "/proc/self/mem: it cannot be read: "),
    (f"execution simulate east.json east-plans.json --delays {'9' * 300}", "[request/delays]"),
    (f"execution simulate east.json east-plans.json --delays 0.1:{'9' * 5000}", "[request/delays]"),
    (f"execution dependencies east.json east-plans.json --delay r1:0:{'9' * 5000}", "[request/delays]"),
    ("execution dependencies east.json east-plans.json --delay r1:0:²", "[request/delays]"),
    ("execution dependencies east.json east-plans.json --delay r1", "[request/delays]"),
    ("execution simulate east.json east-plans.json --delays delays-nobody.json", "[request/delays]"),
    ("execution simulate east.json east-plans.json --delays nothing.json", "[request/delays]"),
    (
        "execution simulate east.json east-plans.json --delays delays-zero.json",
        "delays-zero.json: $[0]: the delay",
    ),
    ("execution simulate east.json east-plans.json --driver order --now 3", "--now needs --trace."),
    ("execution simulate east.json east-plans.json --trace t.json", "--trace and --followed need --driver."),
    (
        "execution simulate east.json east-plans.json --driver order --trace t.json --now -1",
        "--now: it must be a whole",
    ),
    # numbers that the compiled planner does not hold
    ("assign slow-e.json east-plans.json r1 b", f"Error: slow-e.json: {SLOW_E}"),
    ("audit slow-e.json east-plans.json", f"Error: slow-e.json: {SLOW_E}"),
    ("execution give-way slow-e.json east-plans.json r1", f"Error: slow-e.json: {SLOW_E}"),
    ("execution retime slow-e.json east-plans.json trace.json", f"Error: slow-e.json: {SLOW_E}"),
    ("execution retime park.json long-plans.json trace.json", "Error: long-plans.json: $.plans: the tick"),
    ("polish park.json long-plans.json", "Error: long-plans.json: $.plans: the tick"),
    *((f"{command} --now {2**40}", "Error: --now: the tick must be at most ") for command in NOW),
    # bounds and proofs
    ("audit town.json unordered.json", "[solution/order]"),
    ("bound town.json --plans east-plans.json", "plans to compare with must break no rule"),
    ("bound town.json --plans comma.json", "Error: comma.json: $: "),
    ("bound town.json --from csv", "--from concerns the file of --plans"),
    ("bound --plans plans.json", "Give INSTANCE, or --map and --scen."),
    (
        "bound late.json --steps 1",
        "late.json: $.robots[0].release: ",
        "the reference engine has no such limit, but finds no bounds",
    ),
    ("verify town.json bound-scale.json", "bound-scale.json: $.scale: ", "[document/shape]"),
    ("optimum town.json --proof town.json", "town.json"),
    ("optimum comma.json --proof town.json/proof", "town.json/proof: it cannot be written: "),
    ("verify nowhere", "nowhere"),
    # instances and pictures
    ("generate grid --width 0", "--width: it must be between 1 and 1073741824, not 0 [generate/options]"),
    ("generate grid --width 501 --height 500", "--width: the map must have at most 250000 resources"),
    ("generate grid --robots 401", "--robots: 401 robots need as many distinct starts, and the map has 400"),
    ("generate grid --release 9..3", "--release: its range must not fall, and is 9..3 [generate/options]"),
    ("generate grid --duration 1..x", "must be a whole number or LOW..HIGH"),
    ("generate grid --after-goal stay", "'stay' is not one of 'vanish', 'park'"),
    ("generate warehouse --aisle 0", "--aisle: it must be between 1"),
    ("generate warehouse --headings --orders pick-and-drop", "Error: --headings: robots must have goals alone"),
    ("view town.json plans.json --at 1 --chart", "Only one of --at and --chart can be drawn."),
    ("view town.json far.json", "and there is 1000000000 [view/ticks]"),
    ("view town.json broken.json --at 900", "from tick 0 to tick 5"),
    ("view town.json plans.json --trace plans.json --chart", "--trace is for the page, without --at and --chart."),
    ("view town.json broken.json -o x.pdf", ".html", ".svg"),
    ("view town.json broken.json -o x.svg", ".html", "--at", "--chart"),
    ("view town.json broken.json --at 1 -o x.html", ".svg"),
    # formats
    ("check m.json", "Give INSTANCE and SOLUTION, or --map, --scen and SOLUTION."),
    (f"check m.json lacam {MAPS}", "Give INSTANCE and SOLUTION"),
    ("check lacam --map m.map", "--map and --scen go together, and --agents with them."),
    ("check m.json lacam --from mapf-tracker", "lacam:1: the line must be of the letters"),
    ("convert m.json lacam --from lacam", "--from and --to concern a solution."),
    ("convert m.json lacam --to lacam --agents 1", "--to concerns a solution."),
    (
        "convert m.json lacam --to csv --from nav2",
        "Error: --from: there is no format 'nav2'; the formats are carproof, ",
    ),
    ("convert plant.xml --from lacam", "Error: --from: there is no format 'lacam'; the formats are opentcs, "),
    (
        "convert town.json plans.json",
        "town.json is no map; to convert a solution of an instance, name a format by --to.",
    ),
    (
        "convert town.json plans.json --to vda5050-3 --since 3 --at 2",
        "Error: --since: it must be a tick of at least 0, ",
    ),
    ("convert town.json plans.json --to vda5050-3 --at 999999999999", "Error: --at: it must be a tick of at least 0, "),
    ("convert m.map m.scen --agents 3", "m.scen:3: 3 agents are asked for, and the scenario has 2"),
    ("convert - m.scen", "Error: standard input:1: "),
    # programs
    ("conform --one-shot -- cat {map}", "must hold {instance}, or {map} and {scen}"),
    ("conform --from lacam -- cat", "--from concerns the files that programs write with --one-shot"),
    ("conform --one-shot --level exact -- cat {map} {scen}", "--level must be one of sound, complete, optimal"),
    ("conform --one-shot --level exact -- cat {instance}", "--level must be one of sound, complete-in"),
    ("conform --executor --level complete -- cat", "Of an executor --level must be one of sound, exact."),
    ("conform --executor --kernel -- cat", "--executor can be combined with neither --one-shot nor --kernel."),
    ("conform --executor --one-shot -- cat", "--executor can be combined with neither --one-shot nor --kernel."),
    ("conform --timeout inf -- cat", "inf is not in the range 0<x<=86400."),
    ("conform --timeout nan -- cat", "Error: --timeout: it must be a number of at least 0, not nan"),
    # sizes and times
    ("convert plant.xml --tick 0s", "--tick: it must be a number above 0"),
    ("convert plant.xml --speed 3kn", "--speed: it must be a number above 0"),
    ("convert plant.xml --footprint 0x3mm", "--footprint: it must be a length and a width"),
    ("convert plant.xml --from nav2", "plant.xml:2: it must have features"),
    ("convert plant.xml --json", "--json lists what is not expressed"),
    ("convert plant.xml --agents 3", "--agents concerns a scenario"),
    ("convert plant.xml --at 3", "--at"),
    ("check town.json plans.json --cells 1m", "--cells"),
    ("check town.json plans.json --footprint 450mm --cells 0.5mm", "--cells"),
    ("check town.json plans.json --z3 --kernel", "--kernel and --z3 both decide: give one of them."),
    ("release town.json plans.json trace-early.json --seconds 0", "--seconds"),
    ("audit town.json plans.json --seconds nan", "--seconds"),
    # experiments
    ("experiment quality --backend dask --store st", "needs the address of its --scheduler"),
    # layouts in place of instances
    *OTHERS,
    (
        "plan m.map",
        "Error: m.map: this is a map of MovingAI, not an instance; carproof convert makes instances of layouts",
    ),
    ("convert m.map", "Error: m.map: this is a map of MovingAI: give its scenario too."),
    ("check m.map lacam", "Error: m.map: this is a map of MovingAI, not an instance"),
)
WRITES = ("plan", "polish", "retime", "give-way", "view")


@pytest.fixture(name="many")
def many_documents(folder: Path) -> Path:
    save(**DOCUMENTS)
    files = {"m.map": MAP, "m.scen": SCENARIO, "lacam": LACAM} | LAYOUTS
    for name, text in files.items():
        (folder / name).write_text(text)
    (folder / "comma.json").write_text('{\n "a": 1,,\n}')
    (folder / "m.json").write_bytes(write_instance(INSTANCE))
    return folder


@pytest.mark.parametrize(
    ("command", "messages"),
    [
        pytest.param(command, messages, id=f"{command[:80]}-{number}")
        for number, (command, *messages) in enumerate(REFUSED)
    ],
)
def test_it_is_refused_in_one_sentence_and_nothing_is_written(
    carproof: Run, many: Path, command: str, messages: list[str]
) -> None:
    before = {path.name: path.read_bytes() for path in many.iterdir()}
    writes = command.split(maxsplit=1)[0] in WRITES and " -o " not in command
    outcome = carproof(command, *(("-o", "out") if writes else ()), stdin=b"?")
    assert (outcome.code, outcome.stdout) == (2, "")
    assert outcome.stderr.startswith("Error: ")
    assert outcome.stderr.count("\n") == 1
    assert [message for message in messages if message not in outcome.stderr] == []
    assert {path.name: path.read_bytes() for path in many.iterdir()} == before


@pytest.mark.parametrize("words", [["plan"], ["generate", "grid", "-o"]])
def test_the_empty_name_is_that_of_no_file(carproof: Run, words: list[str]) -> None:
    outcome = carproof("", *words, "")
    assert (outcome.code, outcome.stdout) == (2, "")
    assert "the name of a file must not be empty." in outcome.stderr
