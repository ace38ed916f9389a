"""The UML model that `archgen export xmi` writes: well-formed, whole in itself, and read again as what it was."""

from __future__ import annotations

import time
from pathlib import Path
from typing import Any
from xml.etree import ElementTree as ET

import pytest

from archgen.checking.checked_packing import pack_checked_project
from archgen.pipeline import CheckedProject, check_project
from archgen.plugins.xmi.views.uml_types import IdRegistry, UmlTypes
from archgen.plugins.xmi.xmi_import import read_xmi
from archgen.products.output_options import OutputOptions
from archgen.products.project_outputs import render_exported
from archgen.products.project_views import select_elements
from archgen.syntax.yaml_writer import write_yaml
from tests import hostile
from tests.judged_projects import judge_shipped
from tests.running import ROOT, archgen_here

ID = "{http://www.omg.org/spec/XMI/20131001}id"
TYPE = "{http://www.omg.org/spec/XMI/20131001}type"
REFERENCES = frozenset(
    {"type", "client", "supplier", "general", "realizingClassifier", "utilizedElement", "deployedArtifact", "role"}
    | {"memberEnd", "association", "annotatedElement", "signature", "formal", "actual", "parameter"}
    | {"parameteredElement", "templateParameter"}
)
EXAMPLES = {
    **{name: ROOT / "examples" / name for name in ("arm", "cleaning_robot", "drone", "headlamp")},
    "ramcip": ROOT / "example_ramcip",
}


def export(checked: CheckedProject, selector: str = "") -> str:
    selection = select_elements(checked, selector)[0] if selector else None
    return render_exported(checked, OutputOptions(selection, selector), "xmi").decode()


def check_model(text: str) -> ET.Element:
    """Return the model, if every id is there once and every reference leads to one."""
    root = ET.fromstring(text)  # noqa: S314 - our own output
    ids = [each.attrib[ID] for each in root.iter() if ID in each.attrib]
    assert len(ids) == len(set(ids))
    known = set(ids)
    for element in root.iter():
        for name in REFERENCES & element.attrib.keys():
            assert set(element.attrib[name].split()) <= known, (element.tag, name, element.attrib[name])
    return root


def import_back(text: str, folder: Path) -> Path:
    """Import a model as a project of its own, and return its folder."""
    folder.mkdir()
    file = folder / "model.uml"
    file.write_text(text, encoding="utf-8")
    imported = read_xmi([file])
    assert [each for each in imported.notes if each.fate == "not taken"] == []
    for name, sections in imported.slices.items():
        (folder / name).write_text(write_yaml(sections), encoding="utf-8")
    project = {"archgen": 1, "project": {"id": "back", "title": imported.title}}
    (folder / "archgen.yaml").write_text(write_yaml(project), encoding="utf-8")
    return folder


def list_facts(checked: CheckedProject) -> dict[str, Any]:
    """Return what UML can say of an architecture."""
    architecture = checked.architecture
    everyone = {**architecture.components, **architecture.shells}
    return {
        "groups": {each.id: (each.title, each.description) for each in architecture.groups.values()},
        "components": {
            name: (
                *(each.title, each.functionality, each.description, each.parent),
                *(sorted(each.inputs), {port: output.type for port, output in each.outputs.items()}),
                {key: (each.call and None, each.title) for key, each in each.operations.items()},
            )
            for name, each in everyone.items()
        },
        "edges": {(each.output, each.input) for each in architecture.edges},
        "types": {
            # What only a service's request names is no part of a UML model.
            name: [(field.name, field.type) for field in each.fields]
            for name, each in architecture.types.items()
            if each.fields
        },
        "hosts": {each.id: each.title for each in architecture.hosts.values()},
        "links": {each.id: (each.connects, each.devices, each.title) for each in architecture.links.values()},
        "nodes": {
            each.id: (each.implements, each.package, each.executable, each.host)
            for each in architecture.nodes.values()
            # What stands inside of an instance has no element of its own in UML, so nothing can be deployed for it.
            if each.written and each.implements and not any(everyone[name].parent for name in each.implements)
        },
    }


@pytest.fixture(scope="module", params=EXAMPLES)
def example(request: pytest.FixtureRequest) -> CheckedProject:
    return judge_shipped(EXAMPLES[request.param])


def test_export_import_export_gives_the_same_model(example: CheckedProject, tmp_path: Path) -> None:
    first = export(example)
    check_model(first)
    back = check_project(import_back(first, tmp_path / "back"))
    assert not back.has_errors, [each.message for each in back.findings]
    assert export(back) == first
    before, after = list_facts(example), list_facts(back)
    for name in before:
        assert after[name] == before[name], name


def test_import_export_import_gives_the_same_slices(tmp_path: Path) -> None:
    first = read_xmi([ROOT / "examples" / "headlamp" / "headlamp.xmi"])
    file = tmp_path / "headlamp.uml"
    file.write_text(export(judge_shipped(ROOT / "examples" / "headlamp")), encoding="utf-8")
    again = read_xmi([file])
    assert again.slices == first.slices
    assert again.title == first.title


LIBRARY = """\
archgen: 1
project: {id: lab, title: The lab}
component_types:
  sensor: {abstract: true, parameters: {rate: 10, mode: {choices: [slow, fast], value: slow}}, timing: {rate: 50 Hz}}
  camera: {is: sensor, title: Camera head, outputs: {image: Image}, operations: {get_image: {response: Image, visibility: protected}}}
  viewer: {inputs: {image: Image}}
  filter: {generic: [T], inputs: {raw: T}, outputs: {clean: T}}
types: {Image: {fields: {width: int32, row: "uint8[<=5]", grid: "float64[3]", name: string<=10}}, Colour: {values: [RED, BLUE]}}
groups: {g: {components: {front: {is: camera, parameters: {rate: 20}}, screen: {is: viewer, inputs: {image: front.image}}}}}
hosts: {pc: Computer}
"""


@pytest.fixture
def library(tmp_path: Path) -> Path:
    (tmp_path / "archgen.yaml").write_text(LIBRARY, encoding="utf-8")
    return tmp_path


def list_names(root: ET.Element, kind: str) -> list[str]:
    return [each.attrib["name"] for each in root.iter() if each.attrib.get(TYPE) == f"uml:{kind}"]


def test_select_type_gives_the_classes_of_a_library_abstract_ones_too(library: Path) -> None:
    root = check_model(archgen_here("export", "xmi", "--select", "type:", cwd=library).stdout.decode())
    assert list_names(root, "Class") == ["Sensor", "Camera head", "Viewer", "Filter", "T"]
    abstract = [each.attrib["name"] for each in root.iter() if each.attrib.get("isAbstract") == "true"]
    assert abstract == ["Sensor"]
    assert not list_names(root, "Component")
    assert not list_names(root, "Node")
    assert {*list_names(root, "Port")} == {"image", "raw", "clean"}
    assert {*list_names(root, "Operation")} >= {"get_image"}


def test_classes_of_a_library_with_ids_of_a_tool_come_back_as_types(tmp_path: Path) -> None:
    text = "component_types: {eye: {outputs: {image: Image}, hints: {uml: {id: _1}}}}\nproject: {id: lab}\n"
    (tmp_path / "archgen.yaml").write_text(text, encoding="utf-8")
    file = tmp_path / "library.uml"
    file.write_bytes(archgen_here("export", "xmi", "--select", "type:", cwd=tmp_path).stdout)
    sections = {key: value for each in read_xmi([file]).slices.values() for key, value in each.items()}
    assert sections["component_types"] == {
        "eye": {"outputs": {"image": {"type": "Image"}}, "hints": {"uml": {"id": "_1"}}}
    }
    assert "groups" not in sections


def test_other_exports_still_ask_for_a_value_of_type(library: Path) -> None:
    refused = archgen_here("export", "graphml", "--select", "type:", cwd=library, status=2)
    assert b"`type:` needs a value" in refused.stderr


def test_a_selection_has_what_its_components_are_made_from(library: Path) -> None:
    root = check_model(export(check_project(library), "front"))
    assert list_names(root, "Component") == ["Front"]
    assert list_names(root, "Class") == ["Sensor", "Camera head"]


def test_types_parameters_and_values_come_back(library: Path, tmp_path: Path) -> None:
    back = import_back(export(check_project(library)), tmp_path / "back")
    packed = pack_checked_project(check_project(back)).data
    original = pack_checked_project(check_project(library)).data
    types: Any = original["component_types"]
    assert packed["component_types"] == {
        **{name: types[name] for name in ("camera", "viewer", "filter")},
        "sensor": {
            "abstract": True,
            "parameters": {
                "rate": {"type": "integer", "value": 10},
                "mode": {"choices": ["slow", "fast"], "value": "slow"},
            },
            "timing": {"rate": "50 Hz"},
        },
        "camera": {
            **types["camera"],
            "operations": {"get_image": {"response": "Image", "call": "synchronous", "visibility": "protected"}},
        },
    }
    assert packed["types"] == original["types"]
    components: Any = packed["groups"]["g"]["components"]  # type: ignore[index]
    assert components["front"]["parameters"] == {"rate": {"value": 20}}
    assert components["screen"]["inputs"] == {"image": {"from": ["g.front.image"]}}


@pytest.mark.parametrize("kind", hostile.TEXTS)
def test_hostile_texts_stay_texts(kind: str, tmp_path: Path) -> None:
    (tmp_path / "archgen.yaml").write_text(hostile.written(hostile.project(hostile.TEXTS[kind])), "utf-8")
    text = export(check_project(tmp_path))
    check_model(text)
    file = tmp_path / "back.uml"
    file.write_text(text, encoding="utf-8")
    assert read_xmi([file]).slices


def test_a_model_of_5000_elements_is_read_in_time(tmp_path: Path) -> None:
    component = (
        '<packagedElement xmi:type="uml:Class" xmi:id="k{n}" name="k{n}"><ownedAttribute xmi:type="uml:Property" '
        'xmi:id="a{n}" name="gain" visibility="public"><type href="x#Real"/></ownedAttribute></packagedElement>'
        '<packagedElement xmi:type="uml:Component" xmi:id="c{n}" name="c{n}"><ownedAttribute xmi:type="uml:Port" '
        'xmi:id="p{n}" name="out"/><ownedAttribute xmi:type="uml:Port" xmi:id="q{n}" name="in"/><realization '
        'xmi:id="r{n}" realizingClassifier="k{n}"/></packagedElement><packagedElement xmi:type="uml:Interface" '
        'xmi:id="i{n}" name="i{n}"/><packagedElement xmi:type="uml:Usage" xmi:id="u{n}" client="q{n}" supplier="i{n}"/>'
        '<packagedElement xmi:type="uml:Realization" xmi:id="z{n}" client="p{n}" supplier="i{m}"/>'
    )
    body = "\n".join(component.format(n=number, m=(number + 1) % 700) for number in range(700))
    file = tmp_path / "large.uml"
    file.write_text(
        '<uml:Model xmi:version="20131001" xmlns:xmi="http://www.omg.org/spec/XMI/20131001" '
        f'xmlns:uml="http://www.eclipse.org/uml2/5.0.0/UML" xmi:id="m" name="m">{body}</uml:Model>',
        encoding="utf-8",
    )
    start = time.process_time()
    imported = read_xmi([file])
    assert sum(imported.taken.values()) > 5000
    # Measured: a third of a second; the limit is for a busy machine.
    assert time.process_time() - start < 20


@pytest.mark.parametrize("only_used", [False, True])
def test_many_types_that_name_others_are_written_in_time(*, only_used: bool) -> None:
    fields = {number: {"next": {"type": f"T{number - 1}"}, "own": {"type": f"Named{number}"}} for number in range(1000)}
    types = UmlTypes(IdRegistry(), {f"T{number}": {"fields": each} for number, each in fields.items()})
    types.refer("T900")
    start = time.process_time()
    written = [dict(each["attributes"])["name"] for each in types.write_types(only_used=only_used)]
    # Measured: a tenth of a second; 7 and 10 seconds when each type was held against all others.
    assert time.process_time() - start < 3
    count = 901 if only_used else 1000
    assert written[:count] == [f"T{number}" for number in range(count)]
    assert f"T{count}" not in written


def test_a_group_called_type_is_a_group(tmp_path: Path) -> None:
    (tmp_path / "archgen.yaml").write_text(
        "archgen: 1\nproject: {id: p}\ngroups:\n  type:\n    components:\n      a: {outputs: {x: {type: Pose}}}\n"
        "      b: {inputs: {x: {from: type.a.x}}}\ntypes: {Pose: {}}\n"
    )
    checked = check_project(tmp_path)
    back = check_project(import_back(export(checked), tmp_path / "back"))
    assert list_facts(back)["edges"] == list_facts(checked)["edges"] == {("type.a.x", "type.b.x")}


@pytest.mark.parametrize(
    ("timing", "seconds"),
    [
        ("period: 20 ms", "0.02"),
        ("rate: 3 Hz", "0.333333333"),
        ("period: 999999999999999999 h", "3599999999999999996400"),
    ],
)
def test_a_period_is_exported_in_seconds(tmp_path: Path, timing: str, seconds: str) -> None:
    (tmp_path / "archgen.yaml").write_text(
        f"archgen: 1\nproject: {{id: p}}\ngroups:\n  g:\n    components:\n      a: {{title: A, timing: {{{timing}}}}}\n"
    )
    model = check_model(export(check_project(tmp_path)))
    (sample,) = (each for each in model.iter("ownedAttribute") if each.attrib["name"] == "sample")
    assert [each.attrib["value"] for each in sample.iter("defaultValue")] == [seconds]
