"""What a project says of its report beside the chapters: read, refused with its place, packed, printed."""

from __future__ import annotations

from pathlib import Path

from archgen import pipeline
from archgen.checking.checked_packing import pack_checked_project
from archgen.link import report_chapters
from archgen.model.report_settings import HistoryEntry, ReportSettings
from archgen.products.output_options import OutputOptions
from archgen.products.product_inputs import ProductInputs
from archgen.syntax import yaml_writer

SOURCE = """\
archgen: 1
project: {title: Arm, version: "1.0"}
report:
  level: functional
  date: 2026-03-31
  number: D3.2
  authors: [A. Author, B. Writer]
  dissemination: public
  history: [{version: "0.9", date: 2026-01-01, author: A, change: draft}]
  abbreviations: {MCI: mild cognitive impairment}
  summary: It *helps*.
  lists: [figures]
  large_paper: true
groups:
  sensing:
    components:
      camera: {outputs: {image: sensor_msgs/msg/Image}, requirements: []}
      screen: {inputs: {image: camera.image}, requirements: []}
nodes:
  camera: {implements: camera}
  screen: {implements: screen}
"""
SETTINGS = ReportSettings(
    "functional",
    "2026-03-31",
    "D3.2",
    ("A. Author", "B. Writer"),
    "public",
    (HistoryEntry("0.9", "2026-01-01", "A", "draft"),),
    (("MCI", "mild cognitive impairment"),),
    "It *helps*.",
    ("figures",),
    has_large_paper=True,
)


def _check(folder: Path, source: str = SOURCE) -> pipeline.CheckedProject:
    file = folder / "archgen.yaml"
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(source, encoding="utf-8")
    return pipeline.check_project(file)


def test_everything_is_read(tmp_path: Path) -> None:
    checked = _check(tmp_path)
    assert [str(finding) for finding in checked.findings if finding.severity == "error"] == []
    assert report_chapters.read_report_settings(checked.merged_table) == SETTINGS == checked.chapters.settings


def test_a_packed_project_keeps_it(tmp_path: Path) -> None:
    packed = pack_checked_project(_check(tmp_path))
    again = _check(tmp_path / "packed", yaml_writer.write_yaml(packed.data, packed.comments))
    assert again.chapters.settings == SETTINGS


def test_wrong_values_and_keys_are_refused_where_they_stand(tmp_path: Path) -> None:
    source = SOURCE.replace("2026-03-31", "31.3.2026").replace("number:", "nubmer:").replace("[figures]", "[figure]")
    found = [
        (finding.rule, finding.span.line, finding.help)
        for finding in _check(tmp_path, source).findings
        if finding.severity == "error"
    ]
    assert found[:2] == [
        ("wrong-value", 5, "a date is written `2026-03-31`"),
        ("unknown-key", 6, "did you mean `number`?"),
    ]
    assert [line for _, line, _ in found] == [5, 6, 12]


def test_the_title_page_and_the_properties_say_it(tmp_path: Path) -> None:
    options = OutputOptions(revision="r", show_history=False, document="full")
    outline = ProductInputs(_check(tmp_path), options).printed_report
    facts = {name: value[0].text for name, value in outline.facts}
    assert facts["Number"] == outline.properties["number"] == "D3.2"
    assert facts["Date"] == "2026-03-31"
    assert facts["Level"] == "functional level"
    assert [section.title for section in outline.front_sections][:2] == ["Document history", "Abbreviations"]
    assert outline.sections[0].title == "Summary"
    assert not [section for section in outline.sections if section.anchor == "page:nodes"]


def test_the_command_line_comes_before_the_project(tmp_path: Path) -> None:
    options = OutputOptions(level="implementation", revision="r", show_history=False, document="full")
    outline = ProductInputs(_check(tmp_path), options).printed_report
    (group,) = (section for section in outline.sections if section.anchor == "group:sensing")
    assert any(
        block.anchor == "table:endpoints/sensing.camera"
        for block in group.sections[0].blocks
        if hasattr(block, "anchor")
    )


def test_left_out_the_ros_side_is_an_annex(tmp_path: Path) -> None:
    source = SOURCE.replace("  level: functional\n", "")
    options = OutputOptions(revision="r", show_history=False, document="full")
    outline = ProductInputs(_check(tmp_path, source), options).printed_report
    (annex,) = (section for section in outline.sections if section.anchor == "page:nodes")
    assert annex.appendix
    assert [section.title for section in annex.sections[0].sections] == ["Camera", "Screen"]
