"""What `archgen fmt` writes: proven to say the same; what cannot be laid out, and files of others, stay as they are."""

from __future__ import annotations

import codecs
from pathlib import Path

import pytest

from archgen.edit.element_edit import FileEdit
from archgen.edit.formatted_slices import UnformattedFile, format_text, plan_formatting
from archgen.pipeline import check_project
from archgen.syntax import slice_layout
from archgen.syntax.slice_layout import UnformattableError
from tests.running import ROOT

PROJECT = """\
archgen: 1
partners:
    tum: {title: TUM}
groups:
    sensing:
        owner: tum
        components:
            lidar: { outputs: {scan: Scan} }
"""
TIDY = """\
archgen: 1
partners:
  tum: {title: TUM}
groups:
  sensing:
    owner: tum
    components:
      lidar: {outputs: {scan: Scan}}
"""


def plan(folder: Path, text: str, **files: str) -> list[FileEdit | UnformattedFile]:
    (folder / "archgen.yaml").write_text(text, encoding="utf-8", newline="")
    for name, content in files.items():
        (folder / f"{name}.yaml").write_text(content, encoding="utf-8", newline="")
    return list(plan_formatting(check_project(folder)))


def test_a_file_is_laid_out_and_then_stays(tmp_path: Path) -> None:
    (edit,) = plan(tmp_path, PROJECT)
    assert isinstance(edit, FileEdit)
    assert edit.new_content.decode() == TIDY
    assert plan(tmp_path, TIDY) == []


def test_line_ends_and_byte_order_mark_stay(tmp_path: Path) -> None:
    mark = codecs.BOM_UTF8.decode()
    (edit,) = plan(tmp_path, mark + PROJECT.replace("\n", "\r\n"))
    assert isinstance(edit, FileEdit)
    assert edit.new_content.decode() == mark + TIDY.replace("\n", "\r\n")
    assert format_text("a:   1\r\nb: 2\n\n\nc: 3\n") == "a: 1\nb: 2\n\nc: 3\n"


def test_what_cannot_be_laid_out_is_named_and_the_rest_is_written(tmp_path: Path) -> None:
    planned = plan(
        tmp_path, PROJECT, broken="groups: {a: {title: A\n", kept="groups:\n  a:\n    description: |2\n        x\n"
    )
    assert {(each.file, each.line) for each in planned if isinstance(each, UnformattedFile)} == {
        ("broken.yaml", 1),
        ("kept.yaml", 3),
    }
    assert [each.file for each in planned if isinstance(each, FileEdit)] == ["archgen.yaml"]


def test_an_ignore_comment_goes_on_reaching_its_finding(tmp_path: Path) -> None:
    long_title = "x" * 90
    text = TIDY.replace(
        "{scan: Scan}}", f"{{scan: Scan}}, title: {long_title}}} # archgen: ignore[unread-output] shown by itself"
    )
    project = check_project(_write(tmp_path, text))
    (edit,) = plan_formatting(project)
    assert isinstance(edit, FileEdit)
    assert "lidar:  # archgen: ignore" in edit.new_content.decode()
    before = [finding.rule for finding in project.findings]
    after = [finding.rule for finding in check_project(_write(tmp_path, edit.new_content.decode())).findings]
    assert before == after
    assert "unread-output" not in before


def _write(folder: Path, text: str) -> Path:
    (folder / "archgen.yaml").write_text(text, encoding="utf-8")
    return folder


def test_a_layout_that_says_something_else_is_not_taken(monkeypatch: pytest.MonkeyPatch) -> None:
    for wrong in ("a: 2\n", "a: 1\n# other\n", "# c\na: 1\n", "a: '1'  # c\n", "a: 1  # c\nb:\n"):
        monkeypatch.setattr(slice_layout, "format_slice", lambda _, wrong=wrong: wrong)
        with pytest.raises(UnformattableError):
            format_text("a:   1 # c\n")


def test_files_of_libraries_stay() -> None:
    project = check_project(ROOT / "examples/vehicle/scenario")
    assert project.loaded_project.library_files
    planned = list(plan_formatting(project, project.loaded_project.library_files))
    assert [type(each) for each in planned] == [UnformattedFile] * len(planned)
