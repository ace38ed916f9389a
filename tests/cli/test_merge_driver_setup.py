"""`archgen init --merge-driver`: what it writes and runs, in new projects and in those that are there."""

from __future__ import annotations

import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from tests import repositories
from tests.cli.conftest import Run
from tests.running import ROOT

PROJECT = "archgen: 1\nnodes:\n  n: {package: a_b, executable: x}\n"
DRIVER = "archgen merge-driver --marker-size=%L %O %A %B %P"


@pytest.fixture(autouse=True)
def _archgen_on_path(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(shutil, "which", lambda name: f"/usr/bin/{name}")


def read_setting(folder: Path, name: str) -> str:
    return repositories.git(folder, "config", "--local", f"merge.archgen.{name}")


def list_texts(folder: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in folder.iterdir() if path.is_file()}


def test_in_a_project_that_is_there_nothing_else_is_touched(run: Run, tmp_path: Path) -> None:
    folder = repositories.repository(
        tmp_path, {"archgen.yaml": PROJECT, "README.md": "mine\n", ".gitattributes": "*.png binary"}
    )
    before = list_texts(folder)
    ran = run("init", folder, "--merge-driver")
    assert (ran.status, ran.err) == (0, "")
    assert list_texts(folder) == before | {
        ".gitattributes": b"*.png binary\n*.yaml merge=archgen\n*.yml merge=archgen\n"
    }
    assert (read_setting(folder, "driver"), read_setting(folder, "name")) == (
        DRIVER,
        "slices of archgen by what they say",
    )
    assert ran.out.splitlines()[1:] == [
        "ran, for this clone (every other one needs `archgen init --merge-driver` too):",
        "    git config --local merge.archgen.name 'slices of archgen by what they say'",
        f"    git config --local merge.archgen.driver '{DRIVER}'",
        f"wrote {folder / '.git/hooks/post-merge'} (checks the project after each merge, in this clone)",
    ]
    ran = run("init", folder, "--merge-driver")
    assert ran.status == 0
    assert "names the merge driver already" in ran.out
    assert (folder / ".gitattributes").read_bytes() == b"*.png binary\n*.yaml merge=archgen\n*.yml merge=archgen\n"


def test_libraries_outside_of_the_projects_folder_get_the_line_too(run: Run, tmp_path: Path) -> None:
    project = "archgen: 1\nlibraries: {outer: ../common, inner: lib, ros: builtin, gone: ../gone}\n"
    files = {"robot/archgen.yaml": project, "robot/lib/a.yaml": "types: {A: {}}\n", "common/b.yaml": "types: {B: {}}\n"}
    top = repositories.repository(tmp_path, files)
    ran = run("init", top / "robot", "--merge-driver")
    assert ran.status == 0
    assert sorted(str(path.relative_to(top)) for path in top.rglob(".gitattributes")) == [
        "common/.gitattributes",
        "robot/.gitattributes",
    ]
    assert (top / "common" / ".gitattributes").read_bytes() == b"*.yaml merge=archgen\n*.yml merge=archgen\n"
    ran = run("init", top / "robot", "--merge-driver")
    assert ran.out.count("names the merge driver already") == 2


def test_a_new_project_outside_of_a_repository_says_what_to_do(run: Run, tmp_path: Path) -> None:
    ran = run("init", tmp_path / "robot", "--yes", "--merge-driver")
    assert ran.status == 0
    lines = (tmp_path / "robot/.gitattributes").read_text(encoding="utf-8").splitlines()
    assert lines[-2:] == ["*.yaml merge=archgen", "*.yml merge=archgen"]
    assert "*.yaml text eol=lf" in lines
    assert "There is no git repository yet. After `git init`, in this clone and in every other one, call\n" in ran.out
    assert f"    git config --local merge.archgen.driver '{DRIVER}'\n" in ran.out


def test_other_options_still_do_not_touch_a_project_that_is_there(run: Run, tmp_path: Path) -> None:
    folder = repositories.repository(tmp_path, {"archgen.yaml": PROJECT})
    ran = run("init", folder, "--merge-driver", "--title", "X")
    assert (ran.status, "is there already; nothing was written" in ran.err) == (2, True)
    assert not (folder / ".gitattributes").exists()


def test_a_link_in_its_place_is_refused(run: Run, tmp_path: Path) -> None:
    folder = repositories.repository(tmp_path / "robot", {"archgen.yaml": PROJECT})
    (tmp_path / "other").write_text("x")
    (folder / ".gitattributes").symlink_to(tmp_path / "other")
    ran = run("init", folder, "--merge-driver")
    assert (ran.status, "is a symbolic link, which git does not read; nothing was written" in ran.err) == (2, True)
    assert (tmp_path / "other").read_text() == "x"


def test_settings_that_git_refuses_are_said(run: Run, tmp_path: Path) -> None:
    folder = repositories.repository(tmp_path, {"archgen.yaml": PROJECT})
    (folder / ".git/config.lock").write_text("")
    ran = run("init", folder, "--merge-driver")
    assert (ran.status, "git does not take the setting merge.archgen.name: " in ran.err) == (2, True)


def test_git_merges_with_what_was_set_up_also_where_archgen_is_on_no_path(
    run: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(shutil, "which", lambda _name: None)
    monkeypatch.setenv("PYTHONPATH", str(ROOT))
    folder = repositories.repository(tmp_path / "a robot", {"archgen.yaml": PROJECT})
    run("init", folder, "--merge-driver")
    assert Path(sys.executable).as_posix() in read_setting(folder, "driver")
    repositories.commit(folder, {})
    repositories.git(folder, "checkout", "-q", "-b", "other")
    repositories.commit(folder, {"archgen.yaml": PROJECT.replace("a_b", "c_d")})
    repositories.git(folder, "checkout", "-q", "main")
    repositories.commit(folder, {"archgen.yaml": PROJECT.replace("executable: x", "executable: y")})
    repositories.git(folder, "merge", "-q", "--no-edit", "other")
    assert (folder / "archgen.yaml").read_text() == "archgen: 1\nnodes:\n  n: {package: c_d, executable: y}\n"


def test_after_a_clean_merge_the_whole_is_checked(run: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(shutil, "which", lambda _name: None)
    monkeypatch.setenv("PYTHONPATH", str(ROOT))
    eye = "groups: {g: {components: {eye: {outputs: {image: Image}}}}}\n"
    top = repositories.repository(
        tmp_path / "top",
        {"my robot/archgen.yaml": "archgen: 1\nproject: {id: r}\nsources: ['*.yaml']\n", "my robot/eye.yaml": eye},
    )
    assert run("init", top / "my robot", "--merge-driver").status == 0
    repositories.commit(top, {})
    repositories.git(top, "checkout", "-q", "-b", "rename")
    repositories.commit(top, {"my robot/eye.yaml": eye.replace("image:", "picture:")})
    repositories.git(top, "checkout", "-q", "main")
    reader = "groups: {h: {components: {base: {inputs: {i: eye.image}}}}}\n"
    repositories.commit(top, {"my robot/base.yaml": reader})
    done = subprocess.run(
        ["git", "-c", "user.name=x", "-c", "user.email=x@y", "merge", "--no-edit", "rename"],  # noqa: S607 - as people call it
        cwd=top,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0
    assert "error[unknown-reference]: no component or output named `eye.image`" in done.stderr
    assert done.stderr.endswith("archgen: git merged, and the architecture has errors\n")


def test_a_second_project_checks_too_and_a_hook_of_somebody_s_is_left_alone(run: Run, tmp_path: Path) -> None:
    top = repositories.repository(tmp_path / "top", {"a/archgen.yaml": PROJECT, "b/archgen.yaml": PROJECT})
    hook = top / ".git/hooks/post-merge"
    for name in ("a", "b", "b"):
        assert run("init", top / name, "--merge-driver").status == 0
    text = hook.read_text()
    assert [line.split()[2] for line in text.splitlines() if line.startswith("archgen check ")] == ["a", "b"]
    assert hook.stat().st_mode & 0o111
    hook.write_text("#!/bin/sh\nmine\n")
    ran = run("init", top / "a", "--merge-driver")
    assert hook.read_text() == "#!/bin/sh\nmine\n"
    assert "add there\n    archgen check a --quiet --changed-since ORIG_HEAD >&2\n" in ran.out


def test_hooks_in_a_folder_of_their_own_are_left_alone(run: Run, tmp_path: Path) -> None:
    folder = repositories.repository(tmp_path / "robot", {"archgen.yaml": PROJECT})
    repositories.git(folder, "config", "core.hooksPath", "tools/hooks")
    ran = run("init", folder, "--merge-driver")
    assert (ran.status, "git looks elsewhere for hooks" in ran.out) == (0, True)
    assert not (folder / ".git/hooks/post-merge").exists()
