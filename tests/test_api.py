"""archgen in Python: what docs/api.md promises, on a project of one file."""

from __future__ import annotations

from fractions import Fraction
from pathlib import Path

import pytest

import archgen
from archgen.api import Project, SelectorError, load
from archgen.project import ProjectNotFoundError

TEXT = """\
archgen: 1
partners: {p: {reviewers: "@p"}, q: }
groups:
  sensing:
    owner: p
    components:
      camera: {outputs: {image: sensor_msgs/msg/Image}}
  acting:
    owner: q
    components:
      arm: {inputs: {image: camera.image}}
nodes:
  eye: {implements: camera, timing: {rate: 10 Hz, wcet: 3 ms}}
chains: {see: {through: [camera, arm]}}
"""


@pytest.fixture
def project(tmp_path: Path) -> Project:
    (tmp_path / "archgen.yaml").write_text(TEXT)
    return load(tmp_path)


def test_the_package_hands_the_api_on() -> None:
    assert (archgen.load, archgen.Project) == (load, Project)
    with pytest.raises(AttributeError, match="module 'archgen' has no attribute 'laod'"):
        archgen.laod  # noqa: B018 - the access is the test


def test_a_project_knows_its_folder_its_findings_and_its_size(project: Project, tmp_path: Path) -> None:
    assert project.root == tmp_path
    assert project.ok
    assert "unmapped-component" in {finding.rule for finding in project.findings}
    assert (project.size.components, project.size.connections) == (2, 1)
    assert (project.progress[0].scope, project.progress[0].components) == ("project", 2)


def test_errors_are_findings(tmp_path: Path) -> None:
    (tmp_path / "archgen.yaml").write_text(TEXT.replace("camera.image", "camera.imgae"))
    assert not load(tmp_path).ok


def test_without_a_project_there_is_an_exception(tmp_path: Path) -> None:
    with pytest.raises(ProjectNotFoundError):
        load(tmp_path / "gone")


def test_a_selector_chooses_and_a_wrong_one_is_an_exception(project: Project) -> None:
    assert project.select("owner:p").components == {"sensing.camera"}
    with pytest.raises(SelectorError, match="cemera"):
        project.select("cemera")


def test_timing_is_exact(project: Project) -> None:
    assert project.timing().paces["eye"].rate.value == Fraction(10)
    assert list(project.chains()) == ["see"]


def test_the_record_is_plain_data_of_the_whole_or_a_part(project: Project) -> None:
    whole, part = project.record(), project.record("owner:p")
    assert str(whole) != str(part)
    assert "arm" in str(whole)


def test_owners(project: Project) -> None:
    assert [partner.id for partner in project.ownership().files["archgen.yaml"]] == ["p", "q"]
    assert "/archgen.yaml @p" in project.codeowners()


def test_what_it_writes(project: Project, tmp_path: Path) -> None:
    project.write_packed(tmp_path / "out" / "packed.yaml")
    project.write_report(tmp_path / "out" / "report.docx", revision="1a2b3c4")
    project.write_agreement(tmp_path / "out" / "p-q.md", "p", "q", revision="1a2b3c4")
    assert (
        load(tmp_path / "out" / "packed.yaml").architecture.components.keys() == project.architecture.components.keys()
    )
    assert (tmp_path / "out" / "report.docx").read_bytes().startswith(b"PK")
    assert "image" in (tmp_path / "out" / "p-q.md").read_text(encoding="utf-8")
    assert project.write_diagrams(tmp_path / "out" / "diagrams", formats=("dot",), only=("overview",)) == 1


def test_an_agreement_has_one_of_three_formats(project: Project, tmp_path: Path) -> None:
    with pytest.raises(ValueError, match=r"the ending of `a.pdf` names no format: .docx, .md, .html or .json"):
        project.write_agreement(tmp_path / "a.pdf", "p", "q")


def test_rows_are_those_of_list(project: Project) -> None:
    (edge,) = project.rows("edges")
    assert (edge["output"], edge["input"], edge["message"]) == (
        "sensing.camera.image",
        "acting.arm.image",
        "sensor_msgs/msg/Image",
    )
    assert [row["id"] for row in project.rows("components", select="owner:q")] == ["acting.arm"]
    with pytest.raises(KeyError):
        project.rows("nonsense")


def test_the_graph_has_components_with_attributes_and_an_edge_for_each_connection(project: Project) -> None:
    graph = project.graph()
    assert graph.nodes["sensing.camera"]["owner"] == "p"
    ((giver, taker, key),) = graph.edges(keys=True)
    assert (giver, taker, key) == ("sensing.camera", "acting.arm", ("sensing.camera.image", "acting.arm.image"))
    assert graph.edges[giver, taker, key]["message"] == "sensor_msgs/msg/Image"
    assert list(project.graph("owner:q")) == ["acting.arm"]
    assert project.graph("owner:q").number_of_edges() == 0
