"""Small layouts in each format: a row of three points a, b, c, one-way from a to b, two-way between b and c."""

import json

OPENTCS = """<?xml version="1.0" encoding="UTF-8"?>
<model version="7.0.0" name="row">
  <point name="a" positionX="0" positionY="0" positionZ="0" type="PARK_POSITION"/>
  <point name="b" positionX="3000" positionY="0" positionZ="0" type="HALT_POSITION"/>
  <point name="c" positionX="3000" positionY="4000" positionZ="0" type="PARK_POSITION">
    <vehicleEnvelope key="loaded"/>
  </point>
  <path name="ab" sourcePoint="a" destinationPoint="b" length="3000" maxVelocity="1000" maxReverseVelocity="0"/>
  <path name="bc" sourcePoint="b" destinationPoint="c" length="4000" maxVelocity="1500" maxReverseVelocity="500"/>
  <path name="ca" sourcePoint="c" destinationPoint="a" length="5" maxVelocity="1" maxReverseVelocity="0" locked="true"/>
  <vehicle name="v1" maxVelocity="1000"><property name="loopback:initialPosition" value="a"/></vehicle>
  <block name="corner" type="SINGLE_VEHICLE_ONLY"><member name="ab"/><member name="bc"/></block>
  <block name="stream" type="SAME_DIRECTION_ONLY"><member name="ab"/></block>
</model>
"""
OLD_OPENTCS = OPENTCS.replace("7.0.0", "0.0.4").replace("positionX", "xPosition").replace("positionY", "yPosition")
BUILDING = """
coordinate_system: reference_image
levels:
  L1:
    measurements:
      - [0, 1, {distance: [3, 3.0]}]
    lanes:
      - [0, 1, {bidirectional: [4, false], graph_idx: [2, 0], mutex: [1, "door way"], speed_limit: [3, 0]}]
      - [1, 2, {bidirectional: [4, true], graph_idx: [2, 0], mutex: [1, "door way"], speed_limit: [3, 0.5]}]
    vertices:
      - [0, 0, 0, a, {spawn_robot_name: [1, tiny], is_charger: [4, true]}]
      - [300, 0, 0, b]
      - [300, -400, 0, c]
      - [900, 900, 0, ""]
    doors:
      - [0, 1, {name: [1, front]}]
name: row
"""
NAV_GRAPH = """
building_name: row
levels:
  L1:
    lanes:
      - [0, 1, {mutex: door way}]
      - [1, 2, {mutex: door way, speed_limit: 0.5}]
      - [2, 1, {mutex: door way, speed_limit: 0.5, door_name: front}]
    vertices:
      - [0.0, 0.0, {name: a, is_charger: true}]
      - [3.0, 0.0, {name: b}]
      - [3.0, 4.0, {name: c}]
"""


def lif(version: str) -> str:
    """The Layout Interchange Format."""
    types, speed = ("mobileRobotType", "maximumSpeed") if version.startswith("2") else ("vehicleType", "maxSpeed")
    places = {"a": (0, 0), "b": (3.0, 0), "c": (3, 4)}
    layout = {
        "layoutId": "1",
        "layoutVersion": "1",
        "nodes": [
            {"nodeId": name, "nodePosition": {"x": x, "y": y}, f"{types}NodeProperties": [{}]}
            for name, (x, y) in places.items()
        ],
        "edges": [
            {"edgeId": ends, "startNodeId": ends[0], "endNodeId": ends[1], f"{types}EdgeProperties": [{speed: fast}]}
            for ends, fast in (("ab", 1), ("bc", 0.5), ("cb", 0.5))
        ],
        "stations": [{"stationId": "s", "interactionNodeIds": ["a", "c"]}],
    }
    origins = (
        {"origins": [{"originId": "o", "layouts": [layout]}]} if version.startswith("2") else {"layouts": [layout]}
    )
    return json.dumps({"metaInformation": {"lifVersion": version}, **origins}, indent=1)


def nav2() -> str:
    """A graph of Nav2's route server."""
    places = {"a": (0, 0), "b": (3.0, 0), "c": (3, 4)}
    nodes = [
        {"type": "Feature", "properties": {"id": name}, "geometry": {"type": "Point", "coordinates": place}}
        for name, place in places.items()
    ]
    edges = [
        {
            "type": "Feature",
            "properties": {"id": ends, "startid": ends[0], "endid": ends[1], "metadata": metadata},
            "geometry": {"type": "LineString", "coordinates": []},
        }
        for ends, metadata in (("ab", {}), ("bc", {"abs_speed_limit": 0.5}), ("cb", {"speed_limit": 50}))
    ]
    return json.dumps({"type": "FeatureCollection", "features": nodes + edges}, indent=1)


ANNOTATED = """
roadmap:
  undirected: False
  allow_wait_actions: False
  vertices: {a: [0, 0], b: [3.0, 0], c: [3, 4]}
  edges:
    - [a, b]
    - [b, c]
    - [c, b]
    - [a, a]
  conflicts:
    - [1]
    - [0, 3]
    - []
    - [1]
agents:
  - {name: agent0, start: a, goal: c}
"""
GRAPHML = """<graphml xmlns="http://graphml.graphdrawing.org/xmlns">
<key id="d0" for="node" attr.name="x" attr.type="double"/><key id="d1" for="node" attr.name="y" attr.type="double"/>
<key id="d2" for="edge" attr.name="speed" attr.type="double"/>
<graph edgedefault="directed">
<node id="a"><data key="d0">0</data><data key="d1">0</data></node>
<node id="b"><data key="d0">3</data><data key="d1">0</data></node>
<node id="c"><data key="d0">3</data><data key="d1">4</data></node>
<edge source="a" target="b"/>
<edge source="b" target="c"><data key="d2">0.5</data></edge>
<edge source="c" target="b"><data key="d2">0.5</data></edge>
</graph></graphml>
"""
NODE_LINK = json.dumps(
    {
        "directed": True,
        "nodes": [{"id": "a", "pos": [0, 0]}, {"id": "b", "x": 3, "y": 0}, {"id": "c", "x": 3, "y": 4}],
        "links": [
            {"source": "a", "target": "b"},
            {"source": "b", "target": "c", "speed": 0.5},
            {"source": "c", "target": "b", "length": 4, "speed": 0.5},
        ],
    }
)
LAYOUTS = {
    "opentcs": OPENTCS,
    "old opentcs": OLD_OPENTCS,
    "building": BUILDING,
    "nav graph": NAV_GRAPH,
    "lif 1": lif("1.0.0"),
    "lif 2": lif("2.0.0"),
    "nav2": nav2(),
    "annotated": ANNOTATED,
    "graphml": GRAPHML,
    "json": NODE_LINK,
}
