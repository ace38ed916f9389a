"""Tests of the figures of `archgen stats`."""

from __future__ import annotations

import tempfile
from collections.abc import Callable
from dataclasses import asdict
from fractions import Fraction
from pathlib import Path

from archgen.analyses.size_counts import (
    ArchitectureSize,
    ProgressCounts,
    count_declared_properties,
    count_mapped_connections,
    measure_progress,
    measure_size,
)
from archgen.model.architecture import Architecture
from archgen.pipeline import check_project
from archgen.views.tables.statistics_tables import format_figures, make_statistics_tables

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


def test_a_connection_is_mapped_by_its_type_or_by_the_node_that_publishes() -> None:
    text = """
groups:
  g:
    components:
      a: {outputs: {typed: std_msgs/msg/Empty, named: Open, served: Open, light: {medium: physical}, open: Open}}
      b: {inputs: {i: a.typed, j: a.named, k: a.light, l: a.open, m: [a.typed, a.open], n: a.served, o: c}}
      c: {title: Stub}
nodes:
  a: {implements: a, publishes: {named: {message: std_msgs/msg/Empty}}, serves: {served: {message: std_srvs/srv/Empty}}}
  b: {implements: b, subscribes: {l: {message: std_msgs/msg/Empty}}}
types: {Open: {status: planned}}
"""
    assert count_mapped_connections(_architecture(text)) == 5


def test_progress_has_a_row_for_each_scope_and_for_what_nobody_owns() -> None:
    text = """
project: {id: r, title: Robot}
partners: {lab: The lab, firm: The firm}
requirements: {R-1: One}
groups:
  g:
    title: Group
    components:
      a: {owner: [lab, firm], functionality: F, requirements: [R-1], outputs: {o: std_msgs/msg/Empty}, timing: {rate: 1 Hz}}
      b: {inputs: {o: a.o}, requirements: [be quick, R-9], outputs: {p: }}
      c: {owner: lab, title: C, inputs: {o: a.o}}
nodes:
  n: {implements: b, timing: {rate: 1 Hz}}
  m: {implements: c, timing: {rate: 1 Hz}}
  o: {implements: c}
"""
    rows = {(row.scope, row.id): row for row in measure_progress(_architecture(text))}
    assert {
        key: (r.title, r.components, r.described, r.typed, r.mapped, r.timed, r.traced) for key, r in rows.items()
    } == {
        ("project", "r"): ("Robot", 3, 1, 2, 2, 2, 1),
        ("group", "g"): ("Group", 3, 1, 2, 2, 2, 1),
        ("partner", "lab"): ("The lab", 2, 1, 2, 1, 1, 1),
        ("partner", "firm"): ("The firm", 1, 1, 1, 0, 1, 1),
        ("partner", ""): ("(nobody)", 1, 0, 0, 1, 1, 0),
    }
    owned = text.replace("b: {inputs", "b: {owner: lab, inputs")
    assert [row.id for row in measure_progress(_architecture(owned))] == ["r", "g", "lab", "firm"]
    alone = text.replace("partners: {lab: The lab, firm: The firm}", "").replace("owner: [lab, firm], ", "")
    assert [row.id for row in measure_progress(_architecture(alone.replace("owner: lab, ", "")))] == ["r", "g"]


def _architecture(text: str) -> Architecture:
    with tempfile.TemporaryDirectory() as folder:
        (Path(folder) / "project.yaml").write_text(text, encoding="utf-8")
        return check_project(Path(folder) / "project.yaml").architecture


def test_frames_are_counted_and_told_where_there_are_any() -> None:
    text = "groups: {g: {components: {a: {frames: {laser: {parent: base, static: true}}}}}}\n"
    plain, framed = (
        _architecture(each) for each in (text.replace("frames", "hints"), f"{text}frames: {{base: {{}}}}\n")
    )
    assert ("frames", "Coordinate frames", "2") in format_figures(measure_size(framed))
    assert "frames" not in {key for key, _, _ in format_figures(measure_size(plain))}


def test_promises_and_what_is_going_away_are_counted_where_there_are_any() -> None:
    said = _architecture(
        "groups: {g: {components: {a: {outputs: {o: {promise: {rate: 1 Hz}}, p: {deprecated: {}}}}}}}\n"
        "types: {T: {message: std_msgs/msg/Bool, deprecated: {}}}\ncomponent_types: {m: {deprecated: {}}}\n"
    )
    figures = {key: count for key, _, count in format_figures(measure_size(said))}
    assert (figures["promises"], figures["deprecated"]) == ("1", "3")
    plain = _architecture("groups: {g: {components: {a: {outputs: {o: T}}}}}\n")
    assert figures.keys() - {key for key, _, _ in format_figures(measure_size(plain))} >= {"promises", "deprecated"}


def test_verified_requirements_and_declared_properties_are_counted() -> None:
    architecture = _architecture(
        "requirements: {R-1: One, R-2: {parent: R-1, verified_by: by hand}, R-3: Three}\n"
        "properties: {sil: {of: [component], type: integer}, note: Note}\n"
        "groups: {g: {properties: {note: x}, components: {a: {title: A, properties: {sil: 1, own: 2}}, b: {title: B}}}}\n"
    )
    figures = {key: count for key, _, count in format_figures(measure_size(architecture))}
    assert (figures["verified"], figures["property_values"]) == ("2", "2")
    counts = [(each.id, have, lack) for each, have, lack in count_declared_properties(architecture)]
    assert counts == [("sil", 1, 1), ("note", 1, 0)]
    table = make_statistics_tables(architecture)[-1]
    assert [["".join(run.text for run in cell) for cell in row] for row in table.rows] == [
        ["Sil", "1", "1"],
        ["Note", "1", "0"],
    ]
