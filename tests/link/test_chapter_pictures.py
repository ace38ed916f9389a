"""Pictures of chapters in a project that holds its texts itself."""

from __future__ import annotations

from pathlib import Path

from archgen.pipeline import check_project

_PACKED = """\
archgen: 1
report:
  chapters: [docs/a.md]
  texts:
    docs/a.md: "![There](there.png) ![Gone](gone.png)"
  pictures:
    docs/there.png: aGVsbG8=
"""


def test_a_packed_project_holds_its_pictures_itself(tmp_path: Path) -> None:
    (tmp_path / "robot.yaml").write_text(_PACKED)
    findings = check_project(tmp_path / "robot.yaml").findings
    assert [(str(d.span), d.message) for d in findings if d.rule == "missing-picture"] == [
        ("robot.yaml:5:5", "the picture `gone.png` of the chapter `docs/a.md` is not there")
    ]
