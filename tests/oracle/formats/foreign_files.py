"""A map, a scenario and the same correct solution in every format, and broken ones."""

from carproof.formats.movingai import movingai_instance, read_map, read_scenario

MAP = "type octile\nheight 3\nwidth 4\nmap\n....\n.@..\n....\n"
SCENARIO = "version 1\n0\tm.map\t4\t3\t0\t0\t2\t0\t2\n0\tm.map\t4\t3\t3\t2\t3\t0\t2\n"
GRID = read_map(MAP.encode())
INSTANCE = movingai_instance(GRID, read_scenario(SCENARIO.encode(), GRID, None), "park")
"""r1 goes from 0,0 to 2,0 and r2 from 3,2 to 3,0; both walk, r2 waits at its start for a tick."""

LACAM = """agents=2
map_file=m.map
solver=planner
solved=1
soc=5
starts=(0,0),(3,2),
goals=(2,0),(3,0),
solution=
0:(0,0),(3,2),
1:(1,0),(3,2),
2:(2,0),(3,1),
3:(2,0),(3,0),
4:(2,0),(3,0),
"""
SCHEDULE = """statistics:
  cost: 5
  makespan: 3
  runtime: 0.001
schedule:
  agent0:
    - x: 0
      y: 0
      t: 0
    - {x: 1, y: 0, t: 1}
    - {x: 2, y: 0, t: 2}
  agent1:
    - {x: 3, y: 2, t: 0}
    - {x: 3, y: 1, t: 2}
    - {x: 3, y: 0, t: 3}
"""
MOVES = "2r2w\nw2d\n"
TABLE = '"agents","solution_cost","path"\n"2","5","rr\nwdd"\n'
ROWS = "Agent 0: (0,0)->(0,1)->(0,2)->\nAgent 1: (2,3)->(2,3)->(1,3)->(0,3)->\n"
COLUMNS = "Agent 0: (0,0)->(1,0)->(2,0)->\nAgent 1: (3,2)->(3,2)->(3,1)->(3,0)\n"
CORRECT = {
    "lacam": LACAM,
    "libmultirobotplanning": SCHEDULE,
    "mapf-tracker": MOVES,
    "paths-row-column": ROWS,
    "paths-x-y": COLUMNS,
}
