"""Tables 1 to 4 of "A novel model-based approach to support development cycle of robotic arm applications", row by row."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from tests.plugins.xmi.uml_models import merge_sections, read_model, tell_notes

HINT = {"hints": {"uml": {"id": "id"}}}
CAMERA = """\
<packagedElement xmi:type="uml:Class" xmi:id="Class_Id" name="GUPPY"><ownedAttribute xmi:type="uml:Property"
  xmi:id="p" name="image" visibility="protected" type="img"/></packagedElement>
<packagedElement xmi:type="uml:DataType" xmi:id="img" name="Image"/>
<packagedElement xmi:type="uml:Component" xmi:id="id" name="Comp_Name">
<ownedAttribute xmi:type="uml:Port" xmi:id="port" name="image" visibility="protected"/>
<realization xmi:type="uml:ComponentRealization" xmi:id="r" realizingClassifier="Class_Id"></realization>
</packagedElement>"""
READER = """
<packagedElement xmi:type="uml:Component" xmi:id="reader" name="reader">
<ownedAttribute xmi:type="uml:Port" xmi:id="port_id_ref" name="picture" visibility="protected"/></packagedElement>
<packagedElement xmi:type="uml:Interface" xmi:id="interface_id_ref" name="visionValueConn">
<ownedOperation xmi:type="uml:Operation" xmi:id="o" name="getImage" visibility="public"/></packagedElement>
<packagedElement xmi:type="uml:Usage" xmi:id="u"><supplier xmi:idref="interface_id_ref"/>
<client xmi:idref="port_id_ref"/></packagedElement>
"""
REALIZATION = """
<packagedElement xmi:type="uml:InterfaceRealization" xmi:id="ir"><supplier xmi:idref="interface_id_ref"/>
<client xmi:idref="port"/></packagedElement>
"""
NODE = """
<packagedElement xmi:type="uml:Node" xmi:id="Node_id" name="Node_name">
<deployment xmi:type="uml:Deployment" xmi:id="d" deployedArtifact="Artifact_id">
<client xmi:idref="Node_id"/><supplier xmi:idref="Artifact_id"/></deployment></packagedElement>
<packagedElement xmi:type="uml:Artifact" xmi:id="Artifact_id" name="RequiredLibrary"/>
"""
DEVICE = '<packagedElement xmi:type="uml:Device" xmi:id="Device_id" name="Device_name"/>'
PATH = """
<packagedElement xmi:type="uml:Association" xmi:id="Association_id" name="Protocol_name">
<ownedEnd xmi:type="uml:Property" xmi:id="Property1_id" visibility="protected" type="Node_id">
<association xmi:idref="Association_id"/></ownedEnd>
<ownedEnd xmi:type="uml:Property" xmi:id="Property2_id" visibility="protected" type="Device_id">
<association xmi:idref="Association_id"/></ownedEnd>
<memberEnd xmi:idref="Property1_id"/><memberEnd xmi:idref="Property2_id"/></packagedElement>
"""
COMMUNICATION = PATH.replace("uml:Association", "uml:CommunicationPath")
ENVIRONMENT = (
    '<packagedElement xmi:type="uml:ExecutionEnvironment" xmi:id="EE_id" name="CommunicationMiddleware"/>' + NODE
)


def make_class(contents: str, more: str = "") -> str:
    return f'<packagedElement xmi:type="uml:Class" xmi:id="id" name="ClassName"{more}>{contents}</packagedElement>'


def make_property(visibility: str) -> str:
    return make_class(
        f'<ownedAttribute xmi:type="uml:Property" xmi:id="p" name="PropertyName" visibility="{visibility}">'
        '<type xmi:type="uml:PrimitiveType" href="pathmap://UML_LIBRARIES/UMLPrimitiveTypes.library.uml#Real"/>'
        '<defaultValue xmi:type="uml:LiteralReal" xmi:id="d" value="0.5"/></ownedAttribute>'
    )


def make_operation(name: str, visibility: str, parameter: str = "") -> str:
    return make_class(
        f'<ownedOperation xmi:type="uml:Operation" xmi:id="o" name="{name}" visibility="{visibility}">'
        f"{parameter}</ownedOperation>"
    )


PARAMETER = '<ownedParameter xmi:type="uml:Parameter" xmi:id="q" name="paramName"/>'
CLASS = ("component_types", "class_name")
ROWS: list[tuple[str, str, str, tuple[str, ...], Any]] = [
    ("table 1", "Class", make_class(""), CLASS, {"title": "ClassName", **HINT}),
    (
        *("table 1", "Class, abstract", make_class("", ' isAbstract="true"'), CLASS),
        {"title": "ClassName", "abstract": True, **HINT},
    ),
    *(
        (
            *("table 1", f"Property, {visibility}", make_property(visibility), (*CLASS, "parameters")),
            {"PropertyName": {"type": "float", "value": 0.5, "visibility": visibility}},
        )
        for visibility in ("public", "protected", "private")
    ),
    *(
        (
            *("table 1", f"operation, {visibility}", make_operation("MethodName", visibility), (*CLASS, "operations")),
            {"method_name": {"title": "MethodName", "visibility": visibility}},
        )
        for visibility in ("public", "protected", "private")
    ),
    (
        *("table 1", "parameter", make_operation("getIt", "protected", PARAMETER), (*CLASS, "operations", "get_it")),
        {"title": "getIt", "request": {"param_name": None}, "call": "synchronous", "visibility": "protected"},
    ),
    (
        "table 1",
        "inheritance",
        make_class('<generalization xmi:type="uml:Generalization" xmi:id="g" general="Class_id"/>')
        + '<packagedElement xmi:type="uml:Class" xmi:id="Class_id" name="base"/>',
        (*CLASS, "is"),
        "base",
    ),
    ("table 2", "Component", CAMERA, ("groups", "lab", "components", "comp_name", "is"), "guppy"),
    ("table 2", "Port", CAMERA, ("component_types", "guppy", "outputs"), {"image": {"type": "Image"}}),
    (
        *("table 2", "Interface provided", CAMERA + READER + REALIZATION),
        ("groups", "lab", "components", "comp_name", "outputs", "image", "hints", "uml", "interface"),
        "visionValueConn",
    ),
    (
        *("table 2", "Interface required", CAMERA + READER + REALIZATION),
        ("groups", "lab", "components", "reader", "inputs", "picture", "from"),
        "lab.comp_name.image",
    ),
    (
        *("table 3", "Device", DEVICE, ("groups", "lab", "components", "device_name")),
        {"title": "Device_name", "hints": {"uml": {"id": "Device_id", "kind": "Device"}}},
    ),
    ("table 3", "Node", NODE, ("hosts", "node_name", "title"), "Node_name"),
    (
        *("table 3", "CommunicationPath", NODE + DEVICE + COMMUNICATION, ("links", "protocol_name", "connects")),
        ["node_name", "lab.device_name"],
    ),
    ("table 3", "Artefact", NODE, ("hosts", "node_name", "hints", "uml", "artifacts"), ["RequiredLibrary"]),
    (
        *("table 3", "Execution Environment", ENVIRONMENT, ("hosts", "node_name", "hints", "uml", "middleware")),
        "CommunicationMiddleware",
    ),
    (
        *("table 4", "Component", CAMERA, ("groups", "lab", "components", "comp_name")),
        {
            "title": "Comp_Name",
            "is": "guppy",
            "outputs": {"image": {"hints": {"uml": {"id": "port"}}}},
            **HINT,
        },
    ),
    (
        *("table 4", "Interface", READER, ("groups", "lab", "components", "reader", "inputs", "picture")),
        {"hints": {"uml": {"id": "port_id_ref", "interface": "visionValueConn"}}},
    ),
    (
        *("table 4", "Usage", CAMERA + READER + REALIZATION),
        ("groups", "lab", "components", "reader", "inputs", "picture"),
        {"from": "lab.comp_name.image", "hints": {"uml": {"id": "port_id_ref"}}},
    ),
    (
        *("table 4", "Node", NODE, ("hosts", "node_name")),
        {"title": "Node_name", "hints": {"uml": {"id": "Node_id", "artifacts": ["RequiredLibrary"]}}},
    ),
    (
        *("table 4", "Device", DEVICE, ("groups", "lab", "components", "device_name", "hints")),
        {"uml": {"id": "Device_id", "kind": "Device"}},
    ),
    (
        *("table 4", "Comm. Path", NODE + DEVICE + PATH, ("links", "protocol_name")),
        {
            "connects": ["node_name", "lab.device_name"],
            "title": "Protocol_name",
            "hints": {"uml": {"id": "Association_id"}},
        },
    ),
    ("table 4", "Artefact", NODE, ("hosts", "node_name", "hints", "uml", "artifacts"), ["RequiredLibrary"]),
    (
        *("table 4", "Execution Env.", ENVIRONMENT, ("hosts", "node_name", "hints", "uml")),
        {"id": "Node_id", "middleware": "CommunicationMiddleware", "artifacts": ["RequiredLibrary"]},
    ),
]


@pytest.mark.parametrize(
    ("contents", "path", "expected"),
    [each[2:] for each in ROWS],
    ids=[f"{table}: {row}" for table, row, *_ in ROWS],
)
def test_a_row_of_the_paper(tmp_path: Path, contents: str, path: tuple[str, ...], expected: object) -> None:
    found: Any = merge_sections(read_model(tmp_path, contents))
    for key in path:
        found = found[key]
    assert found == expected


@pytest.mark.parametrize(
    ("name", "visibility", "call"),
    [("getIt", "protected", "synchronous"), ("setIt", "protected", "asynchronous"), ("getIt", "public", None)],
)
def test_protected_methods_are_called_and_wait_or_not(tmp_path: Path, name: str, visibility: str, call: str) -> None:
    sections = merge_sections(read_model(tmp_path, make_operation(name, visibility)))
    (operation,) = sections["component_types"]["class_name"]["operations"].values()
    assert operation.get("call") == call


def test_a_component_without_realization_has_no_parameters_and_a_note(tmp_path: Path) -> None:
    imported = read_model(tmp_path, CAMERA.replace("realizingClassifier", "other"))
    assert merge_sections(imported)["groups"]["lab"]["components"]["comp_name"] == {
        "title": "Comp_Name",
        "outputs": {"image": {"hints": {"uml": {"id": "port"}}}},
        **HINT,
    }
    assert (
        "5 uml:Component noted: no class realizes the Component `Comp_Name`: it has no parameters and no operations"
        in tell_notes(imported)
    )


@pytest.mark.parametrize(
    ("text", "timing"),
    [
        ("0.02", {"period": "20 ms"}),
        ("2", {"period": "2 s"}),
        ("0.0000015", {"period": "1500 ns"}),
        ("50 Hz", {"rate": "50 Hz"}),
        ("0", None),
        ("0.0", None),
    ],
)
def test_the_property_sample_is_the_period(tmp_path: Path, text: str, timing: object) -> None:
    attribute = f'<ownedAttribute xmi:type="uml:Property" xmi:id="s" name="sample" default="{text}"/>'
    imported = read_model(tmp_path, make_class(attribute))
    assert merge_sections(imported)["component_types"]["class_name"].get("timing") == timing
    assert not [each for each in imported.notes if each.kind == "uml:Property"]


@pytest.mark.parametrize("text", ["often", "-1", "nan", "inf", "1e999", "0.0000000001", "9" * 4000])
def test_what_is_no_period_is_noted(tmp_path: Path, text: str) -> None:
    attribute = f'<ownedAttribute xmi:type="uml:Property" xmi:id="s" name="sample" default="{text}"/>'
    imported = read_model(tmp_path, make_class(attribute))
    assert "timing" not in merge_sections(imported)["component_types"]["class_name"]
    assert f"2 uml:Property not taken: `{text[:60]}` of `sample` is no period in seconds" in tell_notes(imported)
