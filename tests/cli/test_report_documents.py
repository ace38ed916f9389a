"""`archgen report`: each document in its file, and what changed since a version."""

from __future__ import annotations

import io
import re
import zipfile
from pathlib import Path

import pytest

from archgen.cli import report_command
from tests import readable
from tests.cli.conftest import Run
from tests.repositories import repository

PROJECT = """
project: {title: Lamp}
partners: {a: {title: Ada}, b: {title: Bob}}
types: {Light: std_msgs/msg/Bool}
groups:
  g: {owner: a, components: {sensor: {outputs: {light: Light}, timing: {rate: 10 Hz}}}}
  h: {owner: b, components: {lamp: {inputs: {light: g.sensor.light}}}}
"""


@pytest.fixture
def lamp(tmp_path: Path) -> Path:
    (tmp_path / "lamp").mkdir()
    (tmp_path / "lamp" / "archgen.yaml").write_text(PROJECT, encoding="utf-8")
    return tmp_path / "lamp"


@pytest.mark.parametrize(
    ("words", "file", "said"),
    [
        ((), "report.docx", "Still to be settled"),
        (("--document", "full"), "report.docx", "ROS side of the components"),
        (("--document", "data-sheets"), "data_sheets.docx", "Data sheets of the components"),
    ],
)
def test_each_document_has_its_file(run: Run, lamp: Path, words: tuple[str, ...], file: str, said: str) -> None:
    assert run("report", *words, lamp).status == 0
    assert [path.name for path in (lamp / "archgen-out").iterdir() if path.is_file()] == [file]
    assert said in readable.document(lamp / "archgen-out" / file)


def test_the_workbook_has_all_lists_whatever_chapters_the_report_has(run: Run, lamp: Path) -> None:
    text = (lamp / "archgen.yaml").read_text(encoding="utf-8")
    (lamp / "archgen.yaml").write_text(f"{text}report: {{chapters: [overview]}}\n", encoding="utf-8")
    assert run("report", "--document", "workbook", lamp).status == 0
    with zipfile.ZipFile(io.BytesIO((lamp / "archgen-out" / "workbook.xlsx").read_bytes())) as archive:
        sheets = re.findall(r'<sheet name="([^"]+)"', archive.read("xl/workbook.xml").decode())
    assert {"Types", "Connections", "Gives", "Takes"} <= set(sheets)


def test_it_says_what_changed_since_a_version(run: Run, lamp: Path) -> None:
    repository(lamp, {"archgen.yaml": PROJECT})
    (lamp / "archgen.yaml").write_text(PROJECT.replace("10 Hz", "5 Hz"), encoding="utf-8")
    assert run("report", "--since", "HEAD", lamp).status == 0
    text = readable.document(lamp / "archgen-out" / "report.docx")
    assert "What changed since HEAD" in text
    spread = text[text.index("[Heading2] Bob") :]
    assert "What changed for it" in spread
    assert "rate 10\u202fHz → 5\u202fHz" in spread.partition("What changed for it")[2]


def test_of_a_large_project_everything_in_one_document_comes_with_advice(
    run: Run, lamp: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(report_command, "_MAX_PAGES", 1)
    advice = "warning: all that is said of 2 components fills some "
    assert f"{advice}6 pages" in run("report", "--document", "full", lamp).err
    assert f"{advice}2 pages" in run("report", "--document", "data-sheets", lamp).err
    assert advice not in run("report", lamp).err
    assert advice not in run("report", "--document", "full", "--select", "owner:a", lamp).err
