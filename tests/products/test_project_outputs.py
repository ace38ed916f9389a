"""Single outputs, as the verbs and the API ask for them."""

from __future__ import annotations

from pathlib import Path

import pytest
import yaml

from archgen.emit.file_tree import OutputError
from archgen.pipeline import CheckedProject, check_project
from archgen.products import project_outputs
from archgen.products.output_options import OutputOptions


@pytest.fixture
def project(tmp_path: Path) -> CheckedProject:
    (tmp_path / "archgen.yaml").write_text(
        "archgen: 1\nproject: {id: rover}\ngroups: {g: {components: {a: {outputs: {o: T}}, b: {inputs: {i: a.o}}}}}\n",
        encoding="utf-8",
    )
    return check_project(tmp_path)


def test_the_packed_and_the_resolved_file_are_yaml(project: CheckedProject, tmp_path: Path) -> None:
    project_outputs.write_packed(project, tmp_path / "out" / "packed.yaml")
    project_outputs.write_resolved(project, OutputOptions(), tmp_path / "out" / "resolved.yaml")
    assert yaml.safe_load((tmp_path / "out" / "packed.yaml").read_text())["project"]["id"] == "rover"
    assert list(yaml.safe_load((tmp_path / "out" / "resolved.yaml").read_text())["components"]) == ["g.a", "g.b"]


def test_the_site_has_a_page_for_each_component(project: CheckedProject, tmp_path: Path) -> None:
    project_outputs.write_site(project, OutputOptions(show_history=False), tmp_path / "site")
    assert {file.name for file in (tmp_path / "site" / "components").rglob("*.html")} == {"g.a.html", "g.b.html"}


def test_a_picture_that_nobody_knows_is_an_error_and_nothing_is_written(
    project: CheckedProject, tmp_path: Path
) -> None:
    with pytest.raises(OutputError, match="no picture is called nowhere"):
        project_outputs.write_diagrams(project, OutputOptions(), tmp_path / "pictures", ("svg",), ("nowhere",))
    assert not (tmp_path / "pictures").exists()


def test_a_workspace_asks_for_a_backend_that_makes_one(project: CheckedProject) -> None:
    with pytest.raises(OutputError, match="wiki"):
        project_outputs.write_workspace(project, OutputOptions(), "wiki")
