"""What the explorer knows of composed components: what is around and inside, what stands behind their ports, where they lie."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from archgen import pipeline
from archgen.products.output_options import OutputOptions
from archgen.products.product_inputs import ProductInputs
from archgen.products.project_views import select_elements
from archgen.views.explorer import make_explorer_map
from archgen.views.explorer.explorer_map import make_composed_rows

ROBOT = """\
archgen: 1
project: {id: r, title: Robot}
requirements: {R-1: {title: It holds on}}
component_types:
  motor: {title: Motor, inputs: {target: Goal}, outputs: {state: State}}
chains: {c: {title: Hold, through: [planner, arm], deadline: 1 s}}
groups:
  arms:
    autoconnect: ports
    components:
      planner: {outputs: {goal: Goal}}
      arm:
        functionality: Moves a **hand**.
        requirements: [R-1]
        tags: [strong]
        inputs: {goal: {type: Goal}, spare: planner.goal}
        outputs: {state: {from: hand.state}}
        components:
          elbow: {is: motor, inputs: {target: self.goal}}
          hand:
            inputs: {goal: self.goal}
            outputs: {state: {from: finger.state}}
            components:
              finger: {is: motor, inputs: {target: self.goal}}
  outside: {components: {reader: {inputs: {state: arm.state}}}}
"""


def tables_of(folder: Path, selector: str | None = None) -> dict[str, list[Any]]:
    file = folder / "robot.yaml"
    file.write_text(ROBOT, encoding="utf-8")
    checked_project = pipeline.check_project(file)
    selection = select_elements(checked_project, selector)[0] if selector else None
    options = OutputOptions(revision="test", selection=selection, selector_text=selector or "")
    made = make_explorer_map(ProductInputs(checked_project, options).views.lookup)
    return {name: list(rows) for name, rows in made.tables.items()}


@pytest.fixture(scope="module")
def tables(tmp_path_factory: pytest.TempPathFactory) -> dict[str, list[Any]]:
    return tables_of(tmp_path_factory.mktemp("robot"))


def test_a_composed_component_names_what_is_around_and_directly_inside(tables: dict[str, list[Any]]) -> None:
    ids = [row[1] for row in tables["components"]]
    rows = [(*row[:5], [ids[at] for at in row[5]], *row[6:8]) for row in tables["shells"]]
    assert rows == [
        ("component:arms.arm", "arms.arm", "Arm", 0, -1, ["arms.arm.elbow", "arms.arm"], "", "Moves a hand ."),
        ("component:arms.arm.hand", "arms.arm.hand", "Hand", 0, 0, ["arms.arm.hand.finger"], "", ""),
    ]
    keys = [":".join(tables["keys"][at]) for at in tables["shells"][0][8]]
    assert keys == ["tag:strong", "requirement:R-1"]


def test_ports_say_what_stands_behind_them_and_what_feeds_them(tables: dict[str, list[Any]]) -> None:
    def name(table: str, at: int) -> str:
        row = tables[table][at]
        return f"{tables['components'][row[0]][1]}.{row[1]}"

    rims = [
        (
            f"{tables['shells'][shell][1]}.{port}",
            marks,
            [name("outputs" if is_output else "inputs", at) for at in behind],
            [name("outputs", at) for at in sources],
        )
        for shell, is_output, port, _, _, marks, behind, sources in tables["rims"]
    ]
    assert rims == [
        ("arms.arm.goal", 2, ["arms.arm.elbow.target", "arms.arm.hand.finger.target"], ["arms.planner.goal"]),
        ("arms.arm.spare", 0, ["arms.arm.spare"], ["arms.planner.goal"]),
        ("arms.arm.state", 0, ["arms.arm.hand.finger.state"], []),
        ("arms.arm.hand.goal", 0, ["arms.arm.hand.finger.target"], ["arms.planner.goal"]),
        ("arms.arm.hand.state", 0, ["arms.arm.hand.finger.state"], []),
    ]


def test_places_are_those_among_what_stands_side_by_side(tables: dict[str, list[Any]]) -> None:
    places = {row[1]: row[10] for row in (*tables["components"], *tables["shells"])}
    # The planner feeds the arm; the elbow and the hand lie in the arm, the finger alone in the hand.
    assert places["arms.planner"] == (0, 0)
    assert places["arms.arm"] == (1, 0)
    assert places["arms.arm.elbow"] != places["arms.arm.hand"]
    assert places["arms.arm.hand.finger"] == (0, 0)


def test_findings_chains_and_requirements_reach_composed_components(tables: dict[str, list[Any]]) -> None:
    kinds = {(row[0], row[1]) for row in tables["findings"]}
    assert (2, 0) in kinds  # `spare` of the arm is read by nothing
    ((_, _, _, _, _, components, _),) = tables["chains"]
    assert [tables["components"][at][1] for at in components] == [
        "arms.planner",
        "arms.arm",
        "arms.arm.elbow",
        "arms.arm.hand.finger",
    ]
    assert tables["requirements"] == [("requirement:R-1", "R-1", "It holds on", ())]


def test_a_selected_part_has_the_composed_components_around_it(tmp_path: Path) -> None:
    tables = tables_of(tmp_path, "elbow")
    assert [row[1] for row in tables["components"]] == ["arms.arm.elbow"]
    assert [(row[1], row[5]) for row in tables["shells"]] == [("arms.arm", (0,))]
    assert [row[6] for row in tables["rims"]] == [(0,), (), ()]


def test_without_composed_components_there_are_no_rows(tmp_path: Path) -> None:
    (tmp_path / "robot.yaml").write_text("archgen: 1\ngroups: {g: {components: {a: {outputs: {o: T}}}}}\n", "utf-8")
    checked_project = pipeline.check_project(tmp_path / "robot.yaml")
    lookup = ProductInputs(checked_project, OutputOptions(revision="test")).views.lookup
    assert make_composed_rows(lookup, [], {"g.a": 0}, {}, {}) == ()
    tables = make_explorer_map(lookup).tables
    assert (tables["shells"], tables["rims"]) == ((), ())
