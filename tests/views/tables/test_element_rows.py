"""The tables of `archgen list`: what types and composed components add to them, and only where there are such."""

from __future__ import annotations

from pathlib import Path

import pytest

from archgen import pipeline
from archgen.views.lookup import DocumentScope, Lookup, make_lookup
from archgen.views.tables.element_rows import list_element_rows

ROBOT = """
archgen: 1
component_types:
  motor: {inputs: {target: Goal}, outputs: {state: State}}
groups:
  g:
    autoconnect: types
    components:
      planner: {outputs: {goal: Goal}}
      arm:
        inputs: {goal: planner.goal}
        components:
          hand: {inputs: {goal: self.goal}, components: {finger: {is: motor, inputs: {target: self.goal}}}}
      reader: {inputs: {goal: {type: Goal}}}
"""
PLAIN = "archgen: 1\ngroups: {g: {components: {a: {outputs: {x: X}}, b: {inputs: {x: a.x}}}}}\n"


def read_project(tmp_path: Path, text: str) -> Lookup:
    """Return the look-ups of a one-file project."""
    (tmp_path / "archgen.yaml").write_text(text)
    return make_lookup(pipeline.check_project(tmp_path).architecture)


def list_cells(lookup: Lookup, kind: str, *names: str) -> list[list[str]]:
    """Return some columns of a table."""
    columns, rows = list_element_rows(lookup, kind)
    return [[row[columns.index(name)] for name in names] for row in rows]


def test_composed_components_stand_before_what_is_inside(tmp_path: Path) -> None:
    lookup = read_project(tmp_path, ROBOT)
    assert list_cells(lookup, "components", "id", "type", "composed_of") == [
        ["g.planner", "", ""],
        ["g.arm", "", "1"],
        ["g.arm.hand", "", "1"],
        ["g.arm.hand.finger", "motor", ""],
        ["g.reader", "", ""],
    ]
    scope = DocumentScope(frozenset({"g.arm.hand.finger"}), frozenset())
    part = make_lookup(lookup.architecture, scope=scope)
    assert list_cells(part, "components", "id") == [["g.arm"], ["g.arm.hand"], ["g.arm.hand.finger"]]


def test_connections_say_which_port_they_pass_and_who_made_them(tmp_path: Path) -> None:
    assert list_cells(read_project(tmp_path, ROBOT), "connections", "input", "from", "through", "made_by") == [
        ["g.arm.hand.finger.target", "g.planner.goal", "g.arm.hand.goal", ""],
        ["g.reader.goal", "g.planner.goal", "", "autoconnect"],
    ]


def test_tables_without_composition_have_the_columns_that_they_had(tmp_path: Path) -> None:
    lookup = read_project(tmp_path, PLAIN)
    assert list_element_rows(lookup, "components")[0][-1] == "place"
    assert list_element_rows(lookup, "connections")[0][-1] == "place"


SYSTEM = """\
archgen: 1
partners: {lab: {title: Lab, contact: a@lab.eu, reviewers: ["@a", "@b"], properties: {trl: 5}}}
groups: {g: {components: {a: {outputs: {x: X}}}}}
hosts: {pc: {}, arm: {}}
containers: {box: {host: pc, threads: 2}}
resources: {gpu: {host: pc}}
links: {lan: {connects: [pc, arm], bandwidth: 1 Gbit/s}}
views: {v: {show: g, colour: owner}}
policies: {p: {title: Never, forbid: {from: g, to: g}}}
properties: {trl: {title: Readiness, type: integer}}
"""


@pytest.mark.parametrize(
    ("section", "row"),
    [
        ("partners", "id=lab title=Lab contact=a@lab.eu reviewers=@a, @b property:trl=5"),
        ("containers", "id=box title=Box namespace=/ host=pc threads=2"),
        ("resources", "id=gpu title=Gpu host=pc"),
        ("links", "id=lan title=Lan connects=pc, arm bandwidth=1 Gbit/s"),
        ("views", "id=v title=V show=g colour=owner level=functional"),
        ("policies", "id=p title=Never"),
        ("properties", "id=trl title=Readiness type=integer required=False"),
    ],
)
def test_a_section_without_a_table_of_its_own_is_listed_by_its_keys(tmp_path: Path, section: str, row: str) -> None:
    columns, (cells,) = list_element_rows(read_project(tmp_path, SYSTEM), section)
    written = " ".join(f"{name}={cell}" for name, cell in zip(columns, cells, strict=True) if cell and name != "place")
    assert written == row
    assert cells[columns.index("place")].startswith("archgen.yaml:")
