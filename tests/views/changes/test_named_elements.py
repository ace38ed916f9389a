"""Titles of compared elements, and the addresses of where they are written."""

from __future__ import annotations

from pathlib import Path

from archgen.model.source_repository import SourceRepository
from archgen.pipeline import check_project
from archgen.views.changes.named_elements import list_element_addresses

ROBOT = """\
groups:
  g:
    components:
      eye: {outputs: {o: std_msgs/msg/Bool}}
      gone: {}
"""


def test_an_element_is_where_it_is_now_and_one_that_is_gone_where_it_was(tmp_path: Path) -> None:
    sides = []
    for name, text in (("a", ROBOT), ("b", "# moved\n" + ROBOT.replace("      gone: {}\n", ""))):
        (tmp_path / name).mkdir()
        (tmp_path / name / "robot.yaml").write_text(text, encoding="utf-8")
        repository = SourceRepository("https://github.com/lab/robot", folder="", commit=f"c0ffee{name}")
        sides.append((check_project(tmp_path / name / "robot.yaml").architecture, repository))
    before, after = sides
    base = "https://github.com/lab/robot/blob/c0ffee"
    assert list_element_addresses(before, after) == {
        "g": f"{base}b/robot.yaml#L3",
        "g.eye": f"{base}b/robot.yaml#L5",
        "g.eye.o": f"{base}b/robot.yaml#L5",
        "g.gone": f"{base}a/robot.yaml#L5",
    }
    assert list_element_addresses((before[0], None), (after[0], None)) == {}
