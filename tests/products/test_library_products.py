"""What products know of libraries: who reviews them, what editors offer of them, and how documents name them."""

from __future__ import annotations

from pathlib import Path

from archgen.checking.code_ownership import make_codeowners
from archgen.pipeline import check_project
from archgen.products.editor_schema_marks import digest_texts, list_project_names
from archgen.views.elements.functional_level import make_component_type_table
from archgen.views.lookup import make_lookup
from tests.repositories import repository

PROJECT = """archgen: 1
libraries: {common: ../common}
partners: {lab: {title: Lab, reviewers: "@o/lab"}, plant: {title: Plant, reviewers: "@o/plant"}}
"""


def test_the_files_of_a_library_stand_in_codeowners_by_their_place_in_the_repository(tmp_path: Path) -> None:
    repository(tmp_path, {"robots/one/archgen.yaml": PROJECT, "robots/common/a.yaml": "component_types: {x: {}}\n"})
    lines = make_codeowners(check_project(tmp_path / "robots" / "one")).text.splitlines()
    assert "/robots/common/a.yaml @o/lab @o/plant" in lines


def test_editors_offer_all_component_types_of_a_library_and_none_of_them_as_a_key(tmp_path: Path) -> None:
    library = "component_types: {laser: {title: Planar laser}, lamp: {}}\n"
    text = "archgen: 1\nlibraries: {common: lib}\ncomponent_types: {own: {is: common.laser}}\n"
    for name, content in {"archgen.yaml": text, "lib/a.yaml": library}.items():
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text(content)
    checked = check_project(tmp_path)
    names = list_project_names(checked)
    assert list(names["component_type_names"]) == [
        ("own", "Own"),
        ("common.laser", "Planar laser"),
        ("common.lamp", "Lamp"),
    ]
    assert list(names["component_types"]) == [("own", "Own")]
    (tmp_path / "lib" / "a.yaml").write_text(library.replace("lamp", "torch"))
    assert digest_texts(check_project(tmp_path)) != digest_texts(checked)


def test_the_table_of_component_types_says_of_which_library_each_is_and_has_no_empty_columns(tmp_path: Path) -> None:
    text = "archgen: 1\nlibraries: {common: lib}\ncomponent_types: {own: {}}\ngroups: {g: {components: {a: {is: common.laser}}}}\n"
    for name, content in {
        "archgen.yaml": text,
        "lib/a.yaml": "component_types: {laser: {outputs: {o: Scan}}}\n",
    }.items():
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text(content)
    table = make_component_type_table(make_lookup(check_project(tmp_path).architecture))
    assert table is not None
    assert [column.title for column in table.columns] == ["Type", "Library", "Purpose", "Instances"]
    assert ["".join(run.text for run in row[1]) for row in table.rows] == ["", "common"]
