"""Lengths of lanes that a file does not tell, or tells as too short."""

import pytest
from tests.oracle.layouts.layout_files import OLD_OPENTCS, OPENTCS
from tests.oracle.layouts.test_strips import curve, guided, lif

from carp_spec import Refusal
from carproof import Settings, import_layout


def ticks(text: bytes, lane: str) -> int:
    """How long a vehicle of 1 m/s is on the lane."""
    return import_layout(text, settings=Settings(robots=0)).instance.graph.resource[lane].duration


@pytest.mark.parametrize(
    ("properties", "duration"),
    [
        ([curve((0, 0), (3.6, 0))], 10),
        ([curve((3, 3))], 10),
        ([curve((0, 0), (0, 5), (10, 0))], 17),
        ([guided(7)], 7),
        ([curve((0, 0), (3.6, 0)) | guided(7)], 7),
        ([guided(7), curve((0, 0), (3.6, 0))], 10),
    ],
)
def test_a_curve_of_lif_is_no_shorter_than_the_distance_of_the_nodes(
    properties: list[dict[str, object]], duration: int
) -> None:
    assert ticks(lif((10, 0), properties, []), "ab") == duration


@pytest.mark.parametrize("version", ["0.0.4", "0.0.5"])
def test_a_path_of_opentcs_without_a_length_is_as_long_as_its_points_are_apart(version: str) -> None:
    text = OLD_OPENTCS.replace('"0.0.4"', f'"{version}"').replace(' length="4000"', "")
    slow = text.replace('maxVelocity="1500"', 'maxVelocity="1"')
    assert ticks(slow.encode(), "bc") == 4000
    assert ticks(slow.replace('yPosition="4000"', 'yPosition="0"').encode(), "bc") == 1, "of points at one place"
    with pytest.raises(Refusal, match="plant:9: the point 'z' must be one of the layout"):
        import_layout(text.replace('destinationPoint="c"', 'destinationPoint="z"').encode(), "plant")


def test_a_path_of_later_versions_must_have_a_length() -> None:
    with pytest.raises(Refusal, match="plant:9: it must have length"):
        import_layout(OPENTCS.replace(' length="4000"', "").encode(), "plant")
