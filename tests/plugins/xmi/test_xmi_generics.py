"""Generic and composed component types in UML: templates, bound classes, and what stands inside of them, come back."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from archgen.checking.checked_packing import pack_checked_project
from archgen.pipeline import check_project
from tests.plugins.xmi.test_xmi_export import check_model, export, import_back, list_facts, list_names
from tests.running import archgen_here

GENERICS = """\
archgen: 1
project: {id: lab, title: The lab}
types: {Envelope: {generic: [T], fields: {sender: string, payload: T, old: "T[]"}}, Pose: {}, Parcel: {fields: {inside: Envelope<Pose>}}}
component_types:
  filter: {generic: [T], inputs: {raw: T}, outputs: {clean: T}, parameters: {gain: {type: float, value: 1.5}}}
  pair: {generic: [A, B], inputs: {first: A, second: B}, outputs: {both: Envelope<A>}}
  strong: {is: filter<Pose>, title: Strong filter}
  chain:
    generic: [X]
    inputs: {raw: X}
    outputs: {clean: {from: second.clean}}
    components: {first: {is: filter<X>, inputs: {raw: self.raw}}, second: {is: filter<X>, inputs: {raw: first.clean}}}
groups:
  g:
    components:
      source: {functionality: Makes., outputs: {pose: Pose, twist: Twist}}
      smooth: {is: filter<Pose>, inputs: {raw: source.pose}, parameters: {gain: 0.5}}
      tough: {is: strong, inputs: {raw: source.pose}}
      both: {is: "pair<Pose, Twist>", inputs: {first: source.pose, second: source.twist}}
      long: {is: chain<Twist>, inputs: {raw: source.twist}}
      reader: {functionality: Reads., inputs: {x: long.clean, y: both.both}}
"""


def test_generic_types_go_out_as_templates_and_come_back(tmp_path: Path) -> None:
    (tmp_path / "archgen.yaml").write_text(GENERICS, encoding="utf-8")
    original = check_project(tmp_path)
    assert not original.has_errors
    text = export(original)
    root = check_model(text)
    bound = {"Filter<Pose>", "Filter<X>", "Pair<Pose, Twist>", "Chain<Twist>"}
    assert bound <= {*list_names(root, "Class")}
    back = check_project(import_back(text, tmp_path / "back"))
    assert export(back) == text
    packed, before = pack_checked_project(back).data, pack_checked_project(original).data
    assert packed["component_types"] == before["component_types"]
    assert packed["types"] == before["types"]
    assert list_facts(back) == list_facts(original)


def test_what_stands_inside_of_a_type_comes_back_without_an_instance(tmp_path: Path) -> None:
    (tmp_path / "archgen.yaml").write_text(GENERICS.partition("groups:")[0], encoding="utf-8")
    original = check_project(tmp_path)
    text = export(original)
    back = check_project(import_back(text, tmp_path / "back"))
    assert pack_checked_project(back).data["component_types"] == pack_checked_project(original).data["component_types"]
    assert export(back) == text


def test_composed_types_of_a_library_keep_what_their_inside_is_made_from(tmp_path: Path) -> None:
    types = GENERICS.partition("groups:")[0].replace("id: lab", "id: lib")
    (tmp_path / "lib").mkdir()
    (tmp_path / "lib" / "archgen.yaml").write_text(types, encoding="utf-8")
    project = "project: {id: p}\nsources: []\nlibraries: {lib: lib}\ngroups: {g: {components: {long: {is: lib.chain<Pose>}}}}\n"
    (tmp_path / "archgen.yaml").write_text(project, encoding="utf-8")
    folder = import_back(export(check_project(tmp_path)), tmp_path / "back")
    chain: Any = pack_checked_project(check_project(folder)).data["component_types"]["chain"]  # type: ignore[index]
    assert {name: each["is"] for name, each in chain["components"].items()} == {
        "first": "filter<X>",
        "second": "filter<X>",
    }
    assert chain["components"]["first"]["inputs"] == {"raw": {"from": ["self.raw"]}}


def test_a_selection_has_the_generic_types_of_its_components(tmp_path: Path) -> None:
    (tmp_path / "archgen.yaml").write_text(GENERICS, encoding="utf-8")
    root = check_model(export(check_project(tmp_path), "long"))
    assert {*list_names(root, "Class")} == {"Filter", "Chain", "Filter<X>", "Chain<Twist>", "T", "X"}


def test_a_project_without_component_types_has_no_classes_and_says_so(tmp_path: Path) -> None:
    (tmp_path / "archgen.yaml").write_text("project: {id: lab}\ntypes: {Image: {}}\n", encoding="utf-8")
    done = archgen_here("export", "xmi", "--select", "type:", cwd=tmp_path)
    assert b"there are no component types here: the model holds no class" in done.stderr
    assert list_names(check_model(done.stdout.decode()), "Class") == []
