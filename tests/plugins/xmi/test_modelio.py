"""The dialect of Modelio, by a model of ours in the form of its exports."""

from __future__ import annotations

from pathlib import Path

import pytest

from archgen.importers.foreign_import import ForeignImport
from archgen.plugins.xmi.xmi_import import read_xmi
from tests.plugins.xmi.uml_models import merge_sections, tell_notes

MODEL = """\
<?xml version="1.0" encoding="UTF-8"?>
<xmi:XMI xmi:version="2.1" xmlns:xmi="http://schema.omg.org/spec/XMI/2.1" xmlns:JavaExtensions="http:///schemas/JavaExtensions/_1/0" \
xmlns:ecore="http://www.eclipse.org/emf/2002/Ecore" xmlns:uml="http://www.eclipse.org/uml2/3.0.0/UML">
  <uml:Model xmi:id="_model" name="cell">
    <eAnnotations xmi:id="_e" source="Objing">
      <contents xmi:type="uml:Property" xmi:id="_ec" name="exporterVersion">
        <defaultValue xmi:type="uml:LiteralString" xmi:id="_ed" value="3.0.0"/>
      </contents>
    </eAnnotations>
    <ownedRule xmi:id="_rule" name="minlength" constrainedElement="_gain">
      <specification xmi:type="uml:LiteralString" xmi:id="_rs" value="4"/>
    </ownedRule>
    <packagedElement xmi:type="uml:Class" xmi:id="_cam" name="Camera">
      <ownedComment xmi:id="_c">
        <body>&lt;p&gt;Looks at the &lt;strong&gt;bench&lt;/strong&gt;&lt;/p&gt;</body>
      </ownedComment>
      <ownedAttribute xmi:id="_gain" name="gain" visibility="public" isUnique="false">
        <type xmi:type="uml:PrimitiveType" href="pathmap://UML_LIBRARIES/UMLPrimitiveTypes.library.uml#Integer"/>
        <defaultValue xmi:type="uml:LiteralString" xmi:id="_gd" value="3"/>
      </ownedAttribute>
      <ownedAttribute xmi:id="_tags" name="tags" visibility="private" isUnique="false">
        <upperValue xmi:type="uml:LiteralUnlimitedNatural" xmi:id="_tu" value="*"/>
        <lowerValue xmi:type="uml:LiteralInteger" xmi:id="_tl"/>
        <type xmi:type="uml:PrimitiveType" href="http://www.omg.org/spec/UML/20110701/PrimitiveTypes.xmi#String"/>
      </ownedAttribute>
      <ownedAttribute xmi:id="_store" visibility="public" type="_disk" association="_a"/>
      <ownedOperation xmi:id="_grab" name="getFrame" visibility="protected"/>
      <ownedAttribute xmi:type="uml:Port" xmi:id="_out" name="image" type="_images"/>
    </packagedElement>
    <packagedElement xmi:type="uml:Component" xmi:id="_view" name="Viewer">
      <ownedAttribute xmi:type="uml:Port" xmi:id="_in" name="picture"/>
    </packagedElement>
    <packagedElement xmi:type="uml:Interface" xmi:id="_images" name="Images"/>
    <packagedElement xmi:type="uml:Usage" xmi:id="_use" client="_in" supplier="_images"/>
    <packagedElement xmi:type="uml:Class" xmi:id="_disk" name="Disk"/>
    <packagedElement xmi:type="uml:Association" xmi:id="_a" name="keeps" memberEnd="_store _end">
      <ownedEnd xmi:id="_end" visibility="public" type="_cam" association="_a"/>
    </packagedElement>
    <profileApplication xmi:id="_pa">
      <eAnnotations xmi:id="_pe" source="http://www.eclipse.org/uml2/2.0.0/UML">
        <references xmi:type="ecore:EPackage" href="JavaExtensions.profile.xmi#_1"/>
      </eAnnotations>
      <appliedProfile href="JavaExtensions.profile.xmi#_2"/>
    </profileApplication>
  </uml:Model>
  <JavaExtensions:JavaClass xmi:id="_s1" base_Class="_cam"/>
  <JavaExtensions:JavaClass xmi:id="_s2" base_Class="_disk"/>
</xmi:XMI>
"""


@pytest.fixture
def imported(tmp_path: Path) -> ForeignImport:
    (tmp_path / "cell.xmi").write_text(MODEL, encoding="utf-8")
    return read_xmi([tmp_path / "cell.xmi"])


def test_features_without_a_kind_are_what_their_tags_say(imported: ForeignImport) -> None:
    camera = merge_sections(imported)["groups"]["cell"]["components"]["camera"]
    assert camera["parameters"] == {
        "gain": {"type": "integer", "value": 3, "visibility": "public"},
        "tags": {"type": "string[]", "visibility": "private"},
    }
    assert camera["operations"] == {
        "get_frame": {"title": "getFrame", "call": "synchronous", "visibility": "protected"}
    }
    assert camera["description"] == "Looks at the bench"


def test_ports_are_connected_by_the_interface_that_types_one_and_the_other_one_uses(imported: ForeignImport) -> None:
    components = merge_sections(imported)["groups"]["cell"]["components"]
    assert components["viewer"]["inputs"]["picture"]["from"] == "cell.camera.image"


def test_the_annotations_of_modelio_are_not_the_model(imported: ForeignImport) -> None:
    assert [each for each in tell_notes(imported) if "not taken" in each] == [
        "4 xmi:eAnnotations not taken: 1 `eAnnotations` is not taken: what the tool keeps for itself",
        "9 uml:Constraint not taken: the Constraint `minlength` is not taken: archgen cannot check it",
        "25 uml:Property not taken: the Property `_store` is not taken: it has no name",
        (
            "35 uml:Association not taken: the Association `keeps` is not taken: what flows between components is said by ports and "
            "interfaces"
        ),
        "38 uml:ProfileApplication not taken: the ProfileApplication `_pa` is not taken: profiles describe UML itself",
        (
            "45 JavaExtensions:JavaClass not taken: the stereotype `JavaExtensions:JavaClass` of 2 elements is not taken: it belongs "
            "to a profile"
        ),
    ]
    assert imported.taken["uml:Property"] == 2
