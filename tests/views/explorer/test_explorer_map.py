"""The tables of the explorer: what stands in them for each element, each flow and each key of selectors."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from archgen import pipeline
from archgen.products.output_options import OutputOptions
from archgen.products.product_inputs import ProductInputs
from archgen.products.project_views import select_elements
from archgen.views.explorer import make_explorer_map

ROBOT = """\
archgen: 1
project: {id: r, title: Robot}
partners: {acme: {title: ACME}}
requirements: {R-1: {title: It sees, tags: [must]}}
hosts: {pc: {title: Base Computer, cores: 4, tags: [big]}, spare: }
types: {Cloud: {message: sensor_msgs/msg/PointCloud2}}
properties: {maturity: {title: How far, choices: [idea, product]}, mass: Mass}
chains: {c: {title: Seen, through: [sensing.camera, finding.finder], deadline: 1 s}}
groups:
  sensing:
    owner: acme
    description: Looks *around*.
    components:
      camera:
        functionality: Sees **everything**
        tags: [safety]
        status: adapted
        properties: {maturity: idea, own: 1}
        inputs: {light: {external: Light, medium: physical}}
        outputs: {cloud: Cloud, extra: Cloud}
        timing: {behaviour: periodic, rate: 10 Hz}
  finding:
    components:
      finder: {title: Finder, requirements: [R-1], inputs: {scene: {from: camera.cloud, optional: true}, ask: asker.ask}}
      asker: {outputs: {ask: std_srvs/srv/Trigger}, inputs: {any: open}}
      open:
nodes: {eye: {implements: [sensing.camera], host: pc, package: eye_pkg}, lonely: {package: p}}
"""


def tables_of(folder: Path, selector: str | None = None) -> dict[str, list[Any]]:
    file = folder / "robot.yaml"
    file.write_text(ROBOT, encoding="utf-8")
    checked_project = pipeline.check_project(file)
    options = OutputOptions(revision="test")
    if selector:
        selection, problems = select_elements(checked_project, selector)
        assert problems == ()
        options = OutputOptions(revision="test", selection=selection, selector_text=selector)
    made = make_explorer_map(ProductInputs(checked_project, options).views.lookup)
    return {name: list(rows) for name, rows in made.tables.items()}


@pytest.fixture(scope="module")
def tables(tmp_path_factory: pytest.TempPathFactory) -> dict[str, list[Any]]:
    return tables_of(tmp_path_factory.mktemp("robot"))


def test_elements_stand_with_their_page_and_what_a_reader_asks_first(tables: dict[str, list[Any]]) -> None:
    assert [row[:5] for row in tables["groups"]] == [
        ("group:sensing", "sensing", "Sensing", "ACME", "Looks around ."),
        ("group:finding", "finding", "Finding", "", ""),
    ]
    camera, finder, asker, _ = tables["components"]
    assert camera[:6] == ("component:sensing.camera", "sensing.camera", "Camera", 0, "10 Hz", "Sees everything")
    assert camera[7:10] == ("to_100_ms", 0b01111, "warning")
    assert finder[8] == 0b10010
    assert asker[:4] == ("component:finding.asker", "finding.asker", "Asker", 1)
    assert tables["hosts"][0][:5] == ("host:pc", "pc", "Base Computer", "4 cores", "")
    eye = next(row for row in tables["nodes"] if row[1] == "eye")
    assert eye[3:7] == ((0,), 0, 0, "10 Hz")
    lonely = next(row for row in tables["nodes"] if row[1] == "lonely")
    assert lonely[3:6] == ((), -1, -1)


def test_flows_run_from_outputs_to_an_input(tables: dict[str, list[Any]]) -> None:
    outputs = [(tables["components"][row[0]][1], row[1]) for row in tables["outputs"]]
    inputs = [(tables["components"][row[0]][1], row[1], row[3], row[4]) for row in tables["inputs"]]
    assert inputs[0] == ("sensing.camera", "light", "Light · physical", 0)
    flows = [(style, inputs[reader], [outputs[at] for at in writers]) for style, reader, writers in tables["flows"]]
    assert flows == [
        (0, ("finding.finder", "scene", "", 1), [("sensing.camera", "cloud")]),
        (2, ("finding.finder", "ask", "", 0), [("finding.asker", "ask")]),
    ]
    # Nobody knows yet what `open` sends, but it feeds its reader.
    assert [(tables["components"][a][1], tables["components"][b][1]) for a, b in tables["extra"]] == [
        ("finding.open", "finding.asker")
    ]


def test_keys_are_those_that_selectors_find(tables: dict[str, list[Any]]) -> None:
    def keys_of(table: str, element: str, place: int) -> list[str]:
        row = next(row for row in tables[table] if row[1] == element)
        return [":".join(tables["keys"][at]) for at in row[place]]

    assert keys_of("components", "sensing.camera", 6) == [
        "tag:safety",
        "owner:acme",
        "type:Cloud",
        "type:sensor_msgs/msg/PointCloud2",
        "medium:physical",
        "medium:digital",
        "medium:ros",
        "status:adapted",
        "behaviour:periodic",
        "finding:unjustified-component",
        "property:maturity=idea",
        "property:own=1",
    ]
    names = [row for row in tables["names"] if row[0].startswith("property")]
    assert names == [
        ("property", "maturity", "How far"),
        ("property:maturity", "idea", "idea"),
        ("property:maturity", "product", "product"),
    ]
    assert {"tag:must", "requirement:R-1", "type:Cloud"} <= set(keys_of("components", "finding.finder", 6))
    assert keys_of("nodes", "eye", 8)[:4] == ["tag:big", "owner:acme", "host:pc", "package:eye_pkg"]


def test_findings_chains_and_requirements_name_what_they_are_about(tables: dict[str, list[Any]]) -> None:
    assert next(row for row in tables["findings"] if not row[0])[:3] == (0, 0, "warning")
    ((anchor, _, title, status, words, components, nodes),) = tables["chains"]
    assert (anchor, title, components, nodes) == ("chain:c", "Seen", (0, 1), ())
    assert words.startswith(status)
    assert status
    assert tables["requirements"] == [("requirement:R-1", "R-1", "It sees", (1,))]


def test_a_selected_part_is_all_that_is_there(tmp_path: Path) -> None:
    tables = tables_of(tmp_path, "finding")
    assert [row[1] for row in tables["groups"]] == ["finding"]
    assert [row[1] for row in tables["components"]] == ["finding.finder", "finding.asker", "finding.open"]
    assert [row[0] for row in tables["flows"]] == [2]
    assert tables["hosts"] == []
