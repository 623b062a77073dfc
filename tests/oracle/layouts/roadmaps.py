"""Roadmaps in GraphML, whose points are named by their places in mm."""

Place = tuple[int, int]


def graphml(lanes: list[tuple[Place, Place]], both: bool = False) -> bytes:
    """Lanes with ends in mm: one-way, or each in both directions."""
    places = dict.fromkeys(place for lane in lanes for place in lane)
    nodes = "".join(
        f'<node id="{x},{y}"><data key="x">{x}e-3</data><data key="y">{y}e-3</data></node>' for x, y in places
    )
    edges = "".join(f'<edge source="{a},{b}" target="{c},{d}"/>' for (a, b), (c, d) in lanes)
    keys = "".join(f'<key id="{name}" attr.name="{name}"/>' for name in "xy")
    kind = "undirected" if both else "directed"
    return f'<graphml>{keys}<graph edgedefault="{kind}">{nodes}{edges}</graph></graphml>'.encode()
