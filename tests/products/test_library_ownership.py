"""Who reviews a library: all partners, since it crosses all borders."""

from __future__ import annotations

from pathlib import Path

from archgen.pipeline import check_project
from archgen.products.code_ownership import make_codeowners
from tests.repositories import repository

PROJECT = """archgen: 1
libraries: {common: ../common}
partners: {lab: {title: Lab, reviewers: "@o/lab"}, plant: {title: Plant, reviewers: "@o/plant"}}
"""


def test_the_files_of_a_library_stand_in_codeowners_by_their_place_in_the_repository(tmp_path: Path) -> None:
    repository(tmp_path, {"robots/one/archgen.yaml": PROJECT, "robots/common/a.yaml": "component_types: {x: {}}\n"})
    lines = make_codeowners(check_project(tmp_path / "robots" / "one")).text.splitlines()
    assert "/robots/common/a.yaml @o/lab @o/plant" in lines
