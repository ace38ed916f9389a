"""Templates of other tools: generic component types, and classes that are bound to them."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from tests.plugins.xmi.uml_models import merge_sections, read_model, tell_notes

FILTER = """\
<packagedElement xmi:type="uml:Class" xmi:id="f" name="Filter"><ownedTemplateSignature xmi:id="s" parameter="p">
<ownedParameter xmi:type="uml:ClassifierTemplateParameter" xmi:id="p" parameteredElement="t">
<ownedParameteredElement xmi:type="uml:Class" xmi:id="t" name="T" templateParameter="p"/></ownedParameter>
</ownedTemplateSignature><ownedAttribute xmi:type="uml:Port" xmi:id="o" name="clean" type="t"/></packagedElement>
<packagedElement xmi:type="uml:DataType" xmi:id="pose" name="Pose"/>"""
BINDING = """\
<templateBinding xmi:id="b" signature="s"><parameterSubstitution xmi:id="u" formal="p" actual="pose"/></templateBinding>"""


def read_sections(folder: Path, contents: str) -> dict[str, Any]:
    return merge_sections(read_model(folder, FILTER + contents))


def test_a_class_with_a_signature_is_a_generic_type(tmp_path: Path) -> None:
    sections = read_sections(tmp_path, "")
    assert sections["component_types"]["filter"]["generic"] == ["T"]
    assert sections["component_types"]["filter"]["outputs"]["clean"]["type"] == "T"
    assert list(sections["types"]) == ["Pose"]


def test_a_bound_class_is_made_from_the_template(tmp_path: Path) -> None:
    bound = f'<packagedElement xmi:type="uml:Class" xmi:id="k" name="PoseFilter">{BINDING}</packagedElement>'
    assert read_sections(tmp_path, bound)["component_types"]["pose_filter"]["is"] == "filter<Pose>"


@pytest.mark.parametrize("binding", ["", BINDING.replace('actual="pose"', ""), BINDING.replace('"s"', '"none"')])
def test_without_a_binding_nothing_is_made_from_a_template(tmp_path: Path, binding: str) -> None:
    user = (
        '<packagedElement xmi:type="uml:Component" xmi:id="c" name="c"><realization xmi:id="r" realizingClassifier="f"/>'
        f'{binding}<ownedAttribute xmi:type="uml:Property" xmi:id="x" name="x" type="f" aggregation="composite"/>'
        '</packagedElement><packagedElement xmi:type="uml:Class" xmi:id="k" name="k"><generalization xmi:id="g" general="f"/>'
        "</packagedElement>"
    )
    imported = read_model(tmp_path, FILTER + user)
    sections = merge_sections(imported)
    assert "is" not in sections["groups"]["lab"]["components"]["c"]
    assert "is" not in sections["component_types"]["k"]
    told = [each for each in tell_notes(imported) if "nothing says what `T` of `Filter` stands for" in each]
    assert len(told) == 3
    assert len([each for each in tell_notes(imported) if "uml:TemplateBinding" in each]) == bool(binding)


@pytest.mark.parametrize("name", ["", 'name="maxSize" ', 'name="T_1" '])
def test_a_template_without_names_for_types_is_noted(tmp_path: Path, name: str) -> None:
    imported = read_model(tmp_path, FILTER.replace('name="T" ', name))
    assert "generic" not in merge_sections(imported)["groups"]["lab"]["components"]["filter"]
    assert any("its template's parameters need a name each, as `T`" in each for each in tell_notes(imported))


def test_a_component_bound_to_itself_is_no_circle(tmp_path: Path) -> None:
    bound = FILTER.replace("</packagedElement>\n<packagedElement", f"{BINDING}</packagedElement>\n<packagedElement")
    imported = read_model(tmp_path, bound)
    assert "is" not in merge_sections(imported)["component_types"]["filter"]
