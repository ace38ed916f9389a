"""What other products know of libraries: who reviews them, and what editors offer of them."""

from __future__ import annotations

from pathlib import Path

from archgen.pipeline import check_project
from archgen.products.code_ownership import make_codeowners
from archgen.products.schema_renewal import digest_texts, list_project_names
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
