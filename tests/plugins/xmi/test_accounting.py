"""Nothing of a model is lost in silence, nothing is counted twice, and it takes time in proportion to the model."""

from __future__ import annotations

import time
from pathlib import Path

import pytest

from archgen.importers.foreign_files import XmlElement
from archgen.plugins.xmi.import_ledger import NOT_TAKEN, ImportLedger
from archgen.plugins.xmi.uml_index import UmlIndex, get_kind, get_name, read_documents
from archgen.plugins.xmi.xmi_import import convert_documents, read_xmi
from tests.plugins.xmi.uml_models import merge_sections, read_model, tell_notes, write_model


def make_element(kind: str, name: str, contents: str = "", more: str = "") -> str:
    return f'<packagedElement xmi:type="uml:{kind}" xmi:id="{name}" name="{name}"{more}>{contents}</packagedElement>'


def make_attribute(name: str, type_name: str = "", contents: str = "", kind: str = "Property") -> str:
    written = f' type="{type_name}"' if type_name else ""
    return f'<ownedAttribute xmi:type="uml:{kind}" xmi:id="{name}" name="{name}"{written}>{contents}</ownedAttribute>'


COMMENT = '<ownedComment xmi:type="uml:Comment" xmi:id="c"><body>Why.</body></ownedComment>'
ODDMENTS = [
    make_element("Interface", "i", '<ownedOperation xmi:id="o" name="start"/>' + make_attribute("state") + COMMENT)
    + make_element("Component", "a", make_attribute("p", "i", kind="Port")),
    make_element("Node", "n", make_attribute("cores") + '<ownedOperation xmi:id="o" name="boot"/>'),
    make_element("DataType", "d", make_attribute("x", "nothing_known") + make_attribute("y") + COMMENT),
    make_element("DataType", "d", make_attribute("x", "e"))
    + make_element("DataType", "e", make_attribute("z", "d") + make_attribute("w", "d")),
    make_element("Enumeration", "d", '<generalization xmi:id="g" general="d"/>'),
    make_element("Class", "k", '<ownedRule xmi:id="r" name="minlength"/><ownedReception xmi:id="s" name="told"/>'),
    make_element("Package", "empty", '<elementImport xmi:type="uml:ElementImport" xmi:id="t"/>' + COMMENT),
    make_element(
        "Class",
        "k",
        f'<ownedOperation xmi:id="o" name="go"><ownedParameter xmi:id="q">{COMMENT}</ownedParameter></ownedOperation>',
    ),
    make_element("Class", "k", make_attribute("v", "", '<qualifier xmi:id="q" name="key"/>')),
]
READ_WITH_OWNER = frozenset({"lowerValue", "upperValue", "defaultValue", "end", "ownedLiteral", "ownedEnd"})


@pytest.mark.parametrize("contents", ODDMENTS)
def test_every_element_is_taken_or_noted(tmp_path: Path, contents: str) -> None:
    file = tmp_path / "lab.xmi"
    file.write_text(write_model(contents), encoding="utf-8")
    documents = read_documents([file])
    index = UmlIndex(documents)
    ledger = ImportLedger(index)
    convert_documents(documents, index, ledger)
    forgotten = []

    def visit(element: XmlElement) -> None:
        fate = ledger.get_fate(element)
        if fate is None and "xmi:id" in element.attributes and element.tag not in READ_WITH_OWNER:
            forgotten.append((get_kind(element), get_name(element)))
        for child in element.children if fate != NOT_TAKEN else ():
            visit(child)

    visit(documents[0].models[0])
    assert forgotten == []


def test_parts_that_nobody_asks_for_are_noted_together(tmp_path: Path) -> None:
    operations = "".join(f'<ownedOperation xmi:id="o{n}" name="do{n}"/>' for n in range(7))
    imported = read_model(
        tmp_path,
        make_element("Component", "a", make_attribute("p", "i", kind="Port"))
        + "\n"
        + make_element("Interface", "i", operations),
    )
    # The interface itself counts: a port is typed by it.
    assert imported.taken["uml:Interface"] == 1
    (note,) = (each for each in imported.notes if each.kind == "uml:Operation")
    assert note.count == 7
    assert note.message == (
        "the Operations `do0`, `do1`, `do2`, `do3`, `do4` and others of the Interface `i` are not taken: an interface only says "
        "here who is connected with whom"
    )
    assert (note.span.line, note.fate) == (3, "not taken")


def test_an_element_is_counted_once(tmp_path: Path) -> None:
    contents = (
        make_element("Component", "a")
        + make_element("Component", "b")
        + make_element("Class", "k")
        + make_element("ComponentRealization", "r", more=' abstraction="a b" realizingClassifier="k"')
    )
    assert read_model(tmp_path, contents).taken["uml:ComponentRealization"] == 1


def test_a_port_that_a_stereotype_decides_uses_the_stereotype(tmp_path: Path) -> None:
    file = tmp_path / "lab.xmi"
    model = write_model(
        make_element("Component", "a", make_attribute("p", kind="Port") + make_attribute("q", kind="Port"))
    )
    flow = '<sysml:FlowPort xmlns:sysml="http://www.omg.org/spec/SysML" xmi:id="f" base_Port="p" direction="in"/>'
    other = flow.replace('direction="in"', "").replace('"f"', '"g"')
    file.write_text(model.replace("</xmi:XMI>", f"{flow}{other}</xmi:XMI>"), encoding="utf-8")
    notes = [each for each in tell_notes(read_xmi([file])) if "FlowPort" in each]
    assert notes == [
        "3 sysml:FlowPort not taken: the stereotype `sysml:FlowPort` of one element is not taken: it belongs to a profile"
    ]


def test_parts_of_a_model_in_other_files_are_noted(tmp_path: Path) -> None:
    contents = '<packagedElement xmi:type="uml:Package" href="arm.uml#_1"/><packagedElement href="#k"/>' + make_element(
        "Class", "k"
    )
    notes = [each for each in tell_notes(read_model(tmp_path, contents)) if "not taken" in each]
    assert notes == ["2 uml:Package not taken: `_1` is not taken: it lies in a file that was not named"]


def test_addresses_without_a_file_lead_into_the_same_file(tmp_path: Path) -> None:
    general = '<generalization xmi:id="g"><general href="#base"/></generalization>'
    sections = merge_sections(read_model(tmp_path, make_element("Class", "base") + make_element("Class", "k", general)))
    assert sections["component_types"]["k"]["is"] == "base"


@pytest.mark.parametrize(
    ("text", "plain"),
    [
        (
            "<p>The <b>left</b> arm,\nas &lt;built&gt;.</p>\n<ul>\n<li>one</li>\n<li>two</li></ul>",
            "The left arm, as <built>.\n\n- one\n- two",
        ),
        ("a < b and <p>", "a < b and <p>"),
        ("one&#13;&#10;two&#13;", "one\ntwo"),
        ("<T> is a type", "<T> is a type"),
        ("<div><script>alert(1)</script>Safe</div>", "Safe"),
        ("<p>" * 2000 + "deep", "deep"),
    ],
)
def test_html_of_comments_becomes_plain_text(tmp_path: Path, text: str, plain: str) -> None:
    body = (text if "&#" in text else text.replace("&", "&amp;")).replace("<", "&lt;")
    comment = f'<ownedComment xmi:type="uml:Comment" xmi:id="c"><body>{body}</body></ownedComment>'
    sections = merge_sections(read_model(tmp_path, make_element("Class", "k", comment)))
    assert sections["component_types"]["k"]["description"] == plain


ENUMERATION = make_element(
    "Enumeration", "mode", '<ownedLiteral xmi:id="l" name="fast"/><ownedLiteral xmi:id="w" name="slow"/>'
)
MANY = '<upperValue xmi:type="uml:LiteralUnlimitedNatural" xmi:id="u" value="*"/>'


def make_default(text: str) -> str:
    return f'<defaultValue xmi:type="uml:LiteralString" xmi:id="v" value="{text}"/>'


@pytest.mark.parametrize(
    ("attribute", "parameter", "note"),
    [
        (
            make_attribute("level", "mode", MANY + make_default("{}")),
            {"choices": ["fast", "slow"], "type": "string[]", "value": []},
            "",
        ),
        (
            make_attribute("level", "mode", MANY + make_default("fast, odd")),
            {"choices": ["fast", "slow"], "type": "string[]"},
            "is none of its",
        ),
        (make_attribute("level", "Integer_id", make_default("1_000")), {"type": "integer"}, "is no integer"),
        (make_attribute("level", "Real", make_default("1_0.5")), {"type": "float"}, "is no float"),
        (make_attribute("level", "Integer", make_default("\u0663")), {"type": "integer"}, "is no integer"),
    ],
)
def test_defaults_are_values_of_their_type(
    tmp_path: Path, attribute: str, parameter: dict[str, object], note: str
) -> None:
    imported = read_model(tmp_path, ENUMERATION + make_element("Class", "k", attribute))
    assert merge_sections(imported)["component_types"]["k"]["parameters"]["level"] == parameter
    assert (
        [each for each in tell_notes(imported) if "default" in each and note in each] if note else imported.notes == ()
    )


@pytest.mark.parametrize(
    ("names", "kept", "why"),
    [
        (("2DPoint",), [], "no message of ROS can be called so"),
        (("Größe",), [], "no message of ROS can be called so"),
        (("Level A", "Level_A"), ["Level A"], "its message would be `LevelA`, as that of `Level A`"),
    ],
)
def test_fields_make_messages_that_ros_can_name(
    tmp_path: Path, names: tuple[str, ...], kept: list[str], why: str
) -> None:
    contents = "".join(
        make_element("DataType", f"d{n}", make_attribute(f"x{n}", "Integer")).replace(f'name="d{n}"', f'name="{name}"')
        for n, name in enumerate(names)
    )
    imported = read_model(tmp_path, contents)
    types = merge_sections(imported)["types"]
    assert ([name for name, body in types.items() if "fields" in body], list(types)) == (kept, list(names))
    assert len([each for each in tell_notes(imported) if why in each]) == 1


def test_values_make_messages_that_ros_can_name(tmp_path: Path) -> None:
    imported = read_model(tmp_path, ENUMERATION.replace('name="mode"', 'name="2D mode"'))
    assert merge_sections(imported)["types"] == {"2D mode": {"hints": {"uml": {"id": "mode"}}}}
    (note,) = (each for each in imported.notes if each.kind == "uml:EnumerationLiteral")
    assert (note.count, "no message of ROS can be called so" in note.message) == (2, True)


def test_a_property_that_only_refers_to_a_component_is_no_part_of_it(tmp_path: Path) -> None:
    contents = make_element("Component", "whole") + make_element("Component", "part", make_attribute("owner", "whole"))
    imported = read_model(tmp_path, contents)
    assert list(merge_sections(imported)["groups"]["lab"]["components"]) == ["whole", "part"]
    assert "component_types" not in merge_sections(imported)
    assert any(
        "the property `owner` is no parameter: its type `whole` is no value" in each for each in tell_notes(imported)
    )


def test_ports_of_one_name_are_two_ports(tmp_path: Path) -> None:
    ports = make_attribute("p", kind="Port").replace('name="p"', 'name="data"') + make_attribute(
        "q", kind="Port"
    ).replace('name="q"', 'name="data"')
    components = merge_sections(read_model(tmp_path, make_element("Component", "a", ports)))["groups"]["lab"][
        "components"
    ]
    assert list(components["a"]["outputs"]) == ["data", "data_2"]


def test_a_component_that_stands_for_others_is_not_deployed_in_silence(tmp_path: Path) -> None:
    inner = make_element("Component", "inner")
    contents = (
        make_element("Component", "outer", inner)
        + make_element("Node", "pc")
        + make_element("Deployment", "d", more=' location="pc" deployedArtifact="outer"')
    )
    imported = read_model(tmp_path, contents)
    assert "nodes" not in merge_sections(imported)
    assert any("is not deployed on `pc`: it is made of components" in each for each in tell_notes(imported))


def test_a_path_of_a_node_with_itself_is_told_so(tmp_path: Path) -> None:
    ends = "".join(f'<ownedEnd xmi:type="uml:Property" xmi:id="e{n}" type="pc"/>' for n in range(2))
    contents = make_element("Node", "pc") + make_element("CommunicationPath", "bus", ends)
    assert any("it joins a node with itself" in each for each in tell_notes(read_model(tmp_path, contents)))


def make_meeting(count: int) -> str:
    """Return components that all use or realize one interface."""
    return make_element("Interface", "i") + "".join(
        make_element("Component", f"a{n}", make_attribute(f"p{n}", kind="Port"))
        + make_element("Usage" if n % 2 else "Realization", f"u{n}", more=f' client="p{n}" supplier="i"')
        for n in range(count)
    )


def test_an_interface_that_everybody_uses_connects_nobody(tmp_path: Path) -> None:
    imported = read_model(tmp_path, make_meeting(700))
    components = merge_sections(imported)["groups"]["lab"]["components"]
    assert not any("from" in port for each in components.values() for port in each.get("inputs", {}).values())
    assert any(
        "350 ports realize it and 350 use it, which makes more than 100,000 connections" in each
        for each in tell_notes(imported)
    )


def make_large_model(kind: str) -> str:
    """Return a model that took minutes where something was gone through once more for each of its elements."""
    if kind == "one name":
        return "".join(make_element("Class", f"k{n}").replace(f'name="k{n}"', 'name="k"') for n in range(10_000))
    return "".join(make_element("DataType", f"d{n}", make_attribute(f"f{n}", f"d{n + 1}")) for n in range(6_000))


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["one name", "fields"])
def test_time_is_in_proportion_to_the_model(tmp_path: Path, kind: str) -> None:
    start = time.process_time()
    assert read_model(tmp_path, make_large_model(kind)).slices
    assert time.process_time() - start < 20


def test_many_stereotypes_take_no_more_time_each(tmp_path: Path) -> None:
    file = tmp_path / "lab.xmi"
    stereotypes = "".join(f'<p:Block xmlns:p="urn:p" xmi:id="s{n}" base_Class="k"/>' for n in range(20_000))
    file.write_text(
        write_model(make_element("Class", "k")).replace("</xmi:XMI>", f"{stereotypes}</xmi:XMI>"), encoding="utf-8"
    )
    start = time.process_time()
    (note,) = (each for each in read_xmi([file]).notes if each.kind == "p:Block")
    assert (note.count, time.process_time() - start < 20) == (20_000, True)
