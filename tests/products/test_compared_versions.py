"""What users type as a side of a comparison."""

from __future__ import annotations

from pathlib import Path

import pytest

from archgen import git
from archgen.products.compared_versions import ProjectVersion, read_version, read_versions
from archgen.project import NotAtRevisionError
from tests.repositories import commit, repository
from tests.repositories import git as run


def host(name: str) -> dict[str, str | bytes]:
    return {"archgen.yaml": f"archgen: 1\nproject: {{id: r}}\nhosts: {{{name}: }}\n"}


def told(*found: ProjectVersion) -> list[tuple[str, str]]:
    return [(each.name, ", ".join(each.checked_project.architecture.hosts)) for each in found]


@pytest.fixture
def robot(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Give a repository: `main` moved on after `arm` left it, and the working tree of `arm` holds more."""
    root = repository(tmp_path / "robot", host("first"))
    run(root, "checkout", "-q", "-b", "arm")
    commit(root, host("arm"))
    run(root, "checkout", "-q", "main")
    commit(root, host("later"))
    run(root, "checkout", "-q", "arm")
    (root / "archgen.yaml").write_bytes(host("now")["archgen.yaml"].encode())  # type: ignore[union-attr]
    monkeypatch.chdir(root)
    return root


def test_revisions_and_the_working_tree(robot: Path) -> None:
    now = ("the working tree", "now")
    assert told(*read_versions(None, None)) == [("where this branch left main", "first"), now]
    assert told(*read_versions("main", None)) == [("main", "later"), now]
    assert told(*read_versions("main", "arm")) == [("main", "later"), ("arm", "arm")]
    assert told(*read_versions("HEAD", ".", robot)) == [("HEAD", "arm"), now]
    assert told(*read_versions("main..arm", None)) == [("main", "later"), ("arm", "arm")]
    assert told(*read_versions("main...arm", None)) == [("where arm left main", "first"), ("arm", "arm")]
    assert told(*read_versions("main..", None)) == [("main", "later"), ("HEAD", "arm")]


def test_the_main_line_that_the_project_names(robot: Path) -> None:
    run(robot, "checkout", "-q", "-b", "wrist")
    text = "archgen: 1\nproject: {id: r}\nhosts: {wrist: }\nreview: {main: arm}\n"
    (robot / "archgen.yaml").write_text(text)
    assert told(*read_versions(None, None)) == [("HEAD", "arm"), ("the working tree", "wrist")]


def test_folders_and_files(robot: Path) -> None:
    (robot / "old").mkdir()
    (robot / "old" / "archgen.yaml").write_bytes(host("old")["archgen.yaml"].encode())  # type: ignore[union-attr]
    (robot / "packed.yaml").write_bytes(host("packed")["archgen.yaml"].encode())  # type: ignore[union-attr]
    assert told(*read_versions("old", "packed.yaml")) == [("old", "old"), ("packed.yaml", "packed")]
    run(robot, "branch", "old", "main")
    assert told(read_version("old"), read_version("./old"), read_version(str(robot / "old"))) == [
        ("old", "later"),
        ("./old", "old"),
        (str(robot / "old"), "old"),
    ]


def test_what_is_neither(robot: Path) -> None:
    with pytest.raises(git.UnknownRevisionError, match="there is no revision `mian`: did you mean `main`"):
        read_version("mian")
    repository(robot / "new", {})
    (robot / "new" / "archgen.yaml").write_text("archgen: 1\n")
    with pytest.raises(NotAtRevisionError):
        read_version("HEAD", robot / "new")
