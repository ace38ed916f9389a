"""Tests of the figures of `archgen stats`."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import asdict
from fractions import Fraction

from archgen.analyses.size_counts import ArchitectureSize, ProgressCounts, measure_progress, measure_size
from archgen.model.architecture import Architecture

Sketch = Callable[[str], Architecture]

_ROBOT = """
    partner certh
    requirement R-1
    type Image sensor_msgs/msg/Image
    component a.camera owner=certh functionality=Sees requirements=R-1
    out a.camera.image type=Image
    out a.camera.light type=Light physical
    out a.camera.new type="Not mapped"
    in b.screen.image from=a.camera.image
    in b.screen.light from=a.camera.light
    in b.screen.all from=a.camera
    in b.screen.stub from=a.stub
    component a.stub owner=certh
    component b.other requirements=R-9
    node camera implements=a.camera timed=a.camera
    node screen_a implements=b.screen timed=b.screen
    node screen_b implements=b.screen
    node stub implements=a.stub planned
    end camera publishes /image port=a.camera.image
    end camera serves /reset internal
    chain c a.camera b.screen
"""


def test_size_counts_and_divides_exactly(sketch: Sketch) -> None:
    figures = asdict(measure_size(sketch(_ROBOT)))
    assert {key: value for key, value in figures.items() if value} == {
        "groups": 2,
        "components": 4,
        "components_per_group": 2,
        "largest_group": 2,
        "connections": 4,
        "connections_per_component": 1,
        "mapped_connections": 2,
        "edges": 4,
        "inputs": 4,
        "outputs": 3,
        "inputs_per_component": 1,
        "outputs_per_component": Fraction(3, 4),
        "nodes": 3,
        "planned_nodes": 1,
        "topics": 1,
        "services": 1,
        "types": 1,
        "messages": 1,
        "requirements": 1,
        "partners": 1,
        "chains": 1,
    }


def test_an_empty_architecture_divides_by_nothing(sketch: Sketch) -> None:
    empty = measure_size(sketch(""))
    assert isinstance(empty, ArchitectureSize)
    assert set(asdict(empty).values()) == {0}


def test_progress_measures_the_whole_groups_partners_and_what_nobody_owns(sketch: Sketch) -> None:
    assert measure_progress(sketch(_ROBOT)) == (
        ProgressCounts("project", "p", "P", components=4, described=1, typed=2, mapped=2, timed=1, traced=1),
        ProgressCounts("group", "a", "a", components=2, described=1, typed=1, mapped=1, timed=1, traced=1),
        ProgressCounts("group", "b", "b", components=2, described=0, typed=1, mapped=1, timed=0, traced=0),
        ProgressCounts("partner", "certh", "certh", components=2, described=1, typed=1, mapped=1, timed=1, traced=1),
        ProgressCounts("partner", "", "(nobody)", components=2, described=0, typed=1, mapped=1, timed=0, traced=0),
    )
