"""The annex of messages: the project's own ones with their fields, those with a meaning one by one."""

from __future__ import annotations

from pathlib import Path

import pytest

from archgen import pipeline
from archgen.products.output_options import OutputOptions
from archgen.products.project_views import make_views
from archgen.views.report.printed_report import make_message_annex
from archgen.views.shapes import Section, Table

PROJECT = """archgen: 1
project: {id: p, title: P}
ros: {interfaces: ["msgs/**/*.msg", "msgs/**/*.srv"]}
types:
  Grip: {message: my_msgs/msg/Grip}
  Hold: {message: my_msgs/srv/Hold}
  Far: {message: geometry_msgs/msg/Twist}
"""
GRIP = "# How the hand holds\n\nuint8 OPEN=0\nuint8 CLOSED=1\nstd_msgs/Header header\nint32 track\nfloat32 force # N\n"


def _make_annex(tmp_path: Path, text: str) -> Section | None:
    (tmp_path / "archgen.yaml").write_text(text, encoding="utf-8")
    for name, content in (("my_msgs/msg/Grip.msg", GRIP), ("my_msgs/srv/Hold.srv", "bool firm\n---\n")):
        path = tmp_path / "msgs" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(content, encoding="utf-8")
    checked = pipeline.check_project(tmp_path)
    return make_message_annex(make_views(checked, OutputOptions(revision="r", show_history=False)).lookup)


def test_own_messages_have_their_fields_and_others_are_left_out(tmp_path: Path) -> None:
    annex = _make_annex(tmp_path, PROJECT)
    assert annex is not None
    (table,) = [block for block in annex.blocks if isinstance(block, Table)]
    lines = {
        row[0][0].text: "".join(f"\n{run.text}" if run.line_break else run.text for run in row[1]).split("\n")
        for row in table.rows
    }
    assert lines == {
        "my_msgs/Grip": [
            "How the hand holds",
            "header: std_msgs/Header, track: int32",
            "force: float32 (N)",
            "OPEN = 0, CLOSED = 1",
        ],
        "my_msgs/Hold": ["request firm: bool"],
    }
    assert table.row_anchors == ("message:my_msgs/msg/Grip", "message:my_msgs/srv/Hold")


@pytest.mark.parametrize("types", ["", "types:\n  Far: {message: geometry_msgs/msg/Twist}\n"])
def test_without_messages_of_its_own_a_project_has_no_annex(tmp_path: Path, types: str) -> None:
    assert _make_annex(tmp_path, PROJECT.partition("types:")[0] + types) is None
