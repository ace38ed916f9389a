"""A project read from a commit: the same as from disk, whatever the repository holds."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from archgen import git, pipeline
from archgen.checking.checked_packing import pack_checked_project
from archgen.pipeline import check_at_revision, check_project
from archgen.project import NotAtRevisionError, ProjectNotFoundError
from tests.repositories import commit, repository, trap
from tests.repositories import git as run
from tests.running import RAMCIP, contents

HEAD = "archgen: 1\nproject: {id: robot, title: Robot}\n"
SMALL: dict[str, str | bytes] = {"archgen.yaml": HEAD, "a.yaml": "hosts: {pc: {cores: 4}}\n"}


def said(checked: pipeline.CheckedProject) -> list[str]:
    return [f"{d.span} {d.rule}: {d.message} | {d.help}" for d in checked.findings]


@pytest.mark.slow
def test_the_case_study_is_the_same_from_disk_and_from_a_commit(tmp_path: Path) -> None:
    files = {f"robots/ramcip/{name}": data for name, data in contents(RAMCIP).items() if "archgen-out" not in name}
    repository(tmp_path, dict(files))
    project = tmp_path / "robots" / "ramcip"
    disk, committed = check_project(project), check_at_revision(project, "HEAD")
    assert committed.architecture == disk.architecture
    assert said(committed) == said(disk)
    assert committed.yaml_files == disk.yaml_files
    assert pack_checked_project(committed).data == pack_checked_project(disk).data
    assert committed.root == disk.root
    at = disk.findings[0].span
    assert committed.sources.line_of(at.file, at.line) == disk.sources.line_of(at.file, at.line) is not None


def test_files_that_are_gone_from_the_disk(tmp_path: Path) -> None:
    repository(tmp_path, {f"robot/{name}": data for name, data in SMALL.items()})
    (tmp_path / "robot" / "a.yaml").unlink()
    assert list(check_at_revision(tmp_path / "robot", "HEAD").architecture.hosts) == ["pc"]
    (tmp_path / "robot" / "archgen.yaml").unlink()
    (tmp_path / "robot").rmdir()
    assert list(check_at_revision(tmp_path / "robot", "HEAD").architecture.hosts) == ["pc"]
    assert list(check_at_revision(tmp_path / "robot" / "a.yaml", "HEAD").architecture.hosts) == ["pc"]


def test_the_project_around_the_current_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    repository(tmp_path, {**{f"robot/{name}": data for name, data in SMALL.items()}, "robot/docs/x": "1"})
    monkeypatch.chdir(tmp_path / "robot" / "docs")
    assert check_at_revision(None, "HEAD").yaml_files == ("archgen.yaml", "a.yaml")
    (tmp_path / "robot" / "archgen.yaml").unlink()
    assert check_at_revision(None, "HEAD").yaml_files == ("archgen.yaml", "a.yaml")


def test_where_the_project_does_not_exist(tmp_path: Path) -> None:
    repository(tmp_path, {"x": "1"})
    commit(tmp_path, {f"robot/{name}": data for name, data in SMALL.items()})
    with pytest.raises(NotAtRevisionError, match=r"the project `robot/archgen.yaml` does not exist in `HEAD~1`"):
        check_at_revision(tmp_path / "robot", "HEAD~1")
    with pytest.raises(git.UnknownRevisionError):
        check_at_revision(tmp_path / "robot", "HEAD~9")
    with pytest.raises(git.NoRepositoryError):
        check_at_revision(_alone(tmp_path.parent / "alone"), "HEAD")
    with pytest.raises(ProjectNotFoundError, match="does not exist"):
        check_at_revision(tmp_path.parent / "nothing", "HEAD")


def _alone(folder: Path) -> Path:
    folder.mkdir(exist_ok=True)
    (folder / "archgen.yaml").write_text(HEAD)
    return folder


def test_bare_repositories(tmp_path: Path) -> None:
    repository(tmp_path / "origin", {**SMALL, **{f"two/{name}": data for name, data in SMALL.items()}})
    run(tmp_path, "clone", "-q", "--bare", "origin", "robot.git")
    assert check_at_revision(tmp_path / "robot.git", "main").yaml_files == ("archgen.yaml", "a.yaml")
    assert check_at_revision(tmp_path / "robot.git" / "two", "main").yaml_files == ("archgen.yaml", "a.yaml")


def test_line_ends_and_a_byte_order_mark(tmp_path: Path) -> None:
    text = b"\xef\xbb\xbfhosts:\r\n  pc:\r\n    title: |\r\n      a\r\n    cores: x\r\n"
    repository(tmp_path, {"archgen.yaml": HEAD, "a.yaml": text})
    disk, committed = check_project(tmp_path), check_at_revision(tmp_path, "HEAD")
    assert said(committed) == said(disk) != []
    assert committed.architecture == disk.architecture


def test_links_stay_in_the_project(tmp_path: Path) -> None:
    root = repository(tmp_path, None)
    project = root / "robot"
    (project / "docs").mkdir(parents=True)
    (root / "secret.yaml").write_text("hosts: {secret: }")
    (project / "archgen.yaml").write_text(HEAD)
    (project / "docs" / "real.txt").write_text("hosts: {real: }")
    links = {"a.yaml": "docs/real.txt", "b.yaml": "../secret.yaml", "c.yaml": "/etc/passwd", "d.yaml": "nothing"}
    links |= {"e.yaml": "e.yaml", "f": "docs", "g.yaml": "docs", "docs/h.yaml": "../f/../docs/real.txt"}
    for name, target in links.items():
        (project / name).symlink_to(target)
    commit(root, {})
    disk, committed = check_project(project), check_at_revision(project, "HEAD")
    unread = "`docs/real.txt` holds a part of an architecture and is not read: only names in .yaml and .yml are read"
    assert said(committed) == [
        f"archgen.yaml:1:1 ignored-file: {unread} | give it such a name if it belongs to this project",
        "b.yaml:1:1 syntax-error: this link leads out of the project's folder | copy the file into the project",
        "c.yaml:1:1 syntax-error: this link leads out of the project's folder | copy the file into the project",
        "d.yaml:1:1 syntax-error: this is a broken link: what it points to does not exist | None",
        "e.yaml:1:1 syntax-error: the file cannot be read: too many levels of symbolic links | None",
        "g.yaml:1:1 syntax-error: this is a folder, not a file | None",
    ]
    assert said(disk)[:4] == said(committed)[:4]
    assert committed.yaml_files == disk.yaml_files


def test_other_projects_hidden_folders_and_outputs_are_left_out(tmp_path: Path) -> None:
    names = ("b/c.yaml", "b/a.yaml", "b.yaml", ".hidden/x.yaml", ".x.yaml", "backends/x.yaml", "archgen-out/x.yaml")
    files: dict[str, str | bytes] = {name: f"hosts: {{h{number}: }}" for number, name in enumerate(names)}
    files |= {
        "other/archgen.yaml": HEAD,
        "other/deep/x.yaml": "hosts: {x: }",
        "packed.yaml": HEAD,
        "p.yaml": "speed: 1",
    }
    repository(tmp_path, {**SMALL, **files})
    disk, committed = check_project(tmp_path), check_at_revision(tmp_path, "HEAD")
    assert committed.yaml_files == disk.yaml_files == ("archgen.yaml", "a.yaml", "b/a.yaml", "b/c.yaml", "b.yaml")
    assert said(committed) == said(disk) != []


def test_submodules(tmp_path: Path) -> None:
    other = repository(tmp_path / "other", {"x.yaml": "hosts: {x: }"})
    root = repository(tmp_path / "robot", {**SMALL, "archgen.yaml": f"{HEAD}sources: [a.yaml, lib/x.yaml]\n"})
    run(root, "-c", "protocol.file.allow=always", "submodule", "add", "-q", str(other), "lib")
    commit(root, {})
    assert list(check_project(root).architecture.hosts) == ["pc", "x"]
    committed = check_at_revision(root, "HEAD")
    assert list(committed.architecture.hosts) == ["pc"]
    assert said(committed)[0].startswith(
        "lib/x.yaml:1:1 syntax-error: this lies in the submodule `lib`, of which a commit holds no files"
    )


def test_names_that_look_like_options_or_break_lines(tmp_path: Path) -> None:
    names = ("-x.yaml", "--help.yaml", "a b.yaml", "q'$(touch ran).yaml", "ö.yaml")
    files: dict[str, str | bytes] = {name: f"hosts: {{h{number}: }}" for number, name in enumerate(names)}
    repository(tmp_path, {**SMALL, **files, "-p/archgen.yaml": HEAD, "a\nb.yaml": "hosts: {no: }"})
    disk, committed = check_project(tmp_path), check_at_revision(tmp_path, "HEAD")
    assert said(committed) == said(disk)
    assert committed.yaml_files == disk.yaml_files
    assert len(committed.yaml_files) == 7
    assert check_at_revision(tmp_path / "-p", "HEAD").yaml_files == ("archgen.yaml",)
    assert not (tmp_path / "ran").exists()


def test_a_file_that_is_too_large_is_not_read(tmp_path: Path) -> None:
    repository(tmp_path, {**SMALL, "big.yaml": b"#" * (16 * 1024 * 1024 + 1)})
    assert said(check_at_revision(tmp_path, "HEAD"))[0] == (
        "big.yaml:1:1 too-large: the file is larger than 16 MiB | split it"
    )


def test_the_repository_runs_no_program(tmp_path: Path) -> None:
    attributes = "* filter=x diff=x merge=x text eol=crlf working-tree-encoding=UTF-16 ident\n"
    root = repository(tmp_path / "robot", SMALL)
    commit(root, {".gitattributes": attributes.replace("working-tree-encoding=UTF-16 ", "")})
    (root / ".git" / "info" / "attributes").write_text(attributes)
    program, mark = trap(tmp_path)
    keys = ("core.fsmonitor", "filter.x.clean", "filter.x.smudge", "filter.x.process", "core.pager", "diff.external")
    for key in (
        *keys,
        "diff.x.textconv",
        "diff.x.command",
        "gpg.program",
        "core.sshCommand",
        "core.alternateRefsCommand",
    ):
        run(root, "config", key, str(program))
    for hook in ("post-checkout", "reference-transaction", "post-index-change"):
        (root / ".git" / "hooks" / hook).symlink_to(program)
    assert list(check_at_revision(root, "HEAD").architecture.hosts) == ["pc"]
    git.find_branch_base(git.find_repository(root))
    assert not mark.exists()


@pytest.mark.parametrize("settings", [{}, {"protocol.allow": "always", "protocol.ext.allow": "always"}])
def test_a_partial_clone_fetches_nothing(tmp_path: Path, settings: dict[str, str]) -> None:
    origin = repository(tmp_path / "origin", SMALL)
    run(origin, "config", "uploadpack.allowFilter", "true")
    run(tmp_path, "clone", "-q", "--no-checkout", "--filter=blob:none", f"file://{origin}", "part")
    program, mark = trap(tmp_path)
    for key, value in {"remote.origin.url": f"ext::{program}", **settings}.items():
        run(tmp_path / "part", "config", key, value)
    checked = check_at_revision(tmp_path / "part", "HEAD")
    assert "this partial clone does not hold the file's content" in said(checked)[0]
    assert not mark.exists()


def test_pictures_of_chapters(tmp_path: Path) -> None:
    head = f"{HEAD}report: {{chapters: [docs/a.md, groups]}}\n"
    picture = b"\x89PNG\r\n\x1a\n\0"
    repository(tmp_path, {"archgen.yaml": head, "docs/a.md": "![A](a.png)\n", "docs/a.png": picture, "b.png": b"x"})
    for name in ("docs/a.md", "docs/a.png"):
        (tmp_path / name).unlink()
    chapters = check_at_revision(tmp_path, "HEAD").chapters
    assert chapters.texts["docs/a.md"].text == "![A](a.png)\n"
    assert chapters.read_pictures() == {"docs/a.png": picture}
    assert [chapters.read_picture(name) for name in ("docs/../b.png", "../b.png", "docs/none.png", "docs")] == [
        b"x"
    ] + [None] * 3


def test_no_process_stays(tmp_path: Path) -> None:
    children = Path(f"/proc/{os.getpid()}/task/{os.getpid()}/children")
    if not children.exists():
        pytest.skip("this system does not list processes in /proc")
    repository(tmp_path, SMALL)
    before = children.read_text().split()
    checked = check_at_revision(tmp_path, "HEAD")
    assert len(children.read_text().split()) > len(before)
    del checked
    assert children.read_text().split() == before
