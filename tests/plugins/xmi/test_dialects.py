"""What tools write otherwise than the paper: each dialect by a small model of ours."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from archgen.plugins.xmi.xmi_import import read_xmi
from tests.plugins.xmi.uml_models import merge_sections, read_model, tell_notes, write_model


def read_components(folder: Path, contents: str) -> dict[str, Any]:
    components: dict[str, Any] = merge_sections(read_model(folder, contents))["groups"]["lab"]["components"]
    return components


def test_enterprise_architect_has_owned_ports_with_provided_and_required(tmp_path: Path) -> None:
    components = read_components(
        tmp_path,
        '<packagedElement xmi:type="uml:Component" xmi:id="a" name="a"><ownedPort xmi:type="uml:Port" xmi:id="pa" name="x">'
        '<provided xmi:type="uml:Interface" xmi:id="i1" name="Scan"/></ownedPort></packagedElement>'
        '<packagedElement xmi:type="uml:Component" xmi:id="b" name="b"><ownedPort xmi:type="uml:Port" xmi:id="pb" name="y">'
        '<required xmi:type="uml:Interface" xmi:id="i2" name="Scan"/></ownedPort></packagedElement>',
    )
    assert components["b"]["inputs"]["y"]["from"] == "lab.a.x"


def test_enterprise_architect_calls_types_by_their_ids(tmp_path: Path) -> None:
    imported = read_model(
        tmp_path,
        '<packagedElement xmi:type="uml:Class" xmi:id="k" name="k"><ownedAttribute xmi:type="uml:Property" xmi:id="p" '
        'name="gain"><type xmi:idref="EAJava_float"/><defaultValue xmi:type="uml:LiteralString" xmi:id="d" value="0.5"/>'
        "</ownedAttribute></packagedElement>",
    )
    assert merge_sections(imported)["component_types"]["k"]["parameters"] == {"gain": {"type": "float", "value": 0.5}}


def test_visual_paradigm_has_owned_members_and_extensions(tmp_path: Path) -> None:
    imported = read_model(
        tmp_path,
        '<ownedMember xmi:type="uml:Component" xmi:id="c" name="c"><xmi:Extension extender="Visual Paradigm"/>'
        '<ownedPort xmi:type="uml:Port" xmi:id="p" name="x"><xmi:Extension extender="Visual Paradigm"/></ownedPort>'
        '</ownedMember><ownedMember xmi:type="uml:Interface" xmi:id="i" name="I"/>'
        '<ownedMember xmi:type="uml:Usage" xmi:id="u" client="p" supplier="i"/>',
    )
    assert list(merge_sections(imported)["groups"]["lab"]["components"]["c"]["inputs"]) == ["x"]
    assert "2 xmi:Extension not taken: 2 `Extension` are not taken: what the tool keeps for itself" in tell_notes(
        imported
    )


SYSTEM = """\
<packagedElement xmi:type="uml:Class" xmi:id="cam" name="Camera">
<ownedAttribute xmi:type="uml:Port" xmi:id="image" name="image" type="i"/></packagedElement>
<packagedElement xmi:type="uml:Class" xmi:id="view" name="Viewer">
<ownedAttribute xmi:type="uml:Port" xmi:id="picture" name="picture" type="i" isConjugated="true"/></packagedElement>
<packagedElement xmi:type="uml:Interface" xmi:id="i" name="Images"/>
<packagedElement xmi:type="uml:Class" xmi:id="sys" name="System">
<ownedAttribute xmi:type="uml:Property" xmi:id="c1" name="left" type="cam" aggregation="composite"/>
<ownedAttribute xmi:type="uml:Property" xmi:id="c2" name="right" type="cam" aggregation="composite"/>
<ownedAttribute xmi:type="uml:Property" xmi:id="v" name="screen" type="view" aggregation="composite"/>
<ownedConnector xmi:type="uml:Connector" xmi:id="k"><end xmi:type="uml:ConnectorEnd" xmi:id="k1" role="image"
  partWithPort="c2"/><end xmi:type="uml:ConnectorEnd" xmi:id="k2" role="picture" partWithPort="v"/></ownedConnector>
</packagedElement>"""


def test_papyrus_has_classes_with_ports_and_parts_that_connectors_join(tmp_path: Path) -> None:
    imported = read_model(tmp_path, SYSTEM)
    sections = merge_sections(imported)
    assert list(sections["component_types"]) == ["camera", "viewer"]
    inside = sections["groups"]["lab"]["components"]["system"]["components"]
    assert {name: each["is"] for name, each in inside.items()} == {
        "left": "camera",
        "right": "camera",
        "screen": "viewer",
    }
    # Both cameras provide the interface: the connector says which one is read.
    assert inside["screen"]["inputs"] == {"picture": {"from": "right.image"}}


def test_papyrus_for_robotics_types_ports_by_nested_classes_with_services_of_other_files(tmp_path: Path) -> None:
    components = read_components(
        tmp_path,
        '<packagedElement xmi:type="uml:Class" xmi:id="a" name="Detector"><ownedAttribute xmi:type="uml:Port" xmi:id="p" '
        'name="hands" type="t"/><ownedAttribute xmi:type="uml:Port" xmi:id="q" name="commands" type="s"/>'
        '<nestedClassifier xmi:type="uml:Class" xmi:id="t"/><nestedClassifier xmi:type="uml:Class" xmi:id="s">'
        '<interfaceRealization xmi:type="uml:InterfaceRealization" xmi:id="r" client="s"><contract xmi:type="uml:Interface" '
        'href="pathmap://ROS2/std_msgs.servicedef.uml#svcdefs/P_String"/></interfaceRealization></nestedClassifier>'
        '</packagedElement><packagedElement xmi:type="uml:Usage" xmi:id="u" client="t"><supplier xmi:type="uml:Interface" '
        'href="pathmap://ROS2/geometry_msgs.servicedef.uml#svcdefs/P_PoseArray"/></packagedElement>',
    )
    detector = components["detector"]
    assert (list(detector["inputs"]), list(detector["outputs"])) == (["hands"], ["commands"])
    assert detector["inputs"]["hands"]["hints"]["uml"]["interface"] == "P_PoseArray"


def test_magicdraw_tells_the_names_of_what_lies_in_other_files(tmp_path: Path) -> None:
    file = tmp_path / "lab.xmi"
    file.write_text(
        "<?xml version='1.0' encoding='UTF-8'?><xmi:XMI xmlns:xmi='http://www.omg.org/spec/XMI/20131001' "
        "xmlns:uml='http://www.omg.org/spec/UML/20131001'><xmi:Documentation><xmi:exporter>MagicDraw UML</xmi:exporter>"
        "</xmi:Documentation><uml:Model xmi:type='uml:Model' xmi:id='m' name='Lab'><packagedElement xmi:type='uml:Class' "
        "xmi:id='k' name='k'><ownedAttribute xmi:type='uml:Property' xmi:id='p' name='gain'><type href='UML_Profile.mdzip#_9_0'>"
        "<xmi:Extension extender='MagicDraw UML 18.0'><referenceExtension referentPath='UML Profile::Types::Real'/>"
        "</xmi:Extension></type></ownedAttribute></packagedElement></uml:Model></xmi:XMI>",
        encoding="utf-8",
    )
    assert merge_sections(read_xmi([file]))["component_types"]["k"]["parameters"] == {"gain": {"type": "float"}}


def test_flow_ports_of_sysml_say_which_way_data_goes(tmp_path: Path) -> None:
    ports = [("a", "out"), ("b", "in"), ("c", "inout")]
    blocks = "".join(
        f'<packagedElement xmi:type="uml:Class" xmi:id="{name}" name="{name}"><ownedAttribute xmi:type="uml:Port" '
        f'xmi:id="{name}port" name="x"/></packagedElement>'
        for name, _ in ports
    )
    flows = "".join(
        f'<sysml:FlowPort xmi:id="f{name}" base_Port="{name}port" direction="{way}"/>' for name, way in ports
    )
    text = write_model(blocks).replace("</xmi:XMI>", f"{flows}</xmi:XMI>")
    file = tmp_path / "lab.xmi"
    file.write_text(
        text.replace("<xmi:XMI ", '<xmi:XMI xmlns:sysml="http://www.omg.org/spec/SysML" '), encoding="utf-8"
    )
    components = merge_sections(read_xmi([file]))["groups"]["lab"]["components"]
    assert {name: sorted(each.keys() & {"inputs", "outputs"}) for name, each in components.items()} == {
        "a": ["outputs"],
        "b": ["inputs"],
        "c": ["outputs"],
    }


def test_xsi_type_says_what_an_element_is(tmp_path: Path) -> None:
    file = tmp_path / "lab.uml"
    file.write_text(
        '<uml:Model xmlns:xmi="http://www.omg.org/XMI" xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" '
        'xmlns:uml="http://www.eclipse.org/uml2/3.0.0/UML" xmi:version="2.0" xmi:id="m" name="Lab"><packagedElement '
        'xsi:type="uml:Component" xmi:id="c" name="c"><ownedAttribute xsi:type="uml:Port" xmi:id="p" name="x"/>'
        "</packagedElement></uml:Model>",
        encoding="utf-8",
    )
    assert list(merge_sections(read_xmi([file]))["groups"]["lab"]["components"]["c"]["outputs"]) == ["x"]
