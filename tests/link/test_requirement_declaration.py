"""What is read of a requirement, and which files it may name as what verifies it."""

from __future__ import annotations

from pathlib import Path

import pytest

from archgen.diagnostics.source_span import Span
from archgen.link.named_files import find_missing_verifications
from archgen.model.architecture import Architecture, ProjectInfo
from archgen.model.requirement import Requirement, Verification
from archgen.pipeline import check_project
from archgen.syntax.folder_files import FolderFiles

TEXT = """\
use_cases: {UC-1: Walk}
requirements:
  R-1: Whole
  R-2: {title: Part, parent: R-1, kind: safety, priority: 1, rationale: W, source: 1.10, verified_by: by hand}
  R-3: {parent: [R-1, R-2, R-1, R-9], verified_by: [UC-1, see, a/b.py, by hand, see]}
chains: {see: {through: [g.a, g.b]}}
groups: {g: {components: {a: {outputs: {o: std_msgs/msg/Bool}}, b: {inputs: {o: a.o}}}}}
"""


def test_scalars_are_lists_and_words_are_what_they_name(tmp_path: Path) -> None:
    (tmp_path / "robot.yaml").write_text(TEXT, encoding="utf-8")
    requirements = check_project(tmp_path / "robot.yaml").architecture.requirements
    assert requirements["R-2"] == Requirement(
        "R-2", "Part", None, ("R-1",), "safety", "1", "W", "1.10", (Verification("text", "by hand"),)
    )
    assert requirements["R-3"].parents == ("R-1", "R-2")
    assert [(each.kind, each.text) for each in requirements["R-3"].verified_by] == [
        ("use_case", "UC-1"),
        ("chain", "see"),
        ("file", "a/b.py"),
        ("text", "by hand"),
    ]
    assert (requirements["R-3"].at.line, requirements["R-3"].parent_at.column) == (5, 18)


@pytest.mark.parametrize(
    ("name", "is_missing"),
    [
        ("a.py", False),
        ("a.py::test_it", False),
        ("sub/b.py", False),
        ("b.py", False),  # beside the file that names it
        ("sub", False),
        ("c.py", True),
        ("::test_it", True),
        ("../outside.py", True),
        ("/etc/passwd", True),
        ("sub/../../outside.py", True),
        ("link.py", True),
    ],
)
def test_only_files_of_the_project_verify(name: str, is_missing: bool, tmp_path: Path) -> None:  # noqa: FBT001
    project = tmp_path / "project"
    (project / "sub").mkdir(parents=True)
    for file in (project / "a.py", project / "sub" / "b.py", tmp_path / "outside.py"):
        file.write_text("", encoding="utf-8")
    (project / "link.py").symlink_to(tmp_path / "outside.py")
    verification = Verification("file", name, Span("sub/slice.yaml", 1, 1, 1, 2))
    requirement = Requirement("R", "R", verified_by=(verification,))
    architecture = Architecture(ProjectInfo("p", "P"), requirements={"R": requirement})
    assert bool(list(find_missing_verifications(architecture, FolderFiles(project)))) is is_missing


def test_what_could_not_be_read_may_declare_it() -> None:
    requirement = Requirement("R", "R", verified_by=(Verification("file", "see"),))
    architecture = Architecture(ProjectInfo("p", "P"), requirements={"R": requirement})
    assert len(list(find_missing_verifications(architecture, None))) == 1
    for unread in ("see", "chains", "use_cases"):
        lost = Architecture(ProjectInfo("p", "P"), requirements={"R": requirement}, unread_keys=frozenset({unread}))
        assert list(find_missing_verifications(lost, None)) == []
